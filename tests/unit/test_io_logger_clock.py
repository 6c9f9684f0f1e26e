"""Lines of one logger have one clock: what is known of it from one sentence holds for all."""

from pathlib import Path

import pytest

from navcore.io.recording import read_recording
from tests.nmea import START, rmc, stamped, write


@pytest.mark.parametrize("error_s", [-95.0, 41.0, -300.0])
def test_the_error_of_the_clock_is_taken_off_every_line(tmp_path: Path, error_s: float) -> None:
    lines = []
    for k in range(12):
        lines.append(stamped(k + error_s, rmc(k, 38.0, 9.0, 5.0, 20.0)))
        lines.append(stamped(k + 0.3 + error_s, "HEHDT,20.0,T"))
    read = read_recording(write(tmp_path / "log.txt", lines))
    assert read.heading is not None
    assert read.heading.time_s[0] == pytest.approx(START.timestamp() + 0.3, abs=0.01)
    assert any("logger's clock" in word and f"{error_s:+.1f} s" in word for word in read.warnings)


def test_a_clock_that_is_right_is_left_alone(tmp_path: Path) -> None:
    lines = [stamped(k + 0.4, rmc(k, 38.0, 9.0, 5.0, 20.0)) for k in range(5)]
    read = read_recording(write(tmp_path / "log.txt", [*lines, stamped(5.5, "HEHDT,20.0,T")]))
    assert read.heading is not None
    assert read.heading.time_s[0] == pytest.approx(START.timestamp() + 5.5, abs=0.01)
    assert not read.warnings or all("clock" not in word for word in read.warnings)
