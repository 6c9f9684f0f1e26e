"""Uploaded files: kept under safe names, checked, bounded, and turned into runs."""

from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import pytest

from navcore.foundation.errors import InputError
from navcore.scenario.file import load, to_toml
from navcore.scenario.model import Scenario
from navcore.sensors.recorded import log_recording
from schuler_bench.session import uploads
from schuler_bench.session.content import Contents
from schuler_bench.session.recordings import recorded_scenario
from schuler_bench.session.uploads import (
    Uploads,
    opened_scenario,
    plain_names,
    shared_files,
    with_plain_names,
)
from schuler_bench.views.files.meanings import asks_for_the_order, with_choice, with_meaning


def without_last_column(text: str) -> str:
    return "\n".join(line.rpartition(",")[0] for line in text.splitlines())


LOG = "t_s,speed_mps,heading_deg\n" + "".join(f"{t},5.0,90.0\n" for t in range(120))
TRACK = "t_s,lat_deg,lon_deg,heading_deg\n" + "".join(
    f"{t},48.0,{-123.0 + 6.7e-5 * t:.7f},90.0\n" for t in range(100)
)
IMU = "t_s,gx_rad_s,gy_rad_s,gz_rad_s,fx_mps2,fy_mps2,fz_mps2\n" + "".join(
    f"{0.1 * k:.1f},0.0,6.2e-5,3.9e-5,0.0,0.0,-9.795\n" for k in range(1, 4001)
)


@pytest.fixture
def files(tmp_path: Path) -> Uploads:
    return Uploads(tmp_path / "session")


@pytest.fixture
def scenario() -> Scenario:
    return Scenario.parse(
        {"reference": {"kind": "log"}, "method": [{"damping": "external", "network": {"id": "classic2"}}]}
    )


def in_folder(files: Uploads) -> dict[str, str]:
    return {path.name: path.read_text() for path in files.folder.iterdir()}


@pytest.mark.parametrize(
    "name", ["../../etc/passwd", "..\\..\\log.csv", "/abs/log.csv", ".log.csv", "lo\x00g.csv"]
)
def test_a_file_stays_in_its_folder_whatever_its_name(files: Uploads, name: str) -> None:
    upload = files.add(name, LOG.encode())
    assert upload.path.parent == files.folder and in_folder(files) == {upload.path.name: LOG}


def test_what_a_file_holds_is_found_by_its_content(files: Uploads) -> None:
    assert files.add("a.bin", TRACK.encode()).quantities >= {"position", "heading"}
    assert files.holding("position") == [str(files.folder / "a.bin")]


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (b"", "empty"),
        (bytes(range(256)) * 20, "binary"),
        (b"$GPRMC,120000,A,4807.038,N,01131.000,E,022.4,084.4,230394,003.1,W*00\n" * 8, "checksum"),
        (b"hello world\n" * 30, "log.csv"),
    ],
)
def test_a_wrong_file_is_refused_and_nothing_is_lost(files: Uploads, content: bytes, reason: str) -> None:
    files.add("log.csv", LOG.encode())
    with pytest.raises(InputError, match=reason) as caught:
        files.add("log.csv", content)
    assert {fault.where for fault in caught.value.faults} == {"log.csv"}
    assert str(files.folder) not in str(caught.value)
    assert list(files.files) == ["log.csv"] and in_folder(files) == {"log.csv": LOG}


@pytest.mark.parametrize(
    ("limit", "value", "match"),
    [
        ("LARGEST_FILE", len(LOG) - 1, "MiB are accepted"),
        ("MOST_FILES", 1, "at most 1 files"),
        ("LARGEST_FOLDER", len(LOG) + 5, "all files together"),
    ],
)
def test_sizes_and_numbers_are_bounded(
    files: Uploads, monkeypatch: pytest.MonkeyPatch, limit: str, value: int, match: str
) -> None:
    files.add("log.csv", LOG.encode())
    monkeypatch.setattr(uploads, limit, value)
    if limit != "LARGEST_FILE":
        files.add("log.csv", LOG.encode())  # in place of the old one
    with pytest.raises(InputError, match=match):
        files.add("other.csv", LOG.encode())
    files.clear()
    assert not files.folder.exists()


def test_a_track_and_a_log_become_motion_and_reference(files: Uploads, scenario: Scenario) -> None:
    for name, content in (("log.csv", LOG), ("track.csv", TRACK)):
        files.add(name, content.encode())
    made, notes = recorded_scenario(scenario, files)
    assert (made.motion.kind, made.reference.kind, made.method) == ("track", "file", scenario.method)
    assert made.run.duration_h * 3600.0 == pytest.approx(99.0, abs=1.01)
    assert made.site.lat_deg == pytest.approx(48.0, abs=1e-4)
    assert [word for word in ("track", "reference", "duration", "site") if word not in " ".join(notes)] == []


def test_a_log_alone_is_used_and_a_track_without_heading_is_said(files: Uploads, scenario: Scenario) -> None:
    files.add("log.csv", without_last_column(LOG).encode())
    made, _ = recorded_scenario(scenario, files)
    assert (made.motion.kind, made.reference.kind) == ("static", "file")
    files.add("positions.csv", without_last_column(TRACK).encode())
    made, notes = recorded_scenario(scenario, files)
    assert made.motion.kind == "static" and any("a heading is missing" in note for note in notes)


def test_a_recorded_imu_is_aligned_and_navigated_at_its_rate(files: Uploads, scenario: Scenario) -> None:
    files.add("imu.csv", IMU.encode())
    made, notes = recorded_scenario(scenario, files)
    assert (made.run.fidelity, made.run.rate_hz, made.method) == ("strapdown", 10.0, scenario.method)
    assert (made.imu.file, made.imu.axes) == (str(files.folder / "imu.csv"), "frd")  # -z points up
    assert (made.alignment.kind, made.alignment.duration_s) == ("compass", 200.0)
    assert made.run.duration_h * 3600.0 == pytest.approx(199.0, abs=1.01)
    assert "taken to stand" in notes[0]


