"""The table of numbers at every door: boxes, ``--set``, limits, ranges, TOML, maps."""

import re
from collections.abc import Callable
from typing import Any

import pytest

from navcore import InputError, Scenario, load, parse_network
from navcore.design.measures import read_requirement
from navcore.design.vary import read_varied
from navcore.foundation.numbers import NotANumber, read_number
from navcore.foundation.with_unit import read_with_unit
from navcore.foundation.written_toml import read_value
from navcore.io.column_map import parse_map
from navcore.scenario.file import parse_toml
from schuler_bench.editing import typed
from schuler_bench.editing.limits import limit_text, with_limit
from tests.number_texts import MEANT, NARROW, REFUSED, WITH_UNIT, same

MEANT_IDS, REFUSED_IDS = [ascii(text) for text in MEANT], [ascii(text)[:20] for text in REFUSED]


# ---------------------------------------------------------------- boxes


@pytest.mark.parametrize("unit", ["", "h", "°/h", "kn"])
@pytest.mark.parametrize(("text", "meant"), MEANT.items(), ids=MEANT_IDS)
def test_a_box_takes_the_number_that_is_meant(text: str, meant: float, unit: str) -> None:
    assert same(read_with_unit(text, unit), meant)


@pytest.mark.parametrize("unit", ["", "h", "°/h", "kn"])
@pytest.mark.parametrize("text", REFUSED, ids=REFUSED_IDS)
def test_a_box_refuses_everything_else_with_the_text(text: str, unit: str) -> None:
    with pytest.raises(NotANumber) as caught:
        read_with_unit(text, unit)
    assert caught.value.text == text


@pytest.mark.parametrize(("text", "unit", "meant"), [(text, *more) for text, more in WITH_UNIT.items()])
def test_a_box_takes_a_unit(text: str, unit: str, meant: float) -> None:
    assert same(read_with_unit(text, unit), meant)


@pytest.mark.parametrize(
    ("read", "text", "values"),
    [
        (typed.read_numbers, "1 −0.018 8e-5", [1.0, -0.018, 8e-5]),
        (typed.read_numbers, "1; 0,5; 2·10^-3", [1.0, 0.5, 2e-3]),
        (typed.read_numbers, "1,2,3", [1.0, 2.0, 3.0]),
        (typed.read_numbers, f"1{NARROW}234 5", [1234.0, 5.0]),
        (typed.read_roots, "−0.1 + 0.2j, −0.1 − 0.2j", [[-0.1, 0.2], [-0.1, -0.2]]),
        (typed.read_roots, "−0,1+0,2j; 3", [[-0.1, 0.2], 3.0]),
        (typed.read_roots, "[−1, 2], [1e-3; 2]", [[-1.0, 2.0], [1e-3, 2.0]]),
        (typed.read_roots, "1·10^-3-2j", [[1e-3, -2.0]]),
        (typed.read_pairs, "0: 0,99; 0,5: 0,12", [[0.0, 0.99], [0.5, 0.12]]),
        (typed.read_pairs, "“0: −0.02”", [[0.0, -0.02]]),
    ],
)
def test_lists_are_read_by_the_same_reader(read: Callable[[str], Any], text: str, values: list[Any]) -> None:
    assert read(text) == values


@pytest.mark.parametrize(
    ("read", "text", "quoted"),
    [
        (typed.read_numbers, "1 0,5", "0,5"),
        (typed.read_numbers, "1,234", "1,234"),
        (typed.read_numbers, "1, 2x", "2x"),
        (typed.read_roots, "1,234,567", "1,234,567"),
        (typed.read_roots, "0.1, [1, 2, 3]", "[1, 2, 3]"),
        (typed.read_roots, "--5j", "--5j"),
        (typed.read_roots, "infj", "infj"),
        (typed.read_pairs, "0: 1: 2", "0: 1: 2"),
        (typed.read_pairs, "0: 1e999", "0: 1e999"),
    ],
)
def test_what_a_list_cannot_hold_is_refused_with_its_text(
    read: Callable[[str], Any], text: str, quoted: str
) -> None:
    with pytest.raises(NotANumber) as caught:
        read(text)
    assert caught.value.text == quoted


@pytest.mark.parametrize("value", [0.003, -0.02, 1e-5, 2e-9, 1e22, 0.1 + 0.2, 1.0 / 3.0, 123456.789, 7, 0.0])
def test_what_a_box_shows_is_read_back_as_the_value(value: float) -> None:
    assert read_number(typed.write_number(value)) == pytest.approx(value, rel=1e-12)


# ---------------------------------------------------------------- limits, ranges, requirements


@pytest.mark.parametrize(
    ("text", "shown"), [("12,5", "12.5"), ("2·10^2", "200"), ("“30”", "30"), ("1 km", "1 km")]
)
def test_a_limit_is_read_by_the_same_reader(text: str, shown: str) -> None:
    changed = with_limit(load("zha-fast"), "position_max_m", text)
    assert limit_text(changed, "position_max_m") == shown


@pytest.mark.parametrize("text", ["12abc", "1,234", "--5", "1e", "inf", "5 kn"])
def test_a_limit_that_is_no_number_is_refused_with_the_text(text: str) -> None:
    with pytest.raises(InputError) as caught:
        with_limit(load("zha-fast"), "position_max_m", text)
    assert repr(text) in str(caught.value) and "leave it empty" in str(caught.value)


def test_requirements_and_ranges_are_read_by_the_same_reader() -> None:
    comma, point = (read_requirement(f"tilt_rms<={text}arcsec") for text in ("0,5", "0.5"))
    assert comma.limit == point.limit
    (varied,) = read_varied(load("zha-fast"), ["method.2.network.xi=0,3:1·10^0"])
    assert (varied.low, varied.high) == (0.3, 1.0)


