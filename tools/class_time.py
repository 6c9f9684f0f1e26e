"""Time a class: ``python -m tools.class_time [--visitors 30]``.

A server in this process, a visitor by websocket who leads, and the others, each with a session of his own.
Printed are the seconds from a press of the leader's until the last visitor has the step, and from the moment
in which all send their sketches until the leader's page has got them all.
"""

import argparse
import re
import threading
import time
from typing import Any

from schuler_bench.bench.visitor import PAGE_STATE, Visitor
from schuler_bench.serve import open_dashboard
from schuler_bench.session.classroom import Classroom
from schuler_bench.views.learn.asked import COLUMNS_OF_SKETCH

_LESSON, _STEP = 0, 3
_THEIRS = re.compile(r'class="sb-theirs"')
_OPENING_S, _LONGEST_S = 300.0, 60.0


class Pupil(Visitor):
    """A visitor that remembers what the tab Learn shows."""

    def __init__(self, port: int, session: str) -> None:
        super().__init__(port, session)
        self.lesson = self.sketch = ""

    def heard(self, content: str) -> None:
        """Take a piece of HTML that came."""
        if 'aria-label="Sketch"' in content:
            self.sketch = content
        elif 'aria-label="Lesson"' in content and "<h3>" in content:
            self.lesson = content


def _attend(pupil: Pupil, ended: threading.Event) -> None:
    while not ended.is_set():
        pupil.rest(0.05)


def _until(done: Any, what: str, seconds: float) -> float:
    began = time.perf_counter()
    while not done():
        if time.perf_counter() - began > seconds:
            raise TimeoutError(what)
        time.sleep(0.01)
    return time.perf_counter() - began


def timed(visitors: int) -> tuple[float, float]:
    """Seconds to the step, and to all sketches on the page of the one who leads.

    Parameters
    ----------
    visitors : int
        Without the one who leads.
    """
    room = Classroom()
    server, dashboard = open_dashboard(port=0, classroom=room)
    ended = threading.Event()
    try:
        pupils = [Pupil(server.port, f"class-session-{number:04d}") for number in range(visitors + 1)]
        threads = []
        for pupil in pupils:
            pupil.__enter__()
            pupil.set(PAGE_STATE, "1920x1080|Learn|Frequency|Errors")
            pupil.wait_for_run(1)
            thread = threading.Thread(target=_attend, args=(pupil, ended), daemon=True)
            thread.start()
            threads.append(thread)
        leader, others = pupils[0], pupils[1:]
        _until(lambda: room.here >= visitors, "all visitors", _OPENING_S)
        leader.ask("lesson", f"lead {room.code}")
        _until(lambda: room.is_led, "the leader", _LONGEST_S)
        leader.ask("lesson", f"open {_LESSON}")
        _until(lambda: all("svg" in one.sketch for one in pupils), "the first step", _OPENING_S)
        for one in pupils:
            one.lesson = one.sketch = ""
        leader.ask("lesson", f"step {_STEP}")
        to_step = _until(lambda: all(one.lesson for one in others), "the step", _LONGEST_S)
        _until(lambda: all("svg" in one.sketch for one in pupils), "the axes to sketch in", _OPENING_S)
        heights = ",".join(f"{0.02 * column - 0.5:.3f}" for column in range(COLUMNS_OF_SKETCH))
        for one in others:
            one.ask("lesson", f"sketch {heights}")
        shown = _until(lambda: len(_THEIRS.findall(leader.sketch)) == visitors, "all sketches", _LONGEST_S)
        ended.set()
        for thread in threads:
            thread.join()
        for pupil in pupils:
            pupil.__exit__()
        return to_step, shown
    finally:
        ended.set()
        server.stop()
        dashboard.close()


def main() -> None:
    """Print both times."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--visitors", type=int, default=30, metavar="N")
    visitors = parser.parse_args().visitors
    to_step, shown = timed(visitors)
    print(f"{visitors} visitors: the step {to_step:.2f} s, all sketches on the leader's page {shown:.2f} s")


if __name__ == "__main__":
    main()
