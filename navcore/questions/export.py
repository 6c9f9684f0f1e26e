"""Export: the law of a method as files for a navigation computer."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, Literal

from navcore.foundation.answers import Answer
from navcore.foundation.out import PathLike, placing, refused, require_folder, utf8, writing
from navcore.foundation.parameters import quantity
from navcore.foundation.text import Text
from navcore.questions.base import Cancelled, Progress, Question, Writes, option, unless_stopped

if TYPE_CHECKING:
    from navcore.exporting.exported import Exported, Packed


class ExportQuestion(Question):
    """The law of a method as code, with vectors that prove it."""

    title: ClassVar[str] = Text("Export")
    help: ClassVar[str] = Text(
        "Write the law of a method as code for a navigation computer, with test vectors of its scenario."
    )
    keeps: ClassVar[bool] = False
    stopped: ClassVar[str] = Text("Stopped: nothing was exported.")
    writes: ClassVar[Writes] = "folder"
    written: ClassVar[str] = Text("the files: made if need be, else empty")
    example: ClassVar[str] = """\
>>> from navcore import export, load
>>> found = export(load("zha-external"), "classic2", as_="c")
>>> sorted(found.files)
['schuler_law.c', 'schuler_law.h', 'test.c', 'vectors.csv']"""
    id: Literal["export"] = "export"
    method: str = option(
        "",
        label=Text("method"),
        metavar="NAME|N",
        help=Text("Name of the method, or its number from 0; may be left out where there is only one."),
    )
    as_: Literal["c", "matlab", "python", "table", "fmu"] = option(
        "c", label=Text("as"), help=Text("What the files are.")
    )
    rate: float | None = quantity(
        None,
        unit="Hz",
        ge=0.1,
        le=200.0,
        label=Text("rate of the law"),
        help=Text("Calls of the law a second; as the scenario runs it where none is given."),
    )
    single: bool = option(
        False,
        label=Text("single precision"),
        help=Text("Numbers of single precision; what rounding does over the scenario is told."),
    )
    outside: bool = option(
        False,
        label=Text("from outside"),
        help=Text(
            "A box beside an INS: its output and the log go in, the damped output comes out; in place of a "
            "law in the loop."
        ),
    )
    name: str = option(
        "schuler_law",
        label=Text("name in the files"),
        metavar="PREFIX",
        help=Text("Begins the names of files, functions and types."),
    )
    as_archive: bool = option(False, hidden=True)

    def answer(
        self, progress: Progress | None = None, cancelled: Cancelled | None = None
    ) -> "Exported | Packed":
        """Read the law, and replay the scenario."""
        from navcore.exporting.exported import exported

        found = exported(
            self.scenario,
            self.method,
            target=self.as_,
            rate_hz=self.rate,
            single=self.single,
            outside=self.outside,
            prefix=self.name,
        )
        unless_stopped(cancelled)
        return found.packed() if self.as_archive else found

    def require_free(self, out: Path, reads: Iterable[PathLike] = (), *, force: bool = False) -> None:
        """Refuse a folder in which there is something already: files of two exports must not mix."""
        del force
        require_folder(out, (), reads)
        with writing(out):
            if out.is_dir() and any(out.iterdir()):
                raise refused(out, Text("is not empty: give a folder that is empty or does not exist"))

    def write(
        self, answer: Answer, out: Path, reads: Iterable[PathLike] = (), *, force: bool = False
    ) -> None:
        """Write the files."""
        self.require_free(out, reads, force=force)
        files: Mapping[str, str | bytes] = vars(answer)["files"]
        with placing(out, tuple(files), [*reads, *self.recordings()]) as hidden:
            for name, content in files.items():
                (hidden / name).write_bytes(content if isinstance(content, bytes) else utf8(content))
