"""A network and a motion are added to a copy of the program: one new file and one line of a registry each."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

NETWORK = '''"""A lag network with one pole and one zero."""

from __future__ import annotations

from typing import ClassVar, Literal

from navcore.foundation.parameters import quantity
from navcore.networks.base import LinearNetwork, NetworkParameters, linear_network


class LagNetwork(NetworkParameters):
    """H = (p + a)/(p + a + xi) in p = s/omega_s, so that H(0) < 1."""

    title: ClassVar[str] = "Lag"
    source: ClassVar[str] = "A test, eq. 1"
    id: Literal["lag"] = "lag"
    xi: float = quantity(
        0.8, ge=0.01, le=5.0, slider=(0.05, 2.0), label="xi", help="Strength of the damping.",
        latex=r"H=\\\\frac{p+a}{p+a+\\\\xi}",
    )
    a: float = quantity(1.0, ge=0.1, le=10.0, slider=(0.1, 5.0), label="a", help="Zero over omega_s.")

    def transfer(self, omega_s: float) -> LinearNetwork:
        """Return H(s)."""
        return linear_network("lag", omega_s, [1.0, self.a], [1.0, self.a + self.xi])
'''

MOTION = '''"""A figure of eight on a swell."""

from __future__ import annotations

import math
from typing import ClassVar, Literal

import numpy as np

from navcore.foundation.earth import Earth
from navcore.foundation.parameters import quantity
from navcore.motion.base import Site
from navcore.motion.sampled import SampledMotion, displaced


class EightMotion(SampledMotion):
    """The vehicle runs a figure of eight, and heaves."""

    source: ClassVar[str] = "A test, fig. 8"
    kind: Literal["eight"] = "eight"
    size_m: float = quantity(
        300.0, unit="m", gt=0.0, le=5000.0, slider=(10.0, 1000.0), label="size", help="Half its length."
    )
    period_s: float = quantity(
        400.0, unit="s", ge=60.0, le=1e5, slider=(60.0, 3600.0), label="period", help="Time of one round."
    )
    swell_m: float = quantity(
        1.0, unit="m", ge=0.0, le=10.0, slider=(0.0, 5.0), label="swell", help="Amplitude of the heave, 10 s."
    )

    def path(self, t_s: np.ndarray, site: Site, earth: Earth) -> np.ndarray:
        """Position and attitude."""
        angle = 2.0 * math.pi * t_s / self.period_s
        east, north = self.size_m * np.sin(angle), 0.5 * self.size_m * np.sin(2.0 * angle)
        heading = np.unwrap(np.arctan2(np.cos(angle), np.cos(2.0 * angle)))
        heave = site.height + self.swell_m * np.sin(2.0 * math.pi * t_s / 10.0)
        roll = 0.05 * np.sin(2.0 * math.pi * t_s / 10.0)
        lat, lon = displaced(site, earth, east, north).T
        return np.column_stack([lat, lon, heave, np.zeros_like(t_s), roll, heading])

    def shortest_period_s(self) -> float:
        """Return the period of the swell."""
        return 10.0
'''

PAGE_FORM = """
import json
from app.editing import edits, form
from app.views.explain.text import explain_html
from navcore.motion import MOTIONS
from navcore.networks import NETWORKS
from navcore.scenario.file import load
from navcore.scenario.guide import guide
from navcore.scenario.schema_file import schema_text

