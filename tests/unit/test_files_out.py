"""What the commands write: their own names alone, whole or not at all, and never a file that they read."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from navcore.foundation.inputs import noting
from navcore.foundation.out import signed, written_by
from navcore.io.column_map import read_map
from navcore.scenario.file import load
from navcore.scenario.reads import recordings
from navcore.study.file import load as load_study
from navcore.study.file import recordings as of_study
from schuler_bench.cli import main
from tests.folders import contents

SHIP = """schema = 1
[run]
duration_h = 0.1
[reference]
kind = "log"
noise_mps = 0.1
[[requirement]]
quantity = "tilt_max_arcsec"
at_most = 30.0
[[method]]
name = "damped"
damping = "external"
network = { id = "unity2" }
"""
STUDY = 'schema = 1\nseeds = 1\nscenario = "ship.toml"\n'
LOG = "utc,speed_kn\n" + "".join(f"2024-05-01T00:00:{t:02d}Z,5.{t}\n" for t in range(9))
MAP = """time = { column = "utc", unit = "iso" }
[quantity.speed]
column = "speed_kn"
unit = "kn"
"""

RUN = ["run", "ship.toml"]
DESIGN = ["design", "ship.toml", "--as-set", "--seeds", "2"]
RUN_STUDY = ["study", "study.toml", "--workers", "1"]
TUNE = [
    "tune",
    "ship.toml",
    "--objective",
    "tilt_rms",
    "--vary",
    "method.0.network.zeta=0.3:1",
    "--no-confirm",
]
ADAPT = ["adapt", "ship.toml", "--loop", "step=0.9", "--loop", "differences_kn=[0,3]"]
CHECK = ["check", "log.csv"]


def recorded(file: str, column_map: str) -> str:
    """The ship with a recorded log."""
    block = f'[reference]\nkind = "file"\nfile = "{file}"\nmap = "{column_map}"\n'
    return SHIP.replace('[reference]\nkind = "log"\nnoise_mps = 0.1\n', block)


FOLDERS = {
    "run": (RUN, ("scenario.toml", "metrics.json", "timeseries.parquet")),
    "design": (DESIGN, ("design.json", "scenario.toml")),
    "study": (RUN_STUDY, ("study.toml", "runs.parquet", "summary.json")),
}
FILES = {"tune": (TUNE, "--out"), "adapt": (ADAPT, "--out"), "check": (CHECK, "--write-map")}


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder of a user's own files, in which the commands are given."""
    monkeypatch.chdir(tmp_path)
    for name, text in {"ship.toml": SHIP, "study.toml": STUDY, "log.csv": LOG, "notes.md": "years"}.items():
        (tmp_path / name).write_text(text)
    return tmp_path


