"""The report of a network, and ``schuler network`` that prints it as JSON and for people."""

import json
import math

import pytest

from navcore.analysis.report import network_report
from navcore.foundation.earth import SPHERE
from navcore.foundation.errors import InputError
from navcore.networks import NETWORKS, parse_network
from schuler_bench.cli import main

KEYS = [
    "id",
    "num",
    "den",
    "zeros",
    "poles",
    "gain",
    "h0",
    "closed_loop_poles",
    "stable",
    "damping_ratio",
    "natural_frequency_rad_s",
    "settling_s",
    "worst_tilt_rad_per_mps",
    "worst_velocity_per_mps",
    "lat_deg",
    "earth_mode_growth_per_s",
    "h_slope_s",
    "whole_system_stable",
    "slow_mode_damping_ratio",
    "slow_mode_natural_frequency_rad_s",
    "growth_per_s",
    "warnings",
]


@pytest.mark.parametrize("name", NETWORKS)
def test_keys_are_the_contract_and_json_holds_them(name: str) -> None:
    report = network_report(parse_network({"id": name}))
    assert [key for key in report if key != "two_channel"] == KEYS
    assert ("two_channel" in report) is (name == "optimal")
    assert json.loads(json.dumps(report, allow_nan=False)) == report
    assert all(len(pair) == 2 for pair in report["zeros"] + report["poles"] + report["closed_loop_poles"])


def test_free_loop() -> None:
    report = network_report(parse_network('id = "none"'))
    omega_s = SPHERE.schuler_frequency(0.0)
    assert report["stable"] is True
    assert report["damping_ratio"] == 0.0
    assert report["settling_s"] is None
    assert report["warnings"] == ["undamped"]
    assert report["natural_frequency_rad_s"] == pytest.approx(omega_s, rel=1e-12)
    assert report["closed_loop_poles"] == [[0.0, pytest.approx(-omega_s)], [0.0, pytest.approx(omega_s)]]


def test_an_infinite_h0_becomes_null() -> None:
    report = network_report(parse_network('id = "custom", zeros = [-1], poles = [0]'))
    assert report["h0"] is None
    json.dumps(report, allow_nan=False)


def test_ends_of_what_can_be_asked() -> None:
    free = parse_network('id = "none"')
    for lat_deg in (-89.0, 89.0):
        assert network_report(free, lat_deg)["lat_deg"] == lat_deg
    for lat_deg in (-89.1, 89.1, float("nan")):
        with pytest.raises(InputError, match=r"must be >= -89 and <= 89 \(deg\)"):
            network_report(free, lat_deg)
    damped = parse_network('id = "classic2"')
    for period_s, step_s in ((1e-3, 1e-3), (1e4, 1.0)):
        network_report(damped, log_period_s=period_s, law_step_s=step_s)
    for period_s, step_s in ((0.9e-3, 1e-3), (1.1e4, 1.0), (1.0, 0.9e-3), (1.0, 1.1e4)):
        with pytest.raises(InputError, match=r"must be >= 0.001 and <= 10000 \(s\)"):
            network_report(damped, log_period_s=period_s, law_step_s=step_s)


# ---------------------------------------------------------------- from the command line


@pytest.mark.parametrize("text", ['id = "classic3"', 'id = "pole2", variant = "as_printed", xi = 0.08'])
def test_the_document_is_the_report_of_the_network(text, capsys):
    assert main(["network", text, "--json"]) == 0
    captured = capsys.readouterr()
    assert captured.err == ""
    assert json.loads(captured.out) == network_report(parse_network(text), 45.0)


def test_pole2_with_complex_poles_is_refused_with_the_reason(capsys):
    assert main(["network", 'id = "pole2", n1 = 10, n2 = 5']) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.count("\n") == 1
    assert "(n₁-n₂)² + 4 - 4(n₁+n₂) >= 0" in captured.err


def test_people_get_units_and_warnings(capsys):
    assert main(["network", 'id = "pole2", variant = "as_printed", xi = 0.08']) == 0
    out = capsys.readouterr().out
    for word in ("rad/s", "/ ωₛ", "closed loop", "NO", "never", "warning: unstable"):
        assert word in out


def test_the_network_without_poles_has_none(capsys):
    assert main(["network", 'id = "none"']) == 0
    assert "none" in capsys.readouterr().out


def test_margins_are_shown_when_asked(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["network", 'id = "complementary"', "--margins", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)["margins"]
    assert found["gain_up"] == pytest.approx(4.370, rel=1e-3)
    assert math.degrees(found["phase_rad"]) == pytest.approx(18.58, rel=1e-3)
    assert found["disk_gain"] == pytest.approx(1.391, rel=1e-3)
    assert main(["network", 'id = "none"', "--margins"]) == 0
    assert "none: the loop is undamped or unstable" in capsys.readouterr().out
