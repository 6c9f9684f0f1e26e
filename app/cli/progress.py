"""A progress bar on stderr that shows up only when a run takes long enough to wonder."""

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import TracebackType
from typing import TYPE_CHECKING, Self

from navcore.foundation.compiled import COMPILATION
from navcore.foundation.errors import InputError
from navcore.foundation.visible import visible
from schuler_bench.cli.stop import stop_on_signal
from schuler_bench.cli.terminal import on_terminal

if TYPE_CHECKING:
    from rich.progress import Progress, TaskID

_APPEARS_AFTER_S = 0.5


@contextmanager
def working(
    title: str, quiet: bool, source: str | None = None
) -> Iterator[tuple[Callable[[float], None], Callable[[], bool]]]:
    """Give ``progress(fraction)``, shown on a terminal, and ``stopped()``, which Ctrl-C makes True.

    Parameters
    ----------
    title : str
        Shown beside the bar.
    quiet : bool
        No bar.
    source : str, optional
        What a fault of the input is located in.
    """
    with stop_on_signal() as stopped, Bar(title, on_terminal() and not quiet) as bar:
        try:
            yield bar.advance, stopped
        except InputError as error:
            raise error if source is None else error.located(source) from None


def compiling() -> str:
    """Say which kernel is being compiled, and for how long; empty when there is none."""
    name, seconds = COMPILATION.under_way()
    return f"compiling {name}, {seconds:.0f} s" if name else ""


class Bar:
    """Progress of one run; shown (and its library imported) only after half a second.

    Parameters
    ----------
    title : str
        Shown beside the bar, as plain text.
    show : bool
        False: never shown.
    """

    def __init__(self, title: str, show: bool) -> None:
        self._title = visible(title)
        self._fraction = 0.0
        self._compiled = COMPILATION.count, COMPILATION.seconds
        self._bar: tuple[Progress, TaskID] | None = None
        self._lock = threading.Lock()
        self._timer = threading.Timer(_APPEARS_AFTER_S, self._appear) if show else None

    def __enter__(self) -> Self:
        if self._timer is not None:
            self._timer.daemon = True
            self._timer.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._timer is not None:
            self._timer.cancel()
        with self._lock:
            self._timer = None
            if self._bar is None:
                return
            progress = self._bar[0]
            progress.stop()
        compiled = COMPILATION.count - self._compiled[0]
        if compiled:
            seconds = COMPILATION.seconds - self._compiled[1]
            kernels = "kernel" if compiled == 1 else "kernels"
            progress.console.print(f"compiled {compiled} {kernels} in {seconds:.0f} s; kept for later runs")

    def advance(self, fraction: float) -> None:
        """Tell the fraction done, 0..1; from any thread."""
        self._fraction = fraction
        if self._bar is not None:
            progress, task = self._bar
            progress.update(task, completed=fraction)

    def _appear(self) -> None:
        from rich.console import Console
        from rich.progress import (
            BarColumn,
            Progress,
            ProgressColumn,
            TextColumn,
            TimeElapsedColumn,
            TimeRemainingColumn,
        )
        from rich.text import Text

        class _Compiling(ProgressColumn):
            def render(self, task: object) -> Text:
                return Text(compiling())

        with self._lock:
            if self._timer is None:
                return
            progress = Progress(
                TextColumn("{task.description}", markup=False),
                _Compiling(),
                BarColumn(),
                TextColumn("{task.percentage:>3.0f} %", markup=False),
                TimeElapsedColumn(),
                TimeRemainingColumn(),
                console=Console(stderr=True),
                transient=True,
            )
            task = progress.add_task(self._title, total=1.0)
            progress.update(task, completed=self._fraction)
            self._bar = (progress, task)
            progress.start()
