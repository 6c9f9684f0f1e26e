"""Lessons of a teacher: the guide's example is taken; what is wrong is told with file, line and remedy."""

import os
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from navcore.foundation.errors import InputError
from schuler_bench.cli import main
from schuler_bench.views.learn.lessons import OWN, lessons
from schuler_bench.views.learn.own import use_lessons

_GUIDE = Path(__file__).parents[2] / "docs" / "teaching.md"


def example() -> str:
    """The lesson in the guide."""
    return re.search(r"^````markdown\n(.*?)^````$", _GUIDE.read_text(), re.DOTALL | re.MULTILINE).group(1)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """An empty folder of lessons; afterwards there are those of the program alone."""
    monkeypatch.setenv(OWN, "")  # what the test sets is undone after it
    monkeypatch.delenv(OWN)
    yield tmp_path
    lessons.cache_clear()


def test_the_lesson_of_the_guide_stands_after_those_of_the_program(folder: Path) -> None:
    before = len(lessons())
    (folder / "log.md").write_text(example())
    (lesson,) = use_lessons(folder)
    assert [one.id for one in lessons()][before:] == ["log.md"]
    assert [step.title for step in lesson.steps] == ["The Schuler period", "An error of the log"]
    assert lessons()[-1] == lesson


@pytest.mark.parametrize(
    ("old", "new", "line", "words"),
    [
        ("+++\ntitle", "title", 1, "must begin with TOML between two lines +++"),
        ('preset = "deng-static"', "preset = ", 4, "is not valid TOML"),
        ('preset = "deng-static"', 'preset = "deng-slow"', 6, "deng-slow"),
        ("## The Schuler period", "The Schuler period", 6, "under a heading"),
        ("{{schuler.period}}", "{{schuler.perod}}", 6, "is no number of this step's run"),
        ("reference.bias_mps=", "reference.bias_mp=", 10, "bias_mp"),
        ('tabs = ["Errors"]', 'tabs = ["Error"]', 10, "must be one of Frequency"),
        ('speed = "m/s"', 'speed = "mph"', 10, "mph"),
        ("method = 1\n", "method = 7\n", 10, "must be >= 0 and < 3"),
        ("method.1.network.xi", "method.1.network.zeta", 10, "must be a field with a slider"),
        ("method = 1\n", "method 1\n", 18, "is not valid TOML"),
        ("mean > 0.1", "mean > 99.0", 10, "must have one right choice"),
        ("```toml question", "```toml action", 22, "must stand once in a step"),
    ],
)
def test_what_is_wrong_is_told_with_its_line(
    folder: Path, capsys: pytest.CaptureFixture[str], old: str, new: str, line: int, words: str
) -> None:
    text = example()
    assert old in text
    (folder / "mine.md").write_text(text.replace(old, new, 1))
    assert main(["serve", "--lessons", str(folder), "--port", "0"]) == 2
    told = capsys.readouterr().err
    assert f"mine.md, line {line}" in told and words in told
    assert OWN not in os.environ


def test_a_folder_without_lessons_and_other_files_are_refused(folder: Path) -> None:
    with pytest.raises(InputError, match="holds no lesson"):
        use_lessons(folder)
    with pytest.raises(InputError, match="must be a folder"):
        use_lessons(folder / "none")
    (folder / "latin.md").write_bytes(b'+++\ntitle = "\xe9"\n+++\n')
    with pytest.raises(InputError, match=r"latin.md.*is not UTF-8"):
        use_lessons(folder)
