"""The unattended soak in pieces: counts are summed, levels compared, and visitors keep their sessions."""

from collections import Counter
from pathlib import Path

from tools.serving.unattended import Course, Kept


def piece(folder: Path, memory: list[float], **counts: int) -> Kept:
    """A piece that has been served, with these figures of the memory."""
    figures = [{"memory": one, "files": 20.0, "threads": 10.0, "log": 5.0, "disk": 2.0} for one in memory]
    held = {1: ("a" * 24, 0.5), 2: ("b" * 24, None)}
    return Kept(folder, port=1, counts=Counter(counts), figures=figures, held=held)


def test_pieces_are_summed_and_the_next_call_goes_on(tmp_path: Path) -> None:
    path, there = tmp_path / "course.json", {"kept_shared": 2.0, "upload_bytes": 30.0}
    steady, larger = [300.0] * 9, [300.0] * 3 + [330.0] * 3 + [336.0] * 3
    course = Course.of(path)
    course.add(piece(tmp_path, steady, answers=5, ends=1, compared=2), 600.0, there)
    course.write(path)
    course = Course.of(path)
    assert (course.pieces, course.seconds) == (1, 600.0)
    assert course.held == {1: ("a" * 24, 0.5), 2: ("b" * 24, None)}
    course.add(piece(tmp_path, larger, answers=7, ends=1, lost=1), 300.0, there)
    course.write(path)
    rows = {row.key: row for row in Course.of(path).rows()}
    assert Course.of(path).seconds == 900.0
    assert (rows["alone_answers"].measured, rows["alone_ends"].measured) == (12, 2)
    assert (rows["alone_lost"].measured, rows["alone_lost"].met) == (1, False)
    assert rows["alone_memory"].measured == 336.0 / 330.0 and rows["alone_memory"].met
    assert rows["alone_memory_pieces"].measured == 336.0 / 300.0 and not rows["alone_memory_pieces"].met
    assert rows["alone_shared"].met and rows["alone_uploaded"].met
