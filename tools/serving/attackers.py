"""Visitors of the soak who take what they can, each kind a function for a process of its own."""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING, Any

from schuler_bench.bench.visitor import PAGE_COMMAND
from schuler_bench.views.appearance.view import BANDS
from schuler_bench.views.tune.finder import FIND
from schuler_bench.views.tune.view import SEARCH_FOR
from tests.browser.fields import box_labels
from tools.serving.load import ZETA, opened

if TYPE_CHECKING:
    from multiprocessing.synchronize import Event

_DURATION = box_labels("run.duration_h")[0]
_LONG_RUN_H = 300.0
"""Some seconds of computing, within the memory that a run may take."""
_SEARCH_S = (20, 10, 10, 5)  # after so long each search is begun anew


def flood_of_a_slider(port: int, number: int, ended: Event) -> None:
    """Moves a slider as fast as the connection takes it, without waiting for any answer."""
    _flood(port, number, ended, ZETA, lambda step: round(0.5 + 0.0001 * (step % 3000), 4))


def flood_of_commands(port: int, number: int, ended: Event) -> None:
    """Asks for another run as often as the connection takes it."""
    _flood(port, number, ended, PAGE_COMMAND, lambda step: f'[[{step},"run",""]]')


def _flood(port: int, number: int, ended: Event, label: str, value: Callable[[int], Any]) -> None:
    with opened(port, number) as visitor:
        visitor.control(label)
        steps = itertools.count(1)
        while not ended.is_set():
            for step in itertools.islice(steps, 50):
                visitor.set(label, value(step))
            visitor.rest(0.05)


def long_runs(port: int, number: int, ended: Event, count: int = 10) -> None:
    """Some visitors whose every run takes long, and who start it again and again."""

    def one(place: int) -> None:
        time.sleep(0.1 * place)
        with opened(port, number + place) as visitor:
            visitor.set(_DURATION, _LONG_RUN_H)
            visitor.rest(1.0)
            if visitor.notices:
                raise RuntimeError(f"the long run was refused: {visitor.notices[0]}")
            step = 0
            while not ended.is_set():
                visitor.rest(3.0)
                step += 1
                visitor.set(ZETA, round(0.5 + 0.001 * (step % 300), 3))

    with ThreadPoolExecutor(count) as threads:
        list(threads.map(one, range(count)))


def searches(port: int, number: int, ended: Event) -> None:
    """Visitors who search in loops, one for each search: fronts, setting, verification, bands."""

    def one(place: int) -> None:
        with opened(port, number + place) as visitor:
            if place == 0:
                visitor.set(str(SEARCH_FOR), "Pareto fronts")
            if place == 3:
                visitor.set(str(BANDS), "20 seeds, 5 to 95 %")
            for step in itertools.count(1):
                if place == 0:
                    visitor.set(str(FIND), True)
                elif place == 3:
                    visitor.set(ZETA, round(0.5 + 0.001 * (step % 300), 3))
                else:
                    visitor.ask(("tune", "verify")[place - 1])
                for _ in range(_SEARCH_S[place]):
                    visitor.rest(1.0)
                    if ended.is_set():
                        return

    with ThreadPoolExecutor(len(_SEARCH_S)) as threads:
        list(threads.map(one, range(len(_SEARCH_S))))


def studies(port: int, number: int, ended: Event) -> None:
    """A visitor who runs the study of the scenario over two quantities, again and again."""
    with opened(port, number) as visitor:
        while not ended.wait(0.0):
            visitor.ask("study")
            visitor.rest(12.0)


def left_behind(port: int, number: int, ended: Event) -> None:
    """Visitors who begin a study or a verification and leave, one after the other; nobody comes back."""
    for step in itertools.count():
        with opened(port, number + step) as visitor:
            visitor.ask(("study", "verify")[step % 2])
            visitor.rest(1.0)
        if ended.wait(1.0):
            return
