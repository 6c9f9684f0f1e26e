"""Sun 2017: a missing radius, the sign in the quadratic and what it becomes, and the network's B."""

import numpy as np

from navcore.analysis import RADIUS, analyse, frequency_response
from navcore.foundation.text import Text
from navcore.foundation.units import HOUR, KNOT, MINUTE
from navcore.law.policy.adaptive import HIGHEST, LOWEST, QUADRATIC, SUN_TABLE
from navcore.networks.base import LinearNetwork
from navcore.networks.classic import Classic3Network
from navcore.networks.pole2 import Pole2Network
from navcore.networks.unity2 import Unity2Network
from schuler_bench.misprints.base import (
    OMEGA_S,
    Axis,
    Comparison,
    Curve,
    Misprint,
    Number,
    as_network,
)
from schuler_bench.misprints.two_loops import TwoLoops
from schuler_bench.plots.units import number

_DIFFERENCE = Axis("|V − Vᵣ|", "m/s")
_PRINTED = (QUADRATIC[0], -QUADRATIC[1], QUADRATIC[2])


def _table(difference_kn: np.ndarray | float) -> np.ndarray:
    from scipy.interpolate import PchipInterpolator

    knots, xi = zip(*SUN_TABLE, strict=True)
    return np.clip(PchipInterpolator(knots, xi)(difference_kn), LOWEST, HIGHEST)


def _radius() -> Comparison:
    omega = np.geomspace(1e-5, 1.0, 301)
    corrected = np.abs(frequency_response(Classic3Network().transfer(OMEGA_S), "acceleration", "phi", omega))
    printed = corrected * RADIUS
    here = int(np.argmin(np.abs(omega - OMEGA_S)))
    gains = float(printed[here]), float(corrected[here])
    return Comparison(
        x_axis=Axis("frequency", "rad/s", log=True),
        y_axis=Axis(Text("tilt for 1 m/s² of acceleration"), "rad", log=True),
        x=omega,
        curves=(
            Curve("(1-H)/(s² + ωₛ² H)", "printed", printed),
            Curve("(1-H)/(R (s² + ωₛ² H))", "corrected", corrected),
        ),
        numbers=(Number(Text("gain at the Schuler frequency"), "rad/(m/s²)", gains[0], gains[1]),),
        words=Text(
            "Without 1/R the tilt comes out {radius} times too large: {gains} rad for 1 "
            "m/s² at the Schuler frequency instead of {gains_2:.2f} rad.",
            radius=number(RADIUS, 2),
            gains=number(gains[0], 2),
            gains_2=gains[1],
        ),
    )


def _sign() -> Comparison:
    knots = np.arange(0.0, 3.005, 0.01)
    printed, mended = np.polyval(_PRINTED, knots), np.polyval(QUADRATIC, knots)
    table = _table(knots)
    return Comparison(
        x_axis=_DIFFERENCE,
        y_axis=Axis(Text("damping ratio ζ")),
        x=knots * KNOT,
        curves=(
            Curve(Text("Sun 9 as printed"), "printed", printed),
            Curve(Text("Sun 9, sign mended"), "corrected", mended),
            Curve(Text("Sun's Table 1, PCHIP"), "corrected", table),
        ),
        numbers=(Number(Text("ζ at 3 kn"), "", float(printed[-1]), float(table[-1])),),
        words=Text(
            "As printed ζ rises with the difference, to {printed:.1f} at 3 kn where "
            "Sun's own table has {table:.2f}: the worse the log, the harder it is "
            "believed. Clamped to the table's 0.99 it stands there from 0.15 kn on; so "
            "Sun's figures 10 to 12 come out, without adapting.",
            printed=printed[-1],
            table=table[-1],
        ),
    )


def negative_range() -> tuple[float, float]:
    """Differences (m/s) between which Sun 9 with its sign mended asks for negative damping."""
    low, high = np.sort(np.roots(QUADRATIC).real) * KNOT
    return float(low), float(high)


def _mirrored(network: LinearNetwork) -> LinearNetwork:
    """H(-s): the same design with the signs of xi, and so of all its poles, changed."""
    signs = [(-1.0) ** np.arange(len(c) - 1, -1, -1) for c in (network.num_p, network.den_p)]
    return as_network(network.num_p * signs[0], network.den_p * signs[1])


def _negative() -> Comparison:
    difference = 1.8
    asked, table = float(np.polyval(QUADRATIC, difference)), float(_table(difference))
    loops = TwoLoops(
        _mirrored(Pole2Network(xi=-asked).transfer(OMEGA_S)), Unity2Network(zeta=table).transfer(OMEGA_S)
    )
    low, high = negative_range()
    return loops.compare(
        np.arange(0.0, 1801.0, 5.0),
        (
            Text("quadratic at 1.8 kn: ζ = {asked:.3f}", asked=asked),
            Text("table at 1.8 kn: ζ = {table:.2f}", table=table),
        ),
        (
            Number(Text("ζ at 1.8 kn"), "", asked, table),
            loops.growth,
            Number(Text("negative from"), "m/s", low, None),
            Number(Text("negative to"), "m/s", high, None),
        ),
        Text(
            "Even with its sign mended the quadratic is negative between {low:.2f} and "
            "{high:.2f} kn: negative damping, e-fold in {growth_s:.1f} min at 1.8 kn.",
            low=low / KNOT,
            high=high / KNOT,
            growth_s=loops.growth_s / MINUTE,
        ),
    )


