"""Every lesson is whole: its names, fields, tabs and answers exist and come from the engine."""

import math
import re
from collections.abc import Iterator

import numpy as np
import pytest

from navcore.averaging.parameters import Averaging
from navcore.damping.gyrocompass import Gyrocompass
from navcore.engine.simulation import simulate
from navcore.foundation.errors import InputError
from navcore.law.policy import POLICIES
from navcore.law.switching import SWITCHINGS
from navcore.motion import MOTIONS
from navcore.motion.swing import Oscillation
from navcore.networks import NETWORKS
from navcore.networks.discrete import discretise
from navcore.scenario.blocks import Alignment, RunSettings, SiteSettings
from navcore.scenario.initial_error import InitialError
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.sensors.imu import Imu
from navcore.sensors.reference import Reference
from schuler_bench.editing import form
from schuler_bench.editing.form import FieldSpec
from schuler_bench.session.display import Display
from schuler_bench.views import load
from schuler_bench.views import load as load_views
from schuler_bench.views.errors.figure import error_plots
from schuler_bench.views.errors.view import moving
from schuler_bench.views.explain.view import (
    Explanation,
    explain_html,
    explanation,
    explanations,
    formula_html,
    key_of,
    told_html,
)
from schuler_bench.views.learn.asked import Question, holds, is_right, right_choice
from schuler_bench.views.learn.lessons import Lesson, lessons, read_lesson, to_html, without
from schuler_bench.views.learn.names import Named, named
from schuler_bench.views.learn.view import spec_at
from schuler_bench.views.log.view import _KINDS
from tests.answers import names_in, right_answer, run_of


def all_fields() -> Iterator[tuple[str, FieldSpec]]:
    """Every field that the page can show, with its name in ``assets/explain.toml``."""
    plain = {
        "imu": Imu,
        "reference": Reference,
        "run": RunSettings,
        "site": SiteSettings,
        "initial_error": InitialError,
        "alignment": Alignment,
        "method": Method,
        "averaging": Averaging,
        "gyrocompass": Gyrocompass,
    }
    plain |= {f"reference.{name}": model for name, model in _KINDS.items()}
    plain |= {"motion.swing.pitch": Oscillation}
    for part, members in (
        ("network", NETWORKS),
        ("policy", POLICIES),
        ("switching", SWITCHINGS),
        ("motion", MOTIONS),
    ):
        plain |= {f"{part}.{id}": model for id, model in members.items()}
    for name, model in plain.items():
        for spec in form.fields(model, tuple(name.split("."))):
            yield ".".join(str(step) for step in spec.path if not isinstance(step, int)), spec


FIELDS = list(all_fields())


@pytest.mark.parametrize(("key", "spec"), FIELDS, ids=[f"{key}-{spec.label}" for key, spec in FIELDS])
def test_every_control_is_explained_and_every_slider_with_unit_and_range(key: str, spec: FieldSpec) -> None:
    words = explanation(key)
    assert words is not None and words.source and spec.hint, key
    if spec.slider is not None:
        assert re.search(r"Must be (>|<)", spec.hint), spec.hint
        unit = re.search(r"\(([^()]+(\([^()]*\))?[^()]*)\)$", spec.label)
        assert (f"({unit.group(1)})" if unit else "(no unit)") in spec.hint


def test_no_explanation_is_left_over() -> None:
    keys = [key for key, _ in FIELDS] + [
        "network.id",
        "azimuth.id",
        "method.gyrocompass",
        "policy.id",
        "switching.id",
        "motion.kind",
        "reference.kind",
    ]
    used = {id(explanation(key)) for key in keys}
    assert [pattern for pattern, entry in explanations().items() if id(entry) not in used] == []


def test_equations_are_mathml() -> None:
    for pattern, entry in explanations().items():
        html = formula_html(entry.latex) if entry.latex else "<math"
        assert html.startswith("<math") and "\\" not in html, pattern


COMPASS = {"damping": "external", "network": {"id": "compass"}, "policy": {"id": "variation"}}
SCENARIO = Scenario.parse({"method": [COMPASS], "reference": {"kind": "log"}, "motion": {"kind": "swing"}})


