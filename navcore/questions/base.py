"""What the bench is asked: one frozen parameter model a question, from which everything else is made.

The command, the panel of the page, the job in the background, the task of a cluster, the function of a
notebook and the reference page take fields, ranges and help from the model. A question is one file and one
line of `navcore.questions`.
"""

from __future__ import annotations

import types
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, Union, get_args, get_origin

from pydantic import BeforeValidator, Field, ValidationError
from pydantic.fields import FieldInfo

from navcore.foundation.answers import Answer
from navcore.foundation.errors import Fault, InputError, StoppedError
from navcore.foundation.faults import faults_from
from navcore.foundation.out import PathLike, placing, require_file, require_folder, utf8, write_file
from navcore.foundation.parameters import Parameters, extra_of
from navcore.foundation.text import Text

if TYPE_CHECKING:
    from navcore.scenario.model import Scenario

Progress = Callable[[float], None]
Cancelled = Callable[[], bool]
Kind = Literal["flag", "whole", "number", "choice", "text"]
Writes = Literal["", "file", "folder"]


def loaded(value: Any, *, apart: bool = False) -> Any:
    """Scenario of a name or file; imported only now, so that a command line is read at once."""
    from navcore.scenario.file import load
    from navcore.scenario.model import Scenario

    if isinstance(value, Scenario):
        return value
    if isinstance(value, str | Path):
        return load(str(value), apart=apart)
    raise InputError(Fault("", "", value, Text("must be a scenario, the name of a preset, or a TOML file")))


if TYPE_CHECKING:
    Asked = Scenario
else:
    Asked = Annotated[Any, BeforeValidator(loaded)]
    """Type of a field that holds a scenario: itself, the name of a preset, or a file."""


def option(default: Any, *, label: str = "", help: str = "", metavar: str = "", hidden: bool = False) -> Any:
    """Declare a field of a question that is no number: a text, a choice, a flag, or several texts.

    Parameters
    ----------
    default : object
        Default value; ``...`` for none.
    label, help : str
        Name on the page, and what it does.
    metavar : str
        Stands for a value in the help of the command line.
    hidden : bool
        The program gives it: no option of the command line, no parameter of the function.

    Returns
    -------
    pydantic field declaration.
    """
    extra: dict[str, Any] = {name: text for name, text in (("label", label), ("metavar", metavar)) if text}
    extra |= {"hidden": True} if hidden else {}
    return Field(default=default, description=help or None, json_schema_extra=extra or None)


@dataclass(frozen=True)
class Option:
    """One field of a question, as a command line or a signature shows it.

    Attributes
    ----------
    name : str
        Of the field.
    kind : {"flag", "whole", "number", "choice", "text"}
        What one value is.
    default : object
        Default value; ``...`` where one is required.
    many : bool
        It takes several values.
    choices : tuple of str
        Of a "choice".
    help, metavar, label : str
        As declared.
    """

    name: str
    kind: Kind
    default: Any
    many: bool
    choices: tuple[str, ...]
    help: str
    metavar: str
    label: str

    @property
    def flag(self) -> str:
        """As it is given on the command line."""
        return flag_of(self.name if self.default is not True else f"no_{self.name}")


def flag_of(name: str) -> str:
    """Option of the command line for a field.

    Examples
    --------
    >>> flag_of("default_limits"), flag_of("as_")
    ('--default-limits', '--as')
    """
    return f"--{name.rstrip('_').replace('_', '-')}"


