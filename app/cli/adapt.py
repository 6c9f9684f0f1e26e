"""``schuler adapt``: Sun's double loop, which makes the table of the policy ``adaptive``."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from tyro.conf import Positional, UseAppendAction, arg

from navcore.foundation.answers import columns, number
from schuler_bench.cli.terminal import emit_result, say

if TYPE_CHECKING:
    from navcore.design.sun import Tuning, TuningSettings


@dataclass(frozen=True)
class AdaptCommand:
    """Find the damping coefficient with the least velocity errors for each difference (Sun 8, Table 1).

    Attributes
    ----------
    scenario : str
        Name of a preset, or a TOML file; empty: Sun's own setting.
    loop : tuple of str
        A setting of the double loop, e.g. step=0.05, differences_kn=[0,0.5,3], error=drift or
        'network={id="complementary"}'.
    set : tuple of str
        Override one field of the scenario first.
    out : Path or None
        File for the scenario with a further method that follows the table.
    json : bool
        Print one JSON document.
    quiet : bool
        No progress bar.
    """

    scenario: Annotated[Positional[str], arg(metavar="SCENARIO")] = ""
    loop: Annotated[UseAppendAction[tuple[str, ...]], arg(metavar="KEY=VALUE")] = ()
    set: Annotated[UseAppendAction[tuple[str, ...]], arg(metavar="KEY=VALUE")] = ()
    out: Annotated[Path | None, arg(metavar="FILE")] = None
    json: bool = False
    quiet: bool = False

    def execute(self) -> int:
        """Search and print; 3 when it was stopped."""
        from navcore.design.sun import sun_scenario, tune_table, with_table
        from navcore.foundation.errors import Fault, InputError
        from navcore.foundation.out import writing
        from navcore.scenario.file import load, to_toml
        from schuler_bench.cli.progress import working

        if self.set and not self.scenario:
            raise InputError(Fault("", "--set", self.set[0], "needs a SCENARIO whose field it overrides"))
        scenario = load(self.scenario, self.set) if self.scenario else sun_scenario()
        settings = _settings(self.loop)
        with working("double loop", self.quiet, self.scenario or None) as (progress, stopped):
            found = tune_table(scenario, settings, progress=progress, cancelled=stopped)
        if found.status == "stopped":
            say(f"{self.scenario or 'adapt'}: stopped")
            return 3
        if self.out is not None:
            with writing(self.out):
                self.out.write_text(to_toml(with_table(scenario, found)), encoding="utf-8")
        emit_result(self.json, _document(found), lambda: _lines(found))
        return 0


def _settings(overrides: tuple[str, ...]) -> "TuningSettings":
    """Settings of the double loop with some of them overridden as by ``--set``."""
    from pydantic import ValidationError

    from navcore.design.sun_settings import TuningSettings
    from navcore.foundation.errors import InputError
    from navcore.foundation.faults import faults_from
    from navcore.scenario.file import apply_overrides

    data: dict[str, Any] = {}
    apply_overrides(data, overrides)
    try:
        return TuningSettings.model_validate(data)
    except ValidationError as error:
        raise InputError(*faults_from(error, TuningSettings, data, "--loop")) from None


def _document(found: "Tuning") -> dict[str, Any]:
    names = "difference_kn", "xi", "sun_xi"
    rows = [dict(zip(names, row, strict=True)) for row in found.beside_sun()]
    return {"network": found.settings.network.id, "rows": rows, "warnings": list(found.warnings)}


def _lines(found: "Tuning") -> Iterator[str]:
    head = "difference, kn", f"best coefficient, {found.settings.network.id}", "Sun's table 1"
    rows = [tuple(number(value) for value in row) for row in found.beside_sun()]
    yield from columns([head, *rows])
    if found.warnings:
        yield ""
    yield from (f"warning: {warning}" for warning in found.warnings)
