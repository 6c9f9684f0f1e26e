"""Scenario files: TOML in and out, presets by name, single fields overridden, one hash for one scenario."""

import difflib
import hashlib
import json
import os
from collections.abc import Iterable, Iterator
from functools import lru_cache
from pathlib import Path
from typing import Any

from navcore.foundation.assets import asset_path
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.inputs import NotRegularError, TooLargeError, opened, read_bytes
from navcore.foundation.text import Text
from navcore.foundation.times import in_other_unit
from navcore.foundation.written_toml import read_toml_text, read_value
from navcore.scenario.bounds import LARGEST_BYTES, require_bounded, require_readable
from navcore.scenario.fields import SCHEMA
from navcore.scenario.frozen import frozen
from navcore.scenario.model import Scenario

_NAMED = {"motion": "kind", "network": "id", "policy": "id", "switching": "id"}
"""Blocks that may be given by their name alone, and the field that bears it."""
FILE_FIELDS = tuple(
    (block, field) for block in ("motion", "reference", "imu", "ins", "truth") for field in ("file", "map")
)
"""Block and field of what names recordings."""


def presets() -> dict[str, Path]:
    """Return the presets that come with the program.

    Returns
    -------
    dict
        Name -> path of its TOML file, sorted by name.
    """
    return {path.stem: path for path in sorted(asset_path("presets").glob("*.toml"), key=lambda p: p.stem)}


def load(source: str, overrides: Iterable[str] = (), *, apart: bool = False) -> Scenario:
    """Read a scenario: a preset by its name, or a TOML file.

    Parameters
    ----------
    source : str
        Name of a preset (see `presets`), or path of a file. Names of recordings in a file are relative to it.
    overrides : iterable of str
        Fields to change, as ``KEY=VALUE`` with a dotted key: ``method.0.network.xi=0.5``. The value is read
        as TOML, else as a number however it is written (``0,5``), and, where it is neither, as text.
    apart : bool
        Leave out methods that the rest of the scenario refuses (`Scenario.refused`), as long as one is left.

    Returns
    -------
    Scenario
        Complete and checked; every field that was not given has its default.

    Raises
    ------
    InputError
        The scenario is wrong. It carries one fault for each field, with its value and the allowed range.

    Examples
    --------
    >>> from navcore import load
    >>> load("zha-fast", ["site.lat_deg=45"]).site.lat_deg
    45.0
    """
    return Scenario.parse(read(source, overrides), source, apart=apart)


def read(source: str, overrides: Iterable[str] = ()) -> dict[str, Any]:
    """Read what `load` checks: the mapping of a scenario with its overrides, recordings by absolute path."""
    path = presets().get(source, Path(source))
    data = read_toml(path, source)
    apply_overrides(data, overrides)
    resolve_files(data, path.parent)
    return data


def resolve_files(data: dict[str, Any], folder: Path) -> None:
    """Make the paths of recordings in a scenario mapping absolute in place; they are relative to a folder."""
    for block, field in FILE_FIELDS:
        table = data.get(block)
        if isinstance(table, dict) and field in table:
            table[field] = _resolved(table[field], folder)


def read_toml(path: Path, where: str) -> dict[str, Any]:
    """Read a TOML file into a mapping.

    Raises
    ------
    InputError
        The file is missing, no regular file, too large, no text or no TOML.
    """
    try:
        text = read_bytes(path, LARGEST_BYTES).decode("utf-8")
    except TooLargeError:
        large = Text("is larger than {largest_bytes} bytes: no scenario", largest_bytes=LARGEST_BYTES)
        raise InputError(Fault(where, "", None, large)) from None
    except OSError as error:
        raise InputError(Fault(where, "", None, _not_there(where, error))) from None
    except UnicodeDecodeError:
        raise InputError(Fault(where, "", None, Text("is not UTF-8 text: no scenario"))) from None
    return parse_toml(text, where)


def parse_toml(text: str, where: str) -> dict[str, Any]:
    """Parse TOML text into a mapping; a migration notice would come here for older schemas.

    Raises
    ------
    InputError
        Not TOML (with line and column), too large or too deep for a scenario, or of a schema that this
        version does not know.
    """
    text = text.removeprefix("\ufeff")  # the byte order mark of Windows' editors
    require_readable(text, where)
    try:
        data = read_toml_text(text, where)
    except InputError:
        raise
    except RecursionError:
        raise InputError(Fault(where, "", None, Text("is nested too deep: no scenario"))) from None
    except ValueError as error:  # also what the reader does not call its own
        raise InputError(
            Fault(where, "", None, Text("is not valid TOML: {error}", error=str(error)[:200]))
        ) from None
    require_bounded(data, where)
    if data.get("schema", SCHEMA) != SCHEMA:
        raise InputError(Fault(where, "schema", data["schema"], Text("must be {schema}", schema=SCHEMA)))
    return data


def _not_there(where: str, error: OSError) -> str:
    if isinstance(error, FileNotFoundError):
        near = difflib.get_close_matches(where, presets(), 1)
        hint = Text(' (did you mean "{near}"?)', near=near[0]) if near else ""
        return Text(
            "is neither a preset nor a file{hint}; presets: {presets}",
            hint=hint,
            presets=", ".join(presets()),
        )
    if isinstance(error, NotRegularError):
        return error.reason
    return Text("cannot be read: {strerror}", strerror=error.strerror)


