"""Which study a session's tab carries out: of its own scenario, a listed one, or an uploaded file."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from navcore.foundation import guarded
from navcore.foundation.cores import cores
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.questions.study import StudyQuestion
from navcore.scenario.file import FILE_FIELDS, parse_toml, presets, read
from navcore.scenario.model import Scenario
from schuler_bench.jobs.asking import Asker

if TYPE_CHECKING:
    from navcore.study.model import Study
    from navcore.study.plan import Plan
    from schuler_bench.session.session import Session

PRESENT, UPLOADED = "", "uploaded"
"""Choices beside the names of the listed studies."""
NOTHING = "nothing"
"""In the place of a second quantity that is varied."""
LARGEST_TEXT = 200_000
MOST_RUNS, MOST_S = 20_000, 900.0
"""Runs of a study on a page, and its estimated processor time."""
MOST_POINTS = 50
"""Points of a study over which designs are judged on a page."""
_MOST_VALUES = 300
_OF_STUDIES = re.compile(
    r"^(?:\[\[ ?factor ?\]\]|\[(?:scenario|sample|output)\b|(?:scenario|seeds|constants) ?=)", re.MULTILINE
)
_FILES = {field for _, field in FILE_FIELDS}
_NAMES_FILE = re.compile(rf"\b({'|'.join(sorted(_FILES))})\b")


def is_study(text: str) -> bool:
    """Whether the text of a TOML file looks like that of a study: it is not read yet."""
    return _OF_STUDIES.search(text) is not None


def uploaded_study(name: str, text: str) -> Study:
    """Read the text of an uploaded study, and try its first scenario.

    Parameters
    ----------
    name : str
        Named in faults.
    text : str
        TOML. Its scenario is a preset or stands in it, and it reads no recordings: those of the server are
        not for a visitor.

    Raises
    ------
    InputError
        One fault for each thing wrong.
    """
    if len(text) > LARGEST_TEXT:
        allowed = Text("has more than {most} characters: no study", most=LARGEST_TEXT)
        raise InputError(Fault(name, "", None, allowed))
    return guarded.call(name, _read, text, name)


def _read(text: str, name: str) -> Study:
    from navcore.study.model import Study
    from navcore.study.plan import Plan

    data = parse_toml(text, name)
    if (path := next(_named_files(data, ""), None)) is not None:
        allowed = Text("must not be set: a study on the page reads no recordings; run it with schuler study")
        raise InputError(Fault(name, path, None, allowed))
    study = Study.parse(data, name)
    values = sum(len(factor.values) for factor in study.factor)
    if values > _MOST_VALUES:
        allowed = Text("has {count} values; at most {most} on the page", count=values, most=_MOST_VALUES)
        raise InputError(Fault(name, "factor", None, allowed))
    if isinstance(study.scenario, str):
        if study.scenario not in presets():
            allowed = Text("must be the name of a preset, or a table [scenario]")
            raise InputError(Fault(name, "scenario", study.scenario, allowed))
        study = study.model_copy(update={"scenario": read(study.scenario)})
    Plan(study, name)
    return study


def _named_files(value: Any, path: str) -> Iterator[str]:
    """Yield the places that name a recording, as a key or in the path of a field."""
    if isinstance(value, dict):
        for key, inner in value.items():
            at = f"{path}.{key}".lstrip(".")
            if key in _FILES:
                yield at
            elif key in ("field", "set"):
                named = (inner,) if isinstance(inner, str) else inner
                yield from (at for one in named if isinstance(one, str) and _NAMES_FILE.search(one))
            else:
                yield from _named_files(inner, at)
    elif isinstance(value, list):
        for place, inner in enumerate(value):
            yield from _named_files(inner, f"{path}.{place}")


def chosen_task(session: Session) -> StudyQuestion:
    """Make the study that the session's display chooses.

    Raises
    ------
    InputError
        The scenario cannot be varied so, or the study is too large for a page.
    """
    plan, present = _chosen(session)
    return StudyQuestion(study=plan.study, where=plan.where, scenario=present, workers=1)


def _chosen(session: Session) -> tuple[Plan, Scenario | None]:
    """Plan of the study that is chosen, and the session's scenario where it was made of that."""
    from navcore.study.crossed import crossed
    from navcore.study.file import load, studies
    from navcore.study.plan import Plan

    with session.lock:
        scenario, display, file = session.scenario, session.display, session.study_file
    present: Scenario | None = None
    if display.study == PRESENT:
        keys = [key for key in (display.study_x, display.study_y) if key != NOTHING]
        study, where, present = crossed(scenario, keys, display.study_seeds), "", scenario
    elif display.study == UPLOADED:
        where = file[0]
        study = uploaded_study(*file)
    elif display.study in studies():
        study, where = load(display.study), display.study
    else:
        allowed = Text("must be one of {names}", names=", ".join(studies()))
        raise InputError(Fault("", "study", display.study, allowed))
    plan = Plan(study, where)
    require_small(plan)
    return plan, present


def study_name(session: Session) -> str:
    """Name in faults of the study that the session's display chooses; empty: of its own scenario."""
    with session.lock:
        chosen = session.display.study
        return session.study_file[0] if chosen == UPLOADED else chosen


def planned(session: Session) -> str:
    """How many runs the chosen study has, and about how long they take; or why it cannot be run."""
    try:
        plan, _ = _chosen(session)
    except InputError as error:
        return Text.joined("; ", map(str, error.faults))
    return Text(
        "{runs} runs, each of {methods} methods; about {seconds} s.",
        runs=plan.runs,
        methods=len(plan.scenario.method),
        seconds=max(1, round(plan.seconds() / cores())),
    )


def study_of_points(session: Session) -> Study:
    """Study over whose points a search must hold: the one that the session's display chooses.

    Raises
    ------
    InputError
        It cannot be made, or has too many points for a page.
    """
    plan, _ = _chosen(session)
    points = plan.runs // plan.study.seeds
    if points > MOST_POINTS:
        allowed = Text("are {points} points; at most {most} on the page", points=points, most=MOST_POINTS)
        raise InputError(Fault(plan.where, "factor", None, allowed))
    return plan.study


def run_scenario(task: StudyQuestion, number: int) -> Scenario:
    """Scenario of one run of a study.

    Raises
    ------
    InputError
        There is no such run, or the scenario refuses its setting.
    """
    plan = task.plan
    if not 0 <= number < plan.runs:
        allowed = Text("must be >= 0 and < {runs}", runs=plan.runs)
        raise InputError(Fault(task.where, "run", number, allowed))
    setting, seed = plan.at(number)
    return plan.seeded(plan.scenario_of(setting), seed)


def require_small(plan: Plan) -> None:
    """Refuse a study that takes too long for a page; raises `InputError`."""
    if plan.runs <= MOST_RUNS and plan.seconds() <= MOST_S:
        return
    allowed = Text(
        "is {runs} runs, about {minutes:.3g} min; on the page at most {most} runs and {longest:g} min: give "
        "fewer values or seeds, or run the file with schuler study",
        runs=plan.runs,
        minutes=plan.seconds() / 60.0,
        most=MOST_RUNS,
        longest=MOST_S / 60.0,
    )
    raise InputError(Fault("", Text("study"), None, allowed))


def left_of(studier: Asker) -> StudyQuestion | None:
    """Rest of the last study; None when it is complete."""
    found, asked = studier.result, studier.asked
    if found is None or asked is None or found.complete:
        return None
    return asked.model_copy(update={"runs": found.runs})
