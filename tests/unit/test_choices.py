"""Words of the choosers: each value of a field is told from the others, and read back."""

import pytest
from pydantic import BaseModel

from navcore.foundation.parameters import Parameters
from navcore.law.policy import POLICIES
from navcore.law.switching import SWITCHINGS
from navcore.motion import MOTIONS
from navcore.networks import NETWORKS
from navcore.questions import QUESTIONS
from navcore.scenario.model import Scenario
from navcore.scenario.requirement import Requirement
from schuler_bench.editing import form
from schuler_bench.editing.choices import choice_words, chosen

assert issubclass(Scenario, Parameters), "importing it defines the models of all its blocks"
assert all(issubclass(kind, Parameters) for kind in QUESTIONS.values()), "and this those of all questions"


def models(base: type[BaseModel]) -> list[type[BaseModel]]:
    return [kind for inner in base.__subclasses__() for kind in (inner, *models(inner))]


OFFERED = sorted({
    values for model in models(Parameters) for info in model.model_fields.values()
    if model.__module__.partition(".study")[1] == "" and model is not Requirement  # no control shows these
    and (values := form.choices_of(info))
} | {tuple(kinds) for kinds in (NETWORKS, POLICIES, SWITCHINGS, MOTIONS)})  # fmt: skip


@pytest.mark.parametrize("values", OFFERED, ids="-".join)
def test_each_value_has_words_of_its_own_and_is_read_back(values: tuple[str, ...]) -> None:
    words = [choice_words(value) for value in values]
    assert len(set(words)) == len(values)
    assert [chosen(values, word) for word in words] == list(values)
    assert not [word for word in words if "_" in word]


def test_a_value_without_words_stands_as_it_is() -> None:
    assert choice_words("mine") == "mine" and chosen(("mine", "hard"), "mine") == "mine"
