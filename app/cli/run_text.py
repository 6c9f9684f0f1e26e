"""The metrics of a run as a table for people."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from navcore.analysis.whole_system import duration
from navcore.design.stated import assumed_zero
from navcore.engine.measures import judged
from navcore.foundation.answers import columns, number
from navcore.quantities import ERRORS, POSITION, components
from navcore.scenario.stochastic import drawn_as_zero

if TYPE_CHECKING:
    from collections.abc import Sequence

    from navcore.engine.measures import SeedShare
    from navcore.engine.run import LawInForce, MethodRun, Run

_SHOWN = tuple(error for error in ERRORS if error.name not in components(POSITION))
_STATISTICS = (("rms", "RMS"), ("max_abs", "largest"), ("final", "at the end"))
_LOOP_HEAD = (
    ["loop", "damping", "H(0)", "settling", "24 h mode", "damped", "ζ in", "status"],
    ["", "ratio", "", "min", "e-folding", "%", "force", ""],
)
_EARTHS = {"wgs84": "WGS-84", "sphere": "sphere"}


def run_text(run: Run, shares: Sequence[SeedShare] = ()) -> list[str]:
    """Lines: what was run, the loops, RMS, largest and last errors of every method, verdicts, warnings.

    Parameters
    ----------
    run : Run
        Of a scenario.
    shares : sequence of SeedShare, optional
        One a method: what seeds say of the limits.
    """
    settings, site = run.scenario.run, run.scenario.site
    where = f"{abs(site.lat_deg):g} {'N' if site.lat_deg >= 0 else 'S'}"
    head = ", ".join(part for part in (run.scenario.title, run.scenario.source) if part)
    lines = [
        *([head] if head else []),
        f"{settings.fidelity}, {settings.duration_h:g} h, {_EARTHS[settings.earth]}, {where}, "
        f"seed {settings.seed}; statistics over {run.computed_on}",
        "",
        *columns([*_LOOP_HEAD, *(_loop_row(method) for method in run.methods)]),
    ]
    for key, title in _STATISTICS:
        rows = [[title, *(e.symbol for e in _SHOWN)], ["", *(e.kind.unit for e in _SHOWN)]]
        rows += [
            [m.method.name, *(number(m.errors[e.name][key] / e.kind.size) for e in _SHOWN)]
            for m in run.methods
        ]
        lines += ["", *columns(rows)]
    lines += _verdicts(run, shares)
    warnings = [f"warning: {text}" for text in run.warnings]
    warnings += [f"warning: {m.method.name}: {text}" for m in run.methods for text in m.warnings]
    return [*lines, "", *warnings] if warnings else lines


def _verdicts(run: Run, shares: Sequence[SeedShare]) -> list[str]:
    """Give a line for each method and limit, and what the run draws as 0; empty without limits."""
    limits = run.scenario.requirement
    if not limits:
        return []
    rows = [["requirement", "method", "value", "run", *(["seeds that meet it"] if shares else [])]]
    for place, one in enumerate(limits):
        limit = f"{one.quantity} {one.sense} {number(one.limit)}"
        limit += f" from {number(one.from_h)} h" if one.from_h else ""
        for k, method in enumerate(run.methods):
            value, met = judged(one, method)
            said = [_share(shares[k], place)] if shares else []
            rows.append([limit, method.method.name, number(value), "met" if met else "missed", *said])
    if shares and len(limits) > 1:
        rows += [
            ["all limits", method.method.name, "", "", _share(shares[k])]
            for k, method in enumerate(run.methods)
        ]
    lines = ["", *columns(rows)]
    if zero := drawn_as_zero(run.scenario):
        lines.append(f"drawn as 0 in this run, though a standard deviation is given: {', '.join(zero)}")
    if assumed := assumed_zero(run.scenario):
        lines.append(f"assumed 0, with neither number nor standard deviation given: {', '.join(assumed)}")
    return lines


def _share(share: SeedShare, place: int | None = None) -> str:
    one = share.as_dict(place)
    met, low, high = (number(100.0 * one[key], 3) for key in ("met", "low", "high"))
    return f"{met} % of {share.seeds} ({low} to {high})"


def _loop_row(run: MethodRun) -> list[str]:
    loop = run.loop
    settling = number(loop.settling_s / 60.0) if loop.settling_s is not None else "never"
    h0 = number(loop.h0) if math.isfinite(loop.h0) else "infinite"
    law = run.law_in_force
    return [
        run.method.name, number(loop.damping_ratio), h0, settling, _earth_mode(run),
        number(100.0 * law.damped_share), _coefficient(law), run.status,
    ]  # fmt: skip


def _coefficient(law: LawInForce) -> str:
    """Damping ratio in force: one value, or the range."""
    if law.xi_min is None or law.xi_max is None:
        return "-"
    low, high = number(law.xi_min, 3), number(law.xi_max, 3)
    return low if low == high else f"{low} to {high}"


def _earth_mode(run: MethodRun) -> str:
    """How the 24 h mode of the whole system behaves: which way, and the e-folding time."""
    growth = run.whole.earth_growth
    if growth == 0.0:
        return "stands"
    return f"{'grows' if growth > 0.0 else 'decays'}, {duration(1.0 / growth)}"
