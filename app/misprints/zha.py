"""Zha 2019: a decimal point in the design of sigma, and K2 of the first set of gains."""

import math

import numpy as np

from navcore.analysis import analyse, initial_tilt_response
from navcore.foundation.text import Text
from navcore.foundation.units import MINUTE
from navcore.networks.compass import CompassNetwork, gains_from_sigma_xi
from schuler_bench.misprints.base import OMEGA_S, TILT, TIME, Comparison, Curve, Misprint, Number

_SIGMA, _XI = 0.0088, 0.7
PRINTED_K2 = 156.063
"""Zha 4.1, for sigma = 0.0088, xi = 0.7."""
_PERCENT_OF_INITIAL = 0.005
"""Zha's own measure of "effective decay" once 99.995 % is read as 99.5 %."""


def _last_above(t: np.ndarray, y: np.ndarray, level: float) -> float:
    """Last time at which |y| exceeds a level, s."""
    return float(t[np.flatnonzero(np.abs(y) > level)[-1]])


def _gain() -> Comparison:
    k1, k2, k3 = gains_from_sigma_xi(_SIGMA, _XI, OMEGA_S)
    t = np.arange(0.0, 2401.0, 2.0)
    networks = {
        "printed": CompassNetwork(k1=k1, k2=PRINTED_K2, k3=k3).transfer(OMEGA_S),
        "corrected": CompassNetwork(sigma=_SIGMA, xi=_XI).transfer(OMEGA_S),
    }
    y = {form: initial_tilt_response(network, t) for form, network in networks.items()}
    loop = {form: analyse(network) for form, network in networks.items()}
    slowest = {form: 5.25 / -float(np.max(closed.poles.real)) for form, closed in loop.items()}
    settled = {form: _last_above(t, values, _PERCENT_OF_INITIAL) for form, values in y.items()}
    return Comparison(
        x_axis=TIME,
        y_axis=TILT,
        x=t,
        curves=(
            Curve(f"K₂ = {PRINTED_K2:g} (printed)", "printed", y["printed"]),
            Curve(f"K₂ = {k2:.2f}", "corrected", y["corrected"]),
        ),
        numbers=(
            Number("K₂", "", PRINTED_K2, k2),
            Number(Text("damping ratio"), "", loop["printed"].damping_ratio, loop["corrected"].damping_ratio),
            Number(Text("time in which the slowest pole decays to 0.5 %"), "s", *slowest.values()),
            Number(
                Text("last above 0.5 % of the initial tilt"), "s", settled["printed"], settled["corrected"]
            ),
            Number(Text("last above 2 %"), "s", loop["printed"].settling_s, loop["corrected"].settling_s),
        ),
        words=Text(
            "With the printed K₂ the damping is {damping_ratio:.2f} instead of "
            "{damping_ratio_2:.2f}, and the 10 min of the design (σ t = 5.25) become "
            "{printed:.0f}; 0.5 % of the tilt is last exceeded after {printed_2:.0f} min "
            "instead of {corrected:.0f}.",
            damping_ratio=loop["printed"].damping_ratio,
            damping_ratio_2=loop["corrected"].damping_ratio,
            printed=slowest["printed"] / MINUTE,
            printed_2=settled["printed"] / MINUTE,
            corrected=settled["corrected"] / MINUTE,
        ),
    )


def _design() -> Comparison:
    duration = 600.0
    t = np.concatenate([np.arange(0.0, 20.0, 0.05), np.arange(20.0, 901.0, 1.0)])
    sigmas = {"printed": 525.0 / duration, "corrected": 5.25 / duration}
    y = {
        form: initial_tilt_response(CompassNetwork(sigma=sigma, xi=_XI).transfer(OMEGA_S), t)
        for form, sigma in sigmas.items()
    }
    left = {form: math.exp(-sigma * duration) for form, sigma in sigmas.items()}
    return Comparison(
        x_axis=TIME,
        y_axis=TILT,
        x=t,
        curves=(
            Curve(Text("σ t = 525 (printed)"), "printed", y["printed"]),
            Curve("σ t = 5.25", "corrected", y["corrected"]),
        ),
        numbers=(
            Number(Text("σ for t = 600 s"), "1/s", sigmas["printed"], sigmas["corrected"]),
            Number(Text("exp(-σ t) at 600 s"), "", left["printed"], left["corrected"]),
        ),
        words=Text(
            "The σ = 0.0088 that Zha uses belongs to σ t = 5.25: {corrected:.1f} % is "
            "left after 10 min. The printed 525 would ask for σ = {printed:.3f}.",
            corrected=100.0 * left["corrected"],
            printed=sigmas["printed"],
        ),
    )


ZHA = (
    Misprint(
        id="zha-3",
        paper="Zha 2019",
        where="section 3",
        printed=Text('"99.995 %" in 10 min, σ t = 525'),
        right=Text("σ t = 5.25 gives 99.5 %; σ = 0.0088"),
        consequence=Text("taken at its word, σ a hundred times too large"),
        compute=_design,
    ),
    Misprint(
        id="zha-4.1",
        paper="Zha 2019",
        where="section 4.1",
        printed=Text("K₂ = {printed_k2:g} for σ = 0.0088, ζ = 0.7", printed_k2=PRINTED_K2),
        right="K₂ = 202.52 (K₁ = 0.0264, K₃ = 0.9045 agree)",
        consequence=Text("less damped and twice as slow as designed"),
        compute=_gain,
    ),
)
"""Misprints of Zha 2019 in the order of the paper."""
