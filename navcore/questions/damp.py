"""Damp: the output of a ship's own INS as it would be with a method's damping, in the form that came in."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar, Literal

from navcore.foundation.answers import Answer, Column, Table
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.out import PathLike, placing, require_folder, utf8
from navcore.foundation.text import Text
from navcore.quantities import HEADING, POSITION, VELOCITY
from navcore.questions.base import Cancelled, Progress, Question, Writes, option, unless_stopped


@dataclass(frozen=True)
class Damped(Answer):
    """Files of an INS with the damped output in them.

    Attributes
    ----------
    method : str
        Whose damping it is.
    files : dict
        Text by name.
    largest : dict
        Largest change of position (m), velocity (m/s) and heading (rad).
    """

    method: str
    files: Mapping[str, str]
    largest: Mapping[str, float]

    def document(self) -> dict[str, Any]:
        """Return what ``--json`` prints."""
        return {"method": self.method, "files": list(self.files), "largest_change": dict(self.largest)}

    def rows(self) -> Iterator[Table | str]:
        """Give the files, and by how much the output moves at most."""
        yield Text(
            "{method}: the output moves by at most {position:.4g} m, {velocity:.3g} m/s",
            method=self.method,
            position=self.largest[POSITION.figure],
            velocity=self.largest[VELOCITY.figure],
        )
        counted = tuple((name, text.count("\n")) for name, text in self.files.items())
        yield Table((Column(Text("file")), Column(Text("lines"))), counted)


class DampQuestion(Question):
    """A ship's INS as it would have been damped, as a recording."""

    title: ClassVar[str] = Text("Damp")
    help: ClassVar[str] = Text(
        "Write the output of a ship's own INS as a method would have damped it: the same files, columns and "
        "sentences."
    )
    keeps: ClassVar[bool] = False
    writes: ClassVar[Writes] = "folder"
    written: ClassVar[str] = Text("the files of [ins] with the damped output, by their own names")
    stopped: ClassVar[str] = Text("Stopped: nothing was written.")
    example: ClassVar[str] = """\
>>> from navcore import damp, load
>>> damp(load("zha-fast"))  # not on the output of an INS
Traceback (most recent call last):
    ...
navcore.foundation.errors.InputError: ins: is needed: the output of a ship's own INS"""
    id: Literal["damp"] = "damp"
    method: str = option(
        "",
        label=Text("method"),
        metavar="NAME",
        help=Text("Whose damping; may be left out where there is only one method."),
    )

    def answer(self, progress: Progress | None = None, cancelled: Cancelled | None = None) -> Damped:
        """Run, and write the files."""
        from navcore.engine.damped_recording import damped_files
        from navcore.engine.simulation import simulate

        if not self.scenario.on_ins:
            raise InputError(Fault("", "ins", None, Text("is needed: the output of a ship's own INS")))
        names = [one.name for one in self.scenario.method]
        if self.method not in names and (self.method or len(names) > 1):
            allowed = Text("must be one of {names}", names=", ".join(names))
            raise InputError(Fault("", "--method", self.method or None, allowed))
        chosen = names.index(self.method) if self.method else 0
        alone = self.scenario.model_copy(update={"method": (self.scenario.method[chosen],)})
        run = simulate(alone, progress, cancelled)
        unless_stopped(cancelled)
        (method,) = run.methods
        moved = method.moved
        assert moved is not None
        largest = {
            POSITION.figure: float(abs(moved[:, 5] + 1j * moved[:, 6]).max()),
            VELOCITY.figure: float(abs(moved[:, 3] + 1j * moved[:, 4]).max()),
            HEADING.figure: float(abs(moved[:, 2]).max()),
        }
        return Damped(method.method.name, damped_files(run, method), largest)

    def _names(self) -> list[str]:
        file = self.scenario.ins.file
        names = () if file is None else (file,) if isinstance(file, str) else file
        return [Path(name).name for name in names]

    def require_free(self, out: Path, reads: Iterable[PathLike] = (), *, force: bool = False) -> None:
        """Refuse a folder in which a file of these names cannot be replaced; the INS's own never is."""
        del force
        require_folder(out, self._names(), [*reads, *self.recordings()])

    def write(
        self, answer: Answer, out: Path, reads: Iterable[PathLike] = (), *, force: bool = False
    ) -> None:
        """Write the files."""
        del force
        files: Mapping[str, str] = vars(answer)["files"]
        with placing(out, tuple(files), [*reads, *self.recordings()]) as hidden:
            for name, text in files.items():
                (hidden / name).write_bytes(utf8(text))
