"""Fields of the policies that read the mean of |a|: `acceleration`, `mobility`, `states`."""

from typing import Any

from navcore.foundation.parameters import quantity
from navcore.foundation.text import Text


def acceleration_limit() -> Any:
    """Declare the mean of |a| from which on a method is undamped, m/s^2."""
    return quantity(
        0.01,
        unit="m/s2",
        gt=0.0,
        le=100.0,
        slider=(0.001, 1.0),
        log=True,
        label=Text("acceleration limit"),
        help=Text(
            "Undamped while the mean of |a| exceeds this (Sun 2017, 1); |a| is the rate of change of the"
            " computed velocity."
        ),
    )


def averaging_time() -> Any:
    """Declare the time over which the size of the acceleration is averaged, s."""
    return quantity(
        20.0,
        unit="s",
        gt=0.0,
        le=3600.0,
        slider=(1.0, 300.0),
        log=True,
        label=Text("averaged over"),
        help=Text("Time over which |a| is averaged."),
    )
