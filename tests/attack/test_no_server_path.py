"""No page shows where on the server anything lies: not the uploads, not the state folder, not the program."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

import app
from app.bench.visitor import PAGE_STATE
from app.http.server import DashboardServer
from app.serve import open_dashboard
from tests.attack.wire import Visitor, ask, visit
from tests.browser.fields import label_of

pytestmark = pytest.mark.attack

EVERY_TAB = "1920x1080|Method|Frequency|Poles|Step|Errors|Metrics|Compare|Requirements|Scenario|Files"
LOG = b"t_s,speed_mps,heading_deg\n" + b"".join(b"%d,5.0,90.0\n" % t for t in range(7200))
BROKEN = b"t_s,speed_mps,heading_deg\n0,x,y\n"


@pytest.fixture
def server(tmp_path: Path) -> Iterator[DashboardServer]:
    server, dashboard = open_dashboard(port=0, state=tmp_path / "state")
    yield server
    server.stop()
    dashboard.close()


def upload(page: Visitor, name: str, content: bytes) -> None:
    common = {"source_component_uuid": page.control("Upload a file"), "transfer_uuid": name}
    start = {"filename": name, "mime_type": "", "part_count": 1, "size_bytes": len(content)}
    page.send(type="FileTransferStartUpload", **common, **start)
    page.send(type="FileTransferPart", **common, part_index=0, content=content)


def test_nothing_that_is_sent_holds_a_path_of_the_server(server: DashboardServer, tmp_path: Path) -> None:
    own = ask(server.port, "/").headers["Location"].split("/")[1]
    with visit(server.port, own) as page:
        page.set(page.control(PAGE_STATE), EVERY_TAB)
        page.wait_for(lambda m: 'data-run="1"' in str(m), 60.0)
        upload(page, "broken.csv", BROKEN)
        page.wait_for(lambda m: m["type"] == "NotificationShowMessage" and "broken" in str(m), 30.0)
        upload(page, "log.csv", LOG)
        page.wait_for(lambda m: "log.csv" in str(m) and "sb-file" in str(m), 30.0)
        page.set(page.control("Run on these files"), True)
        page.wait_for(lambda m: "log.csv" in str(m) and "[[method]]" in str(m), 60.0)
        # The file vanishes: what the run says of it is shown too.
        for path in (tmp_path / "state").rglob("log.csv"):
            path.unlink()
        before = len(page.received)
        page.set(page.control(label_of("network.zeta")), 0.43)
        page.wait_for(lambda m: m in page.received[before:] and m["type"] == "NotificationShowMessage", 30.0)
        sent = str(page.received)
    for secret in (str(tmp_path), str(Path(app.__file__).parents[1]), str(Path.home()) + "/"):
        found = re.search(re.escape(secret), sent)
        assert found is None, sent[max(0, found.start() - 200) : found.end() + 200]
