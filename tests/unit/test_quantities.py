"""The table of quantities: lists elsewhere select rows, a key has one number, a name says what is judged."""

import ast
import math
import re
from collections.abc import Iterator
from pathlib import Path
from typing import get_args

import pytest

from navcore.analysis import judged
from navcore.design.figures import Figures
from navcore.design.measures import Setting, Ship
from navcore.design.measures import measure as measure_setting
from navcore.engine.measures import measure, metrics
from navcore.engine.results import timeseries
from navcore.engine.run import Run
from navcore.engine.simulation import simulate
from navcore.foundation.units import UNITS
from navcore.mechanization import recorder
from navcore.quantities import (
    COMPONENTS,
    ERRORS,
    KINDS,
    LIMITED,
    NAMES,
    OBJECTIVES,
    QUANTITIES,
    TUNED,
    VECTORS,
    WEIGHED,
    Judged,
    components,
    searched,
)
from navcore.scenario.file import load
from schuler_bench.cli import main
from schuler_bench.plots.units import NAMED
from schuler_bench.session import display
from schuler_bench.session.requirements import verdicts
from schuler_bench.session.shown import window_of
from schuler_bench.views.compare.table import MEASURED, lines_of
from schuler_bench.views.errors.figure import GROUPS, VERIFIED
from schuler_bench.views.metrics.table import metrics_rows

ROOT = Path(__file__).parents[2]
TABLE = ROOT / "navcore" / "quantities"
OF_LOOP = [key for key, row in QUANTITIES.items() if "loop" in row.names]
OF_RUN = [key for key, row in QUANTITIES.items() if "run" in row.names]
OF_SEEDS = [key for key, row in QUANTITIES.items() if "seeds" in row.names]
SHIPS = ("sikuliaq-like", "sun-ship")


@pytest.fixture(scope="module", params=SHIPS)
def run(request: pytest.FixtureRequest) -> Run:
    return simulate(load(request.param, ["run.duration_h=3"]))


# ---------------------------------------------------------------- rows


def test_a_name_stands_for_one_quantity_judged_of_one_thing() -> None:
    names = [name for row in QUANTITIES.values() for name in row.names.values()]
    assert len(set(names)) == len(names)
    said = {"loop": "", "run": " of this run", "seeds": "", "ensemble": "ensemble ", "steady": "steady "}
    assert said.keys() == set(get_args(Judged))
    for row in QUANTITIES.values():
        assert all(said[of] in name for of, name in row.names.items()), row.key
        assert {row.unit, row.shown} <= UNITS.keys() and row.help.endswith(".")
        assert bool(row.kind) == bool(row.statistic) == ("loop" not in row.names)
    assert len({error.name for error in ERRORS}) == len({error.key for error in ERRORS}) == 8


def test_each_room_computes_the_rows_that_it_judges_and_no_other() -> None:
    assert set(judged._VALUES) == set(OF_LOOP)
    assert set(QUANTITIES) == {"h0"} | {*TUNED} | {*OF_RUN} | {*OF_SEEDS}
    assert {*WEIGHED} < {*OBJECTIVES} < {*TUNED}


# ---------------------------------------------------------------- lists elsewhere


def literals() -> Iterator[tuple[str, ast.expr]]:
    """Tuples, lists, sets and dictionaries written out in both packages, outside the table."""
    for path in (*(ROOT / "app").rglob("*.py"), *(ROOT / "navcore").rglob("*.py")):
        if path.parent != TABLE:
            for node in ast.walk(ast.parse(path.read_text("utf-8"))):
                if isinstance(node, ast.Tuple | ast.List | ast.Set | ast.Dict | ast.Constant):
                    yield f"{path.relative_to(ROOT)}:{node.lineno}", node


def test_the_recorded_errors_and_the_words_of_the_table_stand_nowhere_else() -> None:
    """No other list of the eight names, no second definition, no second name of a quantity."""
    known = {*NAMES, *(kind.figure for kind in KINDS)}
    words = {row.help for row in QUANTITIES.values()} | {error.title for error in ERRORS}
    words |= {name for row in QUANTITIES.values() for name in row.names.values() if name.count(" ") > 1}
    again = []
    for where, node in literals():
        if isinstance(node, ast.Constant):
            again += [where] if node.value in words else []
            continue
        items = [item for item in ast.walk(node) if isinstance(item, ast.Constant)]
        if len({item.value for item in items if isinstance(item.value, str)} & known) > 1:
            again.append(where)
    assert again == []


