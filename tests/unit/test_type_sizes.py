"""The page has four sizes of type; a size may also be relative, and grow in a presentation."""

import re
from pathlib import Path

import pytest

import schuler_bench
from schuler_bench.plots import style

SIZES = {"12", "13", "15", "18"}
HERE = Path(schuler_bench.__file__).parent
OTHERS = {"plotly-basic.min.js"}
"""What is not ours."""
SIZE = re.compile(r"font(?:-size)?[:=] ?\"?[^;\"{}]*?(?<![\w.-])([0-9.]+)(?:px|\")")
FILES = sorted(
    path for ending in ("css", "js", "py") for path in HERE.rglob(f"*.{ending}") if path.name not in OTHERS
)


@pytest.mark.parametrize("path", [pytest.param(path, id=str(path.relative_to(HERE))) for path in FILES])
def test_a_style_uses_one_of_the_four_sizes(path: Path) -> None:
    sizes = SIZE.findall(path.read_text(encoding="utf-8"))
    assert set(sizes) <= SIZES


def test_the_sizes_are_found() -> None:
    assert SIZE.findall("a { font: 600 14px/1.2 x; font-size: 9px } b { font-size: calc(11px * 2) }") == [
        "14", "9", "11",
    ]  # fmt: skip
    assert str(style.FONT_SIZE) in SIZES
