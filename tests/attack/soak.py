"""A lecture: people and browsers on one server for a while, then those who take what they can. One table.

    python -m tests.attack.soak --clients 30 --browsers 3 --minutes 30    # make soak CLIENTS=30 MINUTES=30

Every visitor moves a slider of their own scenario to a value that nobody else uses, and looks for that value
in the scenario text that comes back with the answer: an answer of somebody else's run counts as wrong. Now
and then the metrics that came are compared with those of the same scenario, run in the visitor's process.
Everything goes to 127.0.0.1, and all ends by itself after a stated time. The load is made in processes of its
own, on the same cores: on a machine with two, the load and the browsers take part of what is measured.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import platform
import queue
import signal
import statistics
import sys
import threading
import time
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path

from app.bench.process import Server
from tests.attack.load import (
    Order,
    Seen,
    beside,
    connects,
    crowds,
    dragging,
    flood_of_a_slider,
    flood_of_commands,
    long_runs,
    long_under_way,
    pausing,
)

BESIDE_S = 30.0
_BESIDE_PAUSE_S = (0.3, 0.8)
"""Short enough for some fifty answers: the 95th percentile of fewer is the slowest one."""
_LONG_PER_PROCESS = 10


@dataclass(frozen=True)
class Row:
    """One line of the table.

    Attributes
    ----------
    key : str
        Its name in the record and in tests/attack/serving.toml.
    what, unit : str
        In words.
    measured : float
        The figure.
    most, least : float or None
        Where it is to stay; None: only told.
    strict : bool
        Missing it is a fault of the server whatever the machine is.
    """

    key: str
    what: str
    measured: float
    unit: str
    most: float | None = None
    least: float | None = None
    strict: bool = False

    @property
    def met(self) -> bool:
        """Whether it is where it is to be."""
        return (self.most is None or self.measured <= self.most) and (
            self.least is None or self.measured >= self.least
        )

    @property
    def line(self) -> str:
        wanted = "" if self.most is None else f"<= {self.most:g}"
        wanted = f">= {self.least:g}" if self.least is not None else wanted
        verdict = "" if not wanted else "met" if self.met else "MISSED"
        return f"| {self.what:<62} | {self.measured:>10.4g} | {self.unit:<8} | {wanted:>8} | {verdict:<6} |"


HEAD = (
    f"| {'what':<62} | {'measured':>10} | {'unit':<8} | {'wanted':>8} | {'':<6} |",
    f"|{'-' * 64}|{'-' * 11}:|{'-' * 10}|{'-' * 9}:|{'-' * 8}|",
)


class Memory(threading.Thread):
    """Notes the server's memory every few seconds."""

    def __init__(self, server: Server, every_s: float = 5.0) -> None:
        super().__init__(daemon=True)
        self._server, self._every_s = server, every_s
        self.ended = threading.Event()
        self.mb: list[float] = []

    def run(self) -> None:
        while not self.ended.wait(self._every_s):
            self.mb.append(self._server.rss_mb())

    def growth_mb(self) -> float:
        """Median of the last tenth less the median of the tenth after the first third."""
        third, tenth = len(self.mb) // 3, max(1, len(self.mb) // 10)
        if len(self.mb) < 6:
            return math.nan
        return statistics.median(self.mb[-tenth:]) - statistics.median(self.mb[third : third + tenth])


def answers(key: str, name: str, seen: Seen, p95_ms: float | None) -> list[Row]:
    """Rows of what some visitors saw."""
    slowest_ms, rate = (
        1e3 * max(seen.answers_s, default=math.inf),
        len(seen.answers_s) / max(seen.seconds, 1e-9),
    )
    compared = f"{name}: answers of somebody else's run, of {seen.compared}"
    recomputed = f"{name}: other numbers than run here, of {seen.recomputed}"
    return [
        Row(f"{key}_answers", f"{name}: answers", len(seen.answers_s), "", least=1, strict=True),
        Row(f"{key}_rate", f"{name}: answers a second", rate, "1/s"),
        Row(f"{key}_p50", f"{name}: median", seen.quantile_ms(50), "ms"),
        Row(f"{key}_p95", f"{name}: 95th percentile", seen.quantile_ms(95), "ms", most=p95_ms),
        Row(f"{key}_slowest", f"{name}: slowest", slowest_ms, "ms"),
        Row(f"{key}_lost", f"{name}: moves without an answer", seen.lost, "", most=0, strict=True),
        Row(f"{key}_wrong", compared, seen.wrong, "", most=0, strict=True),
        Row(f"{key}_other", recomputed, seen.other_numbers, "", most=0, strict=True),
    ]


