"""A policy and a switching method are added to a copy of the program: one file and one registry line each."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

POLICY = '''"""Damped in turns."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from navcore.foundation.compiled import inlined
from navcore.foundation.parameters import quantity
from navcore.foundation.records import COUNT, record_type
from navcore.law.policy.base import PolicyParameters, calls


@inlined
def _decide(own, memory, law, sensed):
    """Return True in every other turn, the first included."""
    turn = memory.count // own.turn
    memory.count += 1
    law.s.measure = float(turn)
    return turn % 2 == 0


class Turns(PolicyParameters):
    """Damped and undamped in turns."""

    numbers: ClassVar[np.dtype] = record_type(turn=COUNT)
    memory: ClassVar[np.dtype] = record_type(count=COUNT)
    decide: ClassVar[Any] = _decide
    id: Literal["turns"] = "turns"
    turn_s: float = quantity(60.0, unit="s", ge=1.0, le=3600.0, label="turn", help="Length of a turn.")

    def packed(self, law_step_s: float) -> dict[str, Any]:
        """Length in calls."""
        return {"turn": calls(self.turn_s, law_step_s)}
'''

SWITCHING = '''"""Damped again after a wait."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from navcore.foundation.compiled import inlined
from navcore.foundation.parameters import quantity
from navcore.foundation.records import COUNT, record_type
from navcore.law.policy.base import calls
from navcore.law.records import CLEAR
from navcore.law.switching.base import SwitchingParameters


@inlined
def _switch(own, memory, law, wanted):
    """Wait, then clear the network and damp."""
    s = law.s
    memory.waited = memory.waited + 1 if wanted else 0
    damped = wanted and memory.waited > own.wait
    if damped and not s.damped:
        s.action = CLEAR
    s.damped = damped
    s.xi = s.xi_target if damped else 0.0


class Waiting(SwitchingParameters):
    """Damping begins some time after it is wanted."""

    numbers: ClassVar[np.dtype] = record_type(wait=COUNT)
    memory: ClassVar[np.dtype] = record_type(waited=COUNT)
    switch: ClassVar[Any] = _switch
    id: Literal["waiting"] = "waiting"
    wait_s: float = quantity(15.0, unit="s", ge=1.0, le=3600.0, label="wait", help="Time of the wait.")

    def packed(self, law_step_s: float, omega_s: float) -> dict[str, Any]:
        """Wait in calls."""
        return {"wait": calls(self.wait_s, law_step_s)}
'''

RUN = """
import json
from navcore import simulate
from navcore.scenario.model import Scenario

found = {}
for fidelity in ("error_model", "strapdown"):
    run = simulate(Scenario.parse({
        "run": {"fidelity": fidelity, "duration_h": 0.1, "output_step_s": 1.0, "rate_hz": 10.0},
        "reference": {"kind": "log", "rate_hz": 1.0},
        "method": [
            {"name": "waiting", "damping": "external", "network": {"id": "classic2"},
             "policy": {"id": "turns", "turn_s": 60.0}, "switching": {"id": "waiting", "wait_s": 15.0}},
            {"name": "hard", "damping": "external", "network": {"id": "classic2"},
             "policy": {"id": "turns", "turn_s": 90.0}},
        ],
    }))
    found[fidelity] = [method.law_series.tolist() for method in run.methods]
print(json.dumps(found))
"""
LEFT_OUT = {
    "policy": {
        "yaw_rate": "YawRate",
        "variation": "Variation",
        "adaptive": "Adaptive",
        "schedule": "Schedule",
    },
    "switching": {"ramp": "Ramp", "step": "Step", "bumpless": "Bumpless", "bridge": "Bridge"},
}
ENTRIES = {"policy": ("turns", POLICY, "Turns"), "switching": ("waiting", SWITCHING, "Waiting")}


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory, repo_root: Path) -> Path:
    """Copy of navcore with a policy and a switching method more."""
    folder = tmp_path_factory.mktemp("program")
    for name in ("navcore", "assets"):
        shutil.copytree(repo_root / name, folder / name, ignore=shutil.ignore_patterns("__pycache__"))
    for part, (name, text, kind) in ENTRIES.items():
        place = folder / "navcore/law" / part
        (place / f"{name}.py").write_text(text, encoding="utf-8")
        registry = (place / "__init__.py").read_text(encoding="utf-8")
        line = f'    "navcore.law.{part}.{name}:{kind}",\n'
        changed = registry.replace('    "id",\n', '    "id",\n' + line, 1)
        assert changed != registry, "the first place of the registry moves every other entry by one"
        # what the two runs do not use is left out: compiling all of it takes most of the time
        for module, kind in LEFT_OUT[part].items():
            line = f'    "navcore.law.{part}.{module}:{kind}",\n'
            assert line in changed
            changed = changed.replace(line, "")
        (place / "__init__.py").write_text(changed, encoding="utf-8")
    return folder


@pytest.mark.timeout(900)  # the kernels of the changed program are compiled
def test_they_decide_and_switch_in_both_fidelities(program: Path):
    done = subprocess.run(
        [sys.executable, "-c", RUN],
        cwd=program,
        env=os.environ | {"PYTHONPATH": str(program), "SCHULER_CACHE_DIR": str(program / "cache")},
        capture_output=True,
        text=True,
        timeout=900,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    for fidelity, (waiting, hard) in json.loads(done.stdout).items():
        for k, (wanted, damped, _, measure) in enumerate(waiting):
            turn, second = divmod(k, 60)
            assert measure == turn and wanted == float(turn % 2 == 0), fidelity
            assert damped == float(turn % 2 == 0 and second >= 15), fidelity
        assert [row[1] for row in hard] == [float(k // 90 % 2 == 0) for k in range(len(hard))], fidelity
