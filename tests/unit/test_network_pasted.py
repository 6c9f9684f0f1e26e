"""Networks from text: what other programs and papers write is a custom network, or refused with a remedy."""

import json
from pathlib import Path

import numpy as np
import pytest
import tomlkit

from navcore.exporting.target_matlab import network_lines
from navcore.exporting.target_table import network_table
from navcore.foundation.errors import InputError
from navcore.networks import parse_network
from navcore.networks.pasted import pasted
from navcore.scenario.model import Scenario
from schuler_bench.cli import main

NUM, DEN = [203.5, 0.9045], [1.0, 0.0264]
CLASSIC = [1.0, 0.09497, 8.0002e-05]
SAME = [
    "tf([203.5, 0.9045], [1, 0.0264])",
    "H = tf([203.5 0.9045],[1 2.64e-2]);",
    "H(s) = (203.5 s + 0.9045)/(s + 0.0264)",
    r"H(s) = \frac{203.5 s + 0.9045}{s + 2.64 \times 10^{-2}}",
    r"\dfrac{203.5\,s+0.9045}{s+2.64\cdot10^{-2}}",
]


@pytest.mark.parametrize("text", SAME)
def test_every_writing_is_the_same_network(text: str) -> None:
    network = parse_network(text).transfer(1.24e-3)
    assert network.id == "custom"
    assert network.num.tolist() == NUM
    assert network.den.tolist() == DEN


@pytest.mark.parametrize(
    "text",
    [
        "zpk([-8.5e-4, -9.412e-2], [-8e-3 -1e-2], 1)",
        r"\frac{\left(s+8.5\times10^{-4}\right)\left(s+9.412\times 10^{-2}\right)}{(s+8.0e-3)(s+.01)}",
        "(s + 8.5e-4)*(s + 9.412e-2)/((s + 8e-3)*(s + 1e-2))",
    ],
)
def test_products_and_roots_are_multiplied_out(text: str) -> None:
    found = pasted(text)
    np.testing.assert_allclose(found["num"], CLASSIC, rtol=1e-12)
    np.testing.assert_allclose(found["den"], [1.0, 0.018, 8e-5], rtol=1e-12)


def test_complex_roots_come_with_their_conjugates() -> None:
    found = pasted("zpk([-8.5e-4, -0.094], [-9e-3+1e-3i, -9e-3-1e-3i], 1)")
    np.testing.assert_allclose(found["den"], [1.0, 0.018, 8.2e-5], rtol=1e-12)
    with pytest.raises(InputError, match="without their conjugates"):
        pasted("zpk([], [-1e-3+2e-3i], 1e-3)")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("tf([1, 2, 3], [1, 0.01])", "is improper: 2 zeros and 1 poles"),
        ("tf([1, 0.0264], [1, -0.01])", "is unstable: a pole at 0.01 rad/s lies in the right half plane"),
        ("tf([-202.5, -0.878], [1, 0.0264])", "H must be the network itself, not 1 - H"),
        ("(s+0.685)(s+75.9)/((s+6.45)(s+8.06))", "its s is in other units: put s/0.00124 in"),
        ("tf([203.5, 0.9045], [1, 0.0264], 1)", "is in discrete time (sample time 1): give the continuous"),
        ("tf([203.5, x], [1, 0.0264])", '"203.5, x" is no list of numbers'),
        ("(s + 1e-3)/(s + 1e-2", "is not expected there"),
        (r"\frac{s+1}{z}", 'cannot be read from "z}"'),
        ("nowhere.m", "cannot be read"),
    ],
)
def test_what_is_no_network_is_refused_with_a_remedy(text: str, said: str) -> None:
    with pytest.raises(InputError) as error:
        parse_network(text)
    assert said in str(error.value)


@pytest.mark.parametrize("id", ["unity2", "compass", "complementary", "classic3"])
def test_out_and_back_in_it_is_the_same_to_the_last_digit(tmp_path: Path, id: str) -> None:
    """A table and a MATLAB file with the lines that an export writes."""
    network = parse_network(id).transfer(1.24e-3)
    (tmp_path / "law.toml").write_text(tomlkit.dumps({"network": network_table(network, 1.0)}))
    (tmp_path / "law_objects.m").write_text(f"function H = law()\n{network_lines(network, 1.0)}\nend\n")
    for name in ("law.toml", "law_objects.m"):
        again = parse_network(str(tmp_path / name)).transfer(1.24e-3)
        np.testing.assert_array_equal(again.num, network.num)
        np.testing.assert_array_equal(again.den, network.den)


def test_a_scenario_and_the_command_take_it(capsys: pytest.CaptureFixture[str]) -> None:
    method = {"damping": "external", "network": SAME[0]}
    scenario = Scenario.parse({"reference": {"kind": "log"}, "method": [method]})
    assert scenario.method[0].network.transfer(scenario.omega_s).num.tolist() == NUM
    assert main(["network", SAME[3], "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["num"] == NUM
    with pytest.raises(InputError, match="is unstable"):
        Scenario.parse({"reference": {"kind": "log"}, "method": [{"network": "tf([1, 1e-3], [1, -1e-3])"}]})
