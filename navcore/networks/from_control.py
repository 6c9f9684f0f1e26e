"""A `custom` network from a system of python-control."""

from typing import Any

from navcore.foundation.errors import InputError
from navcore.foundation.text import Text
from navcore.networks.base import refuse
from navcore.networks.custom import CustomNetwork


def from_control(system: Any) -> CustomNetwork:
    """Make a network of a `control.TransferFunction` or `control.StateSpace`.

    Parameters
    ----------
    system
        H(s), s in rad/s: continuous, one input and one output, at most eight poles.

    Returns
    -------
    CustomNetwork
        Its numerator and denominator; `NetworkParameters.transfer` and ``to_control`` lead back.

    Raises
    ------
    InputError
        The system has a sampling time, several inputs or outputs, or makes no network.

    Examples
    --------
    >>> import control
    >>> from_control(control.tf([10.0, 0.01], [1.0, 0.01])).transfer(1.24e-3).h0
    1.0
    """
    import control
    from pydantic import ValidationError

    if not isinstance(system, control.TransferFunction | control.StateSpace):
        raise refuse("system", type(system).__name__, Text("must be a TransferFunction or a StateSpace"))
    if (system.ninputs, system.noutputs) != (1, 1):
        size = f"{system.noutputs} x {system.ninputs}"
        raise refuse("system", size, Text("must have one input and one output"))
    if system.dt:
        raise refuse("system.dt", system.dt, Text("must be 0: a continuous system"))
    ratio: Any = control.tf(system)
    num, den = ([float(one) for one in part[0][0]] for part in (ratio.num, ratio.den))
    try:
        return CustomNetwork(num=tuple(num), den=tuple(den))
    except ValidationError as error:
        text = error.errors()[0]["msg"]
        raise InputError(refuse("system", None, text).faults) from None
