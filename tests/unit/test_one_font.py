"""The page has one list of fonts, in one place: no style names another."""

import re

import pytest

from tests.unit.test_type_sizes import FILES, HERE

ALLOWED = {"var(--sb-font)", "var(--sb-font,sans-serif)", "monospace"}
"""`sans-serif` alone where a script draws before the page has its style."""
FAMILY = re.compile(r"font-family: ?([^;}\n!]+)|font: ?(?:\w+ )*[\d.]+p[xt](?:/[0-9.a-z]+)? ([^;}`\n!]+)")
NAMED = re.compile(r"Segoe UI|Roboto|Helvetica|system-ui|Georgia|Menlo|Consolas|Noto Sans")
STYLES = [*(path for path in FILES if path.suffix != ".py"), *sorted(HERE.rglob("*.html"))]
LIST = HERE / "plots" / "style.py"


def families(text: str) -> set[str]:
    return {(one or other).strip().rstrip('"').strip() for one, other in FAMILY.findall(text)}


@pytest.mark.parametrize("path", [pytest.param(path, id=str(path.relative_to(HERE))) for path in STYLES])
def test_a_style_has_the_font_of_the_page(path: str) -> None:
    with open(path, encoding="utf-8") as file:
        assert families(file.read()) <= ALLOWED


def test_families_are_found() -> None:
    text = 'a { font: 600 13px/1.4 Arial, serif } b { font-family: Georgia !important } "font:12px system-ui"'
    assert families(text) == {"Arial, serif", "Georgia", "system-ui"}


def test_fonts_are_named_in_one_place() -> None:
    assert [path for path in FILES if NAMED.search(path.read_text(encoding="utf-8"))] == [LIST]