@pytest.mark.parametrize(
    ("path", "key"),
    [
        (("method", 0, "network", "xi"), "network.compass.xi"),
        (("method", 0, "network", "id"), "network.id"),
        (("method", 0, "azimuth", "id"), "azimuth.id"),
        (("method", 0, "azimuth", "zeta"), "network.none.zeta"),
        (("method", 0, "gyrocompass", "sigma"), "gyrocompass.sigma"),
        (("method", 0, "policy", "a"), "policy.variation.a"),
        (("method", 0, "averaging", "variant"), "averaging.variant"),
        (("motion", "kind"), "motion.kind"),
        (("motion", "pitch", "amplitude_deg"), "motion.swing.pitch.amplitude_deg"),
        (("reference", "event", 0, "t_h"), "reference.event.t_h"),
    ],
)
def test_a_field_is_named_by_the_kind_of_its_block(path: form.Path, key: str) -> None:
    assert key_of(path, SCENARIO) == key


def test_an_explanation_holds_words_equation_and_source() -> None:
    specs = {spec.path[-1]: spec for spec in form.fields(NETWORKS["compass"], ("method", 0, "network"))}
    html = explain_html(specs["sigma"], SCENARIO)
    assert "Must be &gt;= 1e-05 and &lt;= 1 (1/s)" in html and html.count("<math") == 1
    assert "Deng 2019, eq. 2; Zha 2019, eq. 12" in html
    hostile, plain = (told_html(a, b, Explanation(says=c)) for a, b, c in (("<b>", "<i>", "<u>"), "biu"))
    assert hostile.count("<") == plain.count("<")


LESSONS = lessons()
STEPS = [(lesson, i) for lesson in LESSONS for i in range(len(lesson.steps))]
step_ids = [f"{lesson.id}-{i + 1}" for lesson, i in STEPS]
every_step = pytest.mark.parametrize(("lesson", "index"), STEPS, ids=step_ids)
ASKING = [(lesson, i) for lesson, i in STEPS if lesson.steps[i].question is not None]

ONE = """+++
title = "A"
about = "B"
preset = "zha-fast"
+++
## First
Text with $x$ and {{schuler.period}}.
"""


def test_there_are_the_eleven_lessons_with_questions_and_actions() -> None:
    assert [int(lesson.id.partition("-")[0]) for lesson in LESSONS] == [*range(1, 12)]
    for lesson in LESSONS:
        assert sum(step.question is not None for step in lesson.steps) >= 3, lesson.id
        assert all(step.action is not None for step in lesson.steps), lesson.id
        assert any("$$" in step.text for step in lesson.steps), lesson.id


@every_step
def test_what_a_step_asks_of_the_page_exists(lesson: Lesson, index: int) -> None:
    action = lesson.steps[index].action
    scenario = lesson.scenario_of(index)
    assert set(action.tabs) <= {kind.title for kind in load() if kind.place in ("upper", "lower")}
    Display().with_(**action.shown)
    assert action.method is None or action.method < len(scenario.method)
    for path in action.sliders:
        (spec,) = spec_at(scenario, path)
        assert spec.slider is not None
        assert spec.label.startswith("try:")


SYMBOLS = {
    r"\varphi_E": "phi_e",
    r"\varphi_N": "phi_n",
    r"\varphi_U": "phi_u",
    r"\delta V_E": "dve",
    r"\delta V_N": "dvn",
    "latitude": "dlat",
    "position": "position",
    "heading": "phi_u",
}
"""How the text of a lesson names a curve."""
LOOKS = re.compile(r"(?:^|[.:] )((?:Look|Compare|Watch|Read)\b[^.]*)", re.MULTILINE)
OF_ERRORS = re.compile(r"(?:error|curve)\.\d+\.(\w+)\.")


@every_step
def test_a_step_shows_the_curves_that_it_speaks_of(lesson: Lesson, index: int) -> None:
    step = lesson.steps[index]
    action, question = step.action, step.question
    if action is None or "Errors" not in action.tabs:
        return
    shown = set(Display().with_(**action.shown).chosen_curves)
    looked_at = " ".join(LOOKS.findall(" ".join(step.text.split())))
    spoken_of = {key for name, key in SYMBOLS.items() if name in looked_at}
    if question is not None:
        asked = question.answer + "." + " ".join(choice.when for choice in question.choices)
        spoken_of |= set(OF_ERRORS.findall(asked))
    assert spoken_of <= shown
    run = run_of(lesson.id, index)
    kept = moving({key: plot for key, plot in error_plots(run).items() if key in shown})
    assert spoken_of <= set(kept), "a curve that is zero throughout is not drawn"


