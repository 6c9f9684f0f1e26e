"""``schuler network``: one network's H(s) and its closed loop on the textbook sphere."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

from tyro.conf import Positional, arg

from app.cli.table import columns, number
from app.cli.terminal import emit, emit_json


@dataclass(frozen=True)
class NetworkCommand:
    """Show a damping network: H(s), the poles of the closed loop, its damping and settling.

    Attributes
    ----------
    network : str
        As in a scenario, e.g. 'id = "compass", sigma = 0.0088, xi = 0.7'.
    json : bool
        Print one JSON document.
    """

    network: Annotated[Positional[str], arg(metavar="NETWORK")]
    json: bool = False

    def execute(self) -> int:
        """Print the report; 0, also for an unstable loop, which it says."""
        from navcore.network import parse_network
        from navcore.network.report import network_report

        report = network_report(parse_network(self.network))
        if self.json:
            emit_json(report)
        else:
            emit("\n".join(network_text(report)))
        return 0


def network_text(report: dict[str, Any]) -> list[str]:
    """Lines for people; rates in rad/s and in units of the Schuler frequency."""
    omega_s = _schuler_frequency()
    settling = report["settling_s"]
    rows = [
        ["numerator", *(number(c, 6) for c in report["num"])],
        ["denominator", *(number(c, 6) for c in report["den"])],
    ]
    width = max(len(row) for row in rows)
    rows = [[row[0], *[""] * (width - len(row)), *row[1:]] for row in rows]
    facts = [
        ["H(0)", number(report["h0"], 6), ""],
        ["gain", number(report["gain"], 6), ""],
        ["stable", "yes" if report["stable"] else "NO", ""],
        ["damping ratio", number(report["damping_ratio"]), ""],
        ["natural frequency", number(report["natural_frequency_rad_s"]), "rad/s"],
        ["settling (2 %)", *(("never", "") if settling is None else (number(settling), "s"))],
    ]
    lines = [f"{report['id']} on the sphere, omega_s = {omega_s:.6g} rad/s", "", *columns(rows), ""]
    for key, title in (("zeros", "zeros"), ("poles", "poles"), ("closed_loop_poles", "closed loop")):
        lines += columns([[title, "rad/s", "/ omega_s"], *_roots(report[key], omega_s)]) + [""]
    lines += columns(facts)
    return lines + ([""] if report["warnings"] else []) + [f"warning: {text}" for text in report["warnings"]]


def _schuler_frequency() -> float:
    from navcore.earth import SPHERE

    return SPHERE.schuler_frequency(0.0)


def _roots(roots: list[list[float]], omega_s: float) -> list[list[str]]:
    rows = [["", _complex(re, im), _complex(re / omega_s, im / omega_s)] for re, im in roots]
    return rows or [["", "none", ""]]


def _complex(re: float, im: float) -> str:
    return number(re) if im == 0.0 else f"{number(re)} {'+' if im > 0 else '-'} {number(abs(im))}j"
