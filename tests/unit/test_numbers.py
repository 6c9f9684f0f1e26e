"""The one reader of numbers: what it understands, and what it refuses with the text."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from navcore.foundation.numbers import NotANumber, plain_number, read_number, read_whole, unquoted
from tests.number_texts import MEANT, REFUSED, same


@pytest.mark.parametrize(("text", "meant"), MEANT.items(), ids=map(ascii, MEANT))
def test_what_was_meant_is_read(text: str, meant: float) -> None:
    assert same(read_number(text), meant)
    assert float(plain_number(text)) == read_number(text)


@pytest.mark.parametrize(("text", "said"), REFUSED.items(), ids=[ascii(text)[:20] for text in REFUSED])
def test_anything_else_is_refused_with_the_text(text: str, said: str) -> None:
    with pytest.raises(NotANumber) as caught:
        read_number(text)
    assert said in caught.value.allowed and caught.value.text == text
    assert str(caught.value) == f"{text!r} {caught.value.allowed}"


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_every_number_is_read_as_it_is_written(value: float) -> None:
    mantissa, _, power = repr(value).partition("e")
    texts = [
        repr(value),
        repr(value).replace("-", "\u2212"),
        f"{mantissa}·10^{power}" if power else mantissa,
        f"\u201c{value!r}\u201d",
    ]
    assert [read_number(text) for text in texts] == [value] * len(texts)
    comma = repr(value).replace(".", ",")
    try:
        assert read_number(comma) == value
    except NotANumber as error:  # the comma of 1,234 may group the digits
        assert "may mean" in error.allowed
    assert read_number(comma, ",") == value


@given(st.text(max_size=12) | st.text("0123456789.,-+ eE'_^×⁻³−\u202f", max_size=12))
def test_what_is_read_is_a_finite_number_and_what_python_reads_is_not_read_as_another(text: str) -> None:
    try:
        value = read_number(text)
    except NotANumber:
        return
    assert math.isfinite(value)
    try:
        assert float(text) == value
    except ValueError:
        pass


@pytest.mark.parametrize(
    ("text", "decimal", "meant"),
    [
        ("1,234", ",", 1.234), ("1,234", ".", 1234.0), ("1.234", ".", 1.234), ("54.32", ",", 54.32),
        ("1.234,5", ",", 1234.5), ("1,234.5", ".", 1234.5), ("54,32", ".", 54.32),
    ],
)  # fmt: skip
def test_a_decimal_sign_that_is_known_decides(text: str, decimal: str, meant: float) -> None:
    assert read_number(text, decimal) == meant


@pytest.mark.parametrize(("text", "decimal"), [("1.234", ","), ("1,234.5", ","), ("1.234,5", ".")])
def test_what_does_not_go_with_a_known_decimal_sign_is_refused(text: str, decimal: str) -> None:
    with pytest.raises(NotANumber):
        read_number(text, decimal)


def test_whole_numbers_keep_their_last_digit() -> None:
    assert [read_whole(text) for text in ("9007199254740993", "1e3", "−12", "5.0", "1,234,567")] == [
        9007199254740993, 1000, -12, 5, 1234567,
    ]  # fmt: skip
    for text in ("5.5", "1e-3", "1e17", "1,5", "abc"):
        with pytest.raises(NotANumber):
            read_whole(text)


def test_quotation_marks_go_when_they_stand_around_the_whole() -> None:
    around = ('"a"', "'a'", "“a”", "„a“", "«a»", "‘a’", "»a«")
    assert {unquoted(text) for text in around} == {"a"}
    assert [unquoted(text) for text in ('"a', 'a"', '"', "", "5″", "“a„")] == [
        '"a',
        'a"',
        '"',
        "",
        "5″",
        "“a„",
    ]
