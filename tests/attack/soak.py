"""A lecture: N visitors who move a control now and then, for some minutes; what they saw, and the memory.

    python -m tests.attack.soak --clients 30 --minutes 30        # make soak CLIENTS=30 MINUTES=30

Every visitor moves a slider of their own scenario to a value that nobody else uses, and looks for that value
in the scenario text that comes back with the answer: an answer of somebody else's run counts as wrong.
Everything goes to 127.0.0.1. The load makers run in processes of their own.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import random
import re
import statistics
import sys
import threading
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from app.bench.process import Server
from app.bench.visitor import PAGE_STATE, Visitor

WINDOW = "1920x1080|Method|Frequency|Errors|Scenario"
ANSWER_S = 30.0
_PER_PROCESS = 8
_ZETA = re.compile(r"zeta = ([0-9.]+)")


@dataclass
class Seen:
    """What some visitors saw."""

    answers_s: list[float] = field(default_factory=list)
    lost: int = 0
    wrong: int = 0
    compared: int = 0

    def add(self, other: Seen) -> None:
        self.answers_s += other.answers_s
        self.lost += other.lost
        self.wrong += other.wrong
        self.compared += other.compared

    def line(self, name: str, seconds: float) -> dict[str, Any]:
        if len(self.answers_s) < 2:
            return {"what": name, "failed": 1, "answers": len(self.answers_s), "lost": self.lost}
        hundredths = statistics.quantiles(self.answers_s, n=100, method="inclusive")
        return {
            "what": name,
            "failed": self.lost + self.wrong + (self.compared == 0),
            "answers": len(self.answers_s),
            "answers_per_s": round(len(self.answers_s) / seconds, 1),
            "p50_ms": round(1e3 * hundredths[49]),
            "p95_ms": round(1e3 * hundredths[94]),
            "max_ms": round(1e3 * max(self.answers_s)),
            "lost": self.lost,
            "wrong": f"{self.wrong} of {self.compared}",
        }


def drag(port: int, number: int, seconds: float, pause_s: tuple[float, float], seen: Seen) -> None:
    """One visitor: moves zeta to values of their own, and waits for each answer."""
    chance = random.Random(number)
    with Visitor(port, f"soak-visitor-{number:06d}") as visitor:
        visitor.set(PAGE_STATE, WINDOW)
        visitor.wait(lambda: visitor.run_number >= 1, "its first run", 120.0)
        visitor.control("zeta")
        until, step = time.monotonic() + seconds, 0
        while time.monotonic() < until:
            visitor.rest(chance.uniform(*pause_s))
            step += 1
            # Four decimals of their own, and never the same twice in a row.
            value = round(0.5 + 0.0001 * ((37 * number + 11 * step) % 3000), 4)
            before = visitor.run_number
            sent = visitor.set("zeta", value)
            try:
                visitor.wait(lambda before=before: visitor.run_number > before, "an answer", ANSWER_S)
            except TimeoutError:
                seen.lost += 1
                continue
            seen.answers_s.append(visitor.arrived_s - sent)
            visitor.rest(0.1)
            shown = {float(text) for text in _ZETA.findall(visitor.text)}
            seen.compared += bool(shown)
            seen.wrong += bool(shown) and value not in shown


def crowd(port: int, numbers: list[int], seconds: float, pause_s: tuple[float, float]) -> Seen:
    """Some visitors in threads of this process."""
    seen = [Seen() for _ in numbers]
    threads = [
        threading.Thread(target=drag, args=(port, number, seconds, pause_s, mine))
        for number, mine in zip(numbers, seen, strict=True)
    ]
    for thread in threads:
        thread.start()
        time.sleep(0.1)
    for thread in threads:
        thread.join()
    together = Seen()
    for mine in seen:
        together.add(mine)
    return together


def crowds(port: int, clients: int, seconds: float, pause_s: tuple[float, float], first: int = 0) -> Seen:
    """All visitors, a few to a process."""
    numbers = list(range(first, first + clients))
    parts = [numbers[at : at + _PER_PROCESS] for at in range(0, clients, _PER_PROCESS)]
    together = Seen()
    with multiprocessing.get_context("spawn").Pool(len(parts)) as pool:
        for seen in pool.starmap(crowd, [(port, part, seconds, pause_s) for part in parts]):
            together.add(seen)
    return together


def flood(port: int, ended: threading.Event, number: int = 900_000) -> None:
    """A visitor who moves a slider as fast as the connection takes it, without waiting for any answer."""
    with Visitor(port, f"soak-visitor-{number}") as visitor:
        visitor.set(PAGE_STATE, WINDOW)
        visitor.wait(lambda: visitor.run_number >= 1, "its first run", 120.0)
        visitor.control("zeta")
        step = 0
        while not ended.is_set():
            for _ in range(50):
                step += 1
                visitor.set("zeta", round(0.5 + 0.0001 * (step % 3000), 4))
            visitor.rest(0.05)


def long_run(port: int, ended: threading.Event, number: int, hours: float) -> None:
    """A visitor whose every run takes long, and who starts it again and again."""
    with Visitor(port, f"soak-visitor-{800_000 + number}") as visitor:
        visitor.set(PAGE_STATE, WINDOW)
        visitor.wait(lambda: visitor.run_number >= 1, "its first run", 120.0)
        visitor.set("duration (h), exact", hours)
        step = 0
        while not ended.is_set():
            visitor.rest(3.0)
            step += 1
            visitor.set("zeta", round(0.5 + 0.001 * (step % 300), 3))


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


def measure(arguments: argparse.Namespace) -> list[dict[str, Any]]:
    """The lines of the report."""
    pause_s, lines = (arguments.shortest, arguments.longest), []
    with Server() as server:
        alone = crowds(server.port, 1, min(20.0, 60.0 * arguments.minutes), pause_s, first=700_000)
        lines.append(alone.line("one visitor alone", min(20.0, 60.0 * arguments.minutes)))
        before_mb = server.rss_mb()
        memory = Memory(server)
        memory.start()
        seconds, cpu_s = 60.0 * arguments.minutes, server.cpu_s()
        seen = crowds(server.port, arguments.clients, seconds, pause_s)
        memory.ended.set()
        lines.append(seen.line(f"{arguments.clients} visitors", seconds))
        lines[-1]["cpu_ms_per_answer"] = round(1e3 * (server.cpu_s() - cpu_s) / max(1, len(seen.answers_s)))
        time.sleep(arguments.rest)
        third = memory.mb[len(memory.mb) // 3 :] or [before_mb]
        lines.append(
            {
                "what": "memory of the server, MB",
                "before": round(before_mb),
                "after a third": round(third[0]),
                "at the end": round(third[-1]),
                "most": round(max(memory.mb or [before_mb])),
                "per visitor": round((max(third) - before_mb) / arguments.clients, 1),
                f"{arguments.rest:g} s after all have left": round(server.rss_mb()),
            }
        )
        attacks: dict[str, list[Any]] = {"one who floods": [(flood, ())]}
        if arguments.long:
            attacks[f"{arguments.long} long runs"] = [(long_run, (i, 400.0)) for i in range(arguments.long)]
        for name, attackers in attacks.items():
            lines.append(beside(server.port, f"beside {name}", attackers, pause_s))
    return lines


def beside(port: int, name: str, attackers: list[Any], pause_s: tuple[float, float]) -> dict[str, Any]:
    """What one visitor sees beside others who take what they can."""
    ended = threading.Event()
    threads = [
        threading.Thread(target=attack, args=(port, ended, *more), daemon=True) for attack, more in attackers
    ]
    for thread in threads:
        thread.start()
    time.sleep(5.0)
    seen = crowds(port, 1, 20.0, pause_s, first=600_000)
    ended.set()
    for thread in threads:
        thread.join(10.0)
    return seen.line(f"one visitor {name}", 20.0)


def main() -> int:
    """Measure and report; 1 when an answer was lost or belonged to somebody else."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--clients", type=int, default=30)
    parser.add_argument("--minutes", type=float, default=3.0)
    parser.add_argument("--shortest", type=float, default=0.5, help="pause between two moves, s")
    parser.add_argument("--longest", type=float, default=2.0)
    parser.add_argument("--long", type=int, default=8, help="visitors with a long run each; 0: none")
    parser.add_argument("--rest", type=float, default=20.0, help="pause after all have left, s")
    parser.add_argument("--json", type=Path, help="file for the figures")
    arguments = parser.parse_args()
    lines = measure(arguments)
    for line in lines:
        print("  ".join(f"{name} {value}" if name != "what" else f"{value}:" for name, value in line.items()))
    if arguments.json:
        arguments.json.write_text(json.dumps(lines, indent=2) + "\n")
    return int(any(line.get("failed") for line in lines))


if __name__ == "__main__":
    sys.exit(main())
