"""Three ways through the bench, on the voyage of ``examples/voyage``: ``python examples/three_ways.py``.

An engineer with a ship's recordings asks which damping to take. A researcher asks what a network does with
such a log. A systems engineer asks what would have to be better. A number of one step is that of the next.
"""

from pathlib import Path
from typing import Any

import navcore
from navcore.checks.together import check_together
from navcore.design.modelled import modelled
from navcore.scenario.file import load
from navcore.scenario.model import Scenario

VOYAGE = Path(__file__).resolve().parent / "voyage"


def engineer(seeds: int = 40) -> dict[str, Any]:
    """Check the recordings, fit the log, put its clock right, and judge the methods by seeds."""
    files = [str(VOYAGE / name) for name in ("log.csv", "track.csv")]
    found = check_together(files)
    fit = navcore.fit(files[0], track=files[1:])
    late_s = fit.document()["log"]["delay_s"]["value"]
    mended = load(str(VOYAGE / "ship.toml"), [f"reference.clock_s={-late_s}"])
    fitted = modelled(mended).scenario
    return {
        "warnings": found.warnings,
        "fit": fit,
        "run": navcore.run(mended),
        "fitted": fitted,
        "shares": navcore.designs(fitted, seeds=seeds, as_set=True),
    }


def researcher(ship: Scenario) -> dict[str, Any]:
    """Budget of the fitted ship by source, beside the floor, and a parameter over its range."""
    field = "method.2.network.zeta"
    return {
        "budget": navcore.budget(ship),
        "profile": navcore.profile(ship, vary=[field], objective="tilt_rms"),
    }


def systems_engineer(ship: Scenario, seeds: int = 40) -> navcore.Designs:
    """Judge tighter limits: what would have to be better where nothing meets them."""
    limits = [one.model_copy(update={"at_most": 0.4 * one.limit}) for one in ship.requirement]
    return navcore.designs(ship.model_copy(update={"requirement": tuple(limits)}), seeds=seeds, as_set=True)


def main() -> None:
    """Print what each of them finds."""
    first = engineer()
    print("# Engineer", *first["warnings"], *first["fit"].lines(), *first["shares"].lines(), sep="\n")
    second = researcher(first["fitted"])
    print("\n# Researcher", *second["budget"].lines(), *second["profile"].lines(), sep="\n")
    print("\n# Systems engineer", *systems_engineer(first["fitted"]).lines(), sep="\n")


if __name__ == "__main__":
    main()
