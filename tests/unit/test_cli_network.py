"""``schuler network``: the numbers of theory.md 9.1, 9.2 and 3.3 from the command line."""

import json
import math

import numpy as np
import pytest

from app.cli import main

OMEGA_S = math.sqrt(9.80665 / 6378137.0)
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
    "lat_deg",
    "earth_mode_growth_per_s",
    "h_slope_s",
    "whole_system_stable",
    "warnings",
]


def network(text: str, capsys: pytest.CaptureFixture[str]) -> dict:
    assert main(["network", text, "--json"]) == 0
    captured = capsys.readouterr()
    assert captured.err == ""
    return json.loads(captured.out)


@pytest.mark.parametrize(
    ("text", "poles", "damping"),
    [
        ('id = "classic2"', [-0.982 - 1.003j, -0.982 + 1.003j, -2.674, -9.879], 0.699),
        (
            'id = "classic3"',
            [-1.3253, -0.5946 + 1.3823j, -0.5946 - 1.3823j, -7.618 + 1.290j, -7.618 - 1.290j],
            0.395,
        ),
    ],
)
def test_closed_loops_of_9_1(text, poles, damping, capsys):
    report = network(text, capsys)
    assert list(report) == KEYS
    found = np.array([complex(*pole) for pole in report["closed_loop_poles"]]) / OMEGA_S
    for pole in poles:
        assert np.min(np.abs(found - pole)) < 1e-3
    assert report["damping_ratio"] == pytest.approx(damping, abs=1e-3)
    assert report["stable"] is True


def test_compass_of_9_2(capsys):
    report = network('id = "compass", sigma = 0.0088, xi = 0.7', capsys)
    np.testing.assert_allclose(report["num"], [203.520, 0.904534], rtol=2e-6)
    np.testing.assert_allclose(report["den"], [1.0, 0.0264], rtol=1e-12)
    assert report["damping_ratio"] == pytest.approx(0.7, rel=1e-9)
    assert report["h0"] == pytest.approx(0.904534 / 0.0264, rel=1e-5)


def test_pole2_as_printed_is_reported_unstable(capsys):
    report = network('id = "pole2", variant = "as_printed", xi = 0.08', capsys)
    assert report["stable"] is False
    assert report["settling_s"] is None
    assert any("unstable" in warning for warning in report["warnings"])


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
