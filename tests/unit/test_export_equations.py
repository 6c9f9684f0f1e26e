"""Equations with the numbers in force: what is copied is what runs; and the archive that the page offers."""

import io
import tomllib
import zipfile
from html import escape
from pathlib import Path

import pytest

from navcore.analysis import analyse
from navcore.engine.drivers.common import network_of
from navcore.exporting.equations import as_latex, as_text, equations_of
from navcore.exporting.exported import Exported, Packed, exported
from navcore.networks.pasted import pasted
from navcore.questions.export import ExportQuestion
from navcore.scenario.file import load
from navcore.scenario.model import Scenario
from schuler_bench.views.method.taking import COPY_LATEX, COPY_TEXT, equations_html


def scenario_with(network: str, **more: object) -> Scenario:
    return Scenario.parse(
        {
            "reference": {"kind": "log"},
            "imu": {"gyro_bias_std_dph": 0.01, "accel_bias_std_ug": 20.0, "gyro_arw_dpsh": 0.003},
            "method": [{"damping": "external", "network": {"id": network}, **more}],
        }
    )


@pytest.mark.parametrize(
    "network", ["classic2", "classic3", "compass", "complementary", "pole2", "unity2", "optimal"]
)
def test_the_copied_network_reads_back_to_the_last_digit(network: str) -> None:
    """In LaTeX and as text; and the roots of the copied loop are the poles of the loop."""
    scenario = scenario_with(network)
    (method,) = scenario.method
    found = equations_of(scenario, method)
    ran = network_of(scenario, method)
    for written in (found[0].latex, found[0].text):
        read = pasted(written)
        assert read["num"] == ran.num.tolist() and read["den"] == ran.den.tolist()
    loop = next(one for one in found if one.latex.endswith(" = 0"))
    acting = method.kind.acting(ran)
    for s in analyse(acting).poles:
        terms = [abs(term) for term in terms_at(loop.text, s)]
        assert abs(sum(terms_at(loop.text, s))) < 1e-4 * max(terms)
        assert max(terms) > 0.0


def terms_at(text: str, s: complex) -> list[complex]:
    """Terms of a polynomial that is written as text, at s."""
    found = []
    for term in text.removesuffix(" = 0").replace(" - ", " + -").split(" + "):
        factor, _, power = term.partition("s")
        degree = 0 if "s" not in term else int(power.removeprefix("^") or 1)
        sign = -1.0 if factor.startswith("-") else 1.0
        found.append(sign * float(factor.strip().removeprefix("-") or 1.0) * s**degree)
    return found


def test_velocity_feedback_and_the_azimuth_channel_are_written_with_their_gains() -> None:
    scenario = scenario_with("compass", gyrocompass={"sigma": 0.002})
    (method,) = scenario.method
    k1, k2, k3 = method.network.feedback_gains(network_of(scenario, method).omega_s) or (0.0,) * 3
    text = as_text(equations_of(scenario, method))
    assert f"V* = V_c + {k2!r} dv + {k3!r} integral(dv dt), dv = V_c - V_r" in text
    assert f"a = -{k1!r} dv" in text and "d/dt c_U = -0.004 c_U + " in text
    whole = scenario_with("classic2", azimuth={"id": "unity2"})
    azimuth = whole.method[0].azimuth.at_earth_rate()
    (written,) = [one for one in equations_of(whole, whole.method[0]) if one.text.startswith("Y(s)")]
    assert all(repr(float(value)) in written.text for value in azimuth.den[1:])
    assert "c_U = [1 - Y(s)] (omega_Ur - omega_U)\n" in as_text(equations_of(whole, whole.method[0]))
    inner = Scenario.parse({"method": [{"damping": "internal", "network": {"id": "unity2"}}]})
    assert "V* = H(s) V_c\n" in as_text(equations_of(inner, inner.method[0]))


def test_a_gain_below_zero_has_one_sign() -> None:
    network = {"id": "compass", "k1": 0.01, "k2": -0.5, "k3": 0.002}
    scenario = Scenario.parse(
        {"reference": {"kind": "log"}, "method": [{"damping": "external", "network": network}]}
    )
    text = as_text(equations_of(scenario, scenario.method[0]))
    assert "V* = V_c - 0.5 dv + 0.002 integral" in text


def test_the_page_shows_them_as_mathematics_and_copies_them() -> None:
    scenario = load("zha-external")
    assert equations_of(scenario, scenario.method[0]) == ()
    found = equations_of(scenario, scenario.method[2], 6)
    html = equations_html(found)
    assert html.count("<math") == len(found) and "203.789" in html
    assert COPY_LATEX in html and COPY_TEXT in html
    latex = as_latex(found)
    assert latex.startswith("\\begin{gather*}\n") and latex.count("\\\\\n") == len(found) - 1


def test_the_table_holds_them(tmp_path: Path) -> None:
    """In its TOML, from which the network is read back, and on its page to print."""
    scenario = load("zha-external")
    files = exported(scenario, "fast (compass)", target="table", rate_hz=1.0).files
    table = tomllib.loads(str(files["schuler_law.toml"]))
    found = equations_of(scenario, scenario.method[2])
    assert [(one["latex"], one["text"]) for one in table["equations"].values()] == [one[1:] for one in found]
    assert escape(found[0].text) in str(files["schuler_law.html"])
    (tmp_path / "law.toml").write_text(str(files["schuler_law.toml"]))
    assert pasted(str(tmp_path / "law.toml"))["den"] == table["network"]["den"]


def test_the_archive_holds_the_files_of_the_command() -> None:
    """The same bytes at each time; what the page alone asks for is no option."""
    assert "as_archive" not in {one.name for one in ExportQuestion.options()}
    given = {"scenario": load("zha-external"), "method": "classic2", "as_": "table", "rate": 0.2}
    found = ExportQuestion.ask(given).answer()
    packed = ExportQuestion.ask({**given, "as_archive": True}).answer()
    assert isinstance(found, Exported) and isinstance(packed, Packed)
    with zipfile.ZipFile(io.BytesIO(packed.archive)) as archive:
        held = {name: archive.read(name) for name in archive.namelist()}
    assert held == {name: text.encode() for name, text in found.files.items() if isinstance(text, str)}
    assert packed.name == "schuler_law.zip" and packed.document() == found.document()
    assert packed.html() == found.html() and found.packed().archive == packed.archive
