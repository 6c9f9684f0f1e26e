"""Which loop a method really closes: ``free`` ignores its network, ``internal`` has no velocity feedback."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from navcore.analysis import frequency_response, network_step_response, time_response
from navcore.analysis.transfers import Output, Source
from navcore.engine.run import MethodRun
from navcore.networks.base import LinearNetwork
from navcore.networks.undamped import UndampedNetwork


@lru_cache(maxsize=8)
def _undamped(omega_s: float) -> LinearNetwork:
    return UndampedNetwork().transfer(omega_s)


@dataclass(frozen=True)
class Loop:
    """A network as the key of a cache: those with the same coefficients are equal.

    Attributes
    ----------
    coefficients : tuple of bytes
        Of the network.
    omega_s : float
        Schuler frequency, rad/s.
    network : LinearNetwork
        One of them.
    """

    coefficients: tuple[bytes, ...]
    omega_s: float
    network: LinearNetwork = field(compare=False)


def loop_of(method: MethodRun) -> Loop:
    """Network that acts in a method, as the key of a cache."""
    network = effective_network(method)
    feedback = b"" if network.feedback_p is None else network.feedback_p.tobytes()
    coefficients = network.num_p.tobytes(), network.den_p.tobytes(), feedback
    return Loop(coefficients, network.omega_s, network)


def effective_network(method: MethodRun) -> LinearNetwork:
    """H(s) that acts in this method: 1 when it runs free."""
    return _undamped(method.network.omega_s) if method.method.undamped else method.network


def closed_loop_poles(method: MethodRun) -> np.ndarray:
    """Closed-loop poles of what acts, rad/s."""
    network = effective_network(method)
    if network is method.network:
        return method.loop.poles
    return np.array([-1j, 1j]) * network.omega_s


def realisation(method: MethodRun) -> str:
    """How the network is carried out; internal damping always uses the network form."""
    return effective_network(method).realisation if method.method.damping == "external" else "network"


def reacts(method: MethodRun, source: Source) -> bool:
    """Whether an error source enters this method at all: no log without external damping, and so on."""
    damping = method.method.damping
    if source == "dv_r":
        return damping == "external"
    if source == "acceleration":
        return damping == "internal" or realisation(method) == "as_printed"
    return True


def frequency(method: MethodRun, source: Source, output: Output, omega: np.ndarray) -> np.ndarray | None:
    """Frequency response of a method at ``omega`` (rad/s), SI; None when the source does not enter it."""
    if not reacts(method, source):
        return None
    return _at_frequencies(loop_of(method), realisation(method), source, output, omega.tobytes())


def response(
    method: MethodRun, source: Source, output: Output, span_s: float, count: int
) -> np.ndarray | None:
    """Time response of a method to a unit source (SI) on `time_grid`; None where it does not enter."""
    if not reacts(method, source):
        return None
    return _over_time(loop_of(method), realisation(method), source, output, span_s, count)


def network_step(method: MethodRun, span_s: float, count: int) -> np.ndarray:
    """Step response of H itself on `time_grid`."""
    return _network_step(loop_of(method), span_s, count)


@lru_cache(maxsize=32)
def time_grid(span_s: float, count: int) -> np.ndarray:
    """``count`` even times from 0 to ``span_s``, s."""
    return _frozen(np.linspace(0.0, span_s, count))


# A slider of one method leaves the loops of the others as they were: half of the time of a figure.
@lru_cache(maxsize=256)
def _at_frequencies(loop: Loop, form: str, source: Source, output: Output, omega: bytes) -> np.ndarray:
    return _frozen(frequency_response(loop.network, source, output, np.frombuffer(omega), realisation=form))


@lru_cache(maxsize=256)
def _over_time(
    loop: Loop, form: str, source: Source, output: Output, span_s: float, count: int
) -> np.ndarray:
    return _frozen(time_response(loop.network, source, output, time_grid(span_s, count), realisation=form))


@lru_cache(maxsize=256)
def _network_step(loop: Loop, span_s: float, count: int) -> np.ndarray:
    return _frozen(network_step_response(loop.network, time_grid(span_s, count)))


def _frozen(values: np.ndarray) -> np.ndarray:
    values.setflags(write=False)
    return values
