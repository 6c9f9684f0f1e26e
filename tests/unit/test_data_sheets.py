"""Parts of the list: published figures in a scenario, and what a part does not state."""

import json
from typing import Any

import pytest

from navcore import load
from navcore.engine.notices import input_notices
from navcore.foundation.errors import InputError
from navcore.scenario.model import Scenario
from navcore.sensors.data_sheets import data_sheets, grades
from navcore.sensors.imu import Imu
from navcore.sensors.reference import Reference
from schuler_bench.cli import main
from schuler_bench.editing import form
from schuler_bench.editing.edits import value_at, with_value

STIM300 = "Sensonor STIM300"
PART = ("imu", "part")


def scenario_of(**imu: Any) -> Scenario:
    return Scenario.parse({"schema": 1, "imu": imu})


def test_every_figure_has_words_unit_and_source_and_fits_its_field() -> None:
    for name, sheet in data_sheets().items():
        assert sheet.source and sheet.grade and sheet.figures, name
        block = {"imu": Imu, "reference": Reference}[sheet.block]
        fields = [figure.field for figure in sheet.figures if figure.field]
        assert len(fields) == len({*fields}) and {*fields} <= {*block.model_fields}, name
        for figure in sheet.figures:
            assert figure.words and figure.unit and figure.value > 0.0
        missing = {field: 0.1 for field in sheet.absent()}
        block.model_validate({"part": name, **missing})


def test_published_units_are_those_of_the_fields() -> None:
    vn100, hg1700 = data_sheets()["VectorNav VN-100"].values, data_sheets()["Honeywell HG1700 AG58"].values
    assert vn100["gyro_arw_dpsh"] == pytest.approx(0.21)
    assert vn100["accel_vrw_ugpshz"] == pytest.approx(140.0)
    # 0.065 ft/s in the root of an hour
    assert hg1700["accel_vrw_ugpshz"] == pytest.approx(0.065 * 0.3048 / 60.0 / 9.80665e-6, rel=1e-5)
    assert hg1700["accel_bias_std_ug"] == pytest.approx(1000.0)


def test_a_part_fills_what_is_not_given_beside_it() -> None:
    imu = scenario_of(part=STIM300, gyro_arw_dpsh=0.3).imu
    assert imu.gyro_arw_dpsh == 0.3 and imu.gyro_instability_dph == 0.5
    assert imu.accel_vrw_ugpshz == pytest.approx(101.97, rel=1e-4)
    (notice,) = input_notices(scenario_of(part=STIM300, gyro_arw_dpsh=0.3))
    assert "gyro_arw_dpsh" in notice and STIM300 in notice
    assert input_notices(scenario_of(part=STIM300)) == ()


def test_a_part_that_lacks_a_figure_is_refused_by_name() -> None:
    with pytest.raises(InputError) as error:
        scenario_of(part="Honeywell HG9900")
    (fault,) = error.value.faults
    assert (fault.field, fault.value) == ("imu.part", "Honeywell HG9900")
    assert "accel_vrw_ugpshz" in fault.allowed and "brochure" in fault.allowed
    assert scenario_of(part="Honeywell HG9900", accel_vrw_ugpshz=5.0).imu.gyro_bias_std_dph == 0.0035


def test_an_unknown_part_and_one_of_another_block_are_refused() -> None:
    for name in ("no such part", "Teledyne RDI Explorer 1200"):
        with pytest.raises(InputError) as error:
            scenario_of(part=name)
        assert error.value.faults[0].field == "imu.part" and STIM300 in error.value.faults[0].allowed


def test_a_scenario_without_a_part_says_nothing_of_it() -> None:
    assert "part" not in load("zha-fast").canonical()["imu"]


def test_the_page_chooses_a_part_and_another_and_none() -> None:
    (spec,) = (one for one in form.fields(Imu, ("imu",)) if one.path == PART)
    assert spec.kind == "choice" and spec.choices[0] == "none" and STIM300 in spec.choices
    scenario = with_value(scenario_of(gyro_scale_ppm=[5.0, 0.0, 0.0]), PART, STIM300)
    assert value_at(scenario, PART) == STIM300 and scenario.imu.gyro_instability_dph == 0.5
    changed = with_value(scenario, ("imu", "gyro_arw_dpsh"), 0.4)
    other = with_value(changed, PART, "Honeywell HG4930")
    assert other.imu.gyro_instability_dph == 0.25 and other.imu.gyro_arw_dpsh == 0.04
    assert other.imu.accel_bias_std_ug is None, "what only the other part states is gone"
    none = with_value(other, PART, "none")
    assert value_at(none, PART) == "none" and none.imu.gyro_arw_dpsh == 0.0
    assert none.imu.gyro_scale_ppm == (5.0, 0.0, 0.0)


def test_the_command_lists_parts_and_grades(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["parts", "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert {one["block"] for one in document["parts"]} == {"imu", "reference"}
    named = {one["name"]: one for one in document["parts"]}
    assert named["Honeywell HG9900"]["absent"] == ["accel_vrw_ugpshz"]
    assert [one["name"] for one in document["grades"]] == [one.name for one in grades()]
    assert main(["parts"]) == 0
    shown = capsys.readouterr().out
    assert "not stated: accel_vrw_ugpshz" in shown and "marine FOG: no source found" in shown
