"""Write the block diagrams of the documentation: ``python -m tools.diagrams`` (docs/diagrams/*.svg)."""

from pathlib import Path

from navcore.law.policy.variation import Variation
from navcore.scenario.model import Scenario
from schuler_bench.plots import style
from schuler_bench.views.diagram.blocks import diagram
from schuler_bench.views.diagram.membership import membership_svg
from schuler_bench.views.diagram.parts import State
from schuler_bench.views.diagram.svg import diagram_svg

FOLDER = Path(__file__).parents[1] / "docs" / "diagrams"
_LEVEL = {"id": "complementary", "zeta": 0.5, "eta": 0.5}
_COMPASS = {"id": "compass", "sigma": 0.0015, "xi": 0.7}
METHODS = {
    "free": {"damping": "free"},
    "internal": {"damping": "internal", "network": _LEVEL},
    "external": {
        "damping": "external",
        "network": _LEVEL,
        "policy": {"id": "variation"},
        "switching": {"id": "ramp"},
    },
    "feedback": {"damping": "external", "network": _COMPASS},
    "averaging": {"damping": "averaging"},
    "kalman": {"damping": "kalman"},
    "whole": {"damping": "external", "network": _LEVEL, "azimuth": {"id": "unity2", "zeta": 0.5}},
    "gyrocompass": {"damping": "external", "network": _COMPASS, "gyrocompass": {}},
}


def drawn(name: str) -> str:
    """SVG of one of `METHODS`."""
    data = {"imu": {"gyro_arw_dpsh": 0.003}, "reference": {"kind": "log"}, "method": [METHODS[name]]}
    scenario = Scenario.parse(data)
    return f"{diagram_svg(diagram(scenario, 0), style.method_color(0), State(), commands=False)}\n"


def memberships() -> str:
    """SVG of Liu's membership functions (his figure 8), with the limits that he prints."""
    return f"{membership_svg(Variation())}\n"


def main() -> None:
    """Write all files."""
    FOLDER.mkdir(exist_ok=True)
    for name in METHODS:
        (FOLDER / f"{name}.svg").write_text(drawn(name), encoding="utf-8")
    (FOLDER / "membership.svg").write_text(memberships(), encoding="utf-8")


if __name__ == "__main__":
    main()
