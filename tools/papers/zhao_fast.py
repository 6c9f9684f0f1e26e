"""Zhao 2015, section 5.1.1: the Earth's period of a fast vehicle; averaging works where damping fails."""

import numpy as np

from navcore.foundation.units import ARCSEC, HOUR
from navcore.mechanization.recorder import D_LAT, PHI_E, PHI_N, PHI_U
from tools.papers.claim import Claim, Table, at_least, at_most, number
from tools.papers.measure import rms
from tools.papers.runs import Runs, method

PRESET = "zhao-initial"
INTERNAL, AVERAGED = "internal damping", "Zhao"
AT_REST = "motion.kind=static"
COARSE_H, FINE_H = np.arange(8.0, 40.0, 0.5), np.arange(-0.5, 0.5, 0.02)
"""Periods that are tried, and the finer ones around the best of them."""


def earth_period_h(runs: Runs, quantity: int, *overrides: str) -> float:
    """Period of the slow oscillation of a quantity of the free run, h: that of the best single sinusoid.

    A constant, a trend and both Schuler lines (as one of varying size) are fitted beside it.
    """

    def make() -> float:
        found = method(runs(PRESET, *overrides), "free")
        t, values = found.t_s, found.rows[:, quantity]
        fast = runs(PRESET).scenario.omega_s * t
        beside = [np.ones_like(t), np.cos(fast), np.sin(fast), t * np.cos(fast), t * np.sin(fast)]

        def misfit(period_h: float) -> float:
            phase = 2.0 * np.pi * t / (period_h * HOUR)
            basis = np.column_stack([*beside, np.cos(phase), np.sin(phase)])
            return float(np.sum((values - basis @ np.linalg.lstsq(basis, values, rcond=None)[0]) ** 2))

        return float(min(min(COARSE_H, key=misfit) + FINE_H, key=misfit))

    return runs.keep(("zhao earth period", quantity, overrides, runs.strapdown), make)


def tilt(runs: Runs, name: str) -> float:
    """RMS tilt of an axis over the run, arcsec."""
    return rms(method(runs(PRESET), name).rows[:, [PHI_E, PHI_N]]) / ARCSEC


def tilt_table(runs: Runs) -> Table:
    """Tilt of every method on the fast vehicle."""
    rows = tuple(
        (
            each.method.name,
            number(tilt(runs, each.method.name)),
            number(tilt(runs.in_strapdown(), each.method.name)),
        )
        for each in runs(PRESET).methods
    )
    return Table("RMS tilt of an axis over the 24 h, arcsec:", ("method", "linear", "strapdown"), rows)


_PERIOD = (
    "the period of oscillation errors that relate to the rotation of the Earth is smaller than 24 h, "
    "primarily due to the high velocity"
)

FAST_VEHICLE = (
    *(
        Claim(
            f"the Earth's oscillation is faster than 24 h on the fast vehicle (5.1.1): period of {name}",
            "smaller than 24 h",
            at_most(23.9),
            lambda runs, quantity=quantity: earth_period_h(runs, quantity),
            "h",
            kind="predicted",
            strapdown=True,
            note="At rest the same fit gives {rest} h.",
            facts={"rest": lambda runs, quantity=quantity: earth_period_h(runs, quantity, AT_REST)},
            quote=_PERIOD,
        )
        for name, quantity in (("heading", PHI_U), ("latitude", D_LAT))
    ),
    Claim(
        "damping without a reference fails where averaging works: RMS tilt of an axis, internal damping "
        "(classic2) over Zhao's average",
        "averaging is better",
        at_least(1.0),
        lambda runs: tilt(runs, INTERNAL) / tilt(runs, AVERAGED),
        strapdown=True,
        note="{internal} arcsec against {averaged} arcsec; undamped {free} arcsec. The acceleration of the "
        "vehicle enters the damped loop as an error.",
        facts={
            "internal": lambda runs: tilt(runs, INTERNAL),
            "averaged": lambda runs: tilt(runs, AVERAGED),
            "free": lambda runs: tilt(runs, "free"),
        },
        quote="oscillation errors caused by initial errors can be suppressed, which is impossible for the "
        "damping inertial navigation system",
    ),
)
