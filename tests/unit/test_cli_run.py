"""``schuler run``: results on stdout, files, exit codes, stopping."""

import csv
import errno
import json
import signal
import sys
from typing import Any

import numba
import pyarrow.parquet
import pytest
from numba.core import event

from navcore.engine.measures import metrics
from navcore.engine.simulation import simulate
from navcore.foundation.earth import EARTH_RATE
from navcore.scenario.file import load
from schuler_bench.cli import main
from schuler_bench.cli.progress import Bar, compiling
from schuler_bench.cli.terminal import on_terminal

SHORT = ["--set", "run.duration_h=0.1"]
COLUMNS = [
    "method",
    "t_s",
    "phi_e_rad",
    "phi_n_rad",
    "phi_u_rad",
    "dve_mps",
    "dvn_mps",
    "dlat_m",
    "dlon_m",
    "damped",
    "xi",
]
QUANTITIES = [*COLUMNS[2:9], "position_m"]

LOOP_KEYS = [
    "stable",
    "poles",
    "h0",
    "damping_ratio",
    "settling_s",
    "earth_mode_growth_per_s",
    "h_slope_s",
    "whole_system_stable",
    "slow_mode_damping_ratio",
    "slow_mode_natural_frequency_rad_s",
    "growth_per_s",
    "heading_settling_s",
]