scenario = load("scenario.toml")
scenario = edits.with_choice(scenario, ("motion", "kind"), "static")
scenario = edits.with_choice(scenario, ("motion", "kind"), "eight")
scenario = edits.with_value(scenario, ("motion", "size_m"), 250.0)
scenario = edits.with_choice(scenario, ("method", 1, "network", "id"), "lag")
scenario = edits.with_value(scenario, ("method", 1, "network", "xi"), 0.6)
network, motion = scenario.method[1].network, scenario.motion
specs = form.fields(type(network), ("method", 1, "network")) + form.fields(type(motion), ("motion",))
print(json.dumps({
    "labels": [spec.label for spec in specs],
    "told": [explain_html(spec, scenario) for spec in specs],
    "offered": [*NETWORKS, *MOTIONS],
    "guide": [f'network = {{ id = "lag" }}' in guide(), '[motion] kind = "eight"' in guide()],
    "schema": [word in schema_text() for word in ('"lag"', '"eight"')],
    "values": [network.xi, motion.size_m],
}))
"""

SCENARIO = """schema = 1
[run]
duration_h = 0.1
step_s = 1.0
[motion]
kind = "eight"
[imu]
gyro_bias_dph = [0.01, 0.01, 0.01]
[reference]
kind = "log"
[[method]]
name = "free"
[[method]]
name = "damped"
damping = "external"
network = { id = "lag", xi = 0.8 }
[[method]]
name = "inside"
damping = "internal"
network = { id = "lag", xi = 0.8 }
"""


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory, repo_root: Path) -> Path:
    """Copy of the program with a network and a motion more."""
    folder = tmp_path_factory.mktemp("program")
    for name in ("navcore", "app", "assets"):
        shutil.copytree(repo_root / name, folder / name, ignore=shutil.ignore_patterns("__pycache__"))
    (folder / "navcore/networks/lag.py").write_text(NETWORK.replace("\\\\", "\\"), encoding="utf-8")
    (folder / "navcore/motion/eight.py").write_text(MOTION, encoding="utf-8")
    add_line(
        folder / "navcore/networks/catalogue.py",
        '    "navcore.networks.custom:',
        "navcore.networks.lag:LagNetwork",
    )
    add_line(
        folder / "navcore/motion/__init__.py",
        '    "navcore.motion.track:',
        "navcore.motion.eight:EightMotion",
    )
    (folder / "scenario.toml").write_text(SCENARIO, encoding="utf-8")
    return folder


def add_line(path: Path, after: str, place: str) -> None:
    """Write one more line into a registry."""
    lines = path.read_text(encoding="utf-8").splitlines()
    (at,) = (i for i, line in enumerate(lines) if line.startswith(after))
    lines.insert(at + 1, f'    "{place}",')
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def python(program: Path, *arguments: str) -> str:
    """Output of the copied program."""
    done = subprocess.run(
        [sys.executable, *arguments],
        cwd=program,
        env=os.environ | {"PYTHONPATH": str(program)},
        capture_output=True,
        text=True,
        timeout=500,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_they_run_from_the_command_line_in_both_fidelities(program: Path) -> None:
    """A new motion moves truth and IMU alike: the full mechanization errs as the error model says."""
    found: dict[str, dict[str, Any]] = {}
    for fidelity in ("error_model", "strapdown"):
        out = program / fidelity
        setting = f"run.fidelity={fidelity}"
        python(program, "-m", "app", "run", "scenario.toml", "--set", setting, "--out", str(out))
        metrics = json.loads((out / "metrics.json").read_text(encoding="utf-8"))
        found[fidelity] = {method["name"]: method for method in metrics["methods"]}
        assert list(found[fidelity]) == ["free", "damped", "inside"]
    for name, linear in found["error_model"].items():
        full = found["strapdown"][name]
        assert linear["status"] == full["status"] == "ok"
        for quantity in ("phi_e_rad", "phi_n_rad"):
            rms = linear["errors"][quantity]["rms"]
            assert rms > 0.0
            assert full["errors"][quantity]["rms"] == pytest.approx(rms, rel=1e-3)


def test_the_command_line_shows_the_network(program: Path) -> None:
    report = json.loads(python(program, "-m", "app", "network", 'id = "lag", xi = 0.5', "--json"))
    assert report["id"] == "lag"
    assert report["stable"]
    assert report["h0"] == pytest.approx(1.0 / 1.5)


def test_the_page_offers_edits_and_explains_them(program: Path) -> None:
    found = json.loads(python(program, "-c", PAGE_FORM))
    assert found["labels"] == ["xi", "a", "size (m)", "period (s)", "swell (m)"]
    assert {"lag", "eight"} <= set(found["offered"])
    assert found["guide"] == found["schema"] == [True, True]
    assert found["values"] == [0.6, 250.0]
    assert "A test, eq. 1" in found["told"][0] and "<math" in found["told"][0]
    assert "A test, fig. 8" in found["told"][2]
