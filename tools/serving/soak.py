"""A lecture: people and browsers on one server for a while, then those who take what they can. One table.

    python -m tools.serving.soak --clients 30 --browsers 3 --minutes 30    # make soak CLIENTS=30 MINUTES=30

Every visitor moves a slider of their own scenario to a value that nobody else uses, and looks for that value
in the scenario text that comes back with the answer: an answer of somebody else's run counts as wrong. Now
and then the metrics that came are compared with those of the same scenario, run in the visitor's process.
Everything goes to 127.0.0.1, and all ends by itself after a stated time. The load is made in processes of its
own, on the same cores: on a machine with two, the load and the browsers take part of what is measured.
"""

import argparse
import json
import math
import os
import queue
import signal
import statistics
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path

from schuler_bench.bench.process import Server
from tools.serving.attackers import (
    flood_of_a_slider,
    flood_of_commands,
    left_behind,
    long_runs,
    searches,
    studies,
)
from tools.serving.load import (
    Order,
    Seen,
    beside,
    connects,
    crowds,
    dragging,
    long_under_way,
    pausing,
)
from tools.serving.table import machine

BESIDE_S = 30.0
_BESIDE_PAUSE_S = (0.3, 0.8)
"""Short enough for some fifty answers: the 95th percentile of fewer is the slowest one."""
_BESIDE_STUDY = 1.2
"""Times alone that an answer may take beside a study."""
_LONG_PER_PROCESS = 10


@dataclass(frozen=True)
class Row:
    """One line of the table.

    Attributes
    ----------
    key : str
        Its name in the record and in tools/serving/rows.toml.
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
        above = self.least is not None and self.measured < self.least
        return not above and (self.most is None or self.measured <= self.most)

    @property
    def line(self) -> str:
        """Row of the table that is printed."""
        wanted = "" if self.most is None else f"<= {self.most:g}"
        wanted = f">= {self.least:g}" if self.least is not None else wanted
        verdict = "" if not wanted else "met" if self.met else "MISSED"
        return f"| {self.what:<62} | {self.measured:>10.4g} | {self.unit:<8} | {wanted:>8} | {verdict:<6} |"


def counted(key: str, what: str, count: float) -> Row:
    """Line of what must not happen even once."""
    return Row(key, what, count, "", most=0, strict=True)


HEAD = (
    f"| {'what':<62} | {'measured':>10} | {'unit':<8} | {'wanted':>8} | {'':<6} |",
    f"|{'-' * 64}|{'-' * 11}:|{'-' * 10}|{'-' * 9}:|{'-' * 8}|",
)


@contextmanager
def memory_noted(server: Server, every_s: float = 5.0) -> Iterator[list[float]]:
    """Server's memory every few seconds, MB."""
    notes: list[float] = []
    ended = threading.Event()

    def note() -> None:
        while not ended.wait(every_s):
            notes.append(server.rss_mb())

    thread = threading.Thread(target=note, daemon=True)
    thread.start()
    try:
        yield notes
    finally:
        ended.set()
        thread.join()


def growth_mb(notes: list[float]) -> float:
    """Median of the last tenth less the median of the tenth after the first third."""
    third, tenth = len(notes) // 3, max(1, len(notes) // 10)
    if len(notes) < 6:
        return math.nan
    return statistics.median(notes[-tenth:]) - statistics.median(notes[third : third + tenth])


