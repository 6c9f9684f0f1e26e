"""Uploaded files: kept under safe names, checked, bounded, and turned into runs."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.session import uploads
from app.session.uploads import (
    Uploads,
    opened_scenario,
    plain_names,
    recorded_scenario,
    shared_files,
    with_plain_names,
)
from navcore.foundation.errors import InputError
from navcore.scenario.file import load, to_toml
from navcore.scenario.model import Scenario

LOG = "t_s,speed_mps,heading_deg\n" + "".join(f"{t},5.0,90.0\n" for t in range(120))
TRACK = "t_s,lat_deg,lon_deg,heading_deg\n" + "".join(
    f"{t},48.0,{-123.0 + 6.7e-5 * t:.7f},90.0\n" for t in range(100)
)


@pytest.fixture
def files(tmp_path: Path) -> Uploads:
    return Uploads(tmp_path / "session")


@pytest.fixture
def scenario() -> Scenario:
    return Scenario.parse(
        {"reference": {"kind": "log"}, "method": [{"damping": "external", "network": {"id": "classic2"}}]}
    )


@pytest.mark.parametrize(
    "name", ["../../etc/passwd", "..\\..\\log.csv", "/abs/log.csv", ".log.csv", "lo\x00g.csv"]
)
def test_a_file_stays_in_its_folder_whatever_its_name(files: Uploads, name: str) -> None:
    upload = files.add(name, LOG.encode())
    assert upload.path.parent == files.folder
    assert upload.path.read_text() == LOG
    assert list(files.folder.iterdir()) == [upload.path]


def test_what_a_file_holds_is_found_by_its_content(files: Uploads) -> None:
    assert files.add("a.bin", TRACK.encode()).quantities >= {"position", "heading"}
    assert files.holding("position") == [str(files.folder / "a.bin")]


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (b"", "empty"),
        (bytes(range(256)) * 20, "binary"),
        (b"$GPRMC,120000,A,4807.038,N,01131.000,E,022.4,084.4,230394,003.1,W*00\n" * 8, "checksum"),
        (b"hello world\n" * 30, ""),
    ],
)
def test_a_wrong_file_is_refused_and_nothing_is_lost(files: Uploads, content: bytes, reason: str) -> None:
    files.add("log.csv", LOG.encode())
    with pytest.raises(InputError) as caught:
        files.add("log.csv", content)
    assert all(fault.where == "log.csv" for fault in caught.value.faults)
    assert reason in str(caught.value)
    assert str(files.folder) not in str(caught.value)
    assert (files.folder / "log.csv").read_text() == LOG
    assert list(files.files) == ["log.csv"]
    assert [path.name for path in files.folder.iterdir()] == ["log.csv"]


def test_sizes_and_numbers_are_bounded(files: Uploads, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(uploads, "LARGEST_FILE", len(LOG))
    with pytest.raises(InputError, match="MiB are accepted"):
        files.add("log.csv", LOG.encode() + b"\n")
    monkeypatch.setattr(uploads, "MOST_FILES", 1)
    files.add("log.csv", LOG.encode())
    with pytest.raises(InputError, match="at most 1 files"):
        files.add("other.csv", LOG.encode())
    files.add("log.csv", LOG.encode())  # in place of the old one
    monkeypatch.setattr(uploads, "LARGEST_FOLDER", len(LOG) + 5)
    monkeypatch.setattr(uploads, "MOST_FILES", 9)
    with pytest.raises(InputError, match="all files together"):
        files.add("other.csv", LOG.encode())
    files.clear()
    assert not files.folder.exists()


def test_a_track_and_a_log_become_motion_and_reference(files: Uploads, scenario: Scenario) -> None:
    files.add("log.csv", LOG.encode())
    files.add("track.csv", TRACK.encode())
    made, notes = recorded_scenario(scenario, files)
    assert made.motion.kind == "track"
    assert made.reference.kind == "file"
    assert made.method == scenario.method
    assert made.run.duration_h * 3600.0 == pytest.approx(99.0, abs=1.01)
    assert made.site.lat_deg == pytest.approx(48.0, abs=1e-4)
    told = " ".join(notes)
    for word in ("track", "reference", "duration", "site"):
        assert word in told


def test_a_log_alone_is_used_and_a_track_without_heading_is_said(files: Uploads, scenario: Scenario) -> None:
    without_heading = "\n".join(line.rsplit(",", 1)[0] for line in LOG.splitlines())
    files.add("log.csv", without_heading.encode())
    made, _ = recorded_scenario(scenario, files)
    assert (made.motion.kind, made.reference.kind) == ("static", "file")
    only_positions = "\n".join(line.rsplit(",", 1)[0] for line in TRACK.splitlines())
    files.add("positions.csv", only_positions.encode())
    made, notes = recorded_scenario(scenario, files)
    assert made.motion.kind == "static"
    assert any("a heading is missing" in note for note in notes)


def test_an_opened_scenario_reads_uploaded_files_only(
    files: Uploads, scenario: Scenario, tmp_path: Path
) -> None:
    secret = tmp_path / "log.csv"
    secret.write_text(LOG)
    data = scenario.canonical()
    data["reference"] = {"kind": "file", "file": str(secret)}
    text = to_toml(Scenario.parse(data)).encode()
    with pytest.raises(InputError, match="upload this file first"):
        opened_scenario("mine.toml", text, files)
    files.add("log.csv", LOG.encode())
    opened = opened_scenario("mine.toml", text, files)
    assert opened.reference.file == (str(files.folder / "log.csv"),) or opened.reference.file == str(
        files.folder / "log.csv"
    )
    assert with_plain_names(opened).reference.file in (("log.csv",), "log.csv")
    assert shared_files(opened, {"log.csv": secret}).reference.file in ((str(secret),), str(secret))


@pytest.mark.parametrize(
    "content", [b"\xff\xfe", b"no toml at all", b"schema = 99", b"[run]\nduration_h = -1"]
)
def test_a_wrong_scenario_file_is_refused_by_name(files: Uploads, content: bytes) -> None:
    with pytest.raises(InputError) as caught:
        opened_scenario("mine.toml", content, files)
    assert str(caught.value).startswith("mine.toml")


# ------------------------------------------------------------ recorded IMU

IMU = "t_s,gx_rad_s,gy_rad_s,gz_rad_s,fx_mps2,fy_mps2,fz_mps2\n" + "".join(
    f"{0.1 * k:.1f},0.0,6.2e-5,3.9e-5,0.0,0.0,-9.795\n" for k in range(1, 4001)
)


def test_a_recorded_imu_is_aligned_and_navigated_at_its_rate(files: Uploads, scenario: Scenario) -> None:
    files.add("imu.csv", IMU.encode())
    made, notes = recorded_scenario(scenario, files)
    assert (made.run.fidelity, made.run.rate_hz) == ("strapdown", 10.0)
    assert made.imu.file == str(files.folder / "imu.csv")
    assert made.imu.axes == "frd"  # -z points up
    assert (made.alignment.kind, made.alignment.duration_s) == ("compass", 200.0)
    assert made.run.duration_h * 3600.0 == pytest.approx(199.0, abs=1.01)
    assert made.method == scenario.method
    assert "taken to stand" in notes[0]


def test_a_scenario_cannot_read_an_imu_file_of_the_server(files: Uploads) -> None:
    data = {"run": {"fidelity": "strapdown"}, "imu": {"file": "/etc/passwd"}}
    with pytest.raises(InputError, match="upload this file first"):
        shared_files(Scenario.parse(data), {})
    files.add("imu.csv", IMU.encode())
    ours = shared_files(
        Scenario.parse(data | {"imu": {"file": "imu.csv"}}), {"imu.csv": files.folder / "imu.csv"}
    )
    assert ours.imu.file == str(files.folder / "imu.csv")
    assert with_plain_names(ours).imu.file == "imu.csv"


def test_recordings_that_come_with_the_program_need_no_upload() -> None:
    preset = load("sikuliaq-recorded")
    again = shared_files(Scenario.parse(plain_names(preset.canonical())), {})
    assert again.canonical() == preset.canonical()