class Question(Parameters):
    """Base of all questions.

    Attributes
    ----------
    title : str
        Its name on the page, and beside a progress bar.
    help : str
        What it gives, in one sentence.
    function : str
        Name of the function of `navcore` that asks it; by default that of the command.
    subject : str
        Name of the field that says of what it is asked.
    takes : str
        What that is, for the docstring of the function.
    example : str
        Of the function, for its docstring.
    writes, written : str
        What ``--out`` is ("file", "folder" or ""), and what is written there.
    place : str
        Name of the option in the place of ``--out``.
    files : tuple of str
        Names of the files that it writes; of a "file" its kind, for the user names it.
    keeps : bool
        What a stopped question has found so far is an answer.
    spare : bool
        Nobody waits for it: it is answered only beside everything else, never on a cluster.
    still_s : float
        Where it follows the page: time for which nothing newer must have been asked before it is begun.
    apart : bool
        Methods that the rest of the scenario refuses are left out, and it is asked of the others.
    stopped : str
        What is said where it was stopped and nothing was found.
    scenario : Scenario
        Of what it is asked.
    """

    title: ClassVar[str] = ""
    help: ClassVar[str] = ""
    function: ClassVar[str] = ""
    subject: ClassVar[str] = "scenario"
    takes: ClassVar[str] = "Scenario, or str"
    example: ClassVar[str] = ""
    writes: ClassVar[Writes] = ""
    place: ClassVar[str] = "out"
    written: ClassVar[str] = ""
    files: ClassVar[tuple[str, ...]] = ()
    keeps: ClassVar[bool] = True
    spare: ClassVar[bool] = False
    still_s: ClassVar[float] = 0.0
    apart: ClassVar[bool] = False
    stopped: ClassVar[str] = Text("Stopped: nothing was found.")
    scenario: Asked = option(..., metavar="SCENARIO", help=Text("Name of a preset, or a TOML file."))

    @classmethod
    def ask(cls, data: Mapping[str, Any]) -> Any:
        """Make a question of values as they were given.

        Raises
        ------
        InputError
            One fault a field; it is named as on the command line.
        """
        try:
            given = dict(data)
            if cls.apart and isinstance(given.get("scenario"), str):
                given["scenario"] = loaded(given["scenario"], apart=True)
            return cls.model_validate(given)
        except ValidationError as error:
            raise InputError(_faults(error, cls, dict(data))) from None
        except UnicodeEncodeError as error:  # a path that is no UTF-8, which pydantic cannot quote
            raise InputError(Fault("", cls.subject, error.object, Text("is no UTF-8 text"))) from None

    @classmethod
    def options(cls) -> tuple[Option, ...]:
        """Fields beside the subject, in order."""
        return tuple(
            _option(name, info)
            for name, info in cls.model_fields.items()
            if name not in ("id", cls.subject) and not extra_of(info).get("hidden")
        )

    def answer(self, progress: Progress | None = None, cancelled: Cancelled | None = None) -> Answer:
        """Answer it.

        Parameters
        ----------
        progress : callable, optional
            Told the fraction done, 0..1.
        cancelled : callable, optional
            Asked often; True ends the work.

        Raises
        ------
        InputError
            It cannot be answered.
        StoppedError
            It was stopped before there was an answer.
        """
        raise NotImplementedError

    @property
    def load(self) -> Scenario:
        """Scenario whose size says what it takes, and whose files must be at hand where it is answered."""
        return self.scenario

    def refusals(self) -> Iterable[str]:
        """Give methods that are not asked of, or not everywhere, and why: told before the work."""
        return [one.line for one in self.scenario.refused] if self.apart else []

    def recordings(self) -> list[str]:
        """Return the paths of the recordings on which its scenarios and studies run, and of their maps."""
        found: list[str] = []
        for value in vars(self).values():
            for one in value if isinstance(value, tuple) else (value,):
                found += _recordings(one)
        return found

    def require_free(self, out: Path, reads: Iterable[PathLike] = (), *, force: bool = False) -> None:
        """Refuse a place for ``--out`` that cannot be written or must not be replaced.

        Parameters
        ----------
        out : Path
            File or folder, see ``writes``.
        reads : iterable of path
            Files that the question was read from; with its recordings they are never replaced.
        force : bool
            Replace a file that this question has not written, too.

        Raises
        ------
        InputError
            See `navcore.foundation.out`.
        """
        kept = [*reads, *self.recordings()]
        if self.writes == "folder":
            require_folder(out, self.files, kept)
        else:
            require_file(out, self._command, kept, force=force, option=flag_of(self.place))

    def write(
        self, answer: Answer, out: Path, reads: Iterable[PathLike] = (), *, force: bool = False
    ) -> None:
        """Write what ``--out`` asks for; see `require_free`."""
        kept = [*reads, *self.recordings()]
        texts = self.texts(answer)
        if self.writes == "folder":
            with placing(out, self.files, kept) as hidden:
                for name, text in texts.items():
                    (hidden / name).write_bytes(utf8(text))
        else:
            (text,) = texts.values()
            write_file(out, text, self._command, kept, force=force, option=flag_of(self.place))

    def require_beside(self, reads: Iterable[PathLike] = (), *, force: bool = False) -> None:
        """Refuse places for files that its own fields name, as `require_free` does for ``--out``."""

    def write_beside(self, answer: Answer, reads: Iterable[PathLike] = (), *, force: bool = False) -> None:
        """Write the files that its own fields name; see `require_beside`."""

    def texts(self, answer: Answer) -> dict[str, str]:
        """Return what ``--out`` asks for: a text by the name of each of ``files``."""
        raise NotImplementedError

    @property
    def _command(self) -> str:
        return str(vars(self)["id"])


