"""``schuler network``: the report of a network from the command line, as JSON and for people."""

import json
import math

import pytest

from app.cli import main
from navcore.analysis.report import network_report
from navcore.networks import parse_network


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
