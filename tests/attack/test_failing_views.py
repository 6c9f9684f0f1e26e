"""A view that fails says so in its own tab: the page opens, runs and shows all other views, and recovers."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

import pytest

from navcore.scenario.file import load as load_scenario
from navcore.scenario.model import Scenario
from schuler_bench.bench.visitor import PAGE_STATE, Visitor
from schuler_bench.serve import open_dashboard
from schuler_bench.shell.page import Page
from schuler_bench.shell.view import PictureView, View
from schuler_bench.views import load
from tests.attack.wire import ask
from tests.browser.fields import label_of

if TYPE_CHECKING:
    from schuler_bench.dashboard import Dashboard

pytestmark = pytest.mark.attack

STEPS = ("follow_scenario", "follow_display", "follow_jobs", "draw", "stands", "picture", "show", "resize")
ZETA = label_of("network.zeta")


def fails(step: str) -> Callable[..., Any]:
    def fail(*_: object) -> None:
        raise ZeroDivisionError(f"broken {step}")

    fail.__name__ = step
    return fail


def tell_tabs(visitor: Visitor, kind: type[View]) -> None:
    beside = "Errors" if kind.place == "upper" else "Frequency"
    visitor.set(PAGE_STATE, f"1920x1080|Method|{beside}|{kind.title or 'Errors'}")


@pytest.fixture(scope="module")
def dashboard() -> Iterator[tuple[int, Dashboard]]:
    server, served = open_dashboard(port=0)
    yield server.port, served
    server.stop()
    served.close()


def newest(served: Dashboard) -> Page:
    """The server's side of the page that was opened last."""
    return list(served._pages.values())[-1]


def faults(page: Page) -> dict[str, str]:
    """What stands in the places for faults, by the class of the view."""
    return {
        type(view).__name__: place.content for view, place in page._faults._places.items() if place.content
    }


def test_each_view_may_fail_in_turn(
    dashboard: tuple[int, Dashboard], monkeypatch: pytest.MonkeyPatch
) -> None:
    port, served = dashboard
    with Visitor(port, "each-view-fails") as visitor:
        visitor.set(PAGE_STATE, "1920x1080|Method|Frequency|Errors")
        visitor.wait_for_run(1)
        page = newest(served)
        for turn, kind in enumerate(load()):
            with monkeypatch.context() as broken:
                own = [s for s in STEPS if getattr(kind, s, None) not in (None, getattr(PictureView, s))]
                for step in own:
                    broken.setattr(kind, step, fails(step))
                tell_tabs(visitor, kind)
                run = visitor.run_number
                visitor.set(ZETA, 0.3 + 0.01 * turn)
                visitor.wait_for_run(run + 1)
                told = faults(page)
                seen = own and kind.always and kind.place != "page"
                assert set(told) == ({kind.__name__} if seen else set()), kind
                assert not seen or "ZeroDivisionError: broken" in told[kind.__name__]
            visitor.set(ZETA, 0.6 + 0.01 * turn)
            visitor.wait_for_run(run + 2)
            page.session.show(None, theme=page.session.display.theme)
            visitor.wait(lambda: not faults(page), f"the view {kind.__name__} as before")


@pytest.mark.parametrize("kind", [kind for kind in load() if kind.title in ("Tune", "Method", "Errors")])
def test_a_page_opens_though_a_view_cannot_be_built(
    dashboard: tuple[int, Dashboard], kind: type[View], monkeypatch: pytest.MonkeyPatch
) -> None:
    port, served = dashboard
    monkeypatch.setattr(kind, "build", fails("build"))
    name = f"no-{kind.title.lower()}-here"
    with Visitor(port, name) as visitor:
        visitor.set(PAGE_STATE, "1920x1080|Method|Frequency|Errors")
        visitor.wait_for_run(1)
        assert "broken build" in faults(newest(served))[kind.__name__]


DAMPED = {"damping": "external", "network": {"id": "classic2"}}
DESIGNS = {
    "zha": load_scenario("zha-fast"),
    "liu": load_scenario("liu-overshoot"),
    "without-errors": Scenario.parse({"method": [DAMPED], "reference": {"kind": "log"}}),
}


@pytest.mark.parametrize("design", DESIGNS)
def test_fronts_of_a_design_without_an_objective_brick_no_session(
    dashboard: tuple[int, Dashboard], design: str
) -> None:
    """The present design's objective is 0, which a logarithmic axis cannot show."""
    port, served = dashboard
    name, scenario = ask(port, "/").headers["Location"].split("/")[1], DESIGNS[design]
    with Visitor(port, name) as visitor:
        visitor.set(PAGE_STATE, "1920x1080|Method|Tune|Errors")
        visitor.wait_for_run(1)
        session = newest(served).session
        session.show(None, search="fronts")
        session.change(scenario, None, origin="", selected=len(scenario.method) - 1)
        visitor.wait_for_run(2)
    with Visitor(port, name) as again:
        again.set(PAGE_STATE, "1920x1080|Method|Tune|Errors")
        again.wait_for_run(2)
        assert newest(served).session is session and faults(newest(served)) == {}


@pytest.mark.parametrize(("box", "field"), [("from", "window_from_h"), ("to", "window_to_h")])
@pytest.mark.parametrize("hours", [-1.0, 100000.5, 2.0**53, 1e300])
def test_hours_out_of_range_are_refused_by_name_and_the_box_returns(
    dashboard: tuple[int, Dashboard], box: str, field: str, hours: float
) -> None:
    """Sent by websocket, as no page would."""
    with Visitor(dashboard[0], f"hours-{box}-out-of-range") as visitor:
        visitor.set(PAGE_STATE, "1920x1080|Method|Frequency|Metrics")
        visitor.wait_for_run(1)
        before = visitor.held(f"measured {box} (h)")
        visitor.set(f"measured {box} (h)", repr(hours))
        visitor.wait(lambda: visitor.notices != [], "a notice")
        assert field in visitor.notices[0][1] and ">= 0 and <= 100000" in visitor.notices[0][1]
        visitor.wait(lambda: visitor.held(f"measured {box} (h)") == before, "the value before")
