"""Liu 2021: powers of omega_s, a mean over one term too many, the direct form, and figure 7."""

import numpy as np

from navcore.analysis import RADIUS, frequency_response
from navcore.foundation.text import Text
from navcore.foundation.units import MINUTE
from navcore.mechanization.recorder import DV_E
from navcore.networks.complementary import ComplementaryNetwork
from schuler_bench.misprints.base import (
    OMEGA_S,
    TIME,
    Axis,
    Comparison,
    Curve,
    Misprint,
    Number,
    as_network,
    run_scenario,
)
from schuler_bench.misprints.direct_form import direct_form_error, direct_form_growth, state_space_error
from schuler_bench.misprints.two_loops import TwoLoops
from schuler_bench.plots.units import number

_ZETA = 0.7


def _power() -> Comparison:
    right = ComplementaryNetwork(zeta=_ZETA).transfer(OMEGA_S)
    # omega_s^3 s^3 where omega_s s^3 is meant: omega_s^2 (rad/s, numbers) on the coefficient of p^3
    num, den = right.num_p.copy(), right.den_p.copy()
    num[1] *= OMEGA_S**2
    den[1] *= OMEGA_S**2
    loops = TwoLoops(as_network(num, den), right)
    return loops.compare(
        np.arange(0.0, 6 * 3600.0 + 1.0, 30.0),
        ("ωₛ³ s³ (printed)", "ωₛ s³"),
        (loops.damping, loops.growth),
        Text(
            "With the printed power the s³ terms vanish and the loop grows e-fold in "
            "{growth_s:.0f} min; mended its least damping ratio is {damping_ratio:.2f}.",
            growth_s=loops.growth_s / MINUTE,
            damping_ratio=loops.corrected.damping_ratio,
        ),
    )


def _transfer_powers() -> Comparison:
    omega = np.geomspace(1e-5, 1e-1, 301)
    network = ComplementaryNetwork(zeta=_ZETA).transfer(OMEGA_S)
    corrected = RADIUS * np.abs(frequency_response(network, "dv_r", "phi", omega))
    s, w = 1j * omega, OMEGA_S
    # Liu 6 with the powers of omega_s as they stand
    den = np.polyval([1.0, 3.4 * w**5, 6.8 * w**4, 8.2 * w**3, 6.8 * w**2, 3.4 * w, w**6], s)
    printed = np.abs(1.4 * w**3 * s**2 / den)
    here = int(np.argmin(np.abs(omega - w)))
    gains = float(printed[here]), float(corrected[here])
    return Comparison(
        x_axis=Axis("frequency", "rad/s", log=True),
        y_axis=Axis("R φ / δVr", "s", log=True),
        x=omega,
        curves=(
            Curve(Text("Liu 6 as printed"), "printed", printed),
            Curve(Text("powers mended"), "corrected", corrected),
        ),
        numbers=(Number(Text("gain at the Schuler frequency"), "s", gains[0], gains[1]),),
        words=Text(
            "At the Schuler frequency the printed transfer has the gain {gains} s "
            "instead of {gains_2:.0f} s: fig. 3 cannot have been drawn with it.",
            gains=number(gains[0], 2),
            gains_2=gains[1],
        ),
    )


def variation(difference: np.ndarray, window: int, apart: int, terms: int) -> np.ndarray:
    """Compute s of Liu 15 (m/s) at each sample: sums of ``terms`` samples divided by ``window``.

    Parameters
    ----------
    difference : ndarray, shape (n,)
        V_r - V_c each second, m/s; before the first it counts as zero.
    window : int
        Divisor n.
    apart : int
        Samples t0 between the two windows.
    terms : int
        Samples summed: n, or n + 1 as printed.
    """
    sums = np.convolve(difference, np.ones(terms))[: len(difference)] / window
    earlier = np.concatenate([np.zeros(apart), sums[:-apart]])
    return np.abs(sums - earlier)


def _terms() -> Comparison:
    t = np.arange(0.0, 401.0)
    change = 0.43
    difference = change * np.clip((t - 100.0) / 40.0, 0.0, 1.0)
    printed, corrected = variation(difference, 20, 80, 21), variation(difference, 20, 80, 20)
    peaks = float(np.max(printed)), float(np.max(corrected))
    return Comparison(
        x_axis=TIME,
        y_axis=Axis(Text("s of Liu 15"), "m/s"),
        x=t,
        curves=(
            Curve(Text("n + 1 terms over n (printed)"), "printed", printed),
            Curve(Text("n terms over n"), "corrected", corrected),
        ),
        numbers=(Number(Text("largest s for a change of 0.43 m/s"), "m/s", peaks[0], peaks[1]),),
        words=Text(
            "A change of {change:g} m/s counts as {peaks:.4g} m/s, beyond c = 0.45: the "
            "loop is undamped where it should stay as it is.",
            change=change,
            peaks=peaks[0],
        ),
    )


