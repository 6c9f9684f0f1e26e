"""A page that goes in the middle of a study: when it is opened again by its link, the answer is on it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import pytest

from schuler_bench.bench.visitor import PAGE_STATE, Visitor
from schuler_bench.serve import open_dashboard
from tests.attack.conftest import eventually
from tests.attack.wire import ask

if TYPE_CHECKING:
    from schuler_bench.dashboard import Dashboard

pytestmark = pytest.mark.attack


@pytest.fixture
def dashboard() -> Iterator[tuple[int, Dashboard]]:
    server, served = open_dashboard(port=0)
    yield server.port, served
    server.stop()
    served.close()


def opened(port: int, session: str) -> Visitor:
    visitor = Visitor(port, session).__enter__()
    visitor.set(PAGE_STATE, "1920x1080|Method|Frequency|Errors")
    visitor.wait_for_run(1)
    return visitor


@pytest.mark.slow
def test_an_answer_is_there_when_the_page_is_back(dashboard: tuple[int, Dashboard]) -> None:
    port, served = dashboard
    id = ask(port, "/").headers["Location"].split("/")[1]
    visitor = opened(port, id)
    session = served.sessions.get(id)
    session.show(None, study_seeds=2)
    studier = session.searches.asking["study"]
    visitor.ask("study")
    eventually(lambda: studier.under_way is not None)
    visitor.__exit__(None, None, None)
    eventually(lambda: session.open_pages == 0)
    assert studier.result is None, "it left too late"
    eventually(lambda: studier.under_way is None, 90.0)
    back = opened(port, id)
    assert served.sessions.get(id) is session
    assert studier.result is not None and studier.result.complete and studier.words == ()
    (page,) = served._pages.values()
    view: Any = next(view for view in page._views if type(view).__name__ == "StudyView")
    assert view._document["status"] == "complete" and view._method.visible and not view._on.visible
    back.__exit__(None, None, None)