def answers(key: str, name: str, seen: Seen, p95_ms: float | None) -> list[Row]:
    """Rows of what some visitors saw."""
    counts, number = seen.counts, len(seen.answers_s)
    strangers = f"{name}: answers of somebody else's run, of {counts['compared']}"
    others = f"{name}: other numbers than run here, of {counts['recomputed']}"
    return [
        Row(f"{key}_answers", f"{name}: answers", number, "", least=1, strict=True),
        Row(f"{key}_rate", f"{name}: answers a second", number / max(seen.seconds, 1e-9), "1/s"),
        Row(f"{key}_p50", f"{name}: median", seen.quantile_ms(50), "ms"),
        Row(f"{key}_p95", f"{name}: 95th percentile", seen.quantile_ms(95), "ms", most=p95_ms),
        Row(f"{key}_slowest", f"{name}: slowest", 1e3 * max(seen.answers_s, default=math.inf), "ms"),
        counted(f"{key}_lost", f"{name}: moves without an answer", counts["lost"]),
        counted(f"{key}_wrong", strangers, counts["wrong"]),
        counted(f"{key}_other", others, counts["other"]),
    ]


def lecture(server: Server, arguments: argparse.Namespace) -> list[Row]:
    """Everybody at once, for the whole time."""
    order = Order(server.port, 60.0 * arguments.minutes, (arguments.shortest, arguments.longest))
    before_mb, began = server.rss_mb(), []
    people = arguments.clients - arguments.browsers
    with memory_noted(server) as notes:

        def ready() -> None:
            notes.clear()
            began.append(server.cpu_s())

        seen, browsers = crowds(order, people, arguments.browsers, ready=ready)
    cpu_ms = 1e3 * (server.cpu_s() - began[0]) / max(1, len(seen.answers_s) + len(browsers.answers_s))
    rows = answers("lecture", f"{people} visitors", seen, 500.0)
    if arguments.browsers:
        rows += answers("browsers", f"{arguments.browsers} browsers", browsers, None)
    most_mb, growth = max(notes or [before_mb]), "memory: growth after the first third"
    time.sleep(arguments.rest)
    left = f"memory for each, {arguments.rest:g} s after all have left"
    left_mb = (server.rss_mb() - before_mb) / arguments.clients
    each_mb = (most_mb - before_mb) / arguments.clients
    return [
        *rows,
        Row("lecture_cpu", "processor time of an answer, everything included", cpu_ms, "ms"),
        Row("before_mb", "memory before the visitors", before_mb, "MB"),
        Row("each_mb", "memory for each visitor, at most", each_mb, "MB", most=25.0),
        Row("growth_mb", growth, growth_mb(notes), "MB", most=0.1 * most_mb),
        Row("left_mb", left, left_mb, "MB", most=5.0),
    ]


def alone(server: Server, _: argparse.Namespace) -> list[Row]:
    """One visitor."""
    seen = beside(Order(server.port, BESIDE_S, (0.5, 2.0)), None, 0, 0.0, 700_000)
    return answers("alone", "one visitor alone", seen, None)


def cost(server: Server, _: argparse.Namespace) -> list[Row]:
    """Processor time of one answer, and how many a server gives."""
    drag_ms, pause_ms = dragging(server.port, server.cpu_s, 8.0), pausing(server.port, server.cpu_s, 6)
    busy = crowds(Order(server.port, BESIDE_S, (0.0, 0.0), check=False), 10, first=500_000)[0]
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
        ("slider_flood", "one who floods a slider", flood_of_a_slider, 1, 8.0),
        ("command_flood", "one who floods commands", flood_of_commands, 1, 8.0),
        ("searches", "four who search in loops", searches, 1, 15.0),
        ("studies", "one who runs studies", studies, 1, 8.0),
        ("left_behind", "visitors who begin a search and leave", left_behind, 1, 15.0),
    ]
    if arguments.long:
        processes, settle_s = arguments.long // _LONG_PER_PROCESS, 8.0 + 0.25 * arguments.long
        attacks.append(("long_runs", f"{arguments.long} long runs", long_runs, processes, settle_s))
    rows = []
    for number, (key, name, attack, processes, settle_s) in enumerate(attacks):
        first = 600_000 + 20_000 * number
        by_itself = beside(order, None, 0, 0.0, first)
        under_way: list[float] = []
        ready = lambda counts=under_way: counts.append(long_under_way(server.port))  # noqa: E731
        seen = beside(order, attack, processes, settle_s, first + 10_000, ready)
        for hundredth, which in ((50, "median"), (95, "95th percentile")):
            own, other = by_itself.quantile_ms(hundredth), seen.quantile_ms(hundredth)
            what = f"beside {name}: {which} {other:.0f} ms, times alone"
            most = _BESIDE_STUDY if attack is studies else 2.0
            rows.append(Row(f"{key}_p{hundredth}", what, other / own, "", most=most))
        rows.append(counted(f"{key}_lost", f"beside {name}: moves without an answer", seen.counts["lost"]))
        if attack is long_runs:
            what, least = f"of {arguments.long} long runs, under way or waiting", 0.9 * arguments.long
            rows.append(Row(f"{key}_count", what, under_way[0], "", None, least, strict=True))
        time.sleep(3.0)
    return rows


