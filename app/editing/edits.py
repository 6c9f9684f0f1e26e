"""Changes of a scenario, each giving a new, fully checked one: the only way the page changes anything."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from typing import Any, get_args

from app.editing.form import Path
from navcore.averaging.parameters import Variant
from navcore.motion import MOTIONS
from navcore.network import LinearNetwork
from navcore.network.compass import sigma_xi_from_gains
from navcore.scenario import MAX_METHODS, Scenario

ALTERNATIVES: dict[str, tuple[tuple[str, ...], ...]] = {
    "compass": (("sigma", "xi"), ("k1", "k2", "k3")),
    "unity2": (("zeta2",), ("alpha",)),
    "custom": (("zeros", "poles", "gain"), ("num", "den")),
}
"""Parameters of a network that stand for each other: giving one group takes the others away."""


_STRAPDOWN_ONLY: dict[str, tuple[str, ...]] = {
    "run": ("vertical", "compensation"),
    "alignment": ("kind",),
    "imu": ("file", "axes", "begin_s"),
}


def with_value(
    scenario: Scenario, path: Path, value: Any, shown: Mapping[str, Any] | None = None
) -> Scenario:
    """Set one field.

    Parameters
    ----------
    scenario : Scenario
        Stays as it is.
    path : tuple
        Where the value lies in the canonical scenario.
    value : object
        Not yet checked.
    shown : mapping, optional
        What the page shows for the network's other parameters, used where the scenario gives no value: after
        gains that no (sigma, xi) gives, a new xi goes with the sigma on the screen.

    Raises
    ------
    InputError
        The new scenario is wrong.
    """
    data = scenario.canonical()
    if len(path) == 4 and path[2] == "network":
        _choose_alternative(scenario, data, path, shown or {})
    _place(data, path, value)
    if path == ("run", "fidelity") and value != "strapdown":
        _leave_strapdown(data)
    if path[0] == "method" and path[-1] in ("damping", "id", "variant"):
        _forget_made_name(scenario, data, int(path[1]))
    return Scenario.parse(data)


def with_choice(scenario: Scenario, path: Path, chosen: str) -> Scenario:
    """Choose another kind of block (network, policy, switching, motion): it starts with its own defaults.

    What both kinds know by the same name is kept. Raises `InputError`.
    """
    data = scenario.canonical()
    block = _at(data, path[:-1])
    kept = {name: value for name, value in block.items() if name in _shared_fields(path, chosen)}
    block.clear()
    block.update({path[-1]: chosen} | kept)
    if path[0] == "method":
        _forget_made_name(scenario, data, int(path[1]))
    return Scenario.parse(data)


def with_method(scenario: Scenario, like: int | None) -> tuple[Scenario, int]:
    """Add a method: a copy of method ``like``, or one damped by `classic2` as the reference allows.

    Returns
    -------
    Scenario, and the new method's index.

    Raises
    ------
    InputError
        There are too many methods.
    """
    data = scenario.canonical()
    if like is None:
        damping = "internal" if scenario.reference.kind == "none" else "external"
        made: dict[str, Any] = {"damping": damping, "network": {"id": "classic2"}, "name": "classic2"}
        where = len(data["method"])
    else:
        made = dict(data["method"][like])
        where = like + 1
    made["name"] = _free_name(made["name"], [m["name"] for m in data["method"]])
    data["method"].insert(where, made)
    return Scenario.parse(data), where


def without_method(scenario: Scenario, index: int) -> Scenario:
    """Remove a method; raises `InputError` for the last one."""
    data = scenario.canonical()
    del data["method"][index]
    return Scenario.parse(data)


def with_block(scenario: Scenario, path: Path) -> Scenario:
    """Append a block with defaults to a list of blocks such as ``reference.event``; raises `InputError`."""
    data = scenario.canonical()
    blocks = _at(data, path[:-1])
    blocks[path[-1]] = [*blocks.get(path[-1], []), {}]
    return Scenario.parse(data)


def without_block(scenario: Scenario, path: Path) -> Scenario:
    """Remove the last block of a list of blocks."""
    data = scenario.canonical()
    blocks = _at(data, path[:-1])
    blocks[path[-1]] = blocks.get(path[-1], [])[:-1]
    return Scenario.parse(data)


def value_at(scenario: Scenario, path: Path) -> Any:
    """Value of a field; None when it is left out."""
    place: Any = scenario
    for step in path:
        if place is None:
            return None
        place = place[step] if isinstance(step, int) else getattr(place, step)
    return place


def files_of(scenario: Scenario) -> set[str]:
    """Paths of the recordings that the scenario runs on."""
    blocks = (scenario.motion, scenario.reference, scenario.imu)
    named = (getattr(block, "file", None) for block in blocks)
    return {path for files in named for path in ((files,) if isinstance(files, str) else files or ())}


def network_values(scenario: Scenario, index: int) -> dict[str, Any]:
    """Values of all parameters of a method's network, those that follow from others included.

    A parameter that has no value (sigma and xi of gains that no (sigma, xi) gives) is missing.
    """
    parameters = scenario.method[index].network
    names = type(parameters).model_fields
    given = {name: value for name in names if (value := getattr(parameters, name)) is not None}
    follow = _FOLLOWING.get(parameters.id)
    return given if follow is None else follow(parameters, parameters.transfer(scenario.omega_s)) | given


def _compass_follows(parameters: Any, network: LinearNetwork) -> dict[str, float]:
    k1, k2, k3 = parameters.gains(network.omega_s)
    found = sigma_xi_from_gains(k1, k2, k3, network.omega_s)
    design = {} if found is None else {"sigma": found[0], "xi": found[1]}
    return {"k1": k1, "k2": k2, "k3": k3} | design


def _unity2_follows(parameters: Any, network: LinearNetwork) -> dict[str, float]:
    # D(p) = p^2 + (2 zeta r + alpha) p + r^2 beta, the second pair is p^2 + alpha p + beta (physics.md 3.4).
    alpha = float(network.den_p[1]) - 2.0 * parameters.zeta * parameters.r
    beta = float(network.den_p[2]) / parameters.r**2
    return {"alpha": alpha * network.omega_s, "zeta2": alpha / (2.0 * math.sqrt(beta))}


def _custom_follows(parameters: Any, network: LinearNetwork) -> dict[str, Any]:
    del parameters
    roots = {"zeros": list(network.zeros), "poles": list(network.poles), "gain": network.gain}
    return roots | {"num": network.num.tolist(), "den": network.den.tolist()}


_FOLLOWING: dict[str, Callable[[Any, LinearNetwork], dict[str, Any]]] = {
    "compass": _compass_follows,
    "unity2": _unity2_follows,
    "custom": _custom_follows,
}


def _choose_alternative(scenario: Scenario, data: Any, path: Path, shown: Mapping[str, Any]) -> None:
    """Make the group of parameters that holds the field the one that is given."""
    index, name = int(path[1]), path[3]
    block = data["method"][index]["network"]
    groups = ALTERNATIVES.get(block["id"], ())
    mine = next((group for group in groups if name in group), None)
    if mine is None:
        return
    values = dict(shown) | network_values(scenario, index)
    for field in (field for group in groups for field in group):
        block.pop(field, None)
        if field in mine and values.get(field) is not None:
            block[field] = _plain(values[field])


def _plain(value: Any) -> Any:
    """A value as TOML would hold it: complex numbers as pairs, tuples as lists."""
    if isinstance(value, complex):
        return [value.real, value.imag] if value.imag else value.real
    return [_plain(item) for item in value] if isinstance(value, list | tuple) else value


def _shared_fields(path: Path, chosen: str) -> set[str]:
    """Fields of another kind of block that mean the same: a motion's attitude. Network parameters do not."""
    if path[0] != "motion":
        return set()
    scalar = {"pitch_deg", "roll_deg", "heading_deg"}
    return {name for name in MOTIONS[chosen].model_fields if name in scalar}


