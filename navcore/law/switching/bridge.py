"""Switching `bridge` (ours): while the log is not to be trusted, an estimate of the error takes its place.

A Kalman filter of three states a channel, velocity error v, tilt psi and error b of the log, is fed with the
difference d = V_r - V_c = b - v + n while the policy trusts the log, and runs on without it otherwise. The
network is never frozen, cleared or restored by hand: it is fed with d less the log's known level, or with the
estimate -v^ (theory.md 12).
"""

import math
from collections.abc import Iterator
from typing import Any, ClassVar, Literal

import numpy as np

from navcore.foundation.compiled import inlined, kernel
from navcore.foundation.errors import Fault
from navcore.foundation.parameters import choice, quantity
from navcore.foundation.records import COUNT, FLAG, REAL, record_type
from navcore.foundation.text import Text
from navcore.law.history import row_of_age
from navcore.law.network_state import advance_network
from navcore.law.policy.base import PolicyParameters, calls
from navcore.law.records import E, N
from navcore.law.switching.base import SwitchingParameters
from navcore.networks.base import NetworkParameters

_V, _W, _B = 0, 1, 2
"""States: v (m/s), w = sqrt(g R) psi (m/s), b (m/s)."""
_PRIOR = 1.0
"""Variance of each state before anything is known, (m/s)^2."""
_SIGNIFICANT = 12.0
"""|osc|^2 in units of its variance from which the oscillation is damped, fully at twice as much."""
_EARLIEST_S, _LATEST_S = 60.0, 900.0
"""Times after re-engagement, s: the old level is recognised from the one, a new one taken at the other."""
_KNOWN_MPS, _SIGMAS = 0.05, 3.0
"""The old level is recognised when the difference is known to this, and within so many deviations of 0."""


@inlined
def _predict(own, z, P, c_e, c_n):
    """Advance both channels by a step with the correction in force: a rotation by omega_s T."""
    cos, sin = own.cos, own.sin
    for channel, c in ((E, c_e), (N, c_n)):
        v, w = z[channel, _V] + c, z[channel, _W]
        z[channel, _V], z[channel, _W] = cos * v + sin * w - c, cos * w - sin * v
    for j in range(3):
        v, w = P[_V, j], P[_W, j]
        P[_V, j], P[_W, j] = cos * v + sin * w, cos * w - sin * v
    for i in range(3):
        v, w = P[i, _V], P[i, _W]
        P[i, _V], P[i, _W] = cos * v + sin * w, cos * w - sin * v
    P[_V, _V] += own.drive
    P[_W, _W] += own.drive
    P[_B, _B] += own.walk


@inlined
def _update(own, memory, difference):
    """Take in the difference of both channels, d = b - v + n; they share their covariance."""
    z, P, gain = memory.z, memory.P, memory.gain
    for i in range(3):
        gain[i] = P[i, _B] - P[i, _V]
    variance = gain[_B] - gain[_V] + own.noise
    for channel in range(2):
        innovation = difference[channel] - (z[channel, _B] - z[channel, _V])
        for i in range(3):
            z[channel, i] += gain[i] / variance * innovation
    for i in range(3):
        for j in range(3):
            P[i, j] -= gain[i] * gain[j] / variance


@inlined
def _forget_level(memory, difference):
    """Begin anew with the log's error: what of the difference the velocity error does not explain."""
    for i in range(3):
        memory.P[_B, i] = memory.P[i, _B] = 0.0
    memory.P[_B, _B] = _PRIOR
    for channel in range(2):
        memory.z[channel, _B] = difference[channel] + memory.z[channel, _V]
    memory.known, memory.since = False, 0


@inlined
def _begin(memory):
    for channel in range(2):
        for i in range(3):
            memory.z[channel, i] = 0.0
    for i in range(3):
        for j in range(3):
            memory.P[i, j] = _PRIOR if i == j else 0.0
    memory.old_variance = math.inf


@inlined
def _keep(memory, law):
    """Put estimate and correction in force into the newest row of the history."""
    row = row_of_age(law, 0).switchings.bridge
    for channel in range(2):
        row.c[channel] = law.s.correction[channel]
        for i in range(3):
            row.z[channel, i] = memory.z[channel, i]
    for i in range(3):
        for j in range(3):
            row.P[i, j] = memory.P[i, j]
    row.known = memory.known


