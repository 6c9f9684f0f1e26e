"""Scenarios as people write them: a byte order mark, decimal commas, names alone, either unit, short legs."""

import json
from pathlib import Path
from typing import Any

import pytest

from navcore import InputError, Scenario, load, parse_network, simulate
from navcore.law.policy.adaptive import Adaptive
from navcore.motion.swing import SwingMotion
from navcore.scenario.file import parse_toml
from navcore.scenario.schema_file import schema_text
from schuler_bench.cli import main
from schuler_bench.editing.pasting import paste
from schuler_bench.session.uploads import Uploads, opened_scenario

HEAD = "schema = 1\n[run]\nduration_h = 0.02\n"


def refused(text: str) -> str:
    with pytest.raises(InputError) as caught:
        Scenario.parse(parse_toml(text, "x.toml"), "x.toml")
    return str(caught.value)


def test_a_byte_order_mark_is_no_part_of_a_scenario(tmp_path: Path) -> None:
    path = tmp_path / "bom.toml"
    path.write_text(HEAD, "utf-8-sig")
    assert load(str(path)) == Scenario.parse(parse_toml(HEAD, "x"))
    assert opened_scenario("bom.toml", path.read_bytes(), Uploads(tmp_path)) == load(str(path))


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("[run]\nduration_h = 1,5\n", "duration_h = '1,5': {} (line 2)"),
        ("[run]\nduration_h = 1,5", "duration_h = '1,5': {} (line 2)"),
        ("[imu]\ngyro_bias_dph = [1,5, 0,05, 0]\n", "gyro_bias_dph = '0,05': {} (line 2)"),
        ('[[method]]\nnetwork = { id = "unity2", zeta = 0,7 }\n', "zeta = '0,7': {} (line 2)"),
        ('[run]\nduration_h = "1,5"\n', "run.duration_h = '1,5': {}, > 0 and <= 8760 (h)"),
    ],
)
def test_a_decimal_comma_is_named(text: str, line: str) -> None:
    number = line.split("'")[1].replace(",", ".")
    wanted = f"must be a number with a decimal point, {number}, not with a decimal comma"
    assert refused(text).removeprefix("x.toml: ") == line.format(wanted)


def test_a_decimal_comma_between_fields_on_the_command_line_is_named(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(["network", 'id = "unity2", zeta = 0,7']) == 2
    assert "0.7, not with a decimal comma" in capsys.readouterr().err


NOT_OF_COMMAS = ("[run]\nduration_h = 2 x\n", 'title = "a = 1,5"\nx y\n', "x = [1,2 y # a = 1,5\n")
THREE = "must be a list of 3 numbers (x, y, z), each"
PAIR = "2 numbers (difference_kn, xi)"


@pytest.mark.parametrize("text", NOT_OF_COMMAS)
def test_another_fault_is_no_decimal_comma(text: str) -> None:
    assert "is not valid TOML" in refused(text) and "comma" not in refused(text)


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        (
            "imu.gyro_bias_dph = 0.1",
            f"{THREE} >= -100000 and <= 100000 (°/h)",
        ),
        ("imu.gyro_bias_dph = [0.1]", THREE),
        ("imu.gyro_bias_dph = [1, 2, 3, 4]", THREE),
        ("reference.outage.t_h = 1", "must be a list of blocks, [[reference.outage]]"),
        ("method = 3", "must be a list of blocks, [[method]]"),
        ("[[method]]\nevent = 3", "must be a list of blocks, [[method.event]]"),
        ("motion = { kind = 'track', file = 3 }", "must be text, or must be a list of texts"),
        ("[[method]]\nnetwork = { id = 'custom', poles = 3 }", "must be a list of numbers"),
        (
            "[[method]]\npolicy = { id = 'adaptive', table = 3 }",
            f"must be a list of lists of {PAIR}",
        ),
        (
            "[[method]]\npolicy = { id = 'adaptive', table = [[1], [2, 3]] }",
            f"must be a list of {PAIR}",
        ),
    ],
)
def test_a_list_is_asked_for_by_what_it_holds(text: str, wanted: str) -> None:
    (line,) = refused(text).splitlines()
    assert f": {wanted}" in line


def method(**blocks: Any) -> dict[str, Any]:
    return {"reference": {"kind": "log"}, "method": [{"damping": "external", **blocks}]}


@pytest.mark.parametrize(
    ("block", "name", "field"),
    [("network", "classic2", "id"), ("policy", "threshold", "id"), ("switching", "ramp", "id")],
)
def test_a_name_alone_is_its_block(block: str, name: str, field: str) -> None:
    base = {"network": {"id": "unity2"}}
    named, whole = (Scenario.parse(method(**base | {block: value})) for value in (name, {field: name}))
    assert named == whole and named.canonical()["method"][0][block][field] == name


