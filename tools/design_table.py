"""``python -m tools.design_table``: docs/design.md, what the budget covers and a table over the presets.

For each preset: the source that contributes most to the tilt along its run, how many times the floor the tilt
of its first damped method is in the steady state, before and after tuning, and which network comes nearest.
"""

import sys
from pathlib import Path

from navcore.design.budget import budget
from navcore.design.pareto import LEFT_OUT
from navcore.design.tune import tune
from navcore.foundation.errors import InputError
from navcore.foundation.markdown import markdown_table
from navcore.networks import NETWORKS
from navcore.scenario.file import load, presets
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario

PAGE = Path(__file__).resolve().parents[1] / "docs" / "design.md"
MARK = "<!-- the table below is written by `make design` -->"


HEAD = (
    *("preset", "method", "largest source of tilt", "x floor", "x floor, tuned"),
    *("best network", "`optimal`", ""),
)


def row(name: str) -> list[str]:
    """Compute the cells of one preset; a dash where its note says why there is no number."""
    scenario = load(name)
    damped = [i for i, m in enumerate(scenario.method) if m.kind.uses_network]
    index = damped[0] if damped else 0
    method = scenario.method[index]
    alone = scenario.model_copy(update={"method": (method,)})
    source = budget(alone, seeds=2).methods[0].largest or "not split: shown by seeds"
    steady = budget(alone, steady=True)
    if steady.floor_reason or not steady.floor.rms.tilt_rad:
        return [name, method.name, source, *"----", steady.floor_note]
    found = {n: _least(alone, n) for n in NETWORKS if n not in LEFT_OUT}
    times = {n: value / steady.floor.rms.tilt_rad for n, value in found.items() if value is not None}
    optimal = times.pop("optimal")
    best = min(times, key=lambda n: times[n])
    before = steady.times_floor(steady.methods[0])["tilt"]
    own = times.get(method.network.id)
    return [
        name,
        method.name,
        source,
        "-" if before is None else f"{before:.3g}",
        "-" if own is None else f"{own:.3g}",
        f"`{best}` {times[best]:.3g}",
        f"{optimal:.3g}",
        "the recorded log counts as free of error" if scenario.reference.kind == "file" else "",
    ]


def _least(scenario: Scenario, network: str) -> float | None:
    """Least steady tilt of a network in place of the method's own, rad."""
    method = scenario.method[0]
    plain = Method.model_validate({"name": method.name, "damping": "external", "network": {"id": network}})
    plain = scenario.designed(plain)
    other = scenario.model_copy(update={"method": (plain,)})
    fields = plain.network.design_fields()
    if not fields:
        return budget(other, steady=True).methods[0].total.rms.tilt_rad
    try:
        return tune(other, "tilt_rms", [f"method.0.network.{field}" for field in fields]).objective
    except InputError:
        return None


def main() -> int:
    """Write the table into docs/design.md, whose text above it stays; names of presets: only their rows."""
    text, _, old = PAGE.read_text("utf-8").partition(MARK)
    parts = (line.strip()[1:-1].split("|") for line in old.splitlines() if line.startswith("|"))
    kept = {cells[0].strip(): [cell.strip() for cell in cells] for cells in parts}
    names = list(presets())
    for name in sys.argv[1:] or names:
        kept[name] = row(name)
        print(" | ".join(kept[name]), file=sys.stderr, flush=True)
    table = markdown_table(HEAD, [kept[name] for name in names if name in kept])
    PAGE.write_text(f"{text}{MARK}\n\n{table}\n", "utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
