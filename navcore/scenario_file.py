"""Scenario files: TOML in and out, presets by name, single fields overridden, one hash for one scenario."""

from __future__ import annotations

import difflib
import hashlib
import json
import tomllib
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from navcore.assets import asset_path
from navcore.errors import Fault, InputError
from navcore.scenario import SCHEMA, Scenario

_FILE_FIELDS = (("motion", "file"), ("reference", "file"), ("imu", "file"))
_LARGEST_TOML = 4 * 1024 * 1024


def presets() -> dict[str, Path]:
    """Names and files of the presets that come with the product, sorted."""
    return {path.stem: path for path in sorted(asset_path("presets").glob("*.toml"))}


def load(source: str, overrides: Iterable[str] = ()) -> Scenario:
    """Load a preset by name or a TOML file, with ``KEY=VALUE`` overrides.

    Parameters
    ----------
    source : str
        Name of a preset, or path of a file.
    overrides : iterable of str
        E.g. ``method.0.network.xi=0.5``; the value is read as TOML, else as text.

    Raises
    ------
    InputError
        One fault per thing wrong.
    """
    known = presets()
    path = known.get(source, Path(source))
    data = read_toml(path, source)
    apply_overrides(data, overrides)
    for block, field in _FILE_FIELDS:
        table = data.get(block)
        if isinstance(table, dict) and field in table:
            table[field] = _resolved(table[field], path.parent)
    return Scenario.parse(data, source)


def read_toml(path: Path, where: str) -> dict[str, Any]:
    """Read a TOML file into a mapping.

    Raises
    ------
    InputError
        The file is missing, too large, no text or no TOML.
    """
    try:
        if path.stat().st_size > _LARGEST_TOML:
            raise InputError(Fault(where, "", None, f"is larger than {_LARGEST_TOML} bytes: no scenario"))
        text = path.read_bytes().decode("utf-8")
    except OSError as error:
        raise InputError(Fault(where, "", None, _not_there(where, error))) from None
    except UnicodeDecodeError:
        raise InputError(Fault(where, "", None, "is not UTF-8 text: no scenario")) from None
    return parse_toml(text, where)


def parse_toml(text: str, where: str) -> dict[str, Any]:
    """Parse TOML text into a mapping; a migration notice would come here for older schemas.

    Raises
    ------
    InputError
        Not TOML (with line and column), or of a schema that this version does not know.
    """
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InputError(Fault(where, "", None, f"is not valid TOML: {error}")) from None
    if data.get("schema", SCHEMA) != SCHEMA:
        raise InputError(Fault(where, "schema", data["schema"], f"must be {SCHEMA}"))
    return data


def _not_there(where: str, error: OSError) -> str:
    if isinstance(error, FileNotFoundError):
        near = difflib.get_close_matches(where, presets(), 1)
        hint = f' (did you mean "{near[0]}"?)' if near else ""
        return f"is neither a preset nor a file{hint}; presets: {', '.join(presets())}"
    return f"cannot be read: {error.strerror}"


def _resolved(value: Any, folder: Path) -> Any:
    if isinstance(value, str):
        # What no path can be is left as it is: the field's own check names it.
        return str((folder / value).resolve()) if value and "\0" not in value else value
    return [_resolved(item, folder) for item in value] if isinstance(value, list) else value


def apply_overrides(data: dict[str, Any], overrides: Iterable[str]) -> None:
    """Set single fields of a scenario mapping in place.

    Choosing another ``kind`` or ``id`` starts that block anew with the defaults of the new kind.

    Raises
    ------
    InputError
        No ``=`` in an override, or a path that leads through something that is no block.
    """
    faults: list[Fault] = []
    for override in overrides:
        key, equals, text = override.partition("=")
        if not equals or not key.strip():
            faults.append(Fault("--set", "", override, "must have the form KEY=VALUE, e.g. run.duration_h=2"))
            continue
        fault = _set(data, key.strip().split("."), _value(text.strip()))
        if fault:
            faults.append(Fault("--set", key.strip(), text, fault))
    if faults:
        raise InputError(faults)


def _value(text: str) -> Any:
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        return text


def _set(data: Any, path: list[str], value: Any) -> str:
    """Set one field; return what is wrong with the path, or nothing."""
    for depth, part in enumerate(path[:-1]):
        if isinstance(data, list):
            if not part.isdigit() or int(part) >= len(data):
                return f'"{part}" must be a number from 0 to {len(data) - 1}'
            data = data[int(part)]
        elif isinstance(data, dict):
            if part not in data and depth == 0 and part == "method":
                data[part] = [{}]
            data = data.setdefault(part, {})
        else:
            return f'"{".".join(path[:depth])}" is a single value, not a block'
    last = path[-1]
    if isinstance(data, list):
        if not last.isdigit() or int(last) >= len(data):
            return f'"{last}" must be a number from 0 to {len(data) - 1}'
        data[int(last)] = value
    elif isinstance(data, dict):
        if last in ("id", "kind") and path[0] in ("motion", "method") and data.get(last) != value:
            data.clear()
        data[last] = value
    else:
        return f'"{".".join(path[:-1])}" is a single value, not a block'
    return ""


def to_toml(scenario: Scenario) -> str:
    """Complete, resolved scenario as TOML text."""
    import tomlkit

    return tomlkit.dumps(scenario.canonical())


def scenario_hash(scenario: Scenario) -> str:
    """SHA-256 of the canonical scenario; a file counts by its name and content, not by its folder."""
    data = scenario.canonical()
    for block, field in _FILE_FIELDS:
        if data.get(block, {}).get(field):
            data[block][field] = _fingerprints(data[block][field])
    return hashlib.sha256(json.dumps(data, sort_keys=True, separators=(",", ":")).encode()).hexdigest()


def _fingerprints(files: str | list[str]) -> list[str]:
    paths = [Path(file) for file in ([files] if isinstance(files, str) else files)]
    return [f"{path.name}:{hashlib.sha256(path.read_bytes()).hexdigest()}" for path in paths]