@pytest.mark.parametrize("text", ["12abc", "1,234", "--5", "1e"])
def test_requirements_and_ranges_refuse_with_the_text(text: str) -> None:
    with pytest.raises(InputError, match=re.escape(text)):
        read_requirement(f"tilt_rms<={text}")
    with pytest.raises(InputError, match=re.escape(text)):
        read_varied(load("zha-fast"), [f"method.2.network.xi=0.3:{text}"])


# ---------------------------------------------------------------- the command line


@pytest.mark.parametrize(("text", "meant"), MEANT.items(), ids=MEANT_IDS)
def test_set_takes_the_number_that_is_meant(text: str, meant: float) -> None:
    value = read_value(text.strip())
    assert value == "0.02" if text == '"0.02"' else same(value, meant)  # TOML's own text stays one


@pytest.mark.parametrize("text", sorted(REFUSED.keys() - {"0x10", "true", "9" * 2000}))
def test_set_refuses_everything_else_with_the_text(text: str) -> None:
    with pytest.raises(InputError) as caught:
        load("zha-fast", [f"run.duration_h={text}"])
    given = text.strip() if text in ("inf", "nan") else repr(text.strip())
    assert re.search(rf"run.duration_h = {re.escape(given)}: (must be|may mean)", str(caught.value))


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("[0.01, −0.02, 0]", [0.01, -0.02, 0]),
        ("“compass”", "compass"),
        ("‘compass’", "compass"),
        ("compass", "compass"),
        ('"5"', "5"),
        ("{ id = “compass”, xi = −1 }", {"id": "compass", "xi": -1}),
        ("true", True),
        ("0x10", 16),
    ],
)
def test_set_reads_what_a_word_processor_makes_of_toml(text: str, value: Any) -> None:
    assert read_value(text) == value


def test_a_network_on_the_command_line_is_read_with_typographic_signs() -> None:
    assert parse_network("id = “compass”, sigma = 0.008, xi = 0.7") == parse_network(
        'id = "compass", sigma = 0.008, xi = 0.7'
    )


# ---------------------------------------------------------------- TOML


@pytest.mark.parametrize(
    ("line", "wanted"),
    [
        ("a = [0.01, −0.02, 0.0]", "must be written [0.01, -0.02, 0.0]: − (U+2212, minus sign)"),
        ("a = −45  # − west", "a = '−45': must be written -45: − (U+2212"),
        ("a = “internal”", 'must be written "internal": “ (U+201C, left double quotation mark)'),
        ("a = “Ship − 1”", 'must be written "Ship − 1": “'),
        ('a = "Ship”', 'must be written "Ship": ”'),
        ("a = ‘b’", "must be written 'b': ‘ (U+2018"),
        ("a\u00a0= 0.1", "must be written 0.1: \u00a0 (U+00A0, no-break space)"),
        ("a = 1·10^-3", "a = '1·10^-3': must be written 1e-3 (line 2)"),
        ("a = 1×10⁻³", "must be written 1e-3 (line 2)"),
        ("a = .5", "must be written 0.5 (line 2)"),
        ("a = 5.", "must be written 5.0 (line 2)"),
        ("a = 1\u202f234,5", "must be written 1234.5: \u202f (U+202F"),
        ("a = 1.234,5", "must be written 1234.5 (line 2)"),
        ("a = 1,234", "a = '1,234': may mean 1.234 or 1234: write one of these (line 2)"),
        ("a = 0,02", "a = '0,02': must be a number with a decimal point, 0.02, not"),
        ("a = [1\u202f234,5, 2]", ": \u202f (U+202F, narrow no-break space) is no sign of TOML (line 2)"),
        ("a = [\n1,\n−2,\n]", "must be written -2,: − (U+2212, minus sign) is no sign of TOML (line 4)"),
        ("a = { b = “c”, d = −0.7 }", 'must be written { b = "c", d = -0.7 }: “'),
        ("a = 1e-999", "a = '1e-999': must be a number that is not too small"),
        ("a = 1e999", "a = '1e999': must be a finite number (line 2)"),
    ],
)
@pytest.mark.parametrize("read", [parse_toml, parse_map], ids=["scenario and study", "map"])
def test_toml_names_field_text_remedy_and_line(
    read: Callable[[str, str], Any], line: str, wanted: str
) -> None:
    with pytest.raises(InputError) as caught:
        read(f"# of a mail\n{line}\n", "x.toml")
    assert wanted in str(caught.value)


@pytest.mark.parametrize("line", ["a = 12abc", "a = (5)", "a = 30 min", "a = --5", "x y"])
def test_what_is_no_number_stays_a_fault_of_toml(line: str) -> None:
    with pytest.raises(InputError, match="is not valid TOML"):
        parse_toml(line, "x.toml")


@pytest.mark.parametrize(
    ("value", "said"),
    [
        ("−0.02", "'−0.02': must be a number (write -0.02 without quotation marks)"),
        ("1e-3", "must be a number (write 1e-3 without quotation marks)"),
        ("0,02", "must be a number with a decimal point, 0.02, not with a decimal comma"),
        ("1,234", "may mean 1.234 or 1234: write one of these"),
        ("inf", "must be a finite number"),
        ("12abc", "'12abc': must be a number, > 0"),
    ],
)
def test_a_text_for_a_number_is_refused_with_what_to_write(value: str, said: str) -> None:
    with pytest.raises(InputError) as caught:
        Scenario.parse(parse_toml(f'[run]\nduration_h = "{value}"', "x.toml"), "x.toml")
    assert said in str(caught.value) and "run.duration_h" in str(caught.value)