def lecture(server: Server, arguments: argparse.Namespace) -> list[Row]:
    """Everybody at once, for the whole time."""
    order = Order(server.port, 60.0 * arguments.minutes, (arguments.shortest, arguments.longest))
    before_mb, began = server.rss_mb(), []
    memory = Memory(server)

    def ready() -> None:
        began.append(server.cpu_s())
        memory.start()

    people = arguments.clients - arguments.browsers
    seen, browsers = crowds(order, people, arguments.browsers, ready=ready)
    memory.ended.set()
    cpu_ms = 1e3 * (server.cpu_s() - began[0]) / max(1, len(seen.answers_s) + len(browsers.answers_s))
    rows = answers("lecture", f"{people} visitors", seen, 500.0)
    if arguments.browsers:
        rows += answers("browsers", f"{arguments.browsers} browsers", browsers, None)
    most_mb = max(memory.mb or [before_mb])
    for_each = (most_mb - before_mb) / arguments.clients
    rows += [
        Row("lecture_cpu", "processor time of an answer, everything included", cpu_ms, "ms"),
        Row("before_mb", "memory before the visitors", before_mb, "MB"),
        Row("each_mb", "memory for each visitor, at most", for_each, "MB", most=25.0),
        Row(
            "growth_mb", "memory: growth after the first third", memory.growth_mb(), "MB", most=0.1 * most_mb
        ),
    ]
    time.sleep(arguments.rest)
    left = (server.rss_mb() - before_mb) / arguments.clients
    said = f"memory for each, {arguments.rest:g} s after all have left"
    return [*rows, Row("left_mb", said, left, "MB", most=5.0)]


def cost(server: Server) -> list[Row]:
    """Processor time of one answer, and how many a server gives."""
    drag_ms, pause_ms = dragging(server.port, server.cpu_s, 8.0), pausing(server.port, server.cpu_s, 6)
    busy, _ = crowds(Order(server.port, BESIDE_S, (0.0, 0.0), check=False), 10, first=500_000)
    rate = len(busy.answers_s) / busy.seconds
    return [
        Row("drag_cpu", "processor time of an answer while dragging", drag_ms, "ms", 50.0),
        Row("pause_cpu", "the same after a pause of 2.5 s, all included", pause_ms, "ms", 60.0),
        Row("rate", "10 visitors without pauses: answers a second", rate, "1/s", None, 30.0),
    ]


def fairness(server: Server, arguments: argparse.Namespace) -> list[Row]:
    """One visitor beside those who take what they can, and the same visitor alone just before."""
    order = Order(server.port, BESIDE_S, _BESIDE_PAUSE_S, check=False)
    attacks = [
        ("slider_flood", "one who floods a slider", flood_of_a_slider, 1),
        ("command_flood", "one who floods commands", flood_of_commands, 1),
    ]
    if arguments.long:
        processes = arguments.long // _LONG_PER_PROCESS
        attacks.append(("long_runs", f"{arguments.long} long runs", long_runs, processes))
    rows = []
    for number, (key, name, attack, processes) in enumerate(attacks):
        first = 600_000 + 20_000 * number
        alone = beside(order, None, 0, 0.0, first)
        settle_s = 8.0 + 0.25 * arguments.long * (attack is long_runs)
        under_way: list[float] = []
        ready = partial(_count_long, server.port, under_way)
        seen = beside(order, attack, processes, settle_s, first + 10_000, ready)
        for hundredth in (50, 95):
            own, other = alone.quantile_ms(hundredth), seen.quantile_ms(hundredth)
            which = "median" if hundredth == 50 else "95th percentile"
            said = f"beside {name}: {which} {other:.0f} ms, times alone"
            rows.append(Row(f"{key}_p{hundredth}", said, other / own, "", most=2.0))
        said = f"beside {name}: moves without an answer"
        rows.append(Row(f"{key}_lost", said, seen.lost, "", most=0, strict=True))
        if attack is long_runs:
            said, least = f"of {arguments.long} long runs, under way or waiting", 0.9 * arguments.long
            rows.append(Row(f"{key}_count", said, under_way[0], "", None, least, strict=True))
        time.sleep(3.0)
    return rows


