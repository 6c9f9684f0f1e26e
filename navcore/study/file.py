"""Study files: TOML in and out, listed studies by name, the scenario that a study names."""

from __future__ import annotations

import copy
import os
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from navcore.foundation.assets import asset_path
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.stage_cache import recorded_files
from navcore.foundation.text import Text
from navcore.scenario.file import apply_overrides, is_table, presets, read, read_toml, resolve_files
from navcore.scenario.model import Scenario
from navcore.study.model import Study


def studies() -> dict[str, Path]:
    """Return the studies that come with the program: name -> path of the TOML file, sorted by name."""
    return {path.stem: path for path in sorted(asset_path("studies").glob("*.toml"))}


def load(source: str) -> Study:
    """Read a study: a listed one by its name, or a TOML file.

    Returns
    -------
    Study
        Complete and checked by itself; its scenario is a mapping with every recording by absolute path.

    Raises
    ------
    InputError
        The study is wrong, or there is none of this name.
    """
    known = studies()
    path = known.get(source, Path(source))
    if not os.path.lexists(path):
        allowed = Text("is neither a listed study nor a file; studies: {names}", names=", ".join(known))
        raise InputError(Fault(source, "", None, allowed))
    study = Study.parse(read_toml(path, source), source)
    if isinstance(study.scenario, str):
        named = study.scenario
        data = read(named if named in presets() else str(path.parent / named))
    else:
        data = copy.deepcopy(study.scenario)
        resolve_files(data, path.parent)
    return study.model_copy(update={"scenario": data})


def recordings(study: Study) -> list[str]:
    """Return the paths of the recordings of a study's scenario and of their maps.

    Returns
    -------
    list of str
        And whatever text stands among the values of its factors, for it may name a recording; they need not
        exist.
    """
    blocks = study.scenario.values() if isinstance(study.scenario, dict) else ()
    recorded = [
        file
        for block in blocks
        if isinstance(block, dict)
        for file in recorded_files(SimpleNamespace(file=block.get("file"), map=block.get("map")))
    ]
    return recorded + [text for factor in study.factor for text in _texts(factor.values)]


def _texts(value: Any) -> Iterator[str]:
    """Texts within a value."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict | list | tuple):
        for item in value.values() if isinstance(value, dict) else value:
            yield from _texts(item)


def scenario_data(study: Study, where: str) -> dict[str, Any]:
    """Mapping of a study's scenario: with ``set``, the fidelity, and the name of every method.

    Raises
    ------
    InputError
        ``set`` or the scenario is wrong.
    """
    assert isinstance(study.scenario, dict)  # `load` has read it
    data = copy.deepcopy(study.scenario)
    apply_overrides(data, study.set)
    if study.fidelity is not None:
        apply_overrides(data, [f"run.fidelity={study.fidelity}"])
    # named once: a factor that changes a network does not change the name of its method
    scenario = Scenario.parse(copy.deepcopy(data), where, apart=True)
    for given, name in zip(data.get("method", ()), names_of(scenario), strict=False):
        given.setdefault("name", name)
    return data


def names_of(scenario: Scenario) -> list[str]:
    """Names of a scenario's methods as they were given, those that it refuses among them."""
    names = [method.name for method in scenario.method]
    for one in scenario.refused:  # by increasing place
        names.insert(one.place, one.name)
    return names


def to_toml(study: Study) -> str:
    """Complete study as TOML text, from which `load` makes the same study."""
    import tomlkit

    data = study.model_dump(mode="json", by_alias=True, exclude_defaults=True)
    return tomlkit.dumps(_ordered({"schema": study.schema_version, **data}))


def _ordered(value: Any) -> Any:
    """Put plain fields before tables, as TOML wants them."""
    if isinstance(value, list):
        return [_ordered(item) for item in value]
    if not isinstance(value, dict):
        return value
    return {key: _ordered(value[key]) for key in sorted(value, key=lambda key: is_table(value[key]))}
