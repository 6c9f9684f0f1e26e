"""The metrics of a run as a table for people."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from app.cli.table import columns, number
from navcore.units import ARCMIN, ARCSEC

if TYPE_CHECKING:
    from navcore.run import MethodRun, Run

_SHOWN = (
    ("phi_e_rad", "phi_E", "arcsec", ARCSEC),
    ("phi_n_rad", "phi_N", "arcsec", ARCSEC),
    ("phi_u_rad", "phi_U", "arcmin", ARCMIN),
    ("dve_mps", "dV_E", "m/s", 1.0),
    ("dvn_mps", "dV_N", "m/s", 1.0),
    ("position_m", "position", "m", 1.0),
)
_STATISTICS = (("rms", "RMS"), ("max_abs", "largest"), ("final", "at the end"))
_EARTHS = {"wgs84": "WGS-84", "sphere": "sphere"}


def run_text(run: Run) -> list[str]:
    """Lines: what was run, the loops, RMS, largest and last errors of every method, warnings."""
    settings, site = run.scenario.run, run.scenario.site
    where = f"{abs(site.lat_deg):g} {'N' if site.lat_deg >= 0 else 'S'}"
    head = ", ".join(part for part in (run.scenario.title, run.scenario.source) if part)
    lines = [
        *([head] if head else []),
        f"{settings.fidelity}, {settings.duration_h:g} h, {_EARTHS[settings.earth]}, {where}, "
        f"seed {settings.seed}; statistics over {run.computed_on}",
        "",
        *columns([["loop", "damping", "H(0)", "settling", "status"], ["", "ratio", "", "min", ""]]
                 + [_loop_row(method) for method in run.methods]),
    ]  # fmt: skip
    for key, title in _STATISTICS:
        rows = [[title, *(s[1] for s in _SHOWN)], ["", *(s[2] for s in _SHOWN)]]
        rows += [[m.method.name, *(number(m.errors[s[0]][key] / s[3]) for s in _SHOWN)] for m in run.methods]
        lines += ["", *columns(rows)]
    warnings = [f"warning: {text}" for text in run.warnings]
    warnings += [f"warning: {m.method.name}: {text}" for m in run.methods for text in m.warnings]
    return [*lines, "", *warnings] if warnings else lines


def _loop_row(run: MethodRun) -> list[str]:
    loop = run.loop
    settling = number(loop.settling_s / 60.0) if loop.settling_s is not None else "never"
    h0 = number(loop.h0) if math.isfinite(loop.h0) else "infinite"
    return [run.method.name, number(loop.damping_ratio), h0, settling, run.status]