def _count_long(port: int, counts: list[float]) -> None:
    counts.append(long_under_way(port))


def coming_and_going(server: Server, arguments: argparse.Namespace) -> list[Row]:
    """Many who open the page and leave."""
    before_mb = server.rss_mb()
    connects(server.port, arguments.connects)
    time.sleep(arguments.rest)
    grown = server.rss_mb() - before_mb
    said = f"memory: growth by {arguments.connects} visitors who came and left"
    return [
        Row("connects_mb", said, grown, "MB", most=100.0),
        Row("connects_threads", "threads of the server then", server.threads(), "", most=64.0),
    ]


def measure(arguments: argparse.Namespace) -> list[Row]:
    """All rows; each part is told as it ends."""
    rows: list[Row] = []
    with Server(arguments.workers) as server:
        time.sleep(5.0)  # the kernels are loaded behind the first page
        parts = [
            lambda: answers(
                "alone",
                "one visitor alone",
                beside(Order(server.port, BESIDE_S, (0.5, 2.0)), None, 0, 0.0, 700_000),
                None,
            ),
            lambda: cost(server),
            lambda: lecture(server, arguments),
            lambda: fairness(server, arguments),
            lambda: coming_and_going(server, arguments),
        ]
        for part in parts:
            try:
                made = part()
            except (TimeoutError, threading.BrokenBarrierError, queue.Empty, OSError) as error:
                said = f"not ended: {type(error).__name__}: {error}"[:62]
                made = [Row("not_ended", said, 1.0, "", most=0.0, strict=True)]
            rows += made
            if rows == made:
                print("\n".join(HEAD), flush=True)
            for row in made:
                print(row.line, flush=True)
    return rows


def told_of_machine(arguments: argparse.Namespace) -> str:
    """What was measured, where and when, in one line."""
    load = os.getloadavg()[0]
    return (
        f"{arguments.clients} visitors, {arguments.browsers} of them browsers, {arguments.minutes:g} min; "
        f"{arguments.workers} server process{'es' * (arguments.workers > 1)}; "
        f"{os.cpu_count()} cores, load {load:.1f} before it began, Python {platform.python_version()}, "
        f"{time.strftime('%Y-%m-%d', time.gmtime())}"
    )


def main() -> int:
    """Measure and print the table; 1 when an answer was lost or belonged to somebody else."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--clients", type=int, default=30)
    parser.add_argument("--browsers", type=int, default=3, help="how many of them are headless Chromium")
    parser.add_argument("--minutes", type=float, default=3.0)
    parser.add_argument("--workers", type=int, default=1, help="as of schuler serve")
    parser.add_argument("--shortest", type=float, default=0.5, help="pause between two moves, s")
    parser.add_argument("--longest", type=float, default=2.0)
    parser.add_argument("--long", type=int, default=40, help="visitors with a long run each; 0: none")
    parser.add_argument("--connects", type=int, default=400)
    parser.add_argument("--rest", type=float, default=20.0, help="pause after all have left, s")
    parser.add_argument("--json", type=Path, help="file for the rows")
    arguments = parser.parse_args()
    signal.signal(signal.SIGTERM, _end)
    until_s = 60.0 * arguments.minutes + 1500.0
    alarm = threading.Timer(until_s, _give_up, [until_s])
    alarm.daemon = True
    alarm.start()
    began, circumstances = time.monotonic(), told_of_machine(arguments)
    print(f"{circumstances}\n", flush=True)
    rows = measure(arguments)
    missed, took_s = [row.what for row in rows if not row.met], time.monotonic() - began
    print("\n" + "\n".join([f"{len(missed)} of {len(rows)} rows missed; {took_s:.0f} s", *missed]))
    if arguments.json:
        arguments.json.parent.mkdir(parents=True, exist_ok=True)
        record = {"circumstances": circumstances, "rows": [asdict(row) | {"met": row.met} for row in rows]}
        arguments.json.write_text(json.dumps(record, indent=2) + "\n")
    sys.stdout.flush()
    os._exit(int(any(row.strict and not row.met for row in rows)))  # not waiting for the timer


def _give_up(after_s: float) -> None:
    print(f"not ended after {after_s:.0f} s: given up", flush=True)
    os.kill(os.getpid(), signal.SIGTERM)


def _end(number: int, frame: object) -> None:
    """Leave by the way that ends the server and the visitors too."""
    del number, frame
    sys.exit(3)


if __name__ == "__main__":
    sys.exit(main())
