"""Worst: the largest errors that a log within a bound can cause, and the log that causes them."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, Literal

from navcore.foundation.answers import Answer
from navcore.foundation.out import PathLike, placing, require_folder, utf8
from navcore.foundation.parameters import quantity
from navcore.foundation.text import Text
from navcore.questions.base import Cancelled, Progress, Question, Writes

if TYPE_CHECKING:
    from navcore.design.worst.result import Worst


class WorstQuestion(Question):
    """The worst that a log can do."""

    title: ClassVar[str] = Text("Worst case")
    help: ClassVar[str] = Text(
        "Largest errors that a log within a bound can cause, and the log that causes them: exact where the "
        "law is linear, else searched."
    )
    stopped: ClassVar[str] = Text("Stopped: no worst case.")
    writes: ClassVar[Writes] = "folder"
    written: ClassVar[str] = Text(
        "the log that causes each error of each method (CSV), and a scenario that plays it: made if need be; "
        "other files in it stay"
    )
    example: ClassVar[str] = """\
>>> from navcore import load, worst
>>> found = worst(load("zha-fast", ["run.duration_h=2"]), log_max=1.0)
>>> found.methods[1].name, found.methods[1].bound
('classic2', 'exact')"""
    id: Literal["worst"] = "worst"
    log_max: float = quantity(
        1.0,
        unit="m/s",
        ge=1e-6,
        le=50.0,
        slider=(0.05, 5.0),
        log=True,
        label=Text("log within"),
        help=Text("Largest error of each axis of the log, in m/s."),
    )
    log_rate: float | None = quantity(
        None,
        unit="m/s2",
        ge=1e-9,
        le=50.0,
        slider=(1e-5, 0.1),
        log=True,
        label=Text("changes by at most"),
        help=Text("Largest change of that error in a second, in m/s². Not given: it may jump."),
    )

    def answer(self, progress: Progress | None = None, cancelled: Cancelled | None = None) -> Worst:
        """Compute it, or search for it."""
        from navcore.design.worst.bounded import worst

        return worst(self.scenario, self.log_max, self.log_rate, progress, cancelled)

    def require_free(self, out: Path, reads: Iterable[PathLike] = (), *, force: bool = False) -> None:
        """Refuse a folder in which a file of its own names cannot be replaced."""
        from navcore.design.worst.written import names_of

        require_folder(out, names_of(self.scenario), [*reads, *self.recordings()])

    def write(
        self, answer: Answer, out: Path, reads: Iterable[PathLike] = (), *, force: bool = False
    ) -> None:
        """Write a log and a scenario for each method and error."""
        from navcore.design.worst.result import Worst
        from navcore.design.worst.written import files_of, names_of

        assert isinstance(answer, Worst)
        with placing(out, names_of(self.scenario), [*reads, *self.recordings()]) as hidden:
            for name, text in files_of(answer.scenario, answer.logs, answer.playable):
                (hidden / name).write_bytes(utf8(text))