def test_a_name_alone_means_the_same_everywhere(tmp_path: Path) -> None:
    path = tmp_path / "names.toml"
    text = f'motion = "swing"\n{HEAD}[reference]\nkind = "log"\n[[method]]\ndamping = "external"\n'
    path.write_text(text + 'network = "unity2"\npolicy = { id = "adaptive", network = "unity2" }\n', "utf-8")
    changes = ["method.0.network.zeta=0.6", "method.0.policy.network.zeta=0.6", "motion.roll_deg=2"]
    scenario = load(str(path), changes)
    (damped,) = scenario.method
    wanted = parse_network('id = "unity2", zeta = 0.6')
    assert damped.network == wanted and damped.policy == Adaptive(network=wanted)
    assert scenario.motion == SwingMotion(roll_deg=2.0)
    (other,) = load(str(path), ["method.0.policy=constant", "method.0.network=classic2"]).method
    assert (other.policy.id, other.network.id) == ("constant", "classic2")
    assert parse_network("unity2") == parse_network('id = "unity2"')
    (_, pasted) = paste(Scenario(), 0, '[[method]]\nnetwork = "unity2"\n').scenario.method
    assert (pasted.name, pasted.network.id) == ("unity2", "unity2")
    models = json.loads(schema_text())["$defs"]
    offered = [models[name]["properties"]["network"]["anyOf"][0]["enum"] for name in ("Method", "Adaptive")]
    assert "classic2" in offered[0] and offered[1] == ["unity2", "pole2"]


def test_a_wrong_name_is_refused_with_those_there_are() -> None:
    assert "network = 'clasic2': must be one of none, classic2," in refused("[[method]]\nnetwork = 'clasic2'")
    assert refused("[[method]]\nnetwork = 3").endswith("must be a name or a table of fields")


BOTH_UNITS = (
    ("run", {"duration_h": 0.5}, {"duration_s": 1800}),
    ("reference", {"kind": "log", "event": [{"t_h": 2, "duration_s": 1800.0}]},
     {"kind": "log", "event": [{"t_s": 7200, "duration_h": 0.5}]}),
    ("reference", {"outage": [{"t_h": 2, "duration_s": 7200.0}]},
     {"outage": [{"t_s": 7200, "duration_h": 2}]}),
    ("motion", {"kind": "legs", "leg": [{"duration_s": 7200.0}]},
     {"kind": "legs", "leg": [{"duration_h": 2}]}),
    ("motion", {"kind": "profile", "point": [{"t_s": 0}, {"t_s": 3600.0}]},
     {"kind": "profile", "point": [{"t_h": 0}, {"t_h": 1}]}),
    ("alignment", {"duration_s": 7200.0}, {"duration_h": 2}),
)  # fmt: skip


@pytest.mark.parametrize(("block", "own", "other"), BOTH_UNITS)
def test_a_time_is_given_in_either_unit(block: str, own: Any, other: Any) -> None:
    scenario = Scenario.parse({block: other})
    assert scenario == Scenario.parse({block: own})
    assert scenario == Scenario.parse(scenario.canonical())


def test_a_time_in_both_units_or_wrong_is_refused() -> None:
    twice = refused("[[reference.event]]\nt_s = 1\nduration_s = 5\nduration_h = 1")
    assert twice == "x.toml: reference.event.0.duration_h = 1: give duration_s or duration_h, not both"
    assert "duration_s = 36000000000.0: must be > 0 and <= 1e+07 (s)" in refused(
        "[[reference.event]]\nduration_h = 1e7"
    )
    assert "must be a number" in refused("[[reference.event]]\nt_s = 'noon'")
    assert load("zha-fast", ["run.duration_s=1800"]).run.duration_h == 0.5
    assert "duration_h" in json.loads(schema_text())["$defs"]["LogEvent"]["properties"]


def test_legs_that_end_before_the_run_are_told() -> None:
    legs = [{"duration_s": 36, "speed_mps": 5}, {"duration_s": 36, "heading_deg": -10}]
    data = {"run": {"duration_h": 0.05}, "motion": {"kind": "legs", "leg": legs}}
    told = (
        "motion.leg.1 is the last and ends after 0.02 h: for the other 0.03 h of the run the vehicle keeps "
        "5 m/s and heading 350°"
    )
    assert simulate(Scenario.parse(data)).warnings == (told,)
    data["run"] = {"duration_h": 0.05, "fidelity": "strapdown"}
    assert simulate(Scenario.parse(data)).warnings == (told,)
    data["run"] = {"duration_h": 0.02}
    assert simulate(Scenario.parse(data)).warnings == ()