def run_json(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> tuple[int, dict]:
    code = main(["run", *arguments, "--json"])
    return code, json.loads(capsys.readouterr().out)


def test_json_is_one_document_with_the_contracts_keys(capsys):
    code = main(["run", "zha-fast", *SHORT, "--json"])
    captured = capsys.readouterr()
    assert (code, captured.err) == (0, "")
    document = json.loads(captured.out)
    assert {"schema", "scenario_sha256", "versions", "elapsed_s", "methods"} <= document.keys()
    assert document["schema"] == 1
    assert len(document["scenario_sha256"]) == 64
    for method in document["methods"]:
        assert list(method) == ["name", "status", "warnings", "loop", "law", "errors"]
        assert list(method["loop"]) == LOOP_KEYS
        assert list(method["errors"]) == QUANTITIES
        assert all(list(e) == ["mean", "std", "rms", "max_abs", "final"] for e in method["errors"].values())
    free = document["methods"][0]
    assert free["loop"] | {"poles": []} == {
        "stable": True,
        "poles": [],
        "h0": 1.0,
        "damping_ratio": 0.0,
        "settling_s": None,
        "earth_mode_growth_per_s": 0.0,
        "h_slope_s": 0.0,
        "whole_system_stable": True,
        "slow_mode_damping_ratio": pytest.approx(0.0, abs=1e-9),
        "slow_mode_natural_frequency_rad_s": pytest.approx(EARTH_RATE, rel=2e-2),
        "growth_per_s": 0.0,
        "heading_settling_s": None,
    }
    assert "undamped" in free["warnings"]


def test_the_command_gives_the_numbers_of_the_library(capsys):
    _, document = run_json(["liu-networks", *SHORT, "--set", "method.0.damping=internal"], capsys)
    scenario = load("liu-networks", ["run.duration_h=0.1", "method.0.damping=internal"])
    expected = json.loads(json.dumps(metrics(simulate(scenario))))
    assert document | {"elapsed_s": 0} == expected | {"elapsed_s": 0}


def test_people_get_a_table_with_units(capsys):
    assert main(["run", "zha-fast", *SHORT]) == 0
    out = capsys.readouterr().out
    for word in (
        "Zha 2019, fig. 1",
        "arcsec",
        "m/s",
        "RMS",
        "largest",
        "at the end",
        "fast (compass)",
        "every step of",
    ):
        assert word in out
    assert max(len(line) for line in out.splitlines()) < 160


def test_files_hold_what_was_printed(tmp_path, capsys):
    folder = tmp_path / "a" / "b"
    code, document = run_json(["zha-fast", *SHORT, "--out", str(folder)], capsys)
    assert code == 0
    assert sorted(p.name for p in folder.iterdir()) == ["metrics.json", "scenario.toml", "timeseries.parquet"]
    assert json.loads((folder / "metrics.json").read_text("utf-8")) == document
    assert list(tmp_path.joinpath("a").iterdir()) == [folder]


def test_the_written_scenario_is_complete_and_gives_the_same_run(tmp_path, capsys):
    _, first = run_json(["liu-overshoot", *SHORT, "--out", str(tmp_path / "out")], capsys)
    _, again = run_json([str(tmp_path / "out" / "scenario.toml")], capsys)
    assert again["scenario_sha256"] == first["scenario_sha256"]
    assert [m["errors"] for m in again["methods"]] == [m["errors"] for m in first["methods"]]


def test_csv_and_parquet_hold_the_same_rows(tmp_path, capsys):
    for name in ("parquet", "csv"):
        assert main(["run", "zha-fast", *SHORT, "--out", str(tmp_path / name), "--format", name]) == 0
    table = pyarrow.parquet.read_table(tmp_path / "parquet" / "timeseries.parquet")
    with (tmp_path / "csv" / "timeseries.csv").open(newline="") as stream:
        header, *rows = csv.reader(stream)
    assert header == table.column_names == COLUMNS
    assert len(rows) == table.num_rows == 3 * 37
    assert [row[0] for row in rows] == table["method"].to_pylist()
    for index, name in enumerate(COLUMNS[1:], 1):
        assert [float(row[index]) for row in rows] == table[name].to_pylist()
    free = [row for row in rows if row[0] == "free"]
    assert [float(row[1]) for row in free] == [10.0 * k for k in range(37)]
    assert {row[9] for row in free} == {"0"}
    assert {row[9] for row in rows if row[0] == "classic2"} == {"1"}
    assert str(table.schema.field("damped").type) == "int8"


def test_results_in_a_folder_are_replaced_by_those_of_the_next_run(tmp_path, capsys):
    folder = tmp_path / "out"
    for name in ("parquet", "csv"):
        assert main(["run", "zha-fast", *SHORT, "--out", str(folder), "--format", name]) == 0
    assert sorted(p.name for p in folder.iterdir()) == ["metrics.json", "scenario.toml", "timeseries.csv"]
    assert list(tmp_path.iterdir()) == [folder]


@pytest.mark.parametrize("below", ["", "sub"])
def test_a_file_in_the_way_is_named(below, tmp_path, capsys):
    (tmp_path / "file").write_text("x")
    assert main(["run", "zha-fast", *SHORT, "--out", str(tmp_path / "file" / below)]) == 2
    err = capsys.readouterr().err
    assert err.startswith("--out = ") and err.count("\n") == 1


def test_a_full_disk_leaves_the_earlier_results_and_no_half_file(tmp_path, capsys, monkeypatch):
    folder = tmp_path / "out"
    assert main(["run", "zha-fast", *SHORT, "--out", str(folder)]) == 0
    before = {p.name: p.read_bytes() for p in folder.iterdir()}

    def full(*_: object, **__: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("pyarrow.parquet.write_table", full)
    capsys.readouterr()
    assert main(["run", "zha-fast", "--out", str(folder)]) == 2
    captured = capsys.readouterr()
    assert captured.err == f"--out = '{folder}': cannot be written: No space left on device\n"
    assert {p.name: p.read_bytes() for p in folder.iterdir()} == before
    assert list(tmp_path.iterdir()) == [folder]


def test_a_diverging_method_is_written_marked_and_exit_3(tmp_path, capsys):
    unstable = '{ id = "custom", num = [1.0, 0.003], den = [1.0, 0.001] }'
    sets = [f"method.1.network={unstable}", 'method.1.name="unstable"', "run.duration_h=50.0"]
    sets += ["imu.accel_bias_ug=[50.0, 50.0, 0.0]"]
    arguments = [
        "zha-fast",
        *(word for item in sets for word in ("--set", item)),
        "--out",
        str(tmp_path / "o"),
    ]
    code = main(["run", *arguments, "--json"])
    captured = capsys.readouterr()
    document = json.loads(captured.out)
    states = {m["name"]: m["status"] for m in document["methods"]}
    assert (code, states["free"], states["unstable"]) == (3, "ok", "diverged")
    assert "unstable: diverged: the error left the range of the linear model" in captured.err
    assert json.loads((tmp_path / "o" / "metrics.json").read_text("utf-8")) == document
    rows = pyarrow.parquet.read_table(tmp_path / "o" / "timeseries.parquet").to_pylist()
    last = {name: max(row["t_s"] for row in rows if row["method"] == name) for name in states}
    assert last["unstable"] < last["free"] == 180000.0


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("foo = 1", "foo = 1: is not a field here; known: schema, title"),
        ('[motion]\nkind = "track"\nfile = []', "motion.file: name at least one file"),
        ('[motion]\nkind = "track"\nfile = "none.csv"', "motion.file = "),
    ],
)
def test_a_fault_names_the_file_and_the_field_as_the_file_spells_it(text, told, tmp_path, capsys):
    file = tmp_path / "ship.toml"
    file.write_text(f"schema = 1\n{text}\n", "utf-8")
    assert main(["run", str(file)]) == 2
    assert capsys.readouterr().err.startswith(f"{file}: {told}")


