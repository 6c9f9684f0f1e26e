"""Shares of seeds that meet all limits as a table for people."""

from navcore.design.designs import Designs
from navcore.design.needed import MOST
from navcore.design.shares import Share
from navcore.foundation.answers import columns, number
from navcore.study.robust import Robust
from schuler_bench.cli.design_text import unstated


def designs_text(designs: Designs) -> list[str]:
    """Lines: a row a method with its share, its setting and the limit that is missed most often."""
    rows = [["method", "met %", "95 % interval", "missed most often", "median", "limit"]]
    for share in designs.methods:
        worst = min(share.limits, key=lambda limit: limit.met)
        missed = ["-", "", ""]
        if worst.met < 1.0:
            requirement = worst.requirement
            missed = [requirement.quantity, number(worst.median), number(requirement.limit)]
        interval = f"{number(100.0 * share.low, 3)} to {number(100.0 * share.high, 3)}"
        rows.append([share.method.label(), number(100.0 * share.met, 3), interval, *missed])
    lines = [f"{designs.seeds} seeds, each with its own noise and constants", "", *columns(rows), ""]
    if not designs.met:
        lines += [*_alone(designs), *_needed(designs), ""]
    lines += [f"{share.method.label()}: {_setting(share)}" for share in designs.methods]
    lines += [f"{name}: left out: {reason}" for name, reason in designs.left_out]
    return [*lines, *unstated(designs.assumed_zero)]


def robust_text(found: Robust) -> list[str]:
    """Lines: a row a method with its share in the scenario, over all points, and where it is worst."""
    counts = "worst point" if found.quantile == 0.0 else f"{100.0 * found.quantile:g} % point"
    rows = [["method", "as it stands %", "all points %", f"{counts} %", "missed most often there"]]
    for one in found.methods:
        missed = min(one.worst.limits, key=lambda limit: limit.met)
        words = f"{missed.requirement.quantity} {number(missed.median)}" if missed.met < 1.0 else "-"
        shares = (one.nominal.met, one.met, one.counted)
        rows.append([one.method.label(), *(number(100.0 * share, 3) for share in shares), words])
    best = found.methods[0]
    where = ", ".join(f"{name} = {_value(value)}" for name, value in best.where.items())
    lines = [f"{found.points} points, {found.seeds} seeds each with its own noise and constants", ""]
    lines += [*columns(rows), "", f"{best.method.label()} is worst with {where}"]
    if found.price > 0.0:
        price = number(100.0 * found.price, 3)
        lines.append(f"price of robustness: {price} % of the seeds of the scenario as it stands")
    lines += ["", *(f"{one.method.label()}: {_setting(one.nominal)}" for one in found.methods)]
    return [*lines, *(f"{name}: left out: {reason}" for name, reason in found.left_out)]


def _value(value: object) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def _alone(designs: Designs) -> list[str]:
    """Say for each limit the largest share that meets it by itself."""
    lines = ["no method meets all limits on half of the seeds; each limit by itself:"]
    for k, one in enumerate(designs.methods[0].limits):
        best = max(designs.methods, key=lambda share: share.limits[k].met)
        limit = f"{one.requirement.quantity} {one.requirement.sense} {number(one.requirement.limit)}"
        share = number(100.0 * best.limits[k].met, 3)
        lines.append(f"  {limit}: at most {share} % ({best.method.label()})")
    return lines


def _needed(designs: Designs) -> list[str]:
    if not designs.needed:
        return [f"no figure of a sensor, the log or the start is enough, not even {MOST:.0f} times better"]
    lines = ["enough for the median of the seeds, with the settings below:"]
    return lines + [
        f"  {one.quantity or 'all limits'}: {', '.join(one.figures)} {number(one.factor, 3)} times better "
        f"({one.method})"
        for one in designs.needed
    ]


def _setting(share: Share) -> str:
    method = share.method
    fields = {} if method.undamped else method.network.model_dump(exclude_none=True)
    numbers = [f"{name} = {value:.4g}" for name, value in fields.items() if isinstance(value, float)]
    diverged = [f"diverges on {share.diverged} seeds"] if share.diverged else []
    return ", ".join([*(numbers or ["no parameter"]), *diverged])
