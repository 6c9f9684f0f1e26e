"""Pictures that could be read wrongly: edges that mean nothing, and an export under another plot's title."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import pytest

from app.session.display import Display
from app.session.shown import Shown
from app.views.appearance.export import _numbers
from app.views.poles.figure import poles
from app.views.poles.grid import Allowed
from app.views.switching.view import SwitchingView
from tests.unit.figures_runs import run_of, static_run


def test_the_region_that_a_limit_rules_out_has_the_limit_as_its_only_edge() -> None:
    rate = 1e-3
    layout = poles(static_run(), allowed=Allowed(rate=rate))["layout"]
    at = pytest.approx(-rate / static_run().scenario.omega_s)
    for suffix in ("", "2"):
        (region,) = [s for s in layout["shapes"] if s.get("name") == "settling" and s["xref"] == f"x{suffix}"]
        assert region["line"]["width"] == 0
        edges = [s for s in layout["shapes"] if s["type"] == "line" and s.get("x0") == s.get("x1") == at]
        assert {edge["xref"] for edge in edges} == {"x", "x2"}
        # its far side lies beyond all that a zoom shows
        far = max(float(word) for word in region["path"].split() if word[0].isdigit())
        assert far > 100.0 * max(map(abs, layout[f"xaxis{suffix}"]["range"]))


def test_where_nothing_switches_no_other_plot_is_saved_under_that_title() -> None:
    view = SwitchingView(cast(Any, SimpleNamespace(session=None)))
    with pytest.raises(LookupError, match="No method of this scenario switches"):
        view.figures(Shown(static_run(), 1, Display()), "Switching")
    varied = {"name": "varied", "damping": "external", "network": {"id": "unity2", "zeta": 0.5},
              "policy": {"id": "variation"}}  # fmt: skip
    found = Shown(run_of(method=[varied]), 1, Display())
    saved = _numbers(view.figures(found, "Switching"), found, "Switching")
    assert b"damped" in saved.lower() and b"\xcf\x86E" not in saved
