"""Every question: its command, function, document, tables and reference come from its fields alone."""

import dataclasses
import doctest
import inspect
import json
import pickle

import pytest

import navcore
from navcore.foundation.answers import Answer, Column, Table
from navcore.foundation.errors import InputError, StoppedError
from navcore.foundation.parameters import allowed_range
from navcore.questions import QUESTIONS
from navcore.questions.base import Question
from navcore.questions.functions import function_of, name_of
from navcore.questions.page import PAGE, written
from navcore.study.file import studies
from schuler_bench.cli.asking import command_of
from schuler_bench.cli.parse import parse

pytestmark = pytest.mark.contract
EACH = pytest.mark.parametrize("id", QUESTIONS)


@EACH
def test_the_command_has_the_fields_and_no_other_list(id: str) -> None:
    question = QUESTIONS[id]
    names = {one.name for one in dataclasses.fields(command_of(question))}
    own = {question.subject, *(one.name for one in question.options())}
    assert own <= names and names - own <= {"set", question.place, "force", "scheduler", "json", "quiet"}
    assert (question.place in names) == bool(question.writes)


@EACH
def test_the_help_of_the_command_is_that_of_the_fields(id: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert parse([id, "--help"]) is None
    shown = "".join(c for c in capsys.readouterr().out if c.isalnum())
    for one in QUESTIONS[id].options():
        assert one.help, one.name
        assert "".join(c for c in one.help if c.isalnum()) in shown, one.name
        assert "".join(c for c in one.flag if c.isalnum()) in shown, one.name


@EACH
def test_the_function_says_all_that_it_takes(id: str) -> None:
    question = QUESTIONS[id]
    function = getattr(navcore, name_of(question))
    parameters = list(inspect.signature(function).parameters)
    assert parameters[0] == question.subject and parameters[-2:] == ["progress", "cancelled"]
    assert {*parameters[1:-2]} == {one.name for one in question.options()}
    text = function.__doc__ or ""
    for one in question.options():
        assert f"\n{one.name} : " in text and " ".join(one.help.split()) in " ".join(text.split())
        assert allowed_range(question.model_fields[one.name]) in " ".join(text.split())
    assert "Returns\n-------" in text and "Raises\n------" in text


@EACH
def test_the_example_of_the_function_holds(id: str) -> None:
    function = getattr(navcore, name_of(QUESTIONS[id]))
    tests = doctest.DocTestFinder().find(function, name_of(QUESTIONS[id]), module=False, globs={})
    runner = doctest.DocTestRunner()
    for test in tests:
        runner.run(test)
    assert runner.failures == 0 and runner.tries > 0


@EACH
def test_a_question_can_be_sent_to_a_helper_and_to_a_cluster(id: str) -> None:
    question = QUESTIONS[id]
    assert question.title and question.help
    made = _simple(question)
    again = pickle.loads(pickle.dumps(made))
    assert again == made and again.load == made.load


def test_the_page_is_what_the_questions_say() -> None:
    text = PAGE.read_text("utf-8")
    assert text == written(text), "write it anew: python -m navcore.questions.page"


@EACH
def test_a_value_out_of_range_is_refused_by_its_option(id: str) -> None:
    question = QUESTIONS[id]
    for one in question.options():
        if one.kind != "whole" or one.many:
            continue
        with pytest.raises(InputError) as refused:
            question.ask(_given(question) | {one.name: -(10**9)})
        (fault,) = refused.value.faults
        assert fault.field == f"--{one.name.replace('_', '-')}" and fault.value == -(10**9)
        assert fault.allowed == allowed_range(question.model_fields[one.name])


def _given(question: type[Question]) -> dict[str, object]:
    """Values for the fields that need one."""
    names = (question.subject, *(one.name for one in question.options()))
    return {name: REQUIRED[name] for name in names if name in REQUIRED}


def _simple(question: type[Question]) -> Question:
    return question.ask(_given(question))


REQUIRED: dict[str, object] = {
    "scenario": "liu-networks",
    "objective": "settling_s",
    "vary": ["method.2.network.zeta"],
    "study": next(iter(studies())),
    "recording": "log.csv",
}


# ---------------------------------------------------------------- one question


def test_what_was_assumed_is_said_in_every_form() -> None:
    found = navcore.budget("zha-fast", steady=True)
    fields = ", ".join(found.assumed_zero)
    assert fields and found.document()["assumed_zero"] == [*found.assumed_zero]
    assert f"note: 0 is assumed for {fields}" in found.lines()
    assert f"0 is assumed for {fields}" in found.html()


def test_a_question_that_was_stopped_says_so() -> None:
    with pytest.raises(StoppedError):
        navcore.budget("zha-fast", steady=True, cancelled=lambda: True)


def test_a_name_that_is_no_option_is_refused() -> None:
    with pytest.raises(TypeError, match="unexpected keyword argument 'stedy'"):
        function_of(QUESTIONS["budget"])("zha-fast", stedy=True)
    with pytest.raises(InputError, match="is neither a preset nor a file"):
        navcore.budget("zha-fst")
    with pytest.raises(InputError, match="must be a scenario, the name of a preset"):
        navcore.budget(3)


def test_numbers_in_a_table_are_written_alike_on_a_terminal_and_as_html() -> None:
    class Two(Answer):
        def rows(self):  # type: ignore[no-untyped-def]
            yield "<first>"
            yield Table((Column("a"), Column("b", "m/s", 3)), (("x", 1.23456), ("y", None)), "title")

        def document(self) -> dict[str, object]:
            return {}

    assert Two().lines() == ["<first>", "", "title", "a     b", "    m/s", "x  1.23", "y     -"]
    assert "<p>&lt;first&gt;</p>" in Two().html() and '<td class="sb-n">1.23</td>' in Two().html()
    assert json.dumps(Two().document()) == "{}"


def test_a_function_refuses_as_the_command_does() -> None:
    asked = function_of(QUESTIONS["budget"])
    with pytest.raises(InputError, match="--seeds = 0: must be >= 2"):
        asked("zha-fast", seeds=0)