def _resolved(value: Any, folder: Path) -> Any:
    if isinstance(value, str):
        # What no path can be is left as it is: the field's own check names it.
        return os.path.realpath(folder / value) if value and "\0" not in value else value
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
            faults.append(
                Fault("--set", "", override, Text("must have the form KEY=VALUE, e.g. run.duration_h=2"))
            )
            continue
        fault = set_field(data, key.strip(), read_value(text.strip()))
        if fault:
            faults.append(Fault("--set", key.strip(), text, fault))
    if faults:
        raise InputError(faults)


def set_field(data: Any, key: str, value: Any) -> str:
    """Set one field of a scenario mapping by its dotted key; return what is wrong with it, or nothing.

    ``requirement.0.quantity`` makes the list, or its next block, where it is not there; not so a method.
    """
    path = key.split(".")
    for depth, part in enumerate(path[:-1]):
        if isinstance(data, list):
            if part == str(len(data)) and path[0] != "method" and all(isinstance(one, dict) for one in data):
                data.append({})
            if not part.isdigit() or int(part) >= len(data):
                return Text('"{part}" must be a number from 0 to {data}', part=part, data=len(data) - 1)
            data = data[int(part)]
        elif isinstance(data, dict):
            if part not in data and depth == 0 and part == "method":
                data[part] = [{}]
            if part in _NAMED and isinstance(data.get(part), str):
                data[part] = {_NAMED[part]: data[part]}
            of_blocks = path[depth + 1].isdigit() and depth + 2 < len(path)
            data = data.setdefault(part, [] if of_blocks else {})
        else:
            return Text('"{path}" is a single value, not a block', path=".".join(path[:depth]))
    last = path[-1]
    if isinstance(data, list):
        if not last.isdigit() or int(last) >= len(data):
            return Text('"{last}" must be a number from 0 to {data}', last=last, data=len(data) - 1)
        data[int(last)] = value
    elif isinstance(data, dict):
        if last in ("id", "kind") and path[0] in ("motion", "method") and data.get(last) != value:
            data.clear()
        data.pop(in_other_unit(last), None)
        data[last] = value
    else:
        return Text('"{path}" is a single value, not a block', path=".".join(path[:-1]))
    return ""


def to_toml(scenario: Scenario) -> str:
    """Complete, resolved scenario as TOML text; its networks take nothing from it any more (`frozen`)."""
    return blocks_to_toml(frozen(scenario).canonical())


def blocks_to_toml(data: dict[str, Any]) -> str:
    """Blocks of a scenario, as `Scenario.canonical` gives them, as TOML text."""
    return "\n".join(_part_as_toml(json.dumps(part)) for part in _parts(data))


def _parts(data: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """A scenario in pieces, each a mapping of its own; their texts one after the other are the whole."""
    yield {key: value for key, value in data.items() if not is_table(value) and key != "method"}
    for key, value in data.items():
        if key != "method" and is_table(value):
            yield {key: value}
        for method in value if key == "method" else ():
            yield {key: [{name: inner for name, inner in method.items() if not is_table(inner)}]}
            tables = [(name, inner) for name, inner in method.items() if is_table(inner)]
            tables.sort(key=lambda table: isinstance(table[1], list))
            yield from ({key: {name: inner}} for name, inner in tables)


def is_table(value: Any) -> bool:
    """Whether TOML writes it under a heading of its own."""
    return isinstance(value, dict) or (isinstance(value, list) and any(isinstance(v, dict) for v in value))


def _part_as_toml(part: str) -> str:
    """One piece, given as JSON, as text; short ones are kept, for a slider changes one of them."""
    return _kept_as_toml(part) if len(part) <= _LONGEST_KEPT else _as_toml(part)


def _as_toml(part: str) -> str:
    import tomlkit

    return tomlkit.dumps(json.loads(part))


_LONGEST_KEPT = 8192
_kept_as_toml = lru_cache(maxsize=512)(_as_toml)


def names_files(scenario: Scenario) -> bool:
    """Whether a scenario runs on recordings, which lie in files."""
    return any(getattr(getattr(scenario, block), field, None) for block, field in FILE_FIELDS)


def scenario_hash(scenario: Scenario) -> str:
    """SHA-256 of the canonical scenario as written; a file counts by its name and content, not its folder.

    Raises
    ------
    InputError
        A file that it names cannot be read.
    """
    data = frozen(scenario).canonical()
    for block, field in FILE_FIELDS:
        if data.get(block, {}).get(field):
            data[block][field] = _fingerprints(data[block][field], f"{block}.{field}")
    return hashlib.sha256(json.dumps(data, sort_keys=True, separators=(",", ":")).encode()).hexdigest()


def _fingerprints(files: str | list[str], field: str) -> list[str]:
    return [_fingerprint(Path(file), field) for file in ([files] if isinstance(files, str) else files)]


def _fingerprint(path: Path, field: str) -> str:
    from navcore.io.source import require_file

    require_file(path, field=field)
    with opened(path) as stream:
        return f"{path.name}:{hashlib.file_digest(stream, 'sha256').hexdigest()}"
