"""Which loop a method really closes: ``free`` ignores its network, ``internal`` has no velocity feedback."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import lru_cache
from typing import cast

import numpy as np

from navcore.analysis import frequency_response, network_step_response, time_response
from navcore.analysis.transfers import Output, Source
from navcore.engine.run import MethodRun
from navcore.networks.base import LinearNetwork
from navcore.networks.undamped import UndampedNetwork


@lru_cache(maxsize=8)
def _undamped(omega_s: float) -> LinearNetwork:
    return UndampedNetwork().transfer(omega_s)


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
    return _at_frequencies(_question(method, source, output, 0.0, len(omega)), omega.tobytes())


@dataclass(frozen=True)
class _Question:
    """What a response depends on; two runs with the same loop ask the same question."""

    num: bytes
    den: bytes
    feedback: bytes
    omega_s: float
    form: str
    source: str
    output: str
    span_s: float
    count: int
    network: LinearNetwork = field(compare=False)


def response(
    method: MethodRun, source: Source, output: Output, span_s: float, count: int
) -> np.ndarray | None:
    """Time response of a method to a unit source (SI) on `time_grid`; None where it does not enter."""
    return _answer(_question(method, source, output, span_s, count)) if reacts(method, source) else None


def network_step(method: MethodRun, span_s: float, count: int) -> np.ndarray:
    """Step response of H itself on `time_grid`."""
    return _answer(_question(method, "H", "", span_s, count))


@lru_cache(maxsize=32)
def time_grid(span_s: float, count: int) -> np.ndarray:
    """``count`` even times from 0 to ``span_s``, s."""
    grid = np.linspace(0.0, span_s, count)
    grid.setflags(write=False)
    return grid


def _question(method: MethodRun, source: str, output: str, span_s: float, count: int) -> _Question:
    network = effective_network(method)
    return _Question(
        num=network.num_p.tobytes(),
        den=network.den_p.tobytes(),
        feedback=b"" if network.feedback_p is None else network.feedback_p.tobytes(),
        omega_s=network.omega_s,
        form=realisation(method),
        source=source,
        output=output,
        span_s=span_s,
        count=count,
        network=network,
    )


# A slider of one method leaves the loops of the others as they were: half of the time of a figure.
@lru_cache(maxsize=256)
def _at_frequencies(q: _Question, omega: bytes) -> np.ndarray:
    source, output = cast(Source, q.source), cast(Output, q.output)
    values = frequency_response(q.network, source, output, np.frombuffer(omega), realisation=q.form)
    values.setflags(write=False)
    return values


@lru_cache(maxsize=256)
def _answer(q: _Question) -> np.ndarray:
    time_s = time_grid(q.span_s, q.count)
    if q.source == "H":
        values = network_step_response(q.network, time_s)
    else:
        source, output = cast(Source, q.source), cast(Output, q.output)
        values = time_response(q.network, source, output, time_s, realisation=q.form)
    values.setflags(write=False)
    return values