def refusal(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> str:
    """What a refused command says, in one line."""
    capsys.readouterr()
    assert main([*arguments, "--json"]) == 2
    told = capsys.readouterr()
    assert told.out == "" and told.err.count("\n") == 1
    return told.err


# ---------------------------------------------------------------- folders


@pytest.mark.parametrize("command", FOLDERS)
def test_own_names_are_replaced_and_all_other_files_left(
    command: str, here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A scenario, a recording and notes lay beside an earlier result, and were gone after the next run."""
    arguments, names = FOLDERS[command]
    trial = here / "trial"
    assert main([*arguments, "--out", "trial"]) == 0
    assert {path.name for path in trial.iterdir()} == {*names}
    mine = {"ship.toml": SHIP, "voyage.csv": LOG, "notes.md": "x", ".hidden": "x", "sub/deep.txt": "x"}
    (trial / "sub").mkdir()
    for name, text in mine.items():
        (trial / name).write_text(text)
    (trial / names[1]).write_text("from before")
    assert main([*arguments, "--out", "trial/"]) == 0
    held = contents(trial)
    assert {name: held[name].decode() for name in mine} == mine
    assert held.keys() == {*mine, *names}
    assert held[names[1]] != b"from before"


@pytest.mark.parametrize("command", FOLDERS)
@pytest.mark.parametrize("there", ["folder", "link", "dead link", "pipe", "write-protected"])
def test_what_is_no_file_of_ours_at_one_of_our_names_is_refused(
    command: str, there: str, here: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    arguments, names = FOLDERS[command]
    (here / "trial").mkdir()
    place = here / "trial" / names[-1]
    target = here / "notes.md"
    make: dict[str, Callable[[], Any]] = {
        "folder": lambda: (place.mkdir(), (place / "mine.txt").write_text("x")),
        "link": lambda: place.symlink_to(target),
        "dead link": lambda: place.symlink_to(here / "nowhere"),
        "pipe": lambda: os.mkfifo(place),
        "write-protected": lambda: (place.write_text("kept"), place.chmod(0o444)),
    }
    make[there]()
    before = contents(here)
    told = refusal([*arguments, "--out", "trial"], capsys)
    assert f"trial/{names[-1]}'" in told
    assert contents(here) == before and os.path.lexists(place)
    assert [path.name for path in (here / "trial").iterdir()] == [names[-1]]


@pytest.mark.parametrize("given", ["file", "link", "hard link", "far path"])
def test_a_run_never_replaces_its_own_scenario(
    given: str, here: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """``schuler run scenario.toml --out .`` replaced the user's file, comments and all."""
    (here / "scenario.toml").write_text(f"# mine\n{SHIP}")
    name = "scenario.toml"
    if given == "link":
        (here / "elsewhere").mkdir()
        name = "elsewhere/ship.toml"
        (here / name).symlink_to(here / "scenario.toml")
    elif given == "hard link":
        (here / "elsewhere").mkdir()
        name = "elsewhere/ship.toml"
        os.link(here / "scenario.toml", here / name)
    elif given == "far path":
        name = f"../{here.name}/./scenario.toml"
    monkeypatch.setattr("navcore.engine.simulation.simulate", lambda *_: pytest.fail("was run"))
    before = contents(here)
    for folder in (".", str(here), "./", f"../{here.name}"):
        assert "is read by this command" in refusal(["run", name, "--out", folder], capsys)
        assert contents(here) == before


def test_a_run_never_replaces_its_recordings_and_maps(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (here / "metrics.json").write_text(LOG)
    for file, column_map in (("metrics.json", "map.toml"), ("log.csv", "metrics.json")):
        (here / "ship.toml").write_text(recorded(file, column_map))
        assert "is read by this command" in refusal([*RUN, "--out", "."], capsys)


def test_a_recording_is_not_taken_for_the_series_of_an_earlier_run(here: Path) -> None:
    header = "method,t_s,phi_e_rad,phi_n_rad,phi_u_rad,dve_mps,dvn_mps,dlat_m,dlon_m\n"
    (here / "timeseries.csv").write_text(header)
    (here / "ship.toml").write_text(SHIP)
    assert main([*RUN, "--set", "reference.map=timeseries.csv", "--out", "."]) == 0
    assert (here / "timeseries.csv").read_text() == header


def test_what_a_scenario_and_a_study_read_is_listed(here: Path) -> None:
    (here / "ship.toml").write_text(SHIP.replace("[reference]", '[reference]\nfile = ["log.csv", "b.csv"]'))
    factor = '[[factor]]\nfield = ["reference.file", "reference.map"]\nvalues = [["c.csv", "m.toml"]]\n'
    (here / "study.toml").write_text(STUDY + factor)
    with noting() as read:
        scenario = load("ship.toml")
    assert [Path(file).name for file in read] == ["ship.toml"]
    recorded = {"log.csv", "log.csv.map.toml", "b.csv", "b.csv.map.toml"}
    assert {Path(file).name for file in recordings(scenario)} == recorded
    with noting() as read:
        study = load_study("study.toml")
    assert {Path(file).name for file in read} == {"study.toml", "ship.toml"}
    assert {Path(file).name for file in of_study(study)} == {*recorded, "c.csv", "m.toml"}
    with noting() as read:
        load("zha-fast")
    assert [Path(file).name for file in read] == ["zha-fast.toml"]


def test_the_series_of_an_earlier_run_goes_and_a_users_file_of_its_name_stays(
    here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for format in ("parquet", "csv", "parquet"):
        assert main([*RUN, "--out", "trial", "--format", format]) == 0
        assert len([*(here / "trial").glob("timeseries.*")]) == 1
    (here / "trial" / "timeseries.csv").write_text("hour,swell\n1,2\n")
    assert main([*RUN, "--out", "trial"]) == 0
    assert (here / "trial" / "timeseries.csv").read_text() == "hour,swell\n1,2\n"


@pytest.mark.parametrize("place", ["notes.md", "notes.md/sub", "dead", "loop"])
def test_what_is_no_folder_is_refused(place: str, here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (here / "dead").symlink_to(here / "nowhere")
    (here / "loop").symlink_to(here / "loop")
    before = contents(here)
    for arguments, _ in FOLDERS.values():
        assert refusal([*arguments, "--out", place], capsys).startswith("--out = ")
        assert contents(here) == before


def test_a_study_is_gone_on_with_from_its_own_folder(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """``study.toml`` in the folder is what the command reads and what it would write."""
    assert main([*RUN_STUDY, "--out", "results"]) == 0
    again = ["study", "results/study.toml", "--out", "results"]
    assert "is read by this command" in refusal(again, capsys)
    assert main([*again, "--resume"]) == 0
    assert "is read by this command" in refusal([*RUN_STUDY, "--out", "."], capsys)


@pytest.mark.parametrize("mine", ["gear.step", "2024-05.parquet"])
def test_a_folder_named_parts_is_kept(mine: str, here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (here / "results" / "parts").mkdir(parents=True)
    (here / "results" / "parts" / mine).write_text("x")
    told = refusal([*RUN_STUDY, "--out", "results"], capsys)
    assert f"holds what no study wrote: {mine}" in told
    assert (here / "results" / "parts" / mine).read_text() == "x"


def test_a_folder_of_parts_is_never_a_link(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (here / "mine").mkdir()
    (here / "mine" / f"{0:012d}-{1:012d}.parquet").write_text("x")
    (here / "results").mkdir()
    (here / "results" / "parts").symlink_to(here / "mine")
    assert "parts': is not a folder" in refusal([*RUN_STUDY, "--out", "results"], capsys)
    assert len([*(here / "mine").iterdir()]) == 1


def test_an_empty_place_is_not_the_folder_where_the_user_stands(
    here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """``--out "$DIR"`` with no DIR wrote the files among the user's own."""
    for arguments, option in ((RUN, "--out"), (RUN_STUDY, "--out"), (TUNE, "--out"), (CHECK, "--write-map")):
        for place in ([option, ""], [f"{option}="]):
            assert "must name a file or a folder" in refusal([*arguments, *place], capsys)
    assert {path.name for path in here.iterdir()} == {"ship.toml", "study.toml", "log.csv", "notes.md"}


def test_paths_that_are_no_text_are_told(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A folder of an old disk, whose name no TOML file can hold: a recording in it ended in a traceback."""
    old = here / "alt\udcfc"
    old.mkdir()
    (old / "log.csv").write_text("t_s,speed_mps\n0,5\n400,5\n")
    text = '[reference]\nkind = "file"\nfile = "log.csv"\n[imu]\ngyro_bias_dph = [0.01, 0.0, 0.0]\n'
    (old / "ship.toml").write_text(SHIP.replace('[reference]\nkind = "log"\nnoise_mps = 0.1\n', text))
    ship = str(old / "ship.toml")
    assert "is no UTF-8 text" in refusal(["run", ship, "--out", "trial"], capsys)
    assert "is no UTF-8 text" in refusal(["tune", ship, *TUNE[2:], "--along", "--out", "best.toml"], capsys)
    assert not (here / "trial").exists() and not (here / "best.toml").exists()


def test_a_map_of_a_file_with_an_odd_name_is_toml(here: Path) -> None:
    (here / "a\nb.csv").write_text(LOG.replace("5.3", '"5.3\x1b"'))
    main(["check", "a\nb.csv", "--write-map", "map.toml"])
    assert read_map("map.toml").quantity


# ---------------------------------------------------------------- single files


@pytest.fixture(params=FILES)
def writer(request: pytest.FixtureRequest) -> Iterator[tuple[str, list[str], str]]:
    """Name of a command that writes one file, its words, and the option that names the file."""
    arguments, option = FILES[request.param]
    yield request.param, arguments, option


def test_only_its_own_unedited_output_is_replaced(
    writer: tuple[str, list[str], str], here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Notes, a scenario, and a map that had been edited were lost to the next run of the command."""
    command, arguments, option = writer
    call, file = [*arguments, option, "best.toml"], here / "best.toml"
    assert main(call) == 0
    first = file.read_text()
    assert written_by(command, file)
    assert main(call) == 0
    assert file.read_text() == first
    for text in (f"{first}# my note\n", "years of work", ""):
        file.write_text(text)
        told = refusal(call, capsys)
        assert told.startswith(f"{option} = 'best.toml': is there already") and "--force" in told
        assert file.read_text() == text
        assert main([*call, "--force"]) == 0
        assert file.read_text() == first
    other = "tune" if command == "adapt" else "adapt"
    file.write_text(signed("x = 1\n", other))
    assert "is there already" in refusal(call, capsys)


def test_its_own_input_is_not_replaced_even_with_force(
    writer: tuple[str, list[str], str], here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    _, arguments, option = writer
    source = here / arguments[1]
    os.link(source, here / "hard")
    (here / "soft").symlink_to(source)
    before = contents(here)
    for name in (arguments[1], f"./{arguments[1]}", str(source), "hard", "soft", f"../{here.name}/hard"):
        for force in ([], ["--force"]):
            told = refusal([*arguments, option, name, *force], capsys)
            assert "is read by this command" in told or "is a link" in told
    assert contents(here) == before


@pytest.mark.parametrize("place", [".", "sub", "pipe", "dead", "notes.md/best.toml", "no/best.toml"])
def test_what_is_no_place_for_a_file_is_refused(
    place: str, writer: tuple[str, list[str], str], here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    _, arguments, option = writer
    (here / "sub").mkdir()
    os.mkfifo(here / "pipe")
    (here / "dead").symlink_to(here / "nowhere")
    for force in ([], ["--force"]):
        assert refusal([*arguments, option, place, *force], capsys).startswith(f"{option} = ")
    assert not [*(here / "sub").iterdir()]


def test_all_that_a_search_reads_is_kept(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (here / "other.toml").write_text(SHIP)
    for more, kept in (("--worst-of", "other.toml"), ("--over", "study.toml"), ("--over", "ship.toml")):
        given = "study.toml" if kept == "ship.toml" else kept
        told = refusal([*TUNE, more, given, "--out", kept, "--force"], capsys)
        assert "is read by this command" in told
    (here / "design").mkdir()
    os.link(here / "study.toml", here / "design" / "design.json")
    told = refusal([*DESIGN, "--over", "study.toml", "--out", "design"], capsys)
    assert "is read by this command" in told
    assert contents(here / "design") == {"design.json": STUDY.encode()}