@every_step
def test_every_number_in_a_step_is_found_in_its_run(lesson: Lesson, index: int) -> None:
    step, run = lesson.steps[index], run_of(lesson.id, index)
    assert run.status == "ok"
    why = "".join(one.why for one in (step.question, step.sketch, step.task) if one is not None)
    for name in names_in(step.text + why):
        # The text of a step may stand beside the run of the step before: then it says "press Show me".
        assert math.isfinite(named(name, run).value), name
    assert "{{" not in to_html(step.text + why, run)


@pytest.mark.parametrize(("lesson", "index"), ASKING, ids=[f"{le.id}-{i + 1}" for le, i in ASKING])
def test_the_engine_gives_one_right_answer_and_refuses_others(lesson: Lesson, index: int) -> None:
    question, run = lesson.steps[index].question, run_of(lesson.id, index)
    right = right_answer(question, run)
    assert is_right(question, right, run)
    if question.choices:
        assert len(question.choices) >= 2
        others = [str(i) for i in range(len(question.choices)) if str(i) != right]
    else:
        value = float(right)
        others = [f"{value * (1 + sign * 1.2 * question.tolerance):.6g}" for sign in (1, -1)]
    assert not any(is_right(question, other, run) for other in others)


def test_answers_follow_the_run_and_not_the_file() -> None:
    question = LESSONS[0].steps[1].question
    run = run_of(LESSONS[0].id, 1)
    assert float(right_answer(question, run)) == pytest.approx(84.45, abs=0.05)
    scenario = run.scenario.model_copy(update={"run": run.scenario.run.model_copy(update={"earth": "wgs84"})})
    assert named("schuler.period", simulate(scenario)).value != pytest.approx(84.4525, abs=1e-3)


def test_the_numbers_are_those_of_the_physics() -> None:
    run = run_of(LESSONS[6].id, 0)
    fast, slow = named("schuler.fast", run).value, named("schuler.slow", run).value
    beat_h = 1.0 / (60.0 / fast - 60.0 / slow)
    # The two lines are 2 Omega sin L apart: they beat with half the Foucault period.
    assert beat_h == pytest.approx(named("foucault.quarter", run).value * 2.0, rel=1e-9)
    assert named("averaging.left", run).value == pytest.approx(6.6, abs=0.05)
    assert named("day.period", run).value == pytest.approx(23.934, abs=1e-3)
    # the example ship of theory.md 20
    run = run_of(LESSONS[8].id, 0)
    assert named("floor.tilt", run).value == pytest.approx(4.699, rel=0.005)
    assert named("budget.0.tilt", run).value == pytest.approx(13.26, rel=0.005)
    assert named("budget.0.log_drift", run).value == pytest.approx(100.0 * (11.29 / 13.26) ** 2, rel=0.01)
    run = run_of(LESSONS[3].id, 1)
    assert named("loop.1.h0", run).value == pytest.approx(0.648, abs=1e-3)
    assert named("error.1.dvn.final", run).value == pytest.approx(-0.543 * 0.5, abs=1e-3)


def test_the_direct_form_grows_as_the_lesson_says() -> None:
    """An impulse through the difference equation with float32 coefficients, and its growth over 10 000 s."""
    run = run_of(LESSONS[3].id, 3)
    network, step_s = run.methods[0].network, run.scenario.run.step_s
    assert network.id == "complementary" and step_s == 1.0
    den = np.real(np.poly(np.eye(4) + discretise(network, step_s).dA)).astype(np.float32)
    out = [1.0]
    for _ in range(20_000):
        out.append(-sum(float(c) * y for c, y in zip(den[1:], out[:-5:-1], strict=False)))
    size = np.abs(np.array(out))
    grown = math.log(size[19_000:].max() / size[9_000:10_001].max()) / 10_000.0
    assert named("direct.0.growth", run).value == pytest.approx(1.0 / grown, rel=0.02)
    assert named("direct.0.exact", run).value < 1.0 < named("direct.0.rounded", run).value
    assert named("direct.0.kept", run).value < 1e-5


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [(84.4525, "min", "84.5 min"), (8.06, '"', '8.06"'), (0.00124, "rad/s", "0.00124 rad/s"),
     (12345.0, "m", "12300 m"), (0.0000125, "m/s", "1.25e-05 m/s"), (math.inf, "min", "no number")],
)  # fmt: skip
def test_numbers_are_written_to_be_read(value: float, unit: str, text: str) -> None:
    assert Named(value, unit).text == text


