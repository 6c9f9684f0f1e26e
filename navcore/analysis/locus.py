"""Root locus over any one parameter of a network: how the closed-loop poles move as it changes."""

from dataclasses import dataclass

import numpy as np

from navcore.analysis.loop import closed_loop_poles
from navcore.foundation.errors import InputError
from navcore.networks.base import ComplexArray, LinearNetwork, NetworkParameters


@dataclass(frozen=True, eq=False)
class Locus:
    """Closed-loop poles over one parameter.

    Attributes
    ----------
    values : ndarray, shape (k,)
        Values of the parameter that make a network, in the order given.
    poles : ndarray of complex, shape (k, n)
        Closed-loop poles, rad/s; a column is one branch, followed from value to value. NaN where a network
        has fewer.
    """

    values: np.ndarray
    poles: ComplexArray


def root_locus(parameters: NetworkParameters, field: str, values: np.ndarray, omega_s: float) -> Locus:
    """Closed-loop poles while one parameter runs through values.

    Parameters
    ----------
    parameters : NetworkParameters
        The network; its other parameters stay.
    field : str
        Name of the parameter, e.g. ``xi``.
    values : ndarray, shape (m,)
        Values in the field's own unit; those that the network refuses are left out.
    omega_s : float
        Schuler frequency, rad/s.
    """
    kept: list[float] = []
    rows: list[ComplexArray] = []
    for value in np.asarray(values, dtype=float):
        network = _network(parameters, field, float(value), omega_s)
        if network is None:
            continue
        poles = closed_loop_poles(network) * omega_s
        rows.append(_in_order_of(rows[-1], poles) if rows else poles)
        kept.append(float(value))
    width = max((len(row) for row in rows), default=0)
    table = np.full((len(rows), width), np.nan, dtype=np.complex128)
    for i, row in enumerate(rows):
        table[i, : len(row)] = row
    return Locus(np.array(kept), table)


def _network(parameters: NetworkParameters, field: str, value: float, omega_s: float) -> LinearNetwork | None:
    try:
        return parameters.changed(field, value).transfer(omega_s)
    except InputError:
        return None
    except ValueError:  # out of the field's range, or fields that exclude each other
        return None


def _in_order_of(before: ComplexArray, poles: ComplexArray) -> ComplexArray:
    """Each pole in the place of the one it came from: least sum of distances."""
    from scipy.optimize import linear_sum_assignment

    if len(before) != len(poles):
        return poles
    _, order = linear_sum_assignment(np.abs(before[:, None] - poles[None, :]))
    return poles[order]