def _sigma() -> Comparison:
    right = Pole2Network(xi=0.5).transfer(OMEGA_S)
    loops = TwoLoops(_mirrored(right), right)
    return loops.compare(
        np.arange(0.0, 901.0, 2.0),
        (Text("σ = + ζ ωₙ (printed)"), "σ = - ζ ωₙ"),
        (loops.damping, loops.growth),
        Text(
            "With the positive σ of Sun 16 all four poles of Sun 14 and 15 lie on the "
            "right: e-fold in {growth_s:.0f} s.",
            growth_s=loops.growth_s,
        ),
    )


def real_damping(xi: float) -> tuple[float, float]:
    """Damping ratio of the loop with `pole2` as printed and exact, n1 = 14, n2 = 5, when xi is asked."""
    printed = Pole2Network(xi=xi, variant="as_printed").transfer(OMEGA_S)
    return analyse(printed).damping_ratio, analyse(Pole2Network(xi=xi).transfer(OMEGA_S)).damping_ratio


def least_stable() -> float:
    """Smallest xi for which `pole2` as printed (n1 = 14, n2 = 5) is stable."""
    low, high = 0.01, 0.5
    while high - low > 1e-6:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if real_damping(middle)[0] > 0.0 else (middle, high)
    return high


def _residue() -> Comparison:
    asked = np.linspace(0.02, 1.0, 50)
    real = np.array([real_damping(float(xi)) for xi in asked])
    limit, (printed, exact) = least_stable(), real_damping(0.5)
    return Comparison(
        x_axis=Axis(Text("damping ratio asked")),
        y_axis=Axis(Text("damping ratio of the loop")),
        x=asked,
        curves=(
            Curve("B = -A w₂/w₁ (printed)", "printed", real[:, 0]),
            Curve("B = (c-a) - A", "corrected", real[:, 1]),
        ),
        numbers=(
            Number(Text("damping ratio when 0.5 is asked"), "", printed, exact),
            Number(Text("unstable for ζ up to"), "", limit, None),
        ),
        words=Text(
            "Forcing H(0) = 1 moves the pair: {printed:.2f} when 0.5 is asked, and no "
            "stability at all up to ζ = {limit:.3f}.",
            printed=printed,
            limit=limit,
        ),
    )


def _small_xi() -> Comparison:
    xi = 0.08
    loops = TwoLoops(
        Pole2Network(xi=xi, variant="as_printed").transfer(OMEGA_S), Pole2Network(xi=xi).transfer(OMEGA_S)
    )
    entries = sum(real_damping(value)[0] < 0.0 for _, value in SUN_TABLE)
    return loops.compare(
        np.arange(0.0, 86401.0, 120.0),
        (Text("ζ = 0.08 as printed"), "ζ = 0.08 exact"),
        (loops.damping, loops.growth),
        Text(
            "At ζ = 0.08, an entry of Sun's own table, the loop as printed grows e-fold "
            "in {growth_s:.0f} h (damping {damping_ratio:.3f}); so it does for {entries} "
            "of the {sun_table} entries.",
            growth_s=loops.growth_s / HOUR,
            damping_ratio=loops.printed.damping_ratio,
            entries=entries,
            sun_table=len(SUN_TABLE),
        ),
    )


SUN = (
    Misprint(
        id="sun-3",
        paper="Sun 2017",
        where="eq. 3",
        printed="φ/A = (1-H)/(s² + ωₛ² H)",
        right="with 1/R",
        consequence=Text("a tilt six million times too large"),
        compute=_radius,
    ),
    Misprint(
        id="sun-9",
        paper="Sun 2017",
        where="eq. 9",
        printed="ζ = 0.3076 d² + 1.1452 d + 0.8101",
        right=Text("- 1.1452 d"),
        consequence=Text(
            "the damping rises with the difference instead of falling, and clamped it does not adapt"
        ),
        compute=_sign,
    ),
    Misprint(
        id="sun-9-negative",
        paper="Sun 2017",
        where=Text("eq. 9, sign mended, unclamped"),
        printed="ζ = 0.3076 d² - 1.1452 d + 0.8101",
        right=Text("the table, interpolated monotonically and clamped to 0.04 .. 0.99"),
        consequence=Text("negative damping between 0.95 and 2.77 kn"),
        compute=_negative,
    ),
    Misprint(
        id="sun-16",
        paper="Sun 2017",
        where="eq. 16",
        printed="σ = ζ ωₙ",
        right="σ = -ζ ωₙ",
        consequence=Text("all poles on the right"),
        compute=_sigma,
    ),
    Misprint(
        id="sun-18",
        paper="Sun 2017",
        where="eq. 18",
        printed="B = -A w₂/w₁",
        right=Text("B = (c-a) - A (pole2 exact), or unity2 for H(0) = 1"),
        consequence=Text("the loop is less damped than asked"),
        compute=_residue,
    ),
    Misprint(
        id="sun-18-unstable",
        paper="Sun 2017",
        where=Text("eq. 18 with Table 1"),
        printed=Text("B = -A w₂/w₁ at ζ = 0.08"),
        right="B = (c-a) - A",
        consequence=Text("the loop is unstable"),
        compute=_small_xi,
    ),
)
"""Misprints of Sun 2017 in the order of the paper."""
