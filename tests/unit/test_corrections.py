"""Recordings that do not agree: the field that mends it, what it then does, and the lever arm of a log."""

from pathlib import Path

import numpy as np
import pytest

from navcore.engine.correcting import corrected, correction_of
from navcore.foundation.earth import WGS84
from navcore.motion.static import StaticMotion
from navcore.motion.track import TrackMotion
from navcore.motion.truth import Site
from navcore.questions.correction import CorrectionQuestion
from navcore.sensors.corrections import corrections
from navcore.sensors.log import reference_errors
from navcore.sensors.recorded import recorded_window, recording_notices
from navcore.sensors.reference import Reference
from tests.turning_ship import HEADING, SPEED, TIME, TURN, late_log, log, table, track


def _errors(ship: TrackMotion, reference: Reference) -> np.ndarray:
    window = recorded_window(ship, reference)
    assert window is not None
    count = int(window.span_s)
    truth = ship.truth(count + 1, 1.0, Site(0, 0, 0), WGS84, start_utc=window.start_s)
    error = reference_errors(reference, truth, float(count), 1, start_utc=window.start_s).error
    return error[60:-60]  # at its ends the smoothed track knows no acceleration


def test_the_clock_of_a_log_is_found_and_put_right(tmp_path: Path) -> None:
    ship = track(tmp_path)
    late = Reference(kind="file", file=log(tmp_path, late_s=60.0), frame="body")
    (found,) = corrections(ship, late)
    assert found.field == ("reference", "clock_s") and found.value == pytest.approx(-60.0, abs=3.0)
    assert any(found.line in notice for notice in recording_notices(ship, late))
    exact = late.model_copy(update={"clock_s": -60.0})
    assert corrections(ship, exact) == ()
    assert np.abs(_errors(ship, exact)).max() < 0.1 < 1.0 < np.abs(_errors(ship, late)).max()


def test_the_clock_of_a_heading_is_found_and_put_right(tmp_path: Path) -> None:
    ship = track(tmp_path, heading_late_s=-45.0)
    (found,) = corrections(ship, Reference())
    assert found.field == ("motion", "heading_clock_s") and found.value == pytest.approx(45.0, abs=3.0)
    assert corrections(ship.model_copy(update={"heading_clock_s": 45.0}), Reference()) == ()


def test_a_correction_adds_to_what_the_field_holds(tmp_path: Path) -> None:
    ship = track(tmp_path)
    half = Reference(kind="file", file=log(tmp_path, late_s=60.0), clock_s=-20.0)
    (found,) = corrections(ship, half)
    assert found.value == pytest.approx(-60.0, abs=3.0)


def test_the_scale_of_a_log_is_found_and_put_right(tmp_path: Path) -> None:
    ship = track(tmp_path)
    knots = Reference(kind="file", file=log(tmp_path, factor=1.9438))
    (found,) = corrections(ship, knots)
    assert found.field == ("reference", "factor") and found.value == pytest.approx(0.5144, abs=0.003)
    assert corrections(ship, knots.model_copy(update={"factor": found.value})) == ()


@pytest.mark.parametrize("arm", [(0.0, 40.0), (12.0, -30.0)])
def test_the_lever_arm_of_a_log_takes_the_velocity_of_turning_off(
    tmp_path: Path, arm: tuple[float, float]
) -> None:
    ship = track(tmp_path)
    plain = Reference(kind="file", file=log(tmp_path, arm=arm), frame="body")
    right = plain.model_copy(update={"lever_arm_m": (*arm, 0.0)})
    assert np.abs(_errors(ship, right)).max() < 0.1
    assert np.abs(_errors(ship, plain)).max() > 0.9 * np.abs(TURN).max() * np.hypot(*arm)


def test_a_lever_arm_of_a_velocity_over_ground_is_turned_by_the_heading(tmp_path: Path) -> None:
    ship, forward = track(tmp_path), 40.0
    side = TURN * forward
    east = SPEED * np.sin(HEADING) + side * np.cos(HEADING)
    north = SPEED * np.cos(HEADING) - side * np.sin(HEADING)
    file = table(tmp_path / "gps.csv", TIME, ve_mps=east, vn_mps=north)
    right = Reference(kind="file", file=file, lever_arm_m=(0.0, forward, 0.0))
    assert np.abs(_errors(ship, right)).max() < 0.1
    assert np.abs(_errors(ship, Reference(kind="file", file=file))).max() > 0.3


def test_a_simulated_log_has_no_use_for_the_corrections() -> None:
    simulated = Reference(kind="log", clock_s=5.0, lever_arm_m=(0.0, 10.0, 0.0))
    (told,) = recording_notices(StaticMotion(), simulated)
    assert told == 'reference.clock_s, reference.lever_arm_m are not used with reference.kind = "log"'


def test_the_page_makes_the_correction_and_says_what_it_changes(tmp_path: Path) -> None:
    scenario = late_log(tmp_path, 60.0)
    found = correction_of(scenario)
    assert found is not None
    found_effects = CorrectionQuestion(scenario=scenario).answer()
    (line,) = found_effects.told()
    before, after = (float(words.split(" m")[0]) for words in (line.split("error ")[1], line.split(", ")[1]))
    assert line.startswith("damped: position error") and after < 0.5 * before
    assert correction_of(corrected(scenario, found)) is None