def _direct_form() -> Comparison:
    steps = np.geomspace(0.005, 1.0, 24)
    network = ComplementaryNetwork(zeta=0.5).transfer(OMEGA_S)
    double = np.array([direct_form_error(network, float(step), np.float64) for step in steps])
    single = np.array([direct_form_error(network, float(step), np.float32) for step in steps])
    right = np.array([state_space_error(network, float(step)) for step in steps])
    at_tenth = direct_form_error(network, 0.1, np.float64), state_space_error(network, 0.1)
    growth = direct_form_growth(0.5, 0.01, np.float64)
    unstable = (
        ""
        if growth is None
        else Text(", and at 0.01 s it is unstable (e-fold in {growth:.0f} s)", growth=growth)
    )
    return Comparison(
        x_axis=Axis(Text("step T"), "s", log=True),
        y_axis=Axis(Text("largest relative error of H"), "", log=True),
        x=steps,
        curves=(
            Curve(Text("direct form, double"), "printed", double),
            Curve(Text("direct form, single"), "printed", single),
            Curve(Text("state space in normalised time"), "corrected", right),
        ),
        numbers=(
            Number(Text("error of H at T = 0.1 s"), "", at_tenth[0], at_tenth[1]),
            Number(Text("e-folding time at T = 0.01 s"), "s", growth, None),
        ),
        words=Text(
            "The coefficients are right, but they do not fit into a double: at 0.1 s H "
            "is wrong by {at_tenth:.0f} %{unstable}.",
            at_tenth=100.0 * at_tenth[0],
            unstable=unstable,
        ),
    )


def _after_ten_hours(switching: str = "hard", **reference: object) -> tuple[np.ndarray, np.ndarray]:
    """Change of dV_E from its value at 10 h (m/s), one level channel, zeta = 0.5, 0.5 m/s of log error."""
    t, (east,) = run_scenario(
        {
            "run": {"fidelity": "channel", "duration_h": 14.0, "output_step_s": 20.0, "earth": "sphere"},
            "imu": {"gyro_bias_dph": [1e-4] * 3, "accel_bias_ug": [10.0] * 3},
            "reference": {"kind": "log", "bias_mps": [0.5, 0.0], **reference},
            "method": [
                {
                    "damping": "external",
                    "network": {"id": "complementary", "zeta": 0.5, "eta": 0.5},
                    "switching": {"id": switching},
                },
            ],
        },
        DV_E,
    )
    start = int(np.searchsorted(t, 10 * 3600.0))
    return t[start:], east[start:] - east[start]


def _figure_7() -> Comparison:
    def step(size: float) -> tuple[np.ndarray, np.ndarray]:
        return _after_ten_hours(event=[{"t_h": 10.0, "duration_s": 20.0, "accel_mps2": [size / 20.0, 0.0]}])

    t, quarter = step(0.25)
    _, half = step(0.5)
    outage = [{"t_h": 10.0, "duration_s": 200.0}]
    _, switched = _after_ten_hours(outage=outage)
    _, kept = _after_ten_hours("keep", outage=outage)
    peaks = [float(np.max(np.abs(y))) for y in (quarter, half, switched, kept)]
    return Comparison(
        x_axis=TIME,
        y_axis=Axis(Text("change of δVE"), "m/s"),
        x=t,
        curves=(
            Curve(Text("s = 0.25 m/s (what Liu says it is like)"), "printed", quarter),
            Curve(Text("undamped for 200 s, network cleared"), "corrected", switched),
            Curve("s = 0.5 m/s", "corrected", half),
            Curve(Text("undamped for 200 s, network kept"), "corrected", kept),
        ),
        numbers=(
            Number(Text("overshoot after the switch"), "m/s", peaks[0], peaks[2]),
            Number(Text("the same without clearing the network"), "m/s", None, peaks[3]),
        ),
        words=Text(
            "Clearing the network with 0.5 m/s of log error present acts like a step of "
            "0.5 m/s: the overshoot is {peaks:.3f} m/s ({peaks_2:.3f} for the step), not "
            "the {peaks_3:.3f} of 0.25 m/s. Without clearing there is none.",
            peaks=peaks[2],
            peaks_2=peaks[1],
            peaks_3=peaks[0],
        ),
    )


LIU = (
    Misprint(
        id="liu-5",
        paper="Liu 2021",
        where="eq. 5",
        printed=Text("ωₛ³ s³ in numerator and denominator"),
        right="ωₛ s³",
        consequence=Text("the loop is unstable"),
        compute=_power,
    ),
    Misprint(
        id="liu-6",
        paper="Liu 2021",
        where="eq. 6",
        printed="3.4 ωₛ⁵ s⁵ + 6.8 ωₛ⁴ s⁴ + ... + 3.4 ωₛ s + ωₛ⁶",
        right="ωₛ s⁵, ωₛ² s⁴, ..., ωₛ⁵ s",
        consequence=Text("a gain that has nothing to do with fig. 3"),
        compute=_transfer_powers,
    ),
    Misprint(
        id="liu-15",
        paper="Liu 2021",
        where="eq. 15",
        printed=Text("n + 1 terms divided by n"),
        right="n terms",
        consequence=Text("every change counts 5 % too large"),
        compute=_terms,
    ),
    Misprint(
        id="liu-19",
        paper="Liu 2021",
        where="eq. 17 to 19",
        printed=Text("the direct form"),
        right=Text("state space in normalised time (theory.md 3.5)"),
        consequence=Text("a wrong, then unstable network at small steps"),
        compute=_direct_form,
        remark=True,
    ),
    Misprint(
        id="liu-fig7",
        paper="Liu 2021",
        where="fig. 7",
        printed=Text("switching undamped for 200 s is like s = 0.25 m/s"),
        right=Text("like a step of the whole 0.5 m/s that the log is off"),
        consequence=Text("the cost of a switch is put at half its size"),
        compute=_figure_7,
        remark=True,
    ),
)
"""Misprints of Liu 2021 in the order of the paper."""
