"""The same objects for python-control, and the margins it computes; imported only when asked, it is slow."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Unpack

import numpy as np

from navcore.loop.analysis import analyse
from navcore.loop.transfers import Output, Source, TransferOptions, transfer
from navcore.network.base import LinearNetwork

if TYPE_CHECKING:
    from control import TransferFunction


@dataclass(frozen=True)
class Margins:
    """Margins of the open loop omega_s^2 H(s)/s^2.

    Attributes
    ----------
    gain_up, gain_down : float or None
        Factor to which the loop gain may rise or fall before the loop gets unstable; None: no limit.
    phase_rad : float or None
        Smallest phase margin, rad.
    crossover_rad_s : float or None
        Frequency of that margin, rad/s.
    delay_s : float or None
        Delay that makes the loop unstable, s.
    """

    gain_up: float | None
    gain_down: float | None
    phase_rad: float | None
    crossover_rad_s: float | None
    delay_s: float | None


def to_control(
    network: LinearNetwork,
    source: Source | None = None,
    output: Output = "phi",
    *,
    normalised: bool = False,
    **options: Unpack[TransferOptions],
) -> TransferFunction:
    """Return H(s), or one transfer of the closed loop, as a python-control TransferFunction.

    Parameters
    ----------
    network : LinearNetwork
        H(s).
    source, output
        As for `navcore.loop.transfer`; source None gives H(s) itself.
    normalised : bool
        In p = s / omega_s (time in units of 1/omega_s): to be preferred for anything numerical.
    **options
        As for `navcore.loop.transfer`.
    """
    import control

    if source is None:
        num, den = network.num, network.den
    else:
        num, den = transfer(network, source, output, **options)
    if normalised:
        w = network.omega_s
        top = len(den) - 1
        num = num * w ** (np.arange(len(num) - 1, -1, -1) - float(top))
        den = den * w ** (-np.arange(len(den), dtype=float))
    return control.TransferFunction(num, den)


def margins(network: LinearNetwork) -> Margins | None:
    """Margins of the loop omega_s^2 H/s^2; None where they mean nothing (undamped or unstable loop)."""
    loop = analyse(network)
    if not loop.stable or loop.settling_s is None:
        return None
    import control

    open_loop = control.TransferFunction(network.num_p, np.append(network.den_p, [0.0, 0.0]))
    gains, phases, _, _, crossings, _ = control.stability_margins(open_loop, returnall=True)
    gains = np.asarray(gains)[np.isfinite(gains)]
    up, down = gains[gains > 1.0], gains[(gains > 0.0) & (gains < 1.0)]
    phases, crossings = np.atleast_1d(phases), np.atleast_1d(crossings)
    if len(phases) == 0:
        return Margins(_smallest(up), _largest(down), None, None, None)
    least = int(np.argmin(np.abs(phases)))
    # a delay turns the phase clockwise: only the way from each crossing down to -180 deg counts
    lag = np.mod(np.deg2rad(phases), 2.0 * math.pi)
    return Margins(
        gain_up=_smallest(up),
        gain_down=_largest(down),
        phase_rad=float(np.deg2rad(phases[least])),
        crossover_rad_s=float(crossings[least]) * network.omega_s,
        delay_s=float(np.min(lag / crossings)) / network.omega_s,
    )


def _smallest(values: np.ndarray) -> float | None:
    return float(np.min(values)) if len(values) else None


def _largest(values: np.ndarray) -> float | None:
    return float(np.max(values)) if len(values) else None
