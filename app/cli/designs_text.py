"""Shares of seeds that meet all limits as a table for people."""

from app.cli.table import columns, number
from navcore.design.designs import Designs
from navcore.design.shares import Share


def designs_text(found: Designs) -> list[str]:
    """Lines: a row a method with its share, its setting and the limit that is missed most often."""
    rows = [["method", "met %", "95 % interval", "missed most often", "median", "limit"]]
    for share in found.methods:
        worst = min(share.limits, key=lambda limit: limit.met)
        missed = ["-", "", ""]
        if worst.met < 1.0:
            requirement = worst.requirement
            missed = [requirement.quantity, number(worst.median), number(requirement.limit)]
        interval = f"{number(100.0 * share.low, 3)} to {number(100.0 * share.high, 3)}"
        rows.append([share.method.label(), number(100.0 * share.met, 3), interval, *missed])
    lines = [f"{found.seeds} seeds, each with its own noise and constants", "", *columns(rows), ""]
    lines += [f"{share.method.label()}: {_setting(share)}" for share in found.methods]
    lines += [f"{name}: left out: {reason}" for name, reason in found.left_out]
    if found.assumed_zero:
        lines.append(f"note: 0 is assumed for {', '.join(found.assumed_zero)}")
    return lines


def _setting(share: Share) -> str:
    method = share.method
    fields = {} if method.undamped else method.network.model_dump(exclude_none=True)
    numbers = [f"{name} = {value:.4g}" for name, value in fields.items() if isinstance(value, float)]
    diverged = [f"diverges on {share.diverged} seeds"] if share.diverged else []
    return ", ".join([*(numbers or ["no parameter"]), *diverged])
