"""Functions of `navcore` that ask a question: their signatures and docstrings are made from its fields."""

import inspect
import textwrap
from collections.abc import Callable
from typing import Any

from navcore.foundation.answers import Answer
from navcore.foundation.parameters import allowed_range
from navcore.questions import QUESTIONS
from navcore.questions.base import Option, Question

_TYPES = {"flag": "bool", "whole": "int", "number": "float", "text": "str"}
_IN = "    "
_WAITED = ("progress", "cancelled")
_REST = """progress : callable, optional
    Told the fraction done, 0..1.
cancelled : callable, optional
    Asked often; True ends the work."""


def function_of(question: type[Question]) -> Callable[..., Answer]:
    """Make the function that asks a question.

    Parameters
    ----------
    question : type of Question
        Its fields are the parameters, the subject first.

    Returns
    -------
    callable
        It returns the question's answer.
    """
    signature = _signature(question)

    def asked(*args: Any, **options: Any) -> Answer:
        given = signature.bind(*args, **options).arguments
        waited = {name: given.pop(name) for name in _WAITED if name in given}
        return question.ask(given).answer(**waited)

    asked.__name__ = asked.__qualname__ = name_of(question)
    asked.__module__ = "navcore"
    asked.__doc__ = _docstring(question)
    vars(asked)["__signature__"] = signature
    return asked


def name_of(question: type[Question]) -> str:
    """Name of the function that asks a question."""
    return question.function or question.model_fields["id"].default


def _signature(question: type[Question]) -> inspect.Signature:
    positional, keyword = inspect.Parameter.POSITIONAL_OR_KEYWORD, inspect.Parameter.KEYWORD_ONLY
    options = sorted(question.options(), key=lambda one: one.default is not ...)
    subject = question.model_fields[question.subject]
    first = inspect.Parameter.empty if subject.is_required() else subject.default
    parameters = [inspect.Parameter(question.subject, positional, default=first)]
    parameters += [inspect.Parameter(one.name, positional, default=_default(one)) for one in options]
    parameters += [inspect.Parameter(name, keyword, default=None) for name in _WAITED]
    return inspect.Signature(parameters)


def _default(one: Option) -> Any:
    return inspect.Parameter.empty if one.default is ... else one.default


def _docstring(question: type[Question]) -> str:
    subject = question.model_fields[question.subject]
    about = [f"{question.subject} : {question.takes}\n    {subject.description}"]
    about += [_parameter(question, one) for one in question.options()]
    returns = question.answer.__annotations__.get("return", "Answer")
    returns = returns if isinstance(returns, str) else returns.__name__
    text = f"""{question.help}

Parameters
----------
{chr(10).join((*about, _REST))}

Returns
-------
{returns}
    ``document()`` is what ``schuler {question.model_fields["id"].default} --json`` prints; as the last line
    of a cell it shows its tables.

Raises
------
InputError
    A value is out of its range, or the question cannot be answered: one fault for each thing wrong.
StoppedError
    It was cancelled before there was an answer.
"""
    return text + (f"\nExamples\n--------\n{question.example}\n" if question.example else "")


def _parameter(question: type[Question], one: Option) -> str:
    kind = f"{{{', '.join(map(repr, one.choices))}}}" if one.choices else _TYPES.get(one.kind, "str")
    kind = f"sequence of {kind}" if one.many else kind
    default = "" if one.default is ... else ", optional"
    allowed = allowed_range(question.model_fields[one.name])
    bounds = f" It {allowed}." if allowed else ""
    given = "" if one.default in (..., None, ()) else f" Default {one.default!r}."
    about = textwrap.fill(f"{one.help}{bounds}{given}", 100, initial_indent=_IN, subsequent_indent=_IN)
    return f"{one.name} : {kind}{default}\n{about}"


FUNCTIONS = {name_of(question): function_of(question) for question in QUESTIONS.values()}
"""Functions by name."""