@inlined
def _amplitude(z, P):
    """Share of the damping: 0 while the oscillation is not known from noise, 1 when it stands out."""
    square = 0.0
    for channel in range(2):
        square += z[channel, _V] ** 2 + z[channel, _W] ** 2
    variance = 0.5 * (P[_V, _V] + P[_W, _W])
    return min(max(square / (_SIGNIFICANT * variance) - 1.0, 0.0), 1.0)


@kernel
def _go_back(own, memory, law):
    """Return to what was known before the event, and run on from there without the log."""
    s = law.s
    age = min(own.age, s.ring_fill - 1)
    row = row_of_age(law, age)
    kept = row.switchings.bridge
    for channel in range(2):
        for i in range(3):
            memory.z[channel, i] = kept.z[channel, i]
        for i in range(law.p.order):
            s.x[channel, i] = row.x[channel, i]
    for i in range(3):
        for j in range(3):
            memory.P[i, j] = kept.P[i, j]
    if kept.known:
        memory.old[E], memory.old[N] = kept.z[E, _B], kept.z[N, _B]
        memory.old_variance = kept.P[_B, _B]
    for later in range(age - 1, -1, -1):
        a = _amplitude(memory.z, memory.P)
        advance_network(law, -a * memory.z[E, _V], -a * memory.z[N, _V])
        c = row_of_age(law, later).switchings.bridge.c
        _predict(own, memory.z, memory.P, c[E], c[N])


@inlined
def _recognise(own, memory):
    """Take the log's level as known: the old one when it has come back, the present one when it stays."""
    if memory.since >= own.latest:
        memory.level[E], memory.level[N] = memory.z[E, _B], memory.z[N, _B]
        memory.known = True
        return
    P = memory.P
    total = P[_B, _B] + memory.old_variance
    if memory.since < own.earliest or not total < _KNOWN_MPS * _KNOWN_MPS:
        return
    off_e, off_n = memory.old[E] - memory.z[E, _B], memory.old[N] - memory.z[N, _B]
    if max(abs(off_e), abs(off_n)) >= _SIGMAS * math.sqrt(total):
        return
    for i in range(3):
        memory.gain[i] = P[i, _B] / total
    for i in range(3):
        memory.z[E, i] += memory.gain[i] * off_e
        memory.z[N, i] += memory.gain[i] * off_n
    for i in range(3):
        for j in range(3):
            P[i, j] -= memory.gain[i] * memory.gain[j] * total
    memory.known = True


@kernel
def _advance(own, memory, law, wanted):
    s = law.s
    if not s.started:
        _begin(memory)
    else:
        _predict(own, memory.z, memory.P, s.correction[E], s.correction[N])
    trusted = wanted and s.valid
    if trusted and not s.damped:
        _forget_level(memory, s.difference)
    if trusted:
        _update(own, memory, s.difference)
        memory.since += 1
        if not memory.known:
            _recognise(own, memory)
    _keep(memory, law)
    if s.damped and not wanted:
        _go_back(own, memory, law)
    s.damped = wanted
    s.xi = s.to_xi = s.xi_target


@inlined
def _switch(own, memory, law, wanted):
    """Estimate on; nothing is asked for but the damping coefficient."""
    _advance(own, memory, law, wanted)


@inlined
def _feed(own, memory, law):
    """Input of the network: the difference less the log's level, or the estimate in its place."""
    s, a = law.s, _amplitude(memory.z, memory.P)
    if own.corrects_output:
        s.output[E], s.output[N] = a * memory.z[E, _V], a * memory.z[N, _V]
    if s.damped and memory.known:
        return a * (s.difference[E] - memory.level[E]), a * (s.difference[N] - memory.level[N])
    return -a * memory.z[E, _V], -a * memory.z[N, _V]


