"""Recordings in iXblue STDBIN: output, deviations, EM log and DVL; damage is named with its place."""

import math
from pathlib import Path

import numpy as np
import pytest

from navcore.checks.file import check_file
from navcore.engine.simulation import simulate
from navcore.foundation.errors import InputError
from navcore.foundation.units import DEG
from navcore.io.recording import load
from navcore.scenario.model import Scenario
from tests.stdbin import dvl_ground, em_log, frame, navigation

MIDNIGHT = 864_000_000
DAY_S = 1704067200.0
"""2024-01-01."""


def voyage(seconds: int, begin: int = MIDNIGHT - 300_000, version: int = 3) -> list[bytes]:
    """Frames of each second, from 30 s before a midnight on; the logs come every second and every two."""
    frames = []
    lat, lon = 54.0, 359.9990
    for k in range(seconds):
        ticks = begin + 10_000 * k
        date = (31, 12, 2023) if ticks < MIDNIGHT else (1, 1, 2024)
        ve, vn = 4.0 + 0.3 * math.sin(1.24e-3 * k), 2.0
        lat, lon = lat + vn / 111_300.0, (lon + ve / 65_400.0) % 360.0
        blocks = navigation(
            heading=63.4, roll=1.0, pitch=2.0, lat=lat, lon=lon, height=12.0, ve=ve, vn=vn, date=date
        )
        late = (ticks - 2_000) % MIDNIGHT
        sensors = {4: em_log(late, 4.5)}
        if k % 2 == 0:
            sensors[10] = dvl_ground(late, 4.4, 0.1)
        frames.append(frame(blocks, sensors, tenths_ms=ticks % MIDNIGHT, version=version))
    return frames


@pytest.mark.parametrize("version", [2, 3, 4, 5])
def test_output_logs_and_deviations_are_read(tmp_path: Path, version: int) -> None:
    file = tmp_path / "phins.bin"
    file.write_bytes(b"".join(voyage(120, version=version)))
    found = load(file)
    position, velocity, attitude = found.position, found.velocity, found.attitude
    assert (
        position is not None and velocity is not None and attitude is not None and found.heading is not None
    )
    assert position.time_s[0] == pytest.approx(DAY_S - 30.0) and position.dated
    assert np.allclose(np.diff(position.time_s), 1.0)
    assert position.values[0] == pytest.approx([(54.0 + 2.0 / 111_300.0) * DEG, 359.99906116 * DEG, 12.0])
    assert velocity.values[0] == pytest.approx([4.0, 2.0], abs=1e-6)
    assert found.heading.values[0, 0] == pytest.approx(63.4 * DEG, rel=1e-6)
    # Pitch counts bow down in it, roll port up.
    assert attitude.values[0] == pytest.approx([-2.0 * DEG, 1.0 * DEG], rel=1e-6)
    assert found.water is not None and found.ground is not None
    assert found.water.what == "STDBIN EM log 1" and found.water.time_s.size == 120
    assert found.water.time_s[0] == pytest.approx(DAY_S - 30.2)
    assert found.water.values[0] == pytest.approx([0.0, 4.5])
    assert found.ground.time_s.size == 60 and found.ground.values[0] == pytest.approx([-0.1, 4.4])
    of = found.deviations
    assert of["position"].values[0] == pytest.approx([5.0, 4.0])
    assert of["velocity"].values[0] == pytest.approx([0.2, 0.3])
    assert of["heading"].values[0] == pytest.approx([0.1 * DEG])
    assert of["attitude"].values[0] == pytest.approx([0.03 * DEG, 0.02 * DEG])


def test_one_file_is_ins_and_log_of_a_run(tmp_path: Path) -> None:
    file = tmp_path / "phins.bin"
    file.write_bytes(b"".join(voyage(1800)))
    run = simulate(
        Scenario.parse(
            {
                "run": {"duration_h": 0.49},
                "ins": {"file": str(file)},
                "reference": {"kind": "file", "file": str(file)},
                "method": [{"damping": "external", "network": {"id": "unity2", "zeta": 0.5}}],
            }
        )
    )
    assert run.methods[0].status == "ok" and run.methods[0].errors["dve_mps"]["max_abs"] > 0.0


def test_a_damaged_frame_is_left_out_and_named(tmp_path: Path) -> None:
    frames = voyage(40)
    frames[7] = frames[7][:60] + bytes([frames[7][60] ^ 1]) + frames[7][61:]
    frames[20] = frames[20][:50]
    file = tmp_path / "phins.bin"
    file.write_bytes(b"".join([*frames[:30], b"noise", *frames[30:]]))
    report = check_file(file)
    assert report.ok and report.kind == "iXblue STDBIN"
    first = sum(map(len, frames[:7]))
    assert any(
        f"damaged frames left out, the first at byte {first} (wrong checksum)" in w for w in report.warnings
    )
    assert report.details["lines_used"] >= 36 and report.details["checksum_faults"] >= 1
    assert "  standard deviation, positions (STDBIN deviation): median 5 / 4 m" in report.text
    assert report.details["deviations"]["heading"]["median_deg"] == pytest.approx([0.1])


@pytest.mark.parametrize(
    ("content", "allowed"),
    [
        (
            b"".join(one[:-1] + bytes([one[-1] ^ 1]) for one in voyage(9)),
            "9 of 9 frames of STDBIN are damaged, the",
        ),
        (voyage(1)[0][:-1], r"the first at byte 0 \(cut off\)"),
        (frame({0: bytes(12)})[:-4] + bytes(4), "the first at byte 0 .wrong checksum"),
        (frame({0: bytes(13)}), "its size is not that of the blocks"),
        (frame({31: bytes(12)}), "its size is not that of the blocks"),
        (frame({2: bytes(16)}), "none of position, speed, attitude"),
        (b"IX\x03" + bytes(200), "the first at byte 0 .no frame begins here"),
        (b"IX\x02\x00\x00\x00\x01" * 20_000, "are damaged, the first at byte 0"),
    ],
)
def test_what_cannot_be_read_is_refused_with_the_place(tmp_path: Path, content: bytes, allowed: str) -> None:
    file = tmp_path / "phins.bin"
    file.write_bytes(content)
    with pytest.raises(InputError, match=allowed):
        load(file)


def test_frames_without_a_date_are_undated(tmp_path: Path) -> None:
    blocks = navigation(lat=54.0)
    del blocks[13]
    file = tmp_path / "phins.bin"
    file.write_bytes(b"".join(frame(blocks, tenths_ms=10_000 * k) for k in range(5)))
    position = load(file).position
    assert (
        position is not None and not position.dated and position.time_s.tolist() == [0.0, 1.0, 2.0, 3.0, 4.0]
    )
