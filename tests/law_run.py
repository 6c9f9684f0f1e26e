"""What the tests of the control law share: a law called step by step from Python."""

from typing import Any

import numpy as np

from navcore.foundation.compiled import kernel
from navcore.foundation.earth import SPHERE
from navcore.law.law import law_step, prepare_law
from navcore.law.policy import POLICIES
from navcore.law.records import Sensed
from navcore.law.switching import SWITCHINGS
from navcore.networks import parse_network
from navcore.networks.base import NetworkParameters
from navcore.networks.discrete import discretise

OMEGA_S = SPHERE.schuler_frequency(0.0)


@kernel
def call_law(law: Any, sensed: Any) -> Any:
    """Call `law_step`: this is kept on disk, while what kernels inline is compiled by each process anew."""
    return law_step(law, sensed)


class LawRun:
    """The compiled law of a method, asked from Python; blocks as in a scenario."""

    def __init__(
        self,
        network: dict[str, Any],
        policy: dict[str, Any],
        switching: dict[str, Any],
        damping: str = "external",
        step_s: float = 1.0,
    ) -> None:
        self.network = parse_network(network)
        self.policy = POLICIES[policy["id"]].model_validate(policy)
        self.switching = SWITCHINGS[switching["id"]].model_validate(switching)
        transfer = self.network.transfer(OMEGA_S)
        self.law = prepare_law(damping, self.network, transfer, self.policy, self.switching, step_s)
        self.s = self.law.s

    def step(
        self,
        d_e: float,
        d_n: float = 0.0,
        valid: bool = True,
        v_c: tuple[float, float] = (0.0, 0.0),
        heading: float = 0.0,
    ) -> np.ndarray:
        """One call: c_E, c_N, a_E, a_N."""
        self.s["difference"], self.s["valid"] = (d_e, d_n, 0.0), valid
        return np.array(call_law(self.law, Sensed(*v_c, heading)))

    def numbers(self, path: str) -> np.ndarray:
        """Numbers in the state: ``"x"``, ``"policies.variation.count"``."""
        place: Any = self.s
        for name in path.split("."):
            place = place[name]
        return np.array(place, float)

    def value(self, path: str) -> float:
        """First number at a place of the state: of a pair, its east."""
        return float(self.numbers(path).flat[0])

    def series(self, differences: Any, *places: str, **inputs: Any) -> np.ndarray:
        """One call for each east difference; the numbers of the state at ``places`` after each."""
        rows = []
        for d in differences:
            self.step(float(d), **inputs)
            rows.append([self.value(place) for place in places])
        return np.array(rows)


def sampled_radius(parameters: NetworkParameters, omega_s: float, law_step_s: float) -> float:
    """Spectral radius of one level channel with the network sampled and held; below 1 is stable.

    Parameters
    ----------
    parameters : NetworkParameters
        The network; external damping in network form.
    omega_s : float
        rad/s.
    law_step_s : float
        s.
    """
    discrete = discretise(parameters.transfer(omega_s), law_step_s)
    angle, n = omega_s * law_step_s, discrete.order
    cos, sin = np.cos(angle), np.sin(angle)
    # states v = dV, w = g phi/omega_s, x: v' = omega_s w, w' = -omega_s (v + c), c = -C x - (1 - D) v held
    step = np.zeros((n + 2, n + 2))
    step[:2, :2] = [[cos, sin], [-sin, cos]]
    held = np.array([cos - 1.0, -sin])
    output = np.concatenate([[-(1.0 - discrete.D), 0.0], -discrete.C])
    step[:2] += np.outer(held, output)
    step[2:, 0] = -discrete.B
    step[2:, 2:] = np.eye(n) + discrete.dA
    return float(np.max(np.abs(np.linalg.eigvals(step))))
