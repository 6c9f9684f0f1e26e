"""Settings of Sun's double loop: differences, coefficients, the network, and the log's errors meanwhile."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from pydantic import Field, model_validator

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.parameters import Parameters, bounded, choice, quantity
from navcore.foundation.units import KNOT
from navcore.networks import Network, NetworkParameters, parse_network
from navcore.networks.unity2 import Unity2Network

MAX_RUNS_A_COEFFICIENT = 65
_Difference = Annotated[float, bounded(unit="kn", ge=0.0, le=100.0)]


class TuningSettings(Parameters):
    """Settings of `navcore.design.sun.tune_table`; the defaults are Sun's (2017, 3.2 and Table 1)."""

    differences_kn: tuple[_Difference, ...] = Field(
        default=(0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 1.8, 3.0),
        min_length=2,
        max_length=28,
        description="Velocity differences |V_c - V_r| to find the best damping for, ascending "
        "(outer loop, Sun Table 1).",
        json_schema_extra={"unit": "kn"},
    )
    smallest: float = quantity(
        0.01,
        ge=0.001,
        le=5.0,
        label="smallest coefficient",
        help="First damping coefficient tried (inner loop, Sun 3.2).",
    )
    largest: float = quantity(
        1.0, ge=0.001, le=5.0, label="largest coefficient", help="Last damping coefficient tried."
    )
    step: float = quantity(
        0.01, ge=0.001, le=1.0, label="step", help="Step between two damping coefficients (Sun 3.2)."
    )
    network: Network = Field(
        default_factory=Unity2Network,
        description="Network whose damping coefficient (zeta or xi) is tuned; its other values stay.",
    )
    error: Literal["constant", "drift"] = choice(
        "constant",
        label="log error",
        help="How the log errs by the difference: constant from t = 0 (Sun 3.2), in any direction; or drift, "
        "a Gauss-Markov error whose RMS is the difference.",
    )
    drift_tau_s: float = quantity(
        600.0,
        unit="s",
        ge=1.0,
        le=1e6,
        slider=(60.0, 36000.0),
        log=True,
        label="drift time",
        help="Correlation time of the drift.",
    )
    realisations: int = Field(
        default=4,
        strict=True,
        ge=1,
        le=MAX_RUNS_A_COEFFICIENT - 1,
        description="Random drifts over which the objective is averaged; seeds run.seed, run.seed + 1, ...",
    )

    @model_validator(mode="after")
    def _searchable(self) -> TuningSettings:
        if list(self.differences_kn) != sorted(set(self.differences_kn)):
            raise InputError(Fault("", "differences_kn", list(self.differences_kn), "must ascend"))
        if self.largest < self.smallest:
            allowed = f"must be >= {self.smallest:g}, the smallest"
            raise InputError(Fault("", "largest", self.largest, allowed))
        if not self.network.damping_field:
            raise InputError(Fault("", "network.id", self.network.id, "must have a damping ratio xi or zeta"))
        return self

    def coefficients(self) -> np.ndarray:
        """Damping coefficients of the inner loop, ascending."""
        count = int(round((self.largest - self.smallest) / self.step + 1e-6)) + 1
        values = np.round(self.smallest + self.step * np.arange(count), 9)
        return values[values <= self.largest + 1e-9]

    def differences(self) -> np.ndarray:
        """Velocity differences of the outer loop, m/s."""
        return np.array(self.differences_kn) * KNOT

    def with_coefficient(self, value: float) -> NetworkParameters:
        """Return the network with another damping coefficient, checked.

        Raises
        ------
        InputError
            The network does not exist for this coefficient.
        """
        fields = self.network.model_dump(exclude_none=True)
        return parse_network({**fields, self.network.damping_field: float(value)}, "network")
