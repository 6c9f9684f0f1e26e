"""A table that was found, put into a scenario."""

from __future__ import annotations

from navcore.foundation.errors import Fault, InputError
from navcore.scenario.model import Scenario
from navcore.studies.tuning.double_loop import Tuning


def with_table(scenario: Scenario, tuning: Tuning, method: int | None = None) -> Scenario:
    """Return the scenario with a method whose policy is `adaptive` with the table that was found.

    Parameters
    ----------
    scenario : Scenario
        Where the table goes.
    tuning : Tuning
        From `navcore.studies.tuning.tune`, not stopped.
    method : int, optional
        Index of the method that takes the table (its network becomes the tuned one); a new method at the end
        when left out.

    Raises
    ------
    InputError
        The search was stopped, there is no such method, or the policy cannot re-tune the network.
    """
    table = tuning.rows()
    if not table:
        raise InputError(Fault("", "table", None, "the search was stopped: there is no table"))
    data = scenario.canonical()
    methods = data["method"]
    if method is None:
        methods.append({"name": _new_name([m["name"] for m in methods])})
        method = len(methods) - 1
    if not 0 <= method < len(methods):
        raise InputError(Fault("", "method", method, f"must be 0 to {len(methods) - 1}"))
    network = tuning.settings.network.model_dump(mode="json", exclude_none=True)
    policy = {"id": "adaptive", "table": table}
    methods[method] |= {"damping": "external", "network": network, "policy": policy}
    if data["reference"]["kind"] == "none":
        data["reference"] = {"kind": "log"}
    return Scenario.parse(data)


def _new_name(taken: list[str]) -> str:
    name, number = "adaptive (tuned)", 2
    while name in taken:
        name, number = f"adaptive (tuned {number})", number + 1
    return name
