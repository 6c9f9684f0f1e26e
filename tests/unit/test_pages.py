"""Pages people read: links lead somewhere, the map names every room, the example of CONTRIBUTING works."""

import re
from dataclasses import fields
from pathlib import Path
from typing import Any

import pytest

from docs.site.api import rooms
from docs.site.stage import _settled, for_myst
from navcore.analysis import analyse
from navcore.engine.simulation import simulate
from navcore.foundation.earth import SPHERE
from navcore.questions import QUESTIONS
from navcore.scenario.model import Scenario
from schuler_bench.cli import main
from schuler_bench.cli.parse import _COMMANDS
from schuler_bench.session.display import Display
from schuler_bench.session.shown import Shown
from schuler_bench.shell.view import PictureView
from tests import theory

ROOT = Path(__file__).resolve().parents[2]
PAGES = sorted([ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "CHANGELOG.md", *ROOT.glob("docs/*.md")])
_LINK = re.compile(r"\]\(([^)#\s]*)(?:#([^)\s]+))?\)")
_CODE = re.compile(r"```.*?```|`[^`\n]*`", re.DOTALL)


def slug(heading: str) -> str:
    """Anchor that GitHub gives a heading."""
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


def targets(page: Path) -> set[str]:
    """Anchors of a page: explicit ones, and those of its headings."""
    text = page.read_text("utf-8")
    return {*theory.anchors(text), *(slug(h) for h in re.findall(r"^#+ (.+)$", text, re.MULTILINE))}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page: Path):
    text = _CODE.sub("", page.read_text("utf-8"))
    for place, anchor in _LINK.findall(text):
        if place.startswith(("http:", "https:")):
            continue
        target = (page.parent / place).resolve() if place else page
        assert target.exists(), f"{page.name}: {place}"
        if anchor:
            assert anchor in targets(target), f"{page.name}: {place}#{anchor}"


def test_links_are_told_apart():
    assert _LINK.findall("[a](b.md#c) [d](#e) [f](g.png)") == [("b.md", "c"), ("", "e"), ("g.png", "")]
    assert slug("3.1 Velocity feedback: `compass`") == "31-velocity-feedback-compass"


@pytest.mark.parametrize("package", ["navcore", "app"])
def test_architecture_names_every_room(package: str):
    text = (ROOT / "docs" / "architecture.md").read_text("utf-8")
    found = {path.parent.name for path in (ROOT / package).glob("*/__init__.py")}
    assert len(found) > 9
    assert {room for room in found if f"`{room}`" not in text} == set()


def test_the_interface_names_every_option_of_every_command():
    text = (ROOT / "docs" / "interface.md").read_text("utf-8")
    rows = dict(re.findall(r"^\| `schuler (\w+)[^`]*` \| (.*) \|$", text, re.MULTILINE))
    others = {name: command for name, command in _COMMANDS.items() if name not in QUESTIONS}
    assert rows.keys() == others.keys()
    for name, command in others.items():
        options = {f"--{each.name.rstrip('_').replace('_', '-')}" for each in fields(command)}
        first = fields(command)[0]
        positional = {f"--{first.name}"} if "Positional" in str(first.type) else set()
        named = set(re.findall(r"`(--[\w-]+)", rows[name])) | {"--json", "--quiet"} & options
        assert named == options - positional, name


def test_the_tutorial_shows_what_the_command_prints(capsys: pytest.CaptureFixture[str]):
    (table,) = re.findall(
        r"```text\n(loop .*?)```", (ROOT / "docs/tutorial.md").read_text("utf-8"), re.DOTALL
    )
    assert main(["run", "zha-fast", "--quiet"]) == 0
    assert table in capsys.readouterr().out


def test_every_room_says_what_it_is():
    assert all(rooms(ROOT).values())


def example_of_contributing(path: str) -> dict[str, Any]:
    """Names that the example for a file defines in CONTRIBUTING.md; tests/extension follows all recipes."""
    text = (ROOT / "CONTRIBUTING.md").read_text("utf-8")
    (code,) = re.findall(rf"<!-- file: {re.escape(path)} -->\n+```python\n(.*?)```", text, re.DOTALL)
    # The module's own name: pydantic looks annotations up there.
    names: dict[str, Any] = {"__name__": __name__}
    exec(compile(code, "CONTRIBUTING.md", "exec"), names)
    return names


def test_the_network_of_contributing_works():
    names = example_of_contributing("navcore/networks/lead.py")
    names["LeadNetwork"].model_rebuild(_types_namespace=names)
    network = names["LeadNetwork"](corner=0.5).transfer(SPHERE.schuler_frequency(0.0))
    assert network.h0 == pytest.approx(1.0)
    assert network.gain == pytest.approx(10.0)
    assert analyse(network).stable


def test_the_tab_of_contributing_works():
    view = example_of_contributing("app/views/peaks/view.py")["VIEW"]
    run = simulate(Scenario.parse({"run": {"duration_h": 0.1}, "imu": {"gyro_bias_dph": [0.1, 0.2, 0.3]}}))
    peak = run.methods[0].errors["position_m"]["max_abs"]
    assert issubclass(view, PictureView) and view.title == "Peaks"
    assert view.picture(None, Shown(run, 1, Display())) == f"<li>{peak:.6g} m</li>"


def test_anchors_become_targets_of_the_site():
    page = '<a id="s-3"></a>\n\n## 3 Network\n\nsee [3](theory.md#s-3) and [x](papers.md#liu-fig-3)\n'
    assert for_myst(page) == "(s-3)=\n## 3 Network\n\nsee [3](#s-3) and [x](papers.md#liu-fig-3)\n"


def test_what_a_page_links_to_comes_along(tmp_path: Path):
    page = ROOT / "docs" / "theory.md"
    text = (
        "[code](../navcore) [top](../README.md#why) [schema](../assets/scenario.schema.json) [x](papers.md)"
    )
    settled = _settled(ROOT, tmp_path, page, text)
    assert settled == ("code [top](../index.md#why) [schema](../assets/scenario.schema.json) [x](papers.md)")
    assert [path.name for path in tmp_path.rglob("*.*")] == ["scenario.schema.json"]
