"""The door "My ship, my limits": a sensor, a log and limits make a scenario that can be searched."""

import json

import pytest

from navcore.foundation.errors import InputError
from navcore.scenario.file import load
from navcore.sensors.data_sheets import data_sheets
from schuler_bench.views.start.ship import LIMITS, form_html, scenario_for

PRESENT = load("sikuliaq-like")


def test_what_is_entered_is_in_the_scenario() -> None:
    entered = {
        "imu": "Honeywell HG9900",
        "reference": "Teledyne RDI Explorer 1200",
        "tilt_max_arcsec": "0,5 arcmin",
    }
    made = scenario_for(json.dumps(entered), PRESENT)
    assert (made.imu.part, made.reference.part, made.reference.kind) == (
        entered["imu"], entered["reference"], "log",
    )  # fmt: skip
    assert [(one.quantity, one.words) for one in made.requirement]
    assert made.requirement[0].limit_si == pytest.approx(30.0 * 4.84813681109536e-06)
    assert len(made.method) == 3


def test_what_is_left_stays_as_it_is_on_the_page() -> None:
    made = scenario_for('{"imu": "", "velocity_max_mps": "0.3"}', PRESENT)
    assert made.imu == PRESENT.imu and made.reference == PRESENT.reference


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("{}", "needs at least one limit"),
        ("not json", "needs at least one limit"),
        ('{"imu": "no such", "tilt_max_arcsec": "1"}', "imu.part"),
        ('{"tilt_max_arcsec": "soon"}', "soon"),
        ('{"tilt_max_arcsec": "-3"}', "-3"),
    ],
)
def test_what_cannot_be_read_is_refused_by_name(text: str, told: str) -> None:
    with pytest.raises(InputError, match=told):
        scenario_for(text, PRESENT)


def test_the_form_offers_every_part_and_each_limit() -> None:
    html = form_html()
    assert html.count('<option value="">') == 2, "what is left has no name"
    assert all(f"{sheet.name} (" in html for sheet in data_sheets().values())
    assert all(f'name="{key}"' in html for key in LIMITS)
