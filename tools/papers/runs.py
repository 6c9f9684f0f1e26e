"""Runs of presets, each made once, in the preset's own fidelity or in the full strapdown."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable
from typing import Any, TypeVar

from navcore.engine.run import MethodRun, Run
from navcore.engine.simulation import simulate
from navcore.scenario.file import apply_overrides, presets, read_toml
from navcore.scenario.model import Scenario

_Made = TypeVar("_Made")

STRAPDOWN_HZ = 50.0
STRAPDOWN = ("run.fidelity=strapdown", f"run.rate_hz={STRAPDOWN_HZ}")
"""Overrides that turn a preset of the linear model into its full strapdown."""


class Runs:
    """Runs by preset and overrides, kept so that several claims share one run.

    Parameters
    ----------
    strapdown : bool
        Whether presets of the linear model are run in the full strapdown.
    """

    def __init__(self, strapdown: bool = False) -> None:
        self.strapdown = strapdown
        self._kept: dict[Hashable, Any] = {}

    def in_strapdown(self) -> Runs:
        """The same runs in the full strapdown; what is made in either is kept in both."""
        other = Runs(strapdown=True)
        other._kept = self._kept
        return other

    def __call__(self, preset: str, *overrides: str) -> Run:
        """Run of a preset with overrides as of ``--set``."""
        overrides = (*(STRAPDOWN if self.strapdown else ()), *overrides)
        return self.keep((preset, overrides), lambda: simulate(scenario_of(preset, overrides)))

    def keep(self, key: Hashable, make: Callable[[], _Made]) -> _Made:
        """Return the value that ``make`` gave when this key was first asked for."""
        if key not in self._kept:
            self._kept[key] = make()
        return self._kept[key]


def scenario_of(preset: str, overrides: Iterable[str] = (), **blocks: Any) -> Scenario:
    """Scenario of a preset with overrides, and with whole blocks replaced (``reference={...}``)."""
    data = read_toml(presets()[preset], preset)
    apply_overrides(data, overrides)
    data.update(blocks)
    return Scenario.parse(data, preset)


def method(run: Run, name: str) -> MethodRun:
    """Method of a run by its name, or by the beginning of its name.

    Raises
    ------
    KeyError
        None, or several, match.
    """
    exact = [m for m in run.methods if m.method.name == name]
    found = exact or [m for m in run.methods if m.method.name.startswith(name)]
    if len(found) != 1:
        raise KeyError(f"{name}: {[m.method.name for m in run.methods]}")
    return found[0]