def test_the_same_file_again_leaves_nothing_beside_it(files: Uploads, tmp_path: Path) -> None:
    """Both names are links to one content then."""
    files.keep_once = Contents(tmp_path / "content").keep_once
    for _ in range(3):
        files.add("log.csv", LOG.encode())
        assert in_folder(files) == {"log.csv": LOG}


@pytest.mark.parametrize(
    ("block", "content", "more"),
    [("reference", LOG, {"kind": "file"}), ("imu", IMU, {})],
    ids=["log", "imu"],
)
def test_an_opened_scenario_reads_uploaded_files_only(
    files: Uploads, tmp_path: Path, block: str, content: str, more: dict[str, str]
) -> None:
    secret = tmp_path / "file.csv"
    secret.write_text(content)
    run = {"fidelity": "strapdown" if block == "imu" else "error_model"}
    text = to_toml(Scenario.parse({"run": run, block: {**more, "file": str(secret)}})).encode()
    with pytest.raises(InputError, match="upload this file first"):
        opened_scenario("mine.toml", text, files)
    files.add("file.csv", content.encode())
    ours = opened_scenario("mine.toml", text, files)

    def file_of(scenario: Scenario) -> Any:
        file = getattr(scenario, block).file
        return file if isinstance(file, str) else file[0]

    plain = with_plain_names(ours)
    assert (file_of(ours), file_of(plain)) == (str(files.folder / "file.csv"), "file.csv")
    assert file_of(shared_files(plain, {"file.csv": secret})) == str(secret)


@pytest.mark.parametrize(
    "content", [b"\xff\xfe", b"no toml at all", b"schema = 99", b"[run]\nduration_h = -1"]
)
def test_a_wrong_scenario_file_is_refused_by_name(files: Uploads, content: bytes) -> None:
    with pytest.raises(InputError, match=r"^mine\.toml"):
        opened_scenario("mine.toml", content, files)


def test_recordings_that_come_with_the_program_need_no_upload() -> None:
    preset = load("sikuliaq-recorded").canonical()
    assert shared_files(Scenario.parse(plain_names(preset)), {}).canonical() == preset


UNNAMED = "wann;fahrt;kurs\n" + "".join(
    f"01/05/2024 12:{t // 60:02d}:{t % 60:02d};5,0;90\n" for t in range(120)
)


def mapped(upload: uploads.Upload) -> dict[str, Any]:
    """What a user chooses for `UNNAMED` in the page."""
    data = with_meaning(upload.map, "wann", "time")
    data = with_choice(data, "wann", "unit", "%d/%m/%Y %H:%M:%S")
    data = with_meaning(data, "fahrt", "speed")
    return with_choice(data, "fahrt", "unit", "mps")


def test_a_table_with_unknown_columns_is_kept_until_they_are_named(
    files: Uploads, scenario: Scenario
) -> None:
    upload = files.add("log.csv", UNNAMED.encode())
    assert upload.faults and not upload.quantities and upload.table is not None
    assert "wann" in str(upload.faults[0]) and str(files.folder) not in str(upload.faults)
    assert asks_for_the_order(with_meaning(upload.map, "wann", "time"), upload.table) == "wann"
    read = files.use_map("log.csv", mapped(upload))
    assert (read.quantities, read.faults) == ({"water"}, ())
    made, _ = recorded_scenario(scenario, files)
    log = log_recording(made.reference).water
    assert log is not None and log.values[0, 1] == 5.0
    assert log.time_s[0] == datetime(2024, 5, 1, 12, tzinfo=UTC).timestamp()


def test_a_map_is_saved_beside_the_data_and_used_again(files: Uploads) -> None:
    files.use_map("log.csv", mapped(files.add("log.csv", UNNAMED.encode())))
    assert sorted(in_folder(files)) == ["log.csv", "log.csv.map.toml"]
    assert files.add("log.csv", UNNAMED.replace("5,0", "6,0").encode()).quantities == {"water"}
    again = Uploads(files.folder)
    again.reopen()
    assert list(again.files) == ["log.csv"] and again.files["log.csv"].mapped
    assert again.use_map("log.csv", None).faults and list(in_folder(files)) == ["log.csv"]


def test_a_wrong_map_changes_nothing_and_names_the_column(files: Uploads) -> None:
    upload = files.add("log.csv", UNNAMED.encode())
    wrong = mapped(upload) | {"time": {"column": "when", "unit": "iso"}}
    with pytest.raises(InputError, match="when.*is no column of the file"):
        files.use_map("log.csv", wrong)
    with pytest.raises(InputError, match="quantity"):
        files.use_map("log.csv", mapped(upload) | {"quantity": {}})
    with pytest.raises(InputError, match="wann = '01/05/2024 12:00:00': may begin with the day or"):
        files.use_map("log.csv", with_meaning(upload.map, "wann", "time"))
    assert files.files["log.csv"] is upload and list(in_folder(files)) == ["log.csv"]


def test_a_column_of_an_imu_is_turned_by_its_sign(files: Uploads) -> None:
    upload = files.add("imu.csv", IMU.encode())
    assert upload.details["up_axis"] == "-z"
    data = upload.map
    for name in ("gy_rad_s", "gz_rad_s", "fy_mps2", "fz_mps2"):
        data = with_choice(data, name, "sign", -1)
    assert files.use_map("imu.csv", data).details["up_axis"] == "+z"
