"""Commands that ask a question: made from its fields, with the same options, faults and exit codes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, make_dataclass
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal

from tyro.conf import Positional, UseAppendAction, arg

from navcore.foundation.answers import Answer
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.inputs import noting
from navcore.questions.base import Option, Question, flag_of
from schuler_bench.cli.codes import DONE, STOPPED, WRONG_INPUT
from schuler_bench.cli.terminal import emit_result, say

_SET = "Override one field of the scenario first, e.g. method.0.network.xi=0.5."
_OUT = {"file": "File for {what}.", "folder": "Folder for {what}."}
FORCE = "Let {flag} replace a file that this command has not written, or that was edited since."
_METAVARS = {"file": "FILE", "folder": "DIR"}


@dataclass(frozen=True)
class AskingCommand:
    """Ask a question and print its answer."""

    asked: ClassVar[type[Question]]

    def execute(self) -> int:
        """Answer and print; 3 when it was stopped, or a method diverged."""
        given: Mapping[str, Any] = vars(self)
        with noting() as reads:
            question = self.asked.ask(self._fields(given))
        self._free(question, given, reads)
        refused = [*question.refusals()]
        for text in refused:
            say(f"{self._source(given)}: {text}")
        answer = self._answered(question, given, reads)
        self._written(question, answer, given, reads)
        emit_result(given["json"], answer.document(), answer.lines)
        for text in answer.complaints():
            say(f"{self._source(given)}: {text}")
        if not answer.complete:
            say(f"{self._source(given)}: stopped; {answer.so_far}")
        if answer.failed or not answer.complete:
            return STOPPED
        # a method of the scenario itself is wrong input, though the others were asked
        return (
            WRONG_INPUT
            if refused and self.asked.subject == "scenario" and question.scenario.refused
            else DONE
        )

    def _free(self, question: Question, given: Mapping[str, Any], reads: list[Any]) -> None:
        """Refuse places for what it writes before the work."""
        force = given.get("force", False)
        if (place := given.get(self.asked.place)) is not None:
            question.require_free(place, reads, force=force)
        question.require_beside(reads, force=force)

    def _written(
        self, question: Question, answer: Answer, given: Mapping[str, Any], reads: list[Any]
    ) -> None:
        """Write what ``--out``, or the option in its place, and other options ask for."""
        force = given.get("force", False)
        if (place := given.get(self.asked.place)) is not None:
            question.write(answer, place, reads, force=force)
        question.write_beside(answer, reads, force=force)

    def _answered(self, question: Question, given: Mapping[str, Any], reads: list[Any]) -> Answer:
        """Answer, and show the progress."""
        del reads
        from schuler_bench.cli.progress import working

        with working(self.asked.title.lower(), given["quiet"], self._source(given)) as (progress, stopped):
            return question.answer(progress, stopped)

    def _source(self, given: Mapping[str, Any]) -> str:
        return str(given[self.asked.subject] or self.asked.model_fields["id"].default)

    def _fields(self, given: Mapping[str, Any]) -> dict[str, Any]:
        """Values of the question's fields: those that are not given keep their defaults."""
        from navcore.scenario.file import load

        fields = {one.name: given[one.name] for one in self.asked.options() if given[one.name] is not None}
        subject = given[self.asked.subject]
        if not subject and given.get("set"):
            allowed = "needs a SCENARIO whose field it overrides"
            raise InputError(Fault("", "--set", given["set"][0], allowed))
        if not subject:
            return fields
        if "where" in self.asked.model_fields:
            fields["where"] = subject
        loaded = load(subject, given["set"], apart=self.asked.apart) if "set" in given else subject
        return fields | {self.asked.subject: loaded}


def command_of(
    question: type[Question], base: type[AskingCommand] = AskingCommand, *more: tuple[str, Any, Any]
) -> type[AskingCommand]:
    """Make the command of a question: a dataclass from which tyro reads a command line.

    Parameters
    ----------
    question : type of Question
        Its fields are the options.
    base : type
        What it does with them.
    *more : (str, annotation, default)
        Options beside these.
    """
    subject = question.model_fields[question.subject]
    metavar = question.subject.upper()
    positional = Annotated[Positional[str], arg(metavar=metavar, help=subject.description)]
    first = ... if subject.is_required() else subject.default
    rows: list[tuple[str, Any, Any]] = [(question.subject, positional, first)]
    rows += [(one.name, _annotation(one), _default(one)) for one in question.options()]
    if question.subject == "scenario":
        rows.append(("set", UseAppendAction[_with(tuple[str, ...], "KEY=VALUE", _SET)], ()))
    if question.writes:
        words = _OUT[question.writes].format(what=question.written)
        rows.append((question.place, _with(Path | None, _METAVARS[question.writes], words), None))
    if question.writes == "file":
        rows.append(("force", Annotated[bool, arg(help=FORCE.format(flag=flag_of(question.place)))], False))
    rows += more
    rows.append(("json", Annotated[bool, arg(help="Print one JSON document.")], False))
    rows.append(("quiet", Annotated[bool, arg(help="No progress bar.")], False))
    # what has no default stands first
    rows.sort(key=lambda row: row[2] is not ...)
    made = make_dataclass(
        f"{question.__name__}Command",
        [
            (name, kind) if default is ... else (name, kind, field(default=default))
            for name, kind, default in rows
        ],
        bases=(base,),
        namespace={"asked": question, "__doc__": str(question.help)},
        frozen=True,
    )
    return made


def _annotation(one: Option) -> Any:
    if one.kind == "flag":
        return Annotated[bool, arg(help=one.help)]
    plain: Any = {"whole": int, "number": float, "text": str}.get(one.kind) or Literal[one.choices]
    words = f"{one.help} One of {', '.join(one.choices)}." if one.choices else one.help
    if one.many:
        return UseAppendAction[_with(tuple[plain, ...], one.metavar, words)]
    return _with(plain | None if one.default is None else plain, one.metavar, words, one.flag.lstrip("-"))


def _default(one: Option) -> Any:
    return () if one.many and one.default is not ... else one.default


def _with(kind: Any, metavar: str, words: str, name: str | None = None) -> Any:
    return Annotated[kind, arg(name=name, metavar=metavar, help=words)]