def _leave_strapdown(data: Any) -> None:
    """Give up what only a strapdown run can do: another fidelity would be refused with it."""
    for block, names in _STRAPDOWN_ONLY.items():
        for name in names:
            data[block].pop(name, None)


def _forget_made_name(scenario: Scenario, data: Any, index: int) -> None:
    """Let a name that was made from the network be made anew."""
    method = scenario.method[index]
    others = [m["name"] for i, m in enumerate(data["method"]) if i != index]
    made = {method.model_copy(update={"name": ""}).label(), method.network.id, "free"}
    made |= {f"averaging ({variant})" for variant in get_args(Variant)}
    if re.sub(r" \d+$", "", method.name) not in made:
        return
    block = data["method"][index]
    names: dict[str, str] = {"free": "free", "averaging": f"averaging ({block['averaging']['variant']})"}
    block["name"] = _free_name(names.get(block["damping"], str(block["network"]["id"])), others)


def _free_name(name: str, taken: list[str]) -> str:
    names = (name, *(f"{name} {number}" for number in range(2, MAX_METHODS + 2)))
    return next(free for free in names if free not in taken)


def _at(data: Any, path: Path) -> Any:
    for step in path:
        data = data[step]
    return data


def _place(data: Any, path: Path, value: Any) -> None:
    block = _at(data, path[:-1])
    if value is None and isinstance(block, dict):
        block.pop(path[-1], None)
    else:
        block[path[-1]] = value
