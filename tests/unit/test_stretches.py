"""Stretches in which a recorded log fails are named; what a ship does is not."""

from pathlib import Path

import numpy as np
import pytest

from navcore.checks.file import check_file
from navcore.engine.notices import input_notices
from navcore.io.stretches import stretches
from navcore.scenario.model import Scenario
from navcore.sensors.recorded import recording_notices

TIME_S = np.arange(7200.0)


def table(path: Path, speed_kn: np.ndarray) -> Path:
    rows = (f"{t:.0f},45.0,-30.0,{v:.2f},90.0" for t, v in zip(TIME_S, speed_kn, strict=True))
    path.write_text("time_s,lat_deg,lon_deg,speed_kn,heading_deg\n" + "\n".join(rows))
    return path


def failing(value_kn: float, length: int = 60) -> np.ndarray:
    speed = np.full(len(TIME_S), 10.0)
    speed[3000 : 3000 + length] = value_kn
    return speed


@pytest.mark.parametrize(("value", "length"), [(99.9, 60), (0.0, 300), (25.0, 1)])
def test_a_log_that_fails_for_a_while_is_told_with_time_length_and_value(
    tmp_path: Path, value: float, length: int
) -> None:
    report = check_file(table(tmp_path / "log.csv", failing(value, length)))
    (told,) = (text for text in report.warnings if "before and after" in text)
    assert f"{length} samples from t = 3000.0 s for {length} s reach {value:.1f} kn" in told
    assert "10.0 kn" in told
    recorded = {"kind": "file", "file": str(tmp_path / "log.csv")}
    scenario = Scenario.parse({"reference": recorded, "run": {"duration_h": 1.0}})
    assert any("before and after" in text for text in recording_notices(scenario.motion, scenario.reference))


def test_what_a_ship_does_is_no_failure(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    speed = 10.0 + 8.0 * np.sin(TIME_S / 400.0) + rng.normal(0.0, 0.3, len(TIME_S))
    speed[4000:] = np.maximum(speed[4000:] - 0.05 * (TIME_S[4000:] - 4000.0), 0.0)
    report = check_file(table(tmp_path / "log.csv", np.abs(speed)))
    assert not any("before and after" in text for text in report.warnings)


def test_a_step_that_stays_is_no_stretch() -> None:
    assert stretches(np.arange(100.0), np.where(np.arange(100) < 50, 5.0, 12.0)) == []
    assert stretches(np.arange(8.0), np.array([5.0, 9.0, 9.0, 5.1, 5.0, 1.0, 1.0, 5.0])) == [(1, 3), (5, 7)]


def test_very_many_jumps_are_noise_and_take_no_time() -> None:
    assert stretches(np.arange(1e5) * 0.1, np.resize([5.0, 15.0], 100_000)) == []


@pytest.mark.parametrize(
    "part", [slice(0, 60), slice(-60, None), slice(3000, 3660)], ids=["first", "last", "eleven minutes"]
)
def test_speeds_that_no_ship_has_are_told_wherever_they_stand(tmp_path: Path, part: slice) -> None:
    speed = np.full(len(TIME_S), 10.0)
    speed[part] = 99.9
    (told,) = (
        text for text in check_file(table(tmp_path / "log.csv", speed)).warnings if "no ship is" in text
    )
    begin = float(TIME_S[part][0])
    assert f"{len(TIME_S[part])} samples from t = {begin:.1f} s on" in told and "up to 99.9 kn" in told


def test_an_event_that_gives_the_log_a_speed_no_ship_has_is_told() -> None:
    def notices(accel: float) -> list[str]:
        event = {"t_h": 0.2, "duration_s": 60.0, "accel_mps2": [accel, 0.0]}
        own = {"damping": "external", "network": {"id": "classic2"}, "event": [event]}
        both = Scenario.parse(
            {"reference": {"kind": "log", "event": [event]}, "method": [own], "run": {"duration_h": 0.5}}
        )
        return [text for text in input_notices(both) if "any ship" in text]

    assert notices(0.05) == []
    first, second = notices(51.4 / 60.0)
    assert first.startswith("reference.event: the log errs by up to 99.9 kn")
    assert second.startswith("method.0.event:")
