"""Boxes of the tab Requirements for a limit as a specification writes it, and the three verdicts there."""

import re
from typing import Any

import pytest

from navcore.design.designs import designs
from navcore.engine.run import Run
from navcore.engine.simulation import simulate
from navcore.foundation.errors import InputError
from navcore.scenario.model import Scenario
from schuler_bench.editing.limits import detail_label, with_detail, with_limit
from schuler_bench.jobs.odds import Odds
from schuler_bench.session.requirements import verdicts
from schuler_bench.views.requirements.table import requirements_html
from tests.limits import limits
from tests.unit.figures_runs import run_of, static_run


def test_a_limit_as_a_specification_writes_it_is_entered_with_share_hour_and_clause() -> None:
    """What is typed with a unit stays as it is typed; each box is refused by its own label."""
    ship = with_limit(static_run().scenario, "position_cep50_m", "1 nmi")
    ship = with_detail(ship, "position_cep50_m", "at_h", "300 min")
    ship = with_detail(ship, "position_cep50_m", "share", "90")
    ship = with_detail(ship, "position_cep50_m", "clause", "3.2.1")
    (one,) = ship.requirement
    assert (one.at_most, one.limit, one.at_h, one.share, one.clause) == ("1 nmi", 1852.0, 5.0, 0.9, "3.2.1")
    assert Scenario.parse(ship.canonical()) == ship
    html = requirements_html(under_these(run_of(), ship.requirement), boxes={})
    found = dict(re.findall(r'data-limit="([a-z0-9_.]+)"[^>]*? value="([^"]*)"', html))
    texts = {
        name.partition(".")[2]: text for name, text in found.items() if name.startswith("position_cep50_m")
    }
    assert texts == {"": "1 nmi", "share": "90", "at_h": "5", "clause": "3.2.1"}
    assert "settling_s.at_h" not in found
    plain = requirements_html(under_these(run_of(), ship.requirement))
    assert "≤ 1 nmi" in plain and "share of seeds (%): 90" in plain and "clause: 3.2.1" in plain
    for field, text, told in (
        ("share", "120", "120"),
        ("at_h", "99", "the end of the run"),
        ("at_h", "1 m", "'1 m'"),
    ):
        with pytest.raises(InputError, match=told) as refused:
            with_detail(ship, "position_cep50_m", field, text)
        assert refused.value.faults[0].field == detail_label("position_cep50_m", field)
    kept = with_limit(ship, "position_cep50_m", "900")
    assert (kept.requirement[0].at_most, kept.requirement[0].clause) == (900.0, "3.2.1")
    assert with_detail(kept, "position_cep50_m", "share", " ").requirement[0].share is None


def test_a_limit_over_seeds_is_open_until_they_have_judged_it() -> None:
    (one,) = limits(position_cep50_m=1e6)
    run = under_these(run_of(), (one,))
    assert verdicts(run, (one,))[0].words == ("open",) * 3
    assert "? open" in requirements_html(run) and "? 1 of 1 open" in requirements_html(run)
    found = designs(run.scenario, 8, as_set=True)
    by_name = {share.method.label(): Odds(share, 8) for share in found.methods}
    html = requirements_html(run, odds=[by_name[method.method.name] for method in run.methods])
    assert html.count("✓ met") == 3 and "? open" not in html


def under_these(run: Run, requirements: Any) -> Run:
    """Simulate a run's scenario with these requirements."""
    return simulate(run.scenario.model_copy(update={"requirement": requirements}))
