"""The same objects for python-control; imported only when asked, it is slow."""

from __future__ import annotations

from typing import TYPE_CHECKING, Unpack

import numpy as np

from navcore.loop.transfers import Output, Source, TransferOptions, transfer
from navcore.network.base import LinearNetwork

if TYPE_CHECKING:
    from control import TransferFunction


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
