"""The damping law once more, slow and obvious: matrices, lists of everything that was, plain Python.

The compiled law is tested against this call by call. It shares the parameter models, with their H(s), and no
computation and no property that a policy or switching method declares of itself: `tests.law_twin_forms` makes
networks discrete, windows come from slices of the whole history, the table's curve from scipy.
"""

import math
from typing import Any

import numpy as np

from navcore.law.policy.base import PolicyParameters
from navcore.law.switching.base import SwitchingParameters
from navcore.networks.base import MAX_ORDER, NetworkParameters
from navcore.networks.compass import CompassNetwork
from navcore.networks.unity2 import Unity2Network
from tests.law_twin_forms import Form, bilinear, companion, controller, damping_ratio
from tests.law_twin_policies import TwinPolicies

Vector = np.ndarray


class TwinLaw(TwinPolicies):
    """Damping law of one method for both channels.

    Parameters
    ----------
    damping : {"internal", "external"}
        Kind of damping.
    network, policy, switching
        As configured.
    omega_s : float
        Schuler frequency, rad/s.
    step_s : float
        Time between two calls, s.
    """

    def __init__(
        self,
        damping: str,
        network: NetworkParameters,
        policy: PolicyParameters,
        switching: SwitchingParameters,
        omega_s: float,
        step_s: float,
    ) -> None:
        self.policy: Any = policy
        self.switching: Any = switching
        self.external, self.omega_s, self.step_s = damping == "external", omega_s, step_s
        self.calm = self.good = 0  # of `states`: calls in a row
        self.network = self._network_in_force(network)
        self.realisation = getattr(network, "realisation", "network") if self.external else "network"
        self.a = math.tan(0.5 * omega_s * step_s)
        self.tunes = policy.id == "adaptive" or switching.id in ("ramp", "step")
        self.k1 = 0.0
        coefficient, transfer = self.network.damping_coefficient(), self.network.transfer(omega_s)
        self.target = damping_ratio(transfer) if coefficient is None else coefficient
        self.least = 1.05 * self.network.least_coefficient() if self.tunes else 0.0
        if policy.id == "adaptive":
            self.target = max(self.target, self.least)
        self.tuned = self.target
        self.form = self._form(self.target)
        self.states = np.zeros((2, len(self.form.B)))
        self.rows: list[dict[str, Any]] = []
        self.damped = self.engaged = False
        self.decision, self.count, self.fresh = True, 0, 0
        self.wish: bool | None = None
        self.xi = self.measure = self.engaged_at = self.stepped_at = 0.0
        self.offset = self.low = self.correction = self.output = np.zeros(2)
        # of `bridge`: estimates v, w, b of both channels, covariance, level of the log
        self.z, self.P, self.level = np.zeros((2, 3)), np.eye(3), np.zeros(2)
        self.old = np.zeros(2), math.inf  # b of before the event, its variance
        self.known, self.since = False, 0
        self.turn = self.growth = np.eye(3)
        self.memory: tuple[np.ndarray, np.ndarray] = (self.states, np.zeros(2))

    def _network_in_force(self, network: NetworkParameters) -> NetworkParameters:
        if self.policy.id == "adaptive":
            return self.policy.network or (Unity2Network() if network.id == "none" else network)
        if self.policy.id == "schedule":
            return CompassNetwork(**dict(zip(("k1", "k2", "k3"), self.policy.to, strict=True)))
        if self.policy.id == "mobility":
            return CompassNetwork(sigma=self.policy.sigma_steady, xi=self.policy.xi)
        return network

    def _form(self, xi: float) -> Form:
        if self.policy.id == "schedule":
            return self._gains(*getattr(self.policy, "from"))
        if self.policy.id == "mobility" and isinstance(self.network, CompassNetwork):
            return self._gains(*self.network.gains(self.omega_s))
        if self.tunes:
            self.tuned = xi
            return controller(self.network.with_damping(xi), self.omega_s, self.a)
        if self.realisation != "network" and isinstance(self.network, CompassNetwork):
            return self._gains(*self.network.gains(self.omega_s))
        return companion(self.network.transfer(self.omega_s), self.a)

    def _gains(self, k1: float, k2: float, k3: float) -> Form:
        if self.realisation != "network":
            self.k1, held = k1, k3 * self.step_s
            return Form(np.eye(1), np.array([-held]), np.ones(1), -k2 - 0.5 * held)
        pole, zero = k1 / self.omega_s, (k1 - k3) / self.omega_s
        return bilinear(np.array([[-pole]]), np.array([zero + pole * k2]), np.ones(1), -k2, self.a)

    def step(
        self, difference: Vector, valid: bool, v_c: Vector, heading: float = 0.0
    ) -> tuple[Vector, Vector]:
        """Return (c_E, c_N), (a_E, a_N) for the held difference, V_c (m/s) and heading (rad)."""
        u = difference if self.external else -v_c
        self.fresh = self.fresh + 1 if valid else 0
        if self.rows:
            turned = (heading - self.rows[-1]["heading"] + math.pi) % (2.0 * math.pi) - math.pi
            total = self.rows[-1]["total"] + turned
        else:
            total = 0.0
        self.rows.append(
            {"d": difference, "u": u, "x": self.states.copy(), "damped": self.damped,
             "c": self.correction, "v_c": v_c, "heading": heading, "total": total}
        )  # fmt: skip
        self.wish = None
        fed = self.external
        wanted = getattr(self, f"_policy_{self.policy.id}")(difference, valid)
        self.wish = wanted if self.wish is None else self.wish
        u = difference if self.external else -v_c
        if self.external and not valid:
            wanted = self.wish = False
        if wanted and not self.damped:
            self.engaged_at = self.now
        if self.policy.id in ("schedule", "mobility"):
            self._follow_gains(self._gains_now(), u)
        if len(self.rows) == 1:
            if self.tunes:
                self.form = self._form(self.target)
            self._clear(u)
        getattr(self, f"_switch_{self.switching.id}")(wanted, u, valid)
        if self.external != fed and self.damped:
            self._clear(u)
        if self.switching.id == "bridge":
            u = self._bridge_input(difference)
        elif not self.damped:
            if self.switching.id not in ("ramp", "bumpless"):
                self.correction = np.zeros(2)
            return self.correction, np.zeros(2)
        self.engaged = True
        a = self.k1 * u
        if self.form.second is not None:
            row, direct = self.form.second
            a = self.states @ row + direct * u
        c = self._feed(u)
        if self.realisation == "as_printed":
            c = c - (v_c + u)
        self.correction = c + self.offset
        self.offset = self.offset * math.exp(-self.step_s / 100.0)
        return self.correction, a

    def watched(self) -> dict[str, Any]:
        """Decision, output and memory after a call, at their places in the compiled law's state."""
        numbers: dict[str, Any] = {
            name: getattr(self, name) for name in ("damped", "engaged", "xi", "measure")
        }
        numbers["wanted"] = self.wish
        for pair in ("correction", "offset", "output"):  # nothing acts in the third channel, the azimuth
            numbers[pair] = np.append(getattr(self, pair), 0.0)
        if self.tunes:
            numbers["x"] = np.pad(self.states, ((0, 1), (0, MAX_ORDER - self.states.shape[1])))
        if self.policy.id == "variation":
            numbers["policies.variation.count"] = self.count
        if self.switching.id == "bridge":
            numbers |= {f"switchings.bridge.{name}": getattr(self, name) for name in ("z", "P", "known")}
        return numbers

    @property
    def now(self) -> float:
        """Time since the first call, s."""
        return (len(self.rows) - 1) * self.step_s

    def _calls(self, seconds: float) -> int:
        return max(1, round(seconds / self.step_s))

    def _feed(self, u: Vector) -> Vector:
        c = self.states @ self.form.C + self.form.D * u
        self.states = self.states @ self.form.A.T + np.outer(u, self.form.B)
        return c

    def _clear(self, u: Vector) -> None:
        self.offset = np.zeros(2)
        self.states = np.zeros_like(self.states) if self.external else np.outer(u, self.form.steady)

    def _gains_now(self) -> Vector:
        own = self.policy
        if own.id == "mobility":
            place = [own.low_mps2, own.high_mps2], [own.sigma_steady, own.sigma_moving]
            sigma = float(np.interp(self.measure, *place))
            return np.array(CompassNetwork(sigma=sigma, xi=own.xi).gains(self.omega_s))
        share = min((self.now - self.engaged_at) / own.duration_s, 1.0)
        first, last = np.array(getattr(own, "from")), np.array(own.to)
        return first + share * (last - first)

    def _follow_gains(self, gains: Vector, u: Vector) -> None:
        new = self._gains(*gains)
        if self.realisation == "network":
            self.states = self._discrete(new, self._at_sample(u), u)
        self.form = new

    # switching

    def _at_sample(self, u: Vector) -> np.ndarray:
        """Continuous states at the sample, (2, n)."""
        assert self.form.continuous is not None
        A, B, _ = self.form.continuous
        return np.linalg.solve(np.eye(len(B)) - self.a * A, (self.states + self.a * np.outer(u, B)).T).T

    def _discrete(self, form: Form, v: np.ndarray, u: Vector) -> np.ndarray:
        assert form.continuous is not None
        A, B, _ = form.continuous
        return v - self.a * (v @ A.T + np.outer(u, B))

    def _retune(self, xi: float, u: Vector) -> None:
        if xi == self.tuned:
            return
        v, old, new = self._at_sample(u), self.form, self._form(xi)
        assert old.continuous is not None and new.continuous is not None
        self.offset = self.offset + v @ (old.continuous[2] - new.continuous[2])
        self.form, self.states = new, self._discrete(new, v, u)

    def _follow_target(self, u: Vector) -> None:
        if self.tunes:
            self._retune(self.target, u)

    def _set(self, damped: bool, xi: float = 0.0) -> None:
        self.damped, self.xi = damped, xi

    def _switch_hard(self, wanted: bool, u: Vector, valid: bool) -> None:
        self._follow_target(u)
        if wanted and not self.damped:
            self._clear(u)
        self._set(wanted, self.target if wanted else 0.0)

    def _switch_keep(self, wanted: bool, u: Vector, valid: bool) -> None:
        self._follow_target(u)
        if not wanted and (valid or not self.external):
            self._feed(u)
        self._set(wanted, self.target if wanted else 0.0)

    def _switch_ramp(self, wanted: bool, u: Vector, valid: bool) -> None:
        if not wanted:
            return self._set(False)
        if not self.engaged:
            self.engaged_at = -math.inf
        left = self.switching.duration_s - 1.0 - (self.now - self.engaged_at)
        left = 0.0 if abs(left) < 1e-6 else left
        xi = self.target * math.exp(-max(left, 0.0))
        self._retune(xi, u)
        if not self.damped:
            self._clear(u)
        if left >= 0.0 and self.switching.form == "as_printed":
            self.states, self.offset = np.outer(u, self.form.steady), np.zeros(2)
        return self._set(True, xi)

    def _switch_step(self, wanted: bool, u: Vector, valid: bool) -> None:
        if self.external and not valid:
            return self._set(False)
        target = self.target if wanted else 0.0
        if not self.damped:
            if wanted:
                xi = max(target if not self.engaged else min(self.switching.size, target), self.least)
                self.form, self.stepped_at = self._form(xi), self.now
                self._clear(u)
                self._set(True, xi)
            return None
        if self.now - self.stepped_at < self.switching.every_s - 1e-6 or target == self.xi:
            return None
        xi = self.xi + float(np.clip(target - self.xi, -self.switching.size, self.switching.size))
        self.stepped_at = self.now
        if xi < 1e-9 or (xi < self.least and not wanted):
            return self._set(False)
        self._retune(max(xi, self.least), u)
        return self._set(True, self.tuned)

    def _switch_bumpless(self, wanted: bool, u: Vector, valid: bool) -> None:
        n, age = self._calls(self.switching.n_s), self._calls(self.switching.memory_s)
        if not wanted:
            if self.damped and len(self.rows) >= age + n and self.rows[-1 - age]["damped"]:
                row = self.rows[-1 - age]
                window = self.rows[len(self.rows) - age - n : len(self.rows) - age]
                self.memory = (row["x"], np.mean([r["u"] for r in window], axis=0))
            return self._set(False)
        if not self.damped:
            if (self.fresh if self.external else len(self.rows)) < n:
                return None
            x0, m0 = self.memory
            if self.tunes:
                self.form = self._form(self.target)
            self.offset = np.zeros(2)
            change = np.mean([row["u"] for row in self.rows[-n:]], axis=0) - m0
            self.states = x0 + np.outer(change, self.form.steady)
        self._follow_target(u)
        return self._set(True, self.target)

    def _switch_bridge(self, wanted: bool, u: Vector, valid: bool) -> None:
        row, s = self.rows[-1], self.switching
        hours = self.step_s / 3600.0
        angle = self.omega_s * self.step_s
        self.turn = np.eye(3)
        self.turn[:2, :2] = [[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]]
        self.growth = np.diag([s.drive_mpsrth**2, s.drive_mpsrth**2, s.log_walk_mpsrth**2]) * hours
        if len(self.rows) > 1:
            self._bridge_predict(row["c"])
        if wanted and valid:
            if not self.damped:
                self.P[2, :] = self.P[:, 2] = [0.0, 0.0, 1.0]
                self.P[2, 2] = 1.0
                self.z[:, 2] = row["d"] + self.z[:, 0]
                self.known, self.since = False, 0
            h = np.array([-1.0, 0.0, 1.0])
            variance = h @ self.P @ h + s.log_noise_mps**2
            gain = self.P @ h / variance
            self.z = self.z + np.outer(row["d"] - self.z @ h, gain)
            self.P = self.P - np.outer(gain, gain) * variance
            self.since += 1
            if not self.known:
                self._bridge_recognise()
        row["bridge"] = (self.z.copy(), self.P.copy(), self.known)
        if self.damped and not wanted:
            self._bridge_go_back()
        self._follow_target(u)
        self._set(wanted, self.target)

    def _bridge_predict(self, c: Vector) -> None:
        shift = np.outer(c, [1.0, 0.0, 0.0])
        self.z = (self.z + shift) @ self.turn.T - shift
        self.P = self.turn @ self.P @ self.turn.T + self.growth

    def _bridge_recognise(self) -> None:
        if self.since >= self._calls(900.0):
            self.level, self.known = self.z[:, 2].copy(), True
        elif self.since >= self._calls(60.0):
            b, variance = self.old
            total = self.P[2, 2] + variance
            off = b - self.z[:, 2]
            if math.sqrt(total) < 0.05 and np.abs(off).max() < 3.0 * math.sqrt(total):
                gain = self.P[:, 2] / total
                self.z = self.z + np.outer(off, gain)
                self.P = self.P - np.outer(gain, gain) * total
                self.known = True

    def _bridge_go_back(self) -> None:
        age = min(self._calls(self.switching.memory_s), len(self.rows) - 1)
        before = self.rows[-1 - age]
        self.z, self.P, known = (np.array(part) for part in before["bridge"])
        if known:
            self.old = (self.z[:, 2].copy(), float(self.P[2, 2]))
        self.states = before["x"]
        for row in self.rows[len(self.rows) - age :]:
            self._feed(-self._bridge_share() * self.z[:, 0])
            self._bridge_predict(row["c"])

    def _bridge_share(self) -> float:
        square = float(np.sum(self.z[:, :2] ** 2))
        return float(np.clip(square / (12.0 * 0.5 * (self.P[0, 0] + self.P[1, 1])) - 1.0, 0.0, 1.0))

    def _bridge_input(self, difference: Vector) -> Vector:
        if self.switching.output == "corrected":
            self.output = self._bridge_share() * self.z[:, 0]
        if self.damped and self.known:
            return self._bridge_share() * (difference - self.level)
        return -self._bridge_share() * self.z[:, 0]