def coming_and_going(server: Server, arguments: argparse.Namespace) -> list[Row]:
    """Many who open the page and leave."""
    before_mb = server.rss_mb()
    connects(server.port, arguments.connects)
    time.sleep(arguments.rest)
    what = f"memory: growth by {arguments.connects} visitors who came and left"
    return [
        Row("connects_mb", what, server.rss_mb() - before_mb, "MB", most=100.0),
        Row("connects_threads", "threads of the server then", server.threads(), "", most=64.0),
    ]


_PARTS = (alone, cost, lecture, fairness, coming_and_going)


def measure(arguments: argparse.Namespace) -> list[Row]:
    """All rows, or those of some parts; each part is told as it ends."""
    rows: list[Row] = []
    print("\n".join(HEAD), flush=True)
    with Server(arguments.workers) as server:
        time.sleep(5.0)  # the kernels are loaded behind the first page
        for part in (each for each in _PARTS if each.__name__ in (arguments.parts or each.__name__)):
            try:
                fresh = part(server, arguments)
            except (TimeoutError, threading.BrokenBarrierError, queue.Empty, OSError) as error:
                fresh = [counted("not_ended", f"not ended: {type(error).__name__}: {error}"[:62], 1.0)]
            rows += fresh
            print("\n".join(row.line for row in fresh), flush=True)
    return rows


def circumstances_of(arguments: argparse.Namespace) -> str:
    """Describe the measurement, its place and time in one line."""
    return (
        f"{arguments.clients} visitors, {arguments.browsers} of them browsers, {arguments.minutes:g} min; "
        f"{arguments.workers} server process{'es' * (arguments.workers > 1)}; "
        f"{machine()}"
    )


def main() -> None:
    """Measure and print the table; exit with 1 when an answer was lost or belonged to somebody else."""
    parser = argparse.ArgumentParser(description=__doc__)
    for name, value, about in (
        ("--clients", 30, "visitors of the lecture"),
        ("--browsers", 3, "how many of them are headless Chromium"),
        ("--minutes", 3.0, "length of the lecture"),
        ("--workers", 1, "as of schuler serve"),
        ("--shortest", 0.5, "pause between two moves, s"),
        ("--longest", 2.0, "the same"),
        ("--long", 40, "visitors with a long run each; 0: none"),
        ("--connects", 400, "visitors who come and leave"),
        ("--rest", 20.0, "pause after all have left, s"),
    ):
        parser.add_argument(name, type=type(value), default=value, help=about)
    parts = [part.__name__ for part in _PARTS]
    parser.add_argument("--parts", nargs="+", choices=parts, help="only these; by default all")
    parser.add_argument("--json", type=Path, help="file for the rows")
    arguments = parser.parse_args()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(3))  # the way that ends server and visitors too
    patience_s = 60.0 * arguments.minutes + 1500.0
    alarm = threading.Timer(patience_s, _give_up, [patience_s])
    alarm.daemon = True
    alarm.start()
    began, circumstances = time.monotonic(), circumstances_of(arguments)
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


if __name__ == "__main__":
    main()
