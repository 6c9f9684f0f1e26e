"""Bridge to python-control: its own objects, and the disk margin.

It is imported only when asked: that takes most of a second. The margins that follow a slider are those of
`navcore.analysis.margins`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Unpack

import numpy as np

from navcore.analysis.loop import analyse
from navcore.analysis.transfers import Output, Source, TransferOptions, transfer
from navcore.networks.base import LinearNetwork
from navcore.networks.transfer_function import transfer_function

if TYPE_CHECKING:
    from control import TransferFunction

_LOWEST, _HIGHEST, _A_DECADE = 1e-3, 1e3, 500
_RESONANCE = np.linspace(-3.0, 3.0, 301)
"""Grid of the disk margin: from 1/1000 of the slowest to 1000 times the fastest root, and within three
half-widths of each resonance."""


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
        As for `navcore.analysis.transfer`; source None gives H(s) itself.
    normalised : bool
        In p = s / omega_s (time in units of 1/omega_s): to be preferred for anything numerical.
    **options
        As for `navcore.analysis.transfer`.
    """
    if source is None:
        return network.to_control(normalised=normalised)
    num, den = transfer(network, source, output, **options)
    return transfer_function(num, den, network.omega_s if normalised else None)


@dataclass(frozen=True)
class DiskMargin:
    """Largest disk of changes of gain and phase *together* that the loop is stable under.

    The loop stays stable when its open loop is multiplied by any (2 + alpha d)/(2 - alpha d) with |d| < 1.

    Attributes
    ----------
    size : float
        alpha of the balanced disk (Seiler, Packard & Gahinet 2020): 1 over the largest |S - T|/2.
    gain : float
        Factor by which the loop gain may rise or fall when the phase stays; inf when alpha >= 2.
    phase_rad : float
        Phase by which it may turn when the gain stays, rad.
    """

    size: float
    gain: float
    phase_rad: float


def disk_margin(network: LinearNetwork) -> DiskMargin | None:
    """Disk margin of the open loop omega_s^2 H/s^2, by python-control; None for an undamped or unstable loop.

    Parameters
    ----------
    network : LinearNetwork
        H(s).
    """
    import control

    loop = analyse(network)
    if not loop.stable or loop.settling_s is None:
        return None
    sizes = np.abs(np.concatenate([loop.poles, network.poles, network.zeros])) / network.omega_s
    low, high = np.log10(sizes[sizes > 0.0].min() * _LOWEST), np.log10(sizes.max() * _HIGHEST)
    omega = np.concatenate(
        [
            np.logspace(low, high, math.ceil((high - low) * _A_DECADE)),
            *(abs(p.imag) + abs(p.real) * _RESONANCE for p in loop.poles / network.omega_s),
        ]
    )
    omega = np.unique(omega[omega > 0.0])
    forward = transfer_function(network.loop_num_p, network.den_p)
    open_loop = forward * control.tf([1.0], [1.0, 0.0, 0.0])
    size, gain_db, phase_deg = (float(value) for value in control.disk_margins(open_loop, omega))
    return DiskMargin(size, 10.0 ** (gain_db / 20.0), math.radians(phase_deg))
