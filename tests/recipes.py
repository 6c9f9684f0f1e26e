"""The recipes of CONTRIBUTING.md: what each adds, and a run that uses all of it."""

import re

_BLOCK = re.compile(r"<!-- (file|line): (\S+) -->\n+```\w+\n(.*?)```\n", re.DOTALL)
RUN = """
import json
from navcore import budget, simulate
from navcore.scenario.model import Scenario

lead = {"damping": "external", "network": {"id": "lead"}}
wait = {"id": "waiting", "wait_s": 15.0}
log = {"kind": "log", "rate_hz": 1.0}
turns = [
    lead | {"name": "waiting", "policy": {"id": "turns", "turn_s": 60.0}, "switching": wait},
    lead | {"name": "hard", "policy": {"id": "turns", "turn_s": 90.0}},
]
eight = {
    "motion": {"kind": "eight"},
    "imu": {"gyro_bias_dph": [0.01, 0.01, 0.01]},
    "method": [{"name": "free"}, lead | {"name": "damped"}, lead | {"name": "inside", "damping": "internal"}],
}
quay = {
    "imu": {"gyro_bias_dph": [0.01, 0.01, 0.01]},
    "method": [{"name": kind, "damping": kind, "network": {"id": "lead"}} for kind in ("moored", "internal")],
}
trend = {"imu": {"gyro_trend_dph": 0.24}, "method": [{"name": "free"}]}
runs = {}
for fidelity in ("error_model", "strapdown"):
    run = {"fidelity": fidelity, "duration_h": 0.1, "output_step_s": 1.0, "rate_hz": 10.0}
    decided = simulate(Scenario.parse({"run": run, "reference": log, "method": turns}))
    moved = simulate(Scenario.parse({"run": run | {"rate_hz": 100.0}, "reference": log} | eight))
    hours = run | {"duration_h": 2.0, "output_step_s": 60.0, "step_s": 1.0}
    grown = Scenario.parse({"run": hours} | trend)
    still = Scenario.parse({"run": hours} | quay)
    runs[fidelity] = {
        "moored": [method.rows.tolist() for method in simulate(still).methods],
        "moored budget": [method.total.rms.tilt_rad for method in budget(still).methods],
        "trend": [simulate(grown).methods[0].errors[name]["rms"] for name in ("phi_e_rad", "phi_n_rad")],
        "source": budget(grown).methods[0].sources["gyro_trend"].rms.tilt_rad,
        "steady": budget(grown, steady=True).methods[0].warnings,
        "law": [method.law_series.tolist() for method in decided.methods],
        "tilt": [[m.errors[name]["rms"] for name in ("phi_e_rad", "phi_n_rad")] for m in moved.methods],
    }
from navcore.foundation.errors import InputError
try:
    Scenario.parse(eight | {"method": quay["method"]})
except InputError as error:
    assert "needs a vehicle that stands at the start" in str(error)
else:
    raise AssertionError("moored under way")
print(json.dumps(runs))
"""


def recipes(guide: str) -> dict[str, list[tuple[str, str, str]]]:
    """Blocks of each recipe, (file or line, path, text), by what it adds."""
    sections = re.split(r"^## ", guide, flags=re.MULTILINE)
    titled = [re.match(r"Add an? (.+)\n", section) for section in sections]
    return {
        title[1]: _BLOCK.findall(section)
        for title, section in zip(titled, sections, strict=True)
        if title is not None
    }
