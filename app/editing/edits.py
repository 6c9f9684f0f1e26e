"""Changes of a scenario, each giving a new, fully checked one: the only way the page changes anything."""

import re
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from pydantic import ValidationError

from navcore.damping import KINDS
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.motion import MOTIONS
from navcore.motion.static import AttitudeMotion
from navcore.scenario.bounds import MAX_METHODS
from navcore.scenario.file import FILE_FIELDS
from navcore.scenario.frozen import frozen_method
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.sensors.imu import RECORDING
from schuler_bench.editing.form import Path
from schuler_bench.editing.parts import PARTS, choose_part, shown_part

_STRAPDOWN_ONLY: dict[str, tuple[str, ...]] = {
    "run": ("vertical", "compensation"),
    "alignment": ("kind",),
    "imu": RECORDING,
}


def with_value(
    scenario: Scenario, path: Path, value: Any, on_screen: Callable[[], Mapping[str, Any]] = dict
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
    on_screen : callable, optional
        Gives what the page shows for the network's other parameters, used where the scenario gives no
        value: after gains that no (sigma, xi) gives, a new xi goes with the sigma on the screen.

    Raises
    ------
    InputError
        The new scenario is wrong.
    """
    data = scenario.canonical()
    if len(path) == 4 and path[2] == "network":
        _choose_alternative(scenario, data, path, on_screen)
    if path[-1] == "gyrocompass":  # a block that is there or not
        value = {} if value else None
        data["method"][int(path[1])].pop("azimuth", None)
    if path in PARTS:
        value = choose_part(scenario, data, path, value)
    _place(data, path, value)
    if path == ("run", "fidelity") and value != "strapdown":
        _leave_strapdown(data)
    if path[0] == "method" and path[-1] in ("damping", "id", "variant"):
        _forget_made_name(scenario, data, int(path[1]))
    return Scenario.parse(data)


def with_choice(
    scenario: Scenario, path: Path, chosen: str, earlier: Mapping[str, Any] | None = None
) -> Scenario:
    """Choose another kind of block (network, policy, switching, motion): it starts with its own defaults.

    Parameters
    ----------
    scenario : Scenario
        Stays as it is.
    path : tuple
        Where the field lies that names the kind.
    chosen : str
        The kind. What both kinds know by the same name is kept.
    earlier : mapping, optional
        Fields that the block had when it was last of this kind, in place of the defaults: the legs of a
        course that was left for another motion and is chosen again.

    Raises
    ------
    InputError
        The new scenario is wrong.
    """
    data = scenario.canonical()
    block = _at(data, path[:-1])
    kept = {name: value for name, value in block.items() if name in _shared_fields(path, chosen)}
    block.clear()
    block.update({**(earlier or {}), path[-1]: chosen, **kept})
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
        added: dict[str, Any] = {"damping": damping, "network": {"id": "classic2"}, "name": "classic2"}
        where = len(data["method"])
    else:
        added = dict(data["method"][like])
        where = like + 1
    added["name"] = free_name(added["name"], [m["name"] for m in data["method"]])
    data["method"].insert(where, added)
    return Scenario.parse(data), where


def without_method(scenario: Scenario, index: int) -> Scenario:
    """Remove a method; raises `InputError` for the last one."""
    data = scenario.canonical()
    del data["method"][index]
    return Scenario.parse(data)


def with_block(scenario: Scenario, path: Path) -> Scenario:
    """Append a block with defaults to a list of blocks such as ``reference.event``; raises `InputError`."""
    return _with_blocks(scenario, path, lambda blocks: [*blocks, {}])


def without_block(scenario: Scenario, path: Path) -> Scenario:
    """Remove the last block of a list of blocks."""
    return _with_blocks(scenario, path, lambda blocks: blocks[:-1])


def with_list(scenario: Scenario, path: Path, blocks: list[Any]) -> Scenario:
    """Put other blocks in the place of a list such as ``motion.leg``; raises `InputError`."""
    return _with_blocks(scenario, path, lambda _: blocks)


def _with_blocks(scenario: Scenario, path: Path, change: Callable[[list[Any]], list[Any]]) -> Scenario:
    data = scenario.canonical()
    parent = _at(data, path[:-1])
    parent[path[-1]] = change(parent.get(path[-1], []))
    return Scenario.parse(data)


def value_at(scenario: Scenario, path: Path) -> Any:
    """Value of a field; None when it is left out."""
    place: Any = scenario
    for step in path:
        if place is None:
            return None
        place = place[step] if isinstance(step, int) else getattr(place, step)
    return shown_part(place, path) if place is None else place


def values_at(scenario: Scenario, paths: Iterable[Path]) -> dict[Path, Any]:
    """Values of some fields: path -> value."""
    return {path: value_at(scenario, path) for path in paths}


def with_network(scenario: Scenario, index: int, network: dict[str, Any], block: str = "network") -> Scenario:
    """Return a scenario with another network, or azimuth network, in one method.

    Raises
    ------
    InputError
        There is no such method any more, or the network does not go with it.
    """
    if not 0 <= index < len(scenario.method) or scenario.method[index].undamped:
        raise InputError(Fault("", f"method.{index}", None, Text("is no method with a network any more")))
    data = scenario.canonical()
    data["method"][index][block] = dict(network)
    if block == "network" and network.get("id") != scenario.method[index].network.id:
        _forget_made_name(scenario, data, index)
    return Scenario.parse(data)


def with_design(scenario: Scenario, index: int, method: Method) -> tuple[Scenario, int]:
    """Put a method, its H(s) as designed, in place of another or behind an undamped one; also its index.

    Raises
    ------
    InputError
        There are too many methods, or it does not go with the scenario.
    """
    data = scenario.canonical()
    behind = index >= len(scenario.method) or scenario.method[index].undamped
    others = [m["name"] for i, m in enumerate(data["method"]) if behind or i != index]
    taken = frozen_method(method, scenario.omega_s).model_dump(mode="json", by_alias=True, exclude_none=True)
    block, at = taken | {"name": free_name(method.label(), others)}, index + behind
    data["method"][at : at + (not behind)] = [block]
    return Scenario.parse(data), at


def files_of(scenario: Scenario) -> set[str]:
    """Paths of the recordings that the scenario runs on."""
    blocks = (getattr(scenario, block) for block in dict.fromkeys(block for block, _ in FILE_FIELDS))
    named = (getattr(block, "file", None) for block in blocks)
    return {path for files in named for path in ((files,) if isinstance(files, str) else files or ())}


def network_values(scenario: Scenario, index: int) -> dict[str, Any]:
    """Values of all parameters of a method's network, those that follow from others included.

    A parameter that has no value (sigma and xi of gains that no (sigma, xi) gives) is missing.
    """
    return scenario.method[index].network.values(scenario.omega_s)


def _choose_alternative(
    scenario: Scenario, data: Any, path: Path, on_screen: Callable[[], Mapping[str, Any]]
) -> None:
    """Make the group of parameters that holds the field the one that is given."""
    index, name = int(path[1]), path[3]
    block, groups = data["method"][index]["network"], scenario.method[index].network.alternatives
    mine = next((group for group in groups if name in group), None)
    if mine is None:
        return
    values = dict(on_screen()) | network_values(scenario, index)
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
    return set(AttitudeMotion.model_fields) & set(MOTIONS[chosen].model_fields) - {"kind"}


def _leave_strapdown(data: Any) -> None:
    """Give up what only a strapdown run can do: another fidelity would be refused with it."""
    for block, names in _STRAPDOWN_ONLY.items():
        for name in names:
            data[block].pop(name, None)


def _forget_made_name(scenario: Scenario, data: Any, index: int) -> None:
    """Let a name that was made from the network be made anew."""
    method = scenario.method[index]
    others = [m["name"] for i, m in enumerate(data["method"]) if i != index]
    automatic = {kind.label(method) for kind in KINDS.values()} | {method.network.id}
    if _unnumbered(method.name) not in automatic:
        return
    block = data["method"][index]
    try:
        changed = Method.model_validate(block | {"name": ""})
    except ValidationError:
        return  # the scenario is refused
    block["name"] = free_name(changed.network.id if changed.kind.uses_network else changed.label(), others)


def free_name(name: str, taken: list[str]) -> str:
    """Name that no other method has: this one, or with another number: the copy of "a 2" is "a 3"."""
    plain = _unnumbered(name) if name in taken else name
    names = (
        plain,
        *(Text("{plain} {number}", plain=plain, number=number) for number in range(2, MAX_METHODS + 2)),
    )
    return next(free for free in names if free not in taken)


def _unnumbered(name: str) -> str:
    """Name without the number that tells it from others."""
    return re.sub(r" \d+$", "", name)


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
