"""Decisions of the policies once more, for `tests.law_twin`: each from slices of the whole history."""

import math
from typing import Any

import numpy as np

from navcore.foundation.units import DEG, KNOT
from tests.law_twin_forms import adaptive

Vector = np.ndarray


class TwinPolicies:
    """Decisions of a `tests.law_twin.TwinLaw`: whether it is damped, and its measure."""

    def _policy_constant(self: Any, difference: Vector, valid: bool) -> bool:
        return True

    _policy_schedule = _policy_constant

    def _policy_mobility(self: Any, difference: Vector, valid: bool) -> bool:
        self.measure = self._mean_acceleration()
        return True

    def _policy_states(self: Any, difference: Vector, valid: bool) -> bool:
        """0 undamped, 1 internal, 3 external: nothing acts in the azimuth."""
        own = self.policy
        calm = self._mean_acceleration() <= own.limit_mps2
        near = valid and float(np.linalg.norm(difference)) <= own.difference_mps
        self.good = self.good + 1 if near else 0
        self.external = self.good > 0 and (self.external or self.good >= self._calls(own.return_s))
        self.measure = (3.0 if self.external else 1.0) if calm else 0.0
        return calm

    def _policy_threshold(self: Any, difference: Vector, valid: bool) -> bool:
        self.measure = float(np.linalg.norm(difference))
        return self.measure <= self.policy.limit_mps

    def _policy_yaw_rate(self: Any, difference: Vector, valid: bool) -> bool:
        window = [row["total"] for row in self.rows[-self._calls(self.policy.window_s) - 1 :]]
        self.measure = abs(window[-1] - window[0])
        return self.measure <= self.policy.limit_deg * DEG

    def _policy_acceleration(self: Any, difference: Vector, valid: bool) -> bool:
        self.measure = self._mean_acceleration()
        return self.measure <= self.policy.limit_mps2

    def _mean_acceleration(self: Any) -> float:
        v_c = np.array([row["v_c"] for row in self.rows])
        sizes = np.linalg.norm(np.diff(v_c, axis=0, prepend=v_c[:1]), axis=1) / self.step_s
        return float(np.mean(sizes[-self._calls(self.policy.mean_s) :]))

    def _policy_variation(self: Any, difference: Vector, valid: bool) -> bool:
        n, t0 = self._calls(self.policy.n_s), self._calls(self.policy.t0_s)
        self.measure = 0.0
        if self.fresh >= n + t0:
            d = np.array([row["d"] for row in self.rows[-n - t0 :]])
            self.measure = float(np.max(np.abs(d[-n:].mean(axis=0) - d[:n].mean(axis=0))))
        wish = self.decision
        if self.measure <= self.policy.a:
            wish = True
        elif self.measure >= self.policy.c:
            wish = False
        self.count = 0 if wish == self.decision else self.count + 1
        if self.count == self.policy.count:
            self.decision, self.count = wish, 0
        self.wish = wish
        return self.decision

    def _policy_adaptive(self: Any, difference: Vector, valid: bool) -> bool:
        if not valid:
            return True
        share = 1.0 if self.fresh == 1 else 1.0 - math.exp(-self.step_s / self.policy.lowpass_s)
        self.low = self.low + share * (difference - self.low)
        self.measure = float(np.linalg.norm(self.low))
        self.target = max(adaptive(self.policy, self.measure / KNOT), self.least)
        return True
