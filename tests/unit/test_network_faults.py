"""pydantic's errors as faults: paths through lists, unions and nested models, and whole ranges."""

from __future__ import annotations

from typing import Annotated, Any, Literal

import pytest
from pydantic import ConfigDict, Field, ValidationError, field_validator, model_validator

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.faults import faults_from
from navcore.foundation.parameters import Parameters, bounded, quantity
from navcore.networks import Network


class Run(Parameters):
    model_config = ConfigDict(strict=True)

    step_s: float = quantity(1.0, gt=0.0, le=10.0, unit="s")
    count: int = quantity(1, ge=1)
    on: bool = True
    title: str = ""
    kind: Literal["a", "b"] = "a"
    vector: tuple[Annotated[float, bounded(ge=0.0, unit="m")], float] = (0.0, 0.0)


class Method(Parameters):
    name: str
    network: Network = Field(default_factory=lambda: None)  # type: ignore[arg-type]
    limit: float | None = quantity(None, ge=0.0, le=1.0, unit="m/s")
    either: float | list[float] = 0.0

    @field_validator("name")
    @classmethod
    def _no_digits(cls, name: str) -> str:
        if name.isdigit():
            raise ValueError("must not be a number")
        return name


class Scenario(Parameters):
    run: Run = Run()
    method: list[Method] = []
    table: dict[str, Run] = {}

    @model_validator(mode="after")
    def _not_both(self) -> Scenario:
        if self.method and self.run.count == 7:
            raise InputError(Fault("", "run.count", 7, "must not be 7 with a method"))
        return self


def lines(data: Any) -> list[str]:
    with pytest.raises(ValidationError) as caught:
        Scenario.model_validate(data)
    return [str(fault) for fault in faults_from(caught.value, Scenario, data, "x.toml")]


@pytest.mark.parametrize(
    ("data", "line"),
    [
        ({"run": {"step_s": 0}}, "x.toml: run.step_s = 0: must be > 0 and <= 10 (s)"),
        (
            {"run": {"step_s": "1"}},
            "x.toml: run.step_s = '1': must be a number (write 1 without quotation marks), > 0 and <= 10 (s)",
        ),
        ({"run": {"step_s": float("inf")}}, "x.toml: run.step_s = inf: must be a finite number, > 0 and"),
        ({"run": {"count": 0.5}}, "x.toml: run.count = 0.5: must be a whole number, >= 1"),
        ({"run": {"on": 1}}, "x.toml: run.on = 1: must be true or false"),
        ({"run": {"title": 3}}, "x.toml: run.title = 3: must be text"),
        ({"run": {"kind": "c"}}, "x.toml: run.kind = 'c': must be one of 'a' or 'b'"),
        ({"run": {"vector": (-1.0, 0.0)}}, "x.toml: run.vector.0 = -1.0: must be >= 0 (m)"),
        ({"run": 3}, "x.toml: run = 3: must be a table of fields"),
        (
            {"run": {"stepp": 3}},
            "x.toml: run.stepp = 3: is not a field here; did you mean step_s? known: step_s",
        ),
        ({"rum": {}}, "x.toml: rum: is not a field here; did you mean run? known: run, method, table"),
        ({"method": {}}, "x.toml: method: must be a list"),
        ({"method": [{}]}, "x.toml: method.0.name: is required"),
        ({"method": [{"name": "12"}]}, "x.toml: method.0.name = '12': must not be a number"),
        ({"method": [{"name": "a", "limit": 2}]}, "x.toml: method.0.limit = 2: must be >= 0 and <= 1 (m/s)"),
        (
            {"method": [{"name": "a", "network": {"id": "compass", "xi": 0}}]},
            "x.toml: method.0.network.xi = 0: must be >= 0.01 and <= 10",
        ),
        (
            {"method": [{"name": "a"}, {"name": "b", "network": {"id": "nine"}}]},
            "x.toml: method.1.network.id = 'nine': must be one of none, classic2,",
        ),
        (
            {"method": [{"name": "a", "network": {}}]},
            "x.toml: method.0.network.id: is required: one of none, classic2,",
        ),
        (
            {"method": [{"name": "a", "network": {"id": "pole2", "n1": 10}}]},
            "x.toml: method.0.network.n1 = 10: with n₂ = 5 the network's poles w₁, w₂ are complex",
        ),
        (
            {"method": [{"name": "a", "network": {"id": "none", "xi": 1}}]},
            "x.toml: method.0.network.xi = 1: is not a field here; known: id",
        ),
        (
            {"method": [{"name": "a", "network": {"id": "custom", "poles": [[-1, 1e9], -1]}}]},
            "x.toml: method.0.network.poles.0.1 = 1000000000.0: must be >= -10000 and <= 10000 (rad/s)",
        ),
        ({"table": {"k": {"step_s": -1}}}, "x.toml: table.k.step_s = -1: must be > 0 and <= 10 (s)"),
        (
            {"run": {"count": 7}, "method": [{"name": "a"}]},
            "x.toml: run.count = 7: must not be 7 with a method",
        ),
    ],
)
def test_one_fault(data: dict[str, Any], line: str) -> None:
    (found,) = lines(data)
    assert found.startswith(line), found


def test_a_plain_union_gives_one_fault_that_names_both_ways() -> None:
    (found,) = lines({"method": [{"name": "a", "either": "x"}]})
    assert found == "x.toml: method.0.either = 'x': must be a number, or must be a list of numbers"


def test_inside_a_member_of_a_plain_union_the_index_stays() -> None:
    found = lines({"method": [{"name": "a", "either": [1.0, "x"]}]})
    assert "x.toml: method.0.either.1 = 'x': must be a number" in found


def test_every_error_gives_its_own_line() -> None:
    found = lines({"run": {"step_s": 0, "count": 0}, "method": [{"name": 3, "limit": -1}]})
    assert len(found) == 4
    assert all("\n" not in line for line in found)
