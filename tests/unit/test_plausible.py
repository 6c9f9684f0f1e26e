"""A water speed far from the speed over ground, and a recording too short for a conclusion, are told."""

from pathlib import Path

import pytest

from navcore.checks.file import check_file
from navcore.engine.simulation import simulate
from navcore.foundation.units import KNOT
from navcore.scenario.model import Scenario
from tests.nmea import stamped, vbw, write


def _log(path: Path, water: float, ground: float) -> Path:
    return write(path, [stamped(k, vbw((0.0, water), (0.0, ground))) for k in range(60)])


@pytest.mark.parametrize(
    ("water", "ground", "said"),
    [(4.0, 10.3, "a wrong unit or scale"), (10.3 * KNOT, 10.3, "m/s taken for knots"), (8.0, 10.3, ""),
     (9.5, 10.3, ""), (2.0, 4.5, ""), (20.0, 10.3, "knots taken for m/s")],
)  # fmt: skip
def test_a_water_speed_far_from_the_speed_over_ground_is_told(
    tmp_path: Path, water: float, ground: float, said: str
) -> None:
    told = [w for w in check_file(_log(tmp_path / "log.txt", water, ground)).warnings if "through the" in w]
    assert len(told) == (said != "")
    assert all(said in warning and "10.3 kn" in warning for warning in told)


def _scenario(motion: dict[str, object], log: Path, seconds: float) -> Scenario:
    return Scenario.parse(
        {
            "run": {"duration_h": seconds / 3600.0},
            "motion": motion,
            "reference": {"kind": "file", "file": str(log), "frame": "body"},
        }
    )


def test_the_log_is_judged_by_the_track_and_the_short_run_is_told(tmp_path: Path) -> None:
    track = tmp_path / "track.csv"
    rows = [f"{k},48.0,{-123.0 + 6.9e-5 * k:.8f},90.0" for k in range(120)]
    track.write_text("t_s,lat_deg,lon_deg,heading_deg\n" + "\n".join(rows), encoding="utf-8")
    log = tmp_path / "log.csv"
    log.write_text("t_s,speed_kn\n" + "".join(f"{k},4.0\n" for k in range(120)), encoding="utf-8")
    run = simulate(_scenario({"kind": "track", "file": str(track)}, log, 100.0))
    assert any("through the water (median 4.0 kn" in warning for warning in run.warnings)
    assert any("1.7 min is 0.02 of a Schuler period" in warning for warning in run.warnings)


def test_a_log_alone_is_said_to_run_against_the_simulated_motion(tmp_path: Path) -> None:
    run = simulate(_scenario({"kind": "static"}, _log(tmp_path / "log.txt", 9.0, 9.0), 50.0))
    assert any("the ship follows the simulated motion (static)" in warning for warning in run.warnings)