@pytest.mark.parametrize(
    ("fidelity", "told"),
    [("error_model", "stopped by the user at"), ("strapdown", "stopped by the user at 60 s")],
)
def test_ctrl_c_keeps_what_was_computed_and_marks_it(fidelity, told, tmp_path, capsys, monkeypatch):
    asked = []

    def interrupt_once(bar: Bar, fraction: float) -> None:
        if not asked:
            asked.append(fraction)
            signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr(Bar, "advance", interrupt_once)
    text = f'schema = 1\n[run]\nfidelity = "{fidelity}"\nduration_h = 100.0\n[[method]]\nname = "free"\n'
    (tmp_path / "long.toml").write_text(text)
    previous = signal.getsignal(signal.SIGINT)
    code, document = run_json([str(tmp_path / "long.toml"), "--out", str(tmp_path / "out")], capsys)
    assert code == 3
    (method,) = document["methods"]
    assert method["status"] == "stopped"
    assert any(told in warning for warning in method["warnings"])
    assert json.loads((tmp_path / "out" / "metrics.json").read_text("utf-8")) == document
    times = pyarrow.parquet.read_table(tmp_path / "out" / "timeseries.parquet")["t_s"].to_pylist()
    assert 0.0 < times[-1] < 360000.0
    assert signal.getsignal(signal.SIGINT) is previous


def test_the_bar_shows_titles_as_they_are_and_follows_the_run():
    with Bar("[red]title[/red] [x", show=True) as bar:
        bar.advance(0.25)
        bar._appear()
        assert bar._bar is not None
        task = bar._bar[0].tasks[0]
        assert task.completed == 0.25
        bar.advance(0.5)
        assert (task.completed, task.description) == (0.5, "[red]title[/red] [x")


def test_the_bar_says_what_is_compiled_and_how_long_it_took(capsys):
    """A slow kernel held the bar at 0 % for 22 s, and nothing was said."""
    said = []

    class Watch(event.Listener):
        def on_start(self, event):
            column: Any = bar._bar[0].columns[1]
            said.append(str(column.render(bar._bar[0].tasks[0])))

        def on_end(self, event):
            pass

    with Bar("title", show=True) as bar, event.install_listener("numba:compile", Watch()):
        bar._appear()
        assert compiling() == ""
        numba.njit(lambda x: x + 1.0)(2.0)
    assert [text.rpartition(", ")[0] for text in said] == [f"compiling {__name__}.{_LAMBDA}"]
    assert "compiled 1 kernel" in capsys.readouterr().err


_LAMBDA = "test_the_bar_says_what_is_compiled_and_how_long_it_took.<locals>.<lambda>"


def test_no_bar_is_drawn_in_a_cell_of_a_notebook(monkeypatch):
    """Behind `!schuler run` stands a pseudo-terminal, and the cell kept 20 states of the bar."""
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    monkeypatch.delenv("JPY_PARENT_PID", raising=False)
    assert on_terminal()
    monkeypatch.setenv("JPY_PARENT_PID", "4711")
    assert not on_terminal()


def test_no_bar_appears_after_the_run():
    with Bar("title", show=True) as bar:
        pass
    bar._appear()
    assert bar._bar is None


# ---------------------------------------------------------------- strapdown


STRAPDOWN = ["--set", "run.fidelity=strapdown", "--set", "run.duration_h=0.05"]


@pytest.mark.parametrize("preset", ["liu-networks", "sikuliaq-like", "zha-fast"])
def test_a_linear_preset_runs_as_strapdown(preset, capsys):
    assert main(["run", preset, *STRAPDOWN, "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["computed_on"].startswith("states every 1 s")
    assert all(method["status"] == "ok" for method in document["methods"])


def test_people_read_what_was_run(capsys):
    assert main(["run", "zha-fast", *STRAPDOWN]) == 0
    out = capsys.readouterr().out
    assert "strapdown, 0.05 h" in out and "every 100 steps of the mechanization at 100 Hz" in out


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        (["site.lat_deg=88", "alignment.kind=compass"], "zha-fast: site.lat_deg = 88.0: compass alignment"),
        (["imu.file=/nowhere.imu"], "/nowhere.imu: imu.file: No such file or directory"),
        (["run.rate_hz=5"], "zha-fast: run.rate_hz = 5: must be >= 10 and <= 1000 (Hz)"),
    ],
)
def test_a_fault_is_one_line_and_exit_2(changes, line, capsys):
    words = [word for change in changes for word in ("--set", change)]
    assert main(["run", "zha-fast", *STRAPDOWN, *words]) == 2
    err = capsys.readouterr().err
    assert err.startswith(line) and err.count("\n") == 1


def test_check_tells_the_samples_of_a_strapdown_scenario(tmp_path, capsys):
    path = tmp_path / "s.toml"
    path.write_text('schema = 1\n[run]\nfidelity = "strapdown"\nduration_h = 0.5\nrate_hz = 200.0\n')
    assert main(["check", str(path)]) == 0
    assert "strapdown, 0.5 h, 360000 samples at 200 Hz" in capsys.readouterr().out