@pytest.mark.parametrize(
    "name",
    ["", "schuler", "schuler.x", "error.9.phi_e.max", "error.0.phi_e.x", "error.-1.phi_e.max",
     "loop.0.__class__", "setting.__class__.x", "setting.method.0.name", "setting.run.earth",
     "setting.method.7.x", "curve.0.phi_e.x", "floor.x", "budget.9.tilt", "budget.x.tilt", "budget.0.x"],
)  # fmt: skip
def test_what_is_no_name_is_refused(name: str) -> None:
    with pytest.raises(KeyError):
        named(name, run_of(LESSONS[0].id, 0))


def test_a_comparison_reads_names_factors_and_numbers_only() -> None:
    run = run_of(LESSONS[0].id, 0)
    assert holds("schuler.period > 84", run)
    assert holds("2 * schuler.half >= 0.999 * schuler.period", run)
    assert not holds("schuler.period < 84", run)
    for bad in ("", "1", "schuler.period", "a > b", "schuler.period == 84", "__import__('os') > 1"):
        with pytest.raises(KeyError):
            holds(bad, run)


def test_two_right_choices_are_a_fault() -> None:
    choices = [{"say": "a", "when": "1 > 0"}, {"say": "b", "when": "2 > 0"}]
    question = Question(ask="?", why="", choices=choices)
    with pytest.raises(KeyError, match="2 choices"):
        right_choice(question, run_of(LESSONS[0].id, 0))


def test_markdown_shows_formulas_and_numbers_and_no_foreign_html() -> None:
    html = to_html("**b** $a_b*c_d$ {{schuler.period}} <script>x</script>", run_of(LESSONS[0].id, 0))
    assert "<strong>b</strong>" in html
    assert html.count("<math") == 1
    assert "<em>" not in html
    assert 'data-name="schuler.period">84.45 min<' in html
    assert "<script" not in html
    assert "press Show me" in to_html("{{schuler.period}}", None)
    assert "press Show me" in to_html("{{error.5.dve.max}}", run_of(LESSONS[0].id, 0))


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("+++\n", "", "must begin with TOML"),
        ("## First", "First", "in steps"),
        ('about = "B"', "about = ", "not valid TOML"),
        ('about = "B"', "", "Field required"),
        ("Text", "```toml action\ntabz = []\n```\nText", "not permitted"),
        ("Text", "```toml action\ntabs = []\n```\n```toml action\ntabs = []\n```\nText", "once"),
    ],
)
def test_a_file_that_is_no_lesson_is_refused_with_its_place(old: str, new: str, said: str) -> None:
    with pytest.raises(InputError, match=said) as caught:
        read_lesson("broken", ONE.replace(old, new, 1))
    assert "broken" in str(caught.value)


def test_a_lesson_may_play_in_a_preset() -> None:
    lesson = read_lesson("one", ONE)
    (step,) = lesson.steps
    assert (step.title, step.text) == ("First", "Text with $x$ and {{schuler.period}}.")
    assert isinstance(lesson.scenario_of(0), Scenario)
    assert lesson.scenario_of(0).method[1].name == "classic2"


def test_what_a_lesson_sets_of_the_display_goes_with_it() -> None:
    """Lesson 1's minutes stayed on the axes of lesson 10."""
    first = lessons()[0]
    set_by_it = Display().with_(**{k: v for s in first.steps if s.action for k, v in s.action.shown.items()})
    assert set_by_it.time == "min" and set_by_it.with_(**without(first)) == Display()
    assert without(None) == {}


@every_step
def test_the_tabs_of_a_step_can_all_be_in_front(lesson: Lesson, index: int) -> None:
    """Of two tabs of one panel only the last is seen."""
    action = lesson.steps[index].action
    places = {kind.title: kind.place for kind in load_views()}
    named = [places[tab] for tab in action.tabs] if action else []
    assert len(named) == len(set(named))
