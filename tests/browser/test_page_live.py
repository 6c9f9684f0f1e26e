"""A ship's INS that the server listens to: shown first in the tab "Files", and taken as a recording."""

import socket
from pathlib import Path

from schuler_bench.live.live import listening
from schuler_bench.live.settings import settings_of
from tests.browser.conftest import Another
from tests.sentences import seconds
from tests.unit.test_live_listening import free_port


def test_what_the_server_hears_is_shown_and_taken_as_a_recording(another: Another, tmp_path: Path) -> None:
    port = free_port()
    settings = settings_of([f"udp://:{port}"])
    with listening(settings) as live, socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as out:
        assert live is not None
        bench = another(1440, 900).open()
        bench.tab("Files")
        shown = bench.page.locator("#sb-live")
        shown.get_by_text("0 in all; 0 dropped, 0 malformed").wait_for()
        each = seconds(600)
        for k in range(0, 600, 20):
            for second in each[k : k + 20]:
                out.sendto("\r\n".join(second).encode(), ("127.0.0.1", port))
            bench.wait_until(lambda so_far=4 * (k + 20): live.status.sentences == so_far)
        shown.get_by_text("2400 in all; 0 dropped").wait_for()
        shown.get_by_text("s behind").wait_for()
        assert "position IN" in shown.inner_text() and shown.locator("svg polyline").count() == 9
        assert "as recorded" in shown.locator("table").inner_text()
        bench.page.screenshot(path=tmp_path / "live.png")
        bench.button("Take what was heard as a recording").click()
        bench.wait_until(lambda: "live.nmea" in bench.session.uploads.files)
        bench.close_notices()
        with bench.next_run():
            bench.button("Damp my INS").click()
        assert bench.session.run is not None and bench.session.run.against is not None
        assert [one.status for one in bench.session.run.methods] == ["ok"] * 4