def test_lists_of_the_page_and_of_files_are_selections(run: Run) -> None:
    assert set(display.OBJECTIVES) <= set(OBJECTIVES) and set(display.AXES) <= set(WEIGHED)
    assert all(QUANTITIES[row.key] is row for row in MEASURED.values())
    assert {*LIMITED} <= {*QUANTITIES}
    drawn = {one.key for one in (*ERRORS, *VECTORS)}
    assert {key for group in (*GROUPS.values(), VERIFIED) for key in group} <= drawn
    columns = recorder.PHI_E, recorder.PHI_U, recorder.DV_N, recorder.D_LON, recorder.POSITION
    assert [ERRORS[column].key for column in columns] == ["phi_e", "phi_u", "dvn", "dlon", "position"]
    assert tuple(Figures.__dataclass_fields__) == tuple(kind.figure for kind in KINDS)
    assert {kind.unit for kind in KINDS} <= NAMED.keys() and {kind.unit for kind in KINDS} <= UNITS.keys()
    assert sum(len(components(kind)) for kind in KINDS) == len(COMPONENTS) == 7
    document = metrics(run)["methods"][0]
    assert tuple(document["errors"]) == NAMES
    assert {"settling_s", "damping_ratio", "h0", "h_slope_s", "earth_mode_growth_per_s"} <= document[
        "loop"
    ].keys()
    assert [name for name in timeseries(run).column_names if name in NAMES] == list(COMPONENTS)


def test_what_a_search_keeps_of_a_limit_of_this_run_is_the_ensembles() -> None:
    kept = {key: row.key if (row := searched(key)) else None for key in OF_RUN}
    assert kept["position_rms_m"] == "position_rms"
    assert kept["velocity_rms_mps"] == "velocity_rms" and kept["tilt_max_arcsec"] is None
    assert all(searched(key) is QUANTITIES[key] for key in TUNED)


def test_help_and_interface_name_every_row(capsys: pytest.CaptureFixture[str]) -> None:
    page = (ROOT / "docs" / "interface.md").read_text("utf-8")
    section = page.partition("\n## Quantities\n")[2].partition("\n## ")[0].replace("\\|", "¦")
    table = [
        [cell.strip() for cell in line.strip("|").split("|")]
        for line in section.splitlines()
        if "| `" in line
    ]
    wanted = []
    for row in QUANTITIES.values():
        unit = (row.unit or "1") + (f" ({row.shown})" if row.shown != row.unit else "")
        cells = f"`{row.key}`", "; ".join(row.names.values()), unit, ", ".join(row.names), row.axes, row.help
        wanted.append([cell.replace("|", "¦").replace("_axis", " axis") for cell in cells])
    assert table == wanted
    for command, keys in (("tune", TUNED), ("pareto", WEIGHED)):
        assert main([command, "--help"]) == 0
        told = re.sub(r"[^\w%.*]+", " ", capsys.readouterr().out)
        assert [key for key in keys if f" {key} " not in told.replace(".", " ")] == []


# ---------------------------------------------------------------- numbers


def test_a_key_has_the_same_number_wherever_it_is_shown(run: Run) -> None:
    """In the page, in files and in a search; of an adaptive method too, whose loop is that of its run."""
    document, rows = metrics(run), {row.label: row for row in metrics_rows(run)}
    judged_all = verdicts(run, ())
    ship = Ship(run.scenario, along_run=False)
    for place, method in enumerate(run.methods):
        numbers = {key: measure(method, key) for key in (*OF_LOOP, *OF_RUN, *OF_SEEDS)}
        setting = Setting(ship, method.method)
        assert {key: measure_setting(setting, key) for key in OF_LOOP} == {
            key: numbers[key] for key in OF_LOOP
        }
        for name, value in document["methods"][place]["loop"].items():
            if name in numbers:
                assert value == (numbers[name] if math.isfinite(numbers[name]) else None), name
        for verdict in judged_all:
            row = verdict.quantity
            assert verdict.measured[place] * row.size == pytest.approx(numbers[row.key], rel=1e-14)
        (line,) = lines_of(window_of(run, display.Display()), run, place, ())
        assert line.numbers == {name: numbers[row.key] / row.size for name, row in MEASURED.items()}
        minutes = rows["settling"].cells[place][0].removesuffix(" min").replace("never", "inf")
        assert float(minutes) == pytest.approx(numbers["settling_s"] / 60.0, rel=5e-3)


def test_log_tilt_is_the_peak_of_a_fine_grid() -> None:
    """theory.md 3: the tilt after a log step of 1 m/s, which was sampled at 800 points and at 1,200."""
    import numpy as np

    from navcore.analysis import time_response

    method = simulate(load("sikuliaq-like", ["run.duration_h=0.1"])).methods[1]
    time_s = np.linspace(0.0, 6000.0, 200_001)
    finest = {
        output: np.max(np.abs(time_response(method.network, "dv_r", output, time_s)))
        for output in ("phi", "dv")
    }
    assert measure(method, "log_tilt") == pytest.approx(finest["phi"], rel=1e-8)
    assert measure(method, "overshoot") == pytest.approx(finest["dv"], rel=1e-8)
