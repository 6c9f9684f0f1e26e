"""Recordings come in through the page: two NMEA files, and a CSV whose columns the user names."""

from datetime import UTC, datetime
from pathlib import Path

import pytest

from schuler_bench.session.session import Session
from tests.browser.driver import Bench
from tests.nmea import START, gga, rmc, stamped, write
from tests.turning_ship import late_log
from tests.unit.test_own_ins_faults import recorded

BEGIN_S = (datetime(2024, 5, 1, 10, tzinfo=UTC) - START).total_seconds()
SPAN_S = 300


def _track(folder: Path) -> list[Path]:
    """Positions and heading of a ship that steams east at 10 kn, as two NMEA files."""
    east_deg = 10.0 / 3600.0 / 60.0 / 0.669  # a second at 10 kn, 48 N
    gps = (
        stamped(BEGIN_S + k, body)
        for k in range(SPAN_S)
        for lon in [-123.0 + east_deg * k]
        for body in (gga(BEGIN_S + k, 48.0, lon, 10.0), rmc(BEGIN_S + k, 48.0, lon, 10.0, 90.0))
    )
    gyro = (stamped(BEGIN_S + k, "HEHDT,90.0,T") for k in range(SPAN_S))
    return [write(folder / "gps.nmea", gps), write(folder / "gyro.nmea", gyro)]


def _log() -> bytes:
    """A German logger's table in local time, the day first; the month would be possible too."""
    rows = (f"01/05/2024 12:{k // 60:02d}:{k % 60:02d};{10.0 + 0.1 * (k % 3):.1f}" for k in range(SPAN_S))
    return "\n".join(["wann;fahrt", *(row.replace(".", ",") for row in rows)]).encode()


def _main(page: Bench) -> list[str]:
    """Texts of the buttons in view that have the colour of the main one."""
    script = """() => [...document.querySelectorAll('button')]
      .filter(one => one.offsetParent && getComputedStyle(one).backgroundColor === 'rgb(25, 113, 194)')
      .map(one => one.textContent)"""
    return page.page.evaluate(script)


def test_two_nmea_files_and_a_csv_are_brought_to_a_run(
    fresh: Bench, session: Session, tmp_path: Path, pictures: Path
) -> None:
    fresh.tab("Files")
    assert _main(fresh) == ["Upload a file"]
    for file in _track(tmp_path):
        fresh.upload(file)
        fresh.wait_until(lambda name=file.name: name in session.uploads.files)
        fresh.notice(f"{file.name}: NMEA 0183 log")
        fresh.close_notices()
    assert _main(fresh) == ["Run on these files"]
    fresh.upload({"name": "log.csv", "mimeType": "text/csv", "buffer": _log()})
    assert "say what its columns mean" in fresh.notice("log.csv is kept")
    fresh.close_notices()
    fresh.page.screenshot(path=pictures / "refused.png")
    fresh.choose("column", "wann")
    fresh.choose("means", "time")
    fresh.page.locator(".sb-note").filter(has_text="does the day or the month come first?").wait_for()
    fresh.page.screenshot(path=pictures / "asked.png")
    fresh.choose("unit", "DD/MM/YYYY hh:mm:ss")
    row = "xpath=ancestor::*[contains(@class, 'mantine-Flex-root')][1]//input"  # viser gives it no id
    fresh.page.locator('label:text-is("time zone")').locator(row).fill("Europe/Berlin")
    fresh.choose("column", "fahrt")
    fresh.choose("means", "speed through water")
    fresh.choose("unit", "kn")
    fresh.page.screenshot(path=pictures / "named.png")
    assert _main(fresh) == ["Read by these columns"]
    with fresh.next_run():
        fresh.button("Read by these columns").click()
    assert "The duration is the 300 s" in fresh.notice("all uploaded streams share")
    fresh.page.screenshot(path=pictures / "run.png")
    assert _main(fresh) == ["Run on these files"]
    assert (session.scenario.motion.kind, session.scenario.reference.kind) == ("track", "file")
    log = session.uploads.files["log.csv"]
    assert log.quantities == {"water"} and log.mapped
    assert log.details["quantities"]["water"]["start_utc"] == "2024-05-01T10:00:00.0Z"
    assert log.details["quantities"]["water"]["forward_kn"] == [10.0, 10.2]


def test_my_ships_ins_is_damped_by_one_button(
    fresh: Bench, session: Session, tmp_path: Path, pictures: Path
) -> None:
    fresh.tab("Files")
    session.uploads.files.clear()  # of the other tests
    files = recorded(tmp_path)
    for kind, name in (("ins", "phins.csv"), ("log", "em-log.csv"), ("truth", "gnss.csv")):
        fresh.upload({"name": name, "mimeType": "text/csv", "buffer": Path(files[kind]).read_bytes()})
        fresh.wait_until(lambda name=name: name in session.uploads.files)
        fresh.settle()
        fresh.close_notices()
    parts = fresh.page.locator("table", has_text="output of the INS").filter(has_text="gnss.csv")
    words = "output of the INS phins.csv speed log em-log.csv reference gnss.csv"
    assert parts.inner_text().split() == words.split()
    with fresh.next_run():
        fresh.button("Damp my INS").click()
    assert "6.0 h" in fresh.notice("My ship's INS")
    fresh.close_notices()
    words = "With compass the largest position error would have been"
    fresh.page.locator(".sb-note").filter(has_text=words).wait_for()
    fresh.page.screenshot(path=pictures / "own-ins.png")
    assert session.run is not None
    assert [one.method.name for one in session.run.lines][:2] == ["as recorded", "unity2"]
    fresh.choose("best by", "largest heading error")
    fresh.page.locator(".sb-note").filter(has_text="largest heading error").wait_for()
    with fresh.page.expect_download() as given:
        fresh.button("Download the damped output").click()
    assert given.value.suggested_filename == "damped-phins.csv"
    damped, own = Path(given.value.path()).read_text(), Path(files["ins"]).read_text()
    assert damped.split("\n", 1)[0] == own.splitlines()[0] and damped.count("\n") == own.count("\n")
    with fresh.next_run():
        fresh.button("A voyage like mine").click()
    assert "legs; at the end" in fresh.notice("A voyage like mine")
    assert session.scenario.motion.kind == "legs" and session.scenario.reference.kind == "log"


@pytest.fixture
def pictures(tmp_path: Path) -> Path:
    """Folder for pictures, to be looked at."""
    return tmp_path


def test_a_correction_of_the_recordings_is_tried_and_made_by_a_click(bench: Bench, tmp_path: Path) -> None:
    bench.put(late_log(tmp_path, 60.0), "Log", origin="a late log")
    note = bench.page.locator(".sb-warning", has_text="reference.clock_s = -60")
    note.wait_for()
    bench.button("try the correction").click()
    bench.page.locator(".sb-warning", has_text="with the correction.").wait_for()
    before, after = (
        float(part.split(" m")[0]) for part in note.inner_text().split("position error ")[1].split(", ")
    )
    assert after < 0.1 * before
    bench.button("correct").click()
    note.wait_for(state="detached")
    assert bench.session.scenario.reference.clock_s == -60.0
    bench.session.undo()
    note.wait_for()