def _recordings(value: Any) -> list[str]:
    """Recordings of a scenario or a study; none of anything else."""
    from navcore.scenario import reads
    from navcore.scenario.model import Scenario
    from navcore.study import file
    from navcore.study.model import Study

    if isinstance(value, Scenario):
        return reads.recordings(value)
    return file.recordings(value) if isinstance(value, Study) else []


def unless_stopped(cancelled: Cancelled | None) -> None:
    """Raise `StoppedError` where the work was cancelled."""
    if cancelled is not None and cancelled():
        raise StoppedError(Fault("", "", None, Text("stopped")))


def _faults(error: ValidationError, model: type[Question], data: dict[str, Any]) -> list[Fault]:
    """Faults by option: those that a text has by itself keep their own names."""
    faults: list[Fault] = []
    for item in error.errors(include_url=False):
        cause = (item.get("ctx") or {}).get("error")
        if isinstance(cause, InputError):
            faults += [
                fault if fault.field or fault.where else replace(fault, field=flag_of(str(item["loc"][0])))
                for fault in cause.faults
            ]
    if not faults:
        for fault in faults_from(error, model, data, ""):
            name, _, rest = fault.field.partition(".")
            faults.append(replace(fault, field=f"{flag_of(name)}{'.' * bool(rest)}{rest}"))
    return faults


def _option(name: str, info: FieldInfo) -> Option:
    annotation, many = _plain(info.annotation), False
    if get_origin(annotation) is tuple:
        annotation, many = _plain(get_args(annotation)[0]), True
    many = many or bool(extra_of(info).get("many"))
    choices = tuple(map(str, get_args(annotation))) if get_origin(annotation) is Literal else ()
    kinds: dict[Any, Kind] = {bool: "flag", int: "whole", float: "number"}
    kind: Kind = "choice" if choices else kinds.get(annotation, "text")
    extra = extra_of(info)
    default = ... if info.is_required() else info.default
    metavar = extra.get("metavar") or {"whole": "N"}.get(kind, name.upper())
    label = extra.get("label") or name.replace("_", " ")
    return Option(name, kind, default, many, choices, info.description or "", metavar, label)


def _plain(annotation: Any) -> Any:
    """Annotation without `Annotated` and None."""
    while get_origin(annotation) is Annotated:
        annotation = get_args(annotation)[0]
    if get_origin(annotation) in (Union, types.UnionType):
        rest = [one for one in get_args(annotation) if one is not type(None)]
        return _plain(rest[0]) if len(rest) == 1 else annotation
    return annotation
