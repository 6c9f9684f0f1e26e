"""Right answers to the questions of lessons, and the numbers of which their texts speak."""

import re
from functools import lru_cache

from navcore.engine.run import Run
from navcore.engine.simulation import simulate
from schuler_bench.views.learn.asked import Question, right_choice
from schuler_bench.views.learn.lessons import lessons
from schuler_bench.views.learn.names import named


def names_in(text: str) -> list[str]:
    """Names of the numbers in a text."""
    return re.findall(r"\{\{([a-z0-9_.]+)\}\}", text)


def right_answer(question: Question, run: Run) -> str:
    """An answer that counts as right, as it would be given."""
    if question.choices:
        return str(right_choice(question, run))
    return f"{named(question.answer, run).value:.4g}"


@lru_cache(maxsize=64)
def run_of(lesson: str, index: int) -> Run:
    """Run of a step of a lesson: made once for all tests of a process."""
    return simulate(next(other for other in lessons() if other.id == lesson).scenario_of(index))