class Bridge(SwitchingParameters):
    """Bridge what the log cannot be trusted for by an estimate of the velocity error (theory.md 12).

    The damping acts only on an oscillation that stands out of the noise, goes on while the policy wants none,
    and takes up the log again when its old level has come back, or its new one has stayed for 15 min. It is
    for a log that changes: with outages it is no better than hard, with nothing to switch it is often worse.
    """

    needs_log: ClassVar[str] = Text('estimates the error of a log: needs damping = "external"')
    numbers: ClassVar[np.dtype] = record_type(
        cos=REAL,  # of omega_s T
        sin=REAL,
        noise=REAL,  # variances: of a sample of the log, (m/s)^2
        drive=REAL,  # added a call to v and w
        walk=REAL,  # and to b
        age=COUNT,  # calls back to what is known before an event
        earliest=COUNT,  # calls after re-engagement, see the constants above
        latest=COUNT,
        corrects_output=FLAG,
    )
    memory: ClassVar[np.dtype] = record_type(
        z=(REAL, (2, 3)),  # estimates of both channels, m/s
        P=(REAL, (3, 3)),  # their covariance, the same for both
        gain=(REAL, (3,)),
        level=(REAL, (2,)),  # L, the log's level, m/s
        known=FLAG,  # whether it is
        since=COUNT,  # calls since re-engagement
        old=(REAL, (2,)),  # b of before the event, m/s
        old_variance=REAL,
    )
    history: ClassVar[np.dtype] = record_type(
        z=(REAL, (2, 3)), P=(REAL, (3, 3)), c=(REAL, (2,)), known=FLAG
    )  # as above; c: correction in force before the call, m/s
    switch: ClassVar[Any] = _switch
    feed: ClassVar[Any] = _feed
    keeps_time: ClassVar[bool] = True
    id: Literal["bridge"] = "bridge"
    output: Literal["computed", "corrected"] = choice(
        "computed",
        label=Text("velocity given out"),
        help=Text(
            "computed: that of the mechanization, V_c; corrected: V_c - a v^, less the oscillation that the "
            "filter sees (theory.md 12)."
        ),
    )
    memory_s: float = quantity(
        110.0,
        unit="s",
        gt=0.0,
        le=3600.0,
        slider=(1.0, 1200.0),
        log=True,
        label=Text("memory"),
        help=Text(
            "How far before the switch the estimate is taken up: window, mean and count of the policy."
        ),
    )
    log_noise_mps: float = quantity(
        0.15,
        unit="m/s",
        gt=0.0,
        le=100.0,
        slider=(0.001, 2.0),
        log=True,
        label=Text("log noise"),
        help=Text(
            "Noise of one difference that the filter assumes, half as much again as it is (theory.md 12)."
        ),
    )
    drive_mpsrth: float = quantity(
        0.03,
        unit="m/s/sqrt(h)",
        ge=0.0,
        le=100.0,
        slider=(0.001, 1.0),
        log=True,
        label=Text("drive"),
        help=Text(
            "Growth of the Schuler oscillation by the inertial sensors' noise that the filter assumes."
        ),
    )
    log_walk_mpsrth: float = quantity(
        0.02,
        unit="m/s/sqrt(h)",
        ge=0.0,
        le=100.0,
        slider=(0.001, 1.0),
        log=True,
        label=Text("log walk"),
        help=Text("Random walk of the log's error that the filter assumes."),
    )

    def packed(self, law_step_s: float, omega_s: float) -> dict[str, Any]:
        """Rotation of a step, variances, times in calls."""
        hours = law_step_s / 3600.0
        return {
            "cos": math.cos(omega_s * law_step_s),
            "sin": math.sin(omega_s * law_step_s),
            "noise": self.log_noise_mps**2,
            "drive": self.drive_mpsrth**2 * hours,
            "walk": self.log_walk_mpsrth**2 * hours,
            "age": calls(self.memory_s, law_step_s),
            "earliest": calls(_EARLIEST_S, law_step_s),
            "latest": calls(_LATEST_S, law_step_s),
            "corrects_output": self.output == "corrected",
        }

    def ring_rows(self, law_step_s: float) -> int:
        """The memory and the present call."""
        return calls(self.memory_s, law_step_s) + 1

    def network_faults(
        self, network: NetworkParameters, realisation: str, policy: PolicyParameters
    ) -> Iterator[Fault]:
        """Refuse gains that a policy sets, and feedback, which the filter knows nothing of."""
        if policy.follow is not None:
            yield self._begins_anew(policy)
        elif realisation != "network":
            yield self._refused(
                Text(
                    'works by the network alone: network.realisation must be "network" with {id}',
                    id=network.id,
                )
            )
