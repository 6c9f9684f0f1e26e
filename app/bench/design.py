"""Time of the error budget: steady with its floor, and along 24 h of a moving ship with every source."""

from __future__ import annotations

from typing import Any

from app.bench.error_model import day
from app.bench.rounds import median_ms
from navcore.design.ship import Ship
from navcore.design.steady import steady_budget
from navcore.scenario.model import Scenario
from navcore.scenario.stochastic import stochastic_model

REPEATS = 7
_NETWORKS: tuple[dict[str, Any], ...] = (
    {"id": "classic2"},
    {"id": "classic3"},
    {"id": "complementary"},
    {"id": "unity2"},
    {"id": "compass", "sigma": 0.0088, "xi": 0.7},
    {"id": "compass", "sigma": 0.0015, "xi": 0.7},
    {"id": "optimal"},
)


def _noisy(methods: list[dict[str, Any]] | None) -> Scenario:
    data = day(seed=1).canonical()
    data["imu"] |= {"gyro_instability_dph": 0.003, "accel_instability_ug": 10.0}
    data["reference"] |= {"drift_mps": 0.1}
    data["initial_error"] |= {"attitude_arcmin": [0.1, 0.1, 2.0], "velocity_mps": [0.1, 0.1]}
    return Scenario.parse(data if methods is None else data | {"method": methods})


def measure_design() -> dict[str, float]:
    """Wall times: steady budget and floor of seven methods; transient budget of three along a day."""
    seven = _noisy(
        [{"name": str(k), "damping": "external", "network": network} for k, network in enumerate(_NETWORKS)]
    )
    three = _noisy(None)

    def steady() -> None:
        steady_budget(seven, stochastic_model(seven))

    def transient() -> None:
        ship = Ship(three)
        for method in three.method:
            ship.along(method)

    return {
        "budget_steady_7_ms": median_ms(steady, REPEATS),
        "budget_24h_3_methods_ms": median_ms(transient, REPEATS),
    }
