"""Sentences that a ship's INS writes beside its heading: position, velocity, roll and pitch."""

import math
from pathlib import Path

import numpy as np
import pytest

from navcore.foundation.units import DEG
from navcore.io.recording import read_recording
from tests.nmea import stamped, write

SECONDS = 120


def recording(folder: Path, *bodies: str):
    lines = (stamped(k, body.format(lat=48.0 + 1e-5 * k, k=k)) for k in range(SECONDS) for body in bodies)
    return read_recording(write(folder / "ins.nmea", lines))


def test_the_output_of_an_ixblue_ins_is_read(tmp_path: Path) -> None:
    found = recording(
        tmp_path,
        "HEHDT,310.25,T",
        "PIXSE,ATITUD,-1.500,2.250",
        "PIXSE,POSITI,{lat:.8f},352.50000000,12.500",
        "PIXSE,SPEED_,-4.5,3.75,0.010",
        "PIXSE,UTMWGS,U,30,400000.0,5300000.0,0.0",
        "PIXSE,STDHRP,0.05,0.01,0.01",
    )
    assert found.position is not None and found.velocity is not None
    assert found.attitude is not None and found.heading is not None
    assert found.position.values[10] == pytest.approx([48.0001 * DEG, 352.5 * DEG, 12.5])
    assert found.velocity.values[10] == pytest.approx([-4.5, 3.75])
    assert found.heading.values[10, 0] == pytest.approx(310.25 * DEG)
    # bow down counts positive there, bow up here
    assert found.attitude.values[10] == pytest.approx([-2.25 * DEG, -1.5 * DEG])
    assert np.allclose(np.diff(found.position.time_s), 1.0)


@pytest.mark.parametrize(
    ("body", "pitch", "roll"),
    [
        ("PASHR,100000.00,310.25,T,-1.50,2.25,0.10,0.02,0.02,0.03,2,1", 2.25, -1.5),
        ("PSXN,23,-1.50,2.25,310.25,0.10", 2.25, -1.5),
        ("PSAT,HPR,100000.00,310.25,2.25,-1.50,N", 2.25, -1.5),
        ("PRDID,2.25,-1.50,310.25", 2.25, -1.5),
    ],
)
def test_roll_and_pitch_stand_beside_the_heading(
    tmp_path: Path, body: str, pitch: float, roll: float
) -> None:
    timed = body.replace("100000.00", "2358{k:02d}.00") if "100000" in body else body
    lines = (stamped(k, timed.format(k=k)) for k in range(60))
    found = read_recording(write(tmp_path / "gyro.nmea", lines))
    assert found.attitude is not None and found.heading is not None
    assert found.attitude.values[5] == pytest.approx([pitch * DEG, roll * DEG])
    assert found.heading.values[5, 0] == pytest.approx(310.25 * DEG)
    assert math.isclose(found.attitude.interval_s, 1.0, abs_tol=1e-6)


def test_an_attitude_out_of_range_makes_no_sense(tmp_path: Path) -> None:
    found = recording(tmp_path, "HEHDT,310.25,T", "PIXSE,ATITUD,-1.5,95.0")
    assert found.attitude is None and found.heading is not None
