"""Requirements: measured, against hand computations; bad input; who meets them; over a part of the run."""

import math
import re
import threading
from collections.abc import Callable
from contextlib import nullcontext
from types import SimpleNamespace
from typing import Any
from unittest.mock import MagicMock

import numpy as np
import pytest
from pydantic import ValidationError

from navcore.design.default_limits import own_limits
from navcore.design.measures import read_requirement
from navcore.engine.run import Run
from navcore.engine.simulation import simulate
from navcore.foundation.errors import InputError
from navcore.foundation.units import ARCSEC
from navcore.quantities import LIMITED, NAMES
from navcore.scenario.file import to_toml
from navcore.scenario.model import Scenario
from schuler_bench.editing.limits import BOXES, FROM, from_text, label_of, limit_text, with_begin, with_limit
from schuler_bench.session.display import Display
from schuler_bench.session.requirements import LimitLine, error_limits, limits_of, verdicts
from schuler_bench.session.shown import window_of
from schuler_bench.views.compare.table import lines_of, pins_html
from schuler_bench.views.requirements.table import requirements_html
from schuler_bench.views.requirements.view import RequirementsView
from tests.limits import limits, under
from tests.unit.figures_runs import INTERNAL, THREE, UNSTABLE, diverging, run_of, static_run


def measured(key: str, run: Run | None = None) -> tuple[float, ...]:
    return next(v.measured for v in verdicts(run or static_run(), ()) if v.quantity.key == key)


def test_every_quantity_of_a_block_has_one_box_and_is_measured() -> None:
    """The page had nine limits of its own, the file ten others."""
    assert {*BOXES} == {*LIMITED} and len(BOXES) == len(LIMITED)
    assert len({label_of(key) for key in BOXES}) == len(BOXES)
    assert [v.quantity.key for v in verdicts(static_run(), ())] == [*BOXES]


def test_settling_and_damping_are_the_loops_and_a_free_method_has_none() -> None:
    settling = static_run().methods[1].loop.settling_s
    assert settling is not None
    assert measured("settling_s")[:2] == (math.inf, pytest.approx(settling / 60.0))
    assert measured("damping_ratio") == (0.0, pytest.approx(0.699, abs=2e-3), pytest.approx(0.7))
    assert measured("h0_deviation")[0] == 0.0
    free = run_of(method=[{"name": "free", "network": {"id": "classic2"}}])
    assert measured("damping_ratio", free) == (0.0,)


@pytest.mark.known(
    "oracle",
    ["tilt_overshoot"],
    kinds=["external"],
    fidelities=["loop"],
    source="partial fractions of the three poles",
)
def test_overshoot_of_the_compass_is_that_of_its_three_poles() -> None:
    """phi/phi0 = s (s + K1)/((s+sigma)(s^2 + 2 sigma s + sigma^2/xi^2)), by partial fractions."""
    sigma, w = 0.0088, 0.0088 * math.sqrt(1 / 0.7**2 - 1)
    t = np.linspace(0.0, 3000.0, 200_001)
    poles = np.array([-sigma, -sigma + 1j * w, -sigma - 1j * w])
    # D/(s^2 D + w_s^2 N) times s: with D = s + K1 the response begins at 1
    residues = [p * (p + 3 * sigma) / np.prod(p - poles[poles != p]) for p in poles]
    phi = np.real(np.array(residues) @ np.exp(np.outer(poles, t)))
    assert phi[0] == pytest.approx(1.0)
    expected = (pytest.approx(100.0, rel=1e-3), pytest.approx(-100.0 * phi.min(), rel=2e-3))
    assert measured("tilt_overshoot")[::2] == expected


def test_log_tilt_of_an_internal_and_a_free_method_is_zero() -> None:
    free, damped, _, inner = measured("log_tilt", run_of(method=[*THREE, INTERNAL]))
    assert free == inner == 0.0 and damped > 10.0


def test_slope_at_0_is_that_of_the_network_and_its_limit_may_be_negative() -> None:
    """theory.md 10: classic2 +962.1 s, complementary 0.5, 0.5 -806.5 s; a free method has H = 1."""
    networks = [{"id": "classic2"}, {"id": "complementary", "zeta": 0.5, "eta": 0.5}]
    damped = [{"name": n["id"], "damping": "external", "network": n} for n in networks]
    run = run_of(method=[{"name": "free"}, *damped])
    (slope,) = (v for v in verdicts(run, limits(h_slope_s=0.0)) if v.quantity.key == "h_slope_s")
    assert slope.measured == (0.0, pytest.approx(962.1, rel=0.03), pytest.approx(-806.5, rel=0.03))
    assert slope.passed == (True, False, True)
    assert [one.limit for one in own_limits(limits(h_slope_s=-500.0), ())] == [-500.0]
    assert read_requirement("h_slope_s<=-500").limit == -500.0


def test_run_measures_are_the_runs_errors() -> None:
    errors = [method.errors for method in static_run().methods]
    tilts = [np.hypot(*method.rows[:, :2].T).max() / ARCSEC for method in static_run().methods]
    assert measured("tilt_max_arcsec") == pytest.approx(tilts, rel=0.02)
    assert measured("position_rms_m") == tuple(e["position_m"]["rms"] for e in errors)


def test_unstable_and_diverged_methods_meet_nothing_of_it() -> None:
    run = diverging(run_of(method=[UNSTABLE]), 0, 50)
    numbers = {v.quantity.key: v.measured[0] for v in verdicts(run, ())}
    unmet = {"settling_s", "tilt_overshoot", "log_tilt", "tilt_max_arcsec", "position_rms_m"}
    assert unmet <= {name for name, number in numbers.items() if number == math.inf}
    assert numbers["damping_ratio"] < 0.0


def test_a_limit_is_met_up_to_its_value() -> None:
    run, at = static_run(), measured("settling_s")[1]
    for limit, met in ((at, True), (at * 0.999, False)):
        assert verdicts(run, limits(settling_s=limit))[0].passed[:2] == (False, met)
    assert verdicts(run, limits(damping_ratio=0.6))[0].passed == (False, True, True)
    assert all(v.passed == (True, True, True) for v in verdicts(run, ()))


@pytest.mark.parametrize("text", ["3x", "nan", "inf", "-1", "1e12", "1 2", "--"])
def test_bad_input_is_refused_with_what_is_allowed(text: str) -> None:
    with pytest.raises(InputError) as refused:
        with_limit(static_run().scenario, "settling_s", text)
    assert "settling ≤ (min)" in str(refused.value) and repr(text) in str(refused.value)


@pytest.mark.parametrize(
    ("key", "text", "limit"),
    [
        ("settling_s", "  ", None),
        ("settling_s", " 30,5 ", 1830.0),
        ("damping_ratio", "0.5", 0.5),
        ("h_slope_s", "-500", -500.0),
    ],
)
def test_what_may_be_typed(key: str, text: str, limit: float | None) -> None:
    changed = with_limit(static_run().scenario, key, text)
    assert [one.limit for one in changed.requirement] == ([] if limit is None else [limit])
    assert Scenario.parse(changed.canonical()) == changed


def test_a_box_edits_the_block_of_the_scenario_and_one_time_counts_for_all_errors() -> None:
    first = with_limit(static_run().scenario, "tilt_max_arcsec", "20")
    second = with_begin(with_limit(first, "settling_s", "90"), "1.5")
    assert [one.from_h for one in second.requirement] == [1.5, 0.0]
    third = with_limit(with_limit(second, "velocity_max_mps", "0.3"), "tilt_max_arcsec", "25")
    assert [(one.quantity, one.limit, one.from_h) for one in third.requirement] == [
        ("tilt_max_arcsec", 25.0, 1.5),
        ("settling_s", 5400.0, 0.0),
        ("velocity_max_mps", 0.3, 1.5),
    ]
    assert (limit_text(third, "settling_s"), from_text(third)) == ("90", "1.5")
    assert "[[requirement]]" in to_toml(third)
    with pytest.raises(InputError, match="the end of the run"):
        with_begin(third, "1e3")
    assert from_text(with_begin(third, " ")) == "0" and FROM


def test_what_is_drawn_is_in_si() -> None:
    asked = limits(settling_s=60.0, tilt_overshoot=40.0, log_tilt=20.0,
                   tilt_max_arcsec=30.0, position_rms_m=500.0, damping_ratio=0.4)  # fmt: skip
    assert limits_of(asked) == pytest.approx(
        {"settling_s": 3600.0, "tilt_overshoot": 0.4, "log_tilt": 20.0 * ARCSEC, "damping_ratio": 0.4}
        | {"tilt_max_arcsec": 30.0 * ARCSEC, "position_rms_m": 500.0}
    )
    run = static_run()
    # a root mean square may be met by a curve that passes it: it has no line
    assert error_limits(asked, run) == {"tilt": (LimitLine("tilt_max_arcsec", pytest.approx(30 * ARCSEC)),)}
    # one far above the curves would press them flat
    for nothing in ((), limits(position_max_m=1e8)):
        assert error_limits(nothing, run) == {}


def test_table_says_in_words_who_meets_what() -> None:
    run = run_of(method=[{"name": "<b>free"}, THREE[1]])
    html = requirements_html(under(run, damping_ratio=0.5, settling_s=10.0))
    words = ("✓ met", "✗ missed", "✗ misses 1 of 2", "&lt;b&gt;free")
    assert [word in html for word in (*words, "<b>free")] == [True] * 4 + [False]
    assert "nothing asked" in requirements_html(run)
    assert "✓ meets it" in requirements_html(under(run, tilt_overshoot=150.0))


def test_pins_say_which_limits_they_miss() -> None:
    run = under(run_of(method=[{"name": "<b>free"}, THREE[1]]), damping_ratio=0.5, settling_s=10.0)
    missed = [
        line
        for place in (0, 1)
        for line in lines_of(window_of(run, Display()), run, place, ())
        if line.missed
    ]
    assert missed
    for line in missed:
        html = pins_html([line], "pinned", None)
        assert f"✗ misses {len(line.missed)} of 2: {', '.join(line.missed)}" in html
        assert {"damping ratio", "settling"} >= set(line.missed)


# ------------------------------------------------------------ kept with the display


def test_choices_are_kept_and_changed_in_a_copy() -> None:
    first = Display()
    display = first.with_(angle="deg")
    assert Display.model_validate_json(display.model_dump_json()) == display
    assert (display.angle, first) == ("deg", Display())


@pytest.mark.parametrize(
    "wrong",
    [
        {"transfer": "nothing"},
        {"exaggeration": 0.0},
        {"angle": "mil"},
        {"theme": "blue"},
        {"no_such": 1},
        {"window_from_h": -1.0},
    ],
)
def test_what_is_not_offered_is_refused(wrong: dict[str, object]) -> None:
    with pytest.raises(ValidationError):
        Display().with_(**wrong)


# ------------------------------------------------------------ the boxes


def test_what_is_typed_into_the_table_is_a_limit_or_refused() -> None:
    begun = static_run().scenario
    commands: dict[str, Callable[[str], None]] = {}
    session: Any = SimpleNamespace(lock=threading.RLock(), scenario=begun, run=None, redrawn=0)
    asker = SimpleNamespace(result=None, words=(), asked=None, fraction=None, halt=None)
    session.searches = SimpleNamespace(judge=SimpleNamespace(known={}, words=()), asking={"report": asker})

    def change(scenario: Scenario, by: object, name: str = "") -> None:
        session.scenario = scenario

    def redraw() -> None:
        session.redrawn += 1

    session.change = change
    notes: list[Any] = []
    gui = MagicMock()
    gui.add_html = lambda text: notes.append(SimpleNamespace(content=text)) or notes[-1]
    register = SimpleNamespace(register=lambda name, act: commands.update({name: act}))
    frame: Any = SimpleNamespace(gui=gui, session=session, commands=register, redraw=redraw)
    RequirementsView(frame).build(nullcontext())
    typed = commands["limit"]
    for key, text in (
        ("settling_s", "90"),
        ("tilt_overshoot", "20"),
        ("position_rms_m", "5"),
        ("from", "1.5"),
    ):
        typed(f"{key} {text}")
    wanted = with_limit(with_limit(begun, "settling_s", "90"), "tilt_overshoot", "20")
    wanted = with_begin(with_limit(wanted, "position_rms_m", "5"), "1.5")
    assert session.scenario == wanted and notes[0].content == ""
    for text, told in (("settling_s soon", "90 is kept"), ("from -1", "1.5 is kept")):
        typed(text)
        assert told in notes[0].content and session.scenario == wanted
    typed("nonsense 3")
    assert (session.scenario, session.redrawn) == (wanted, 2)
    typed("settling_s ")
    assert notes[0].content == "" and [one.quantity for one in session.scenario.requirement] == [
        "tilt_overshoot", "position_rms_m",
    ]  # fmt: skip


def test_a_box_is_made_anew_by_its_own_limit_alone_and_stays_in_its_row() -> None:
    """What is being typed into another box stays as it is: the page exchanges what differs (fill.js)."""

    def boxes(run: Run, **refused: int) -> dict[str, str]:
        html = requirements_html(run, boxes=refused)
        return {
            found[1]: found[0] for found in re.finditer('<input[^>]*data-limit="([a-z0-9_]+)"[^>]*>', html)
        }

    run = run_of()
    before, after = boxes(run), boxes(under(run, tilt_overshoot=20.0))
    assert list(before) == list(after) == [*BOXES, "from"]
    assert {key for key in before if before[key] != after[key]} == {"tilt_overshoot"}
    again = boxes(run, settling_s=1)
    assert {key for key in before if before[key] != again[key]} == {"settling_s"}
    # rows without a limit are folded away, where there is one
    html = requirements_html(under(run, tilt_overshoot=20.0), boxes={})
    assert html.count('class="sb-unasked"') == len(BOXES) and "sb-nothing" not in html
    assert "sb-nothing" in requirements_html(run, boxes={})


# ------------------------------------------------------------ a part of the run


def test_after_settling_leaves_the_transient_of_the_slowest_method_out() -> None:
    run = static_run()
    slowest = max(method.loop.settling_s or 0.0 for method in run.methods)
    window = window_of(run, Display(window="settled"))
    assert (
        0.0 < slowest < 6.0 * 3600.0
        and window.from_s == slowest
        and f"{slowest / 3600.0:.3g} h" in window.told
    )
    for method, whole in zip(window.run.methods, run.methods, strict=True):
        rows = whole.rows[whole.t_s >= slowest]
        for i, name in enumerate(NAMES):
            part, of_all = method.errors[name], whole.errors[name]
            rms = np.sqrt(np.mean(rows[:, i] ** 2))
            assert (part["rms"], part["final"]) == pytest.approx((rms, of_all["final"]))
            assert np.abs(rows[:, i]).max() <= part["max_abs"] <= of_all["max_abs"] * (1.0 + 1e-12)
    # the transient was the larger part of it
    damped, of_all = window.run.methods[1].errors["phi_e_rad"], run.methods[1].errors["phi_e_rad"]
    assert damped["rms"] < of_all["rms"]
    assert [method.errors for method in window.of(run).methods] == [m.errors for m in window.run.methods]


def test_chosen_hours_that_span_the_run_give_its_numbers() -> None:
    window = window_of(static_run(), Display(window="hours", window_from_h=0.0, window_to_h=99.0))
    for method, whole in zip(window.run.methods, static_run().methods, strict=True):
        for name in ("dve_mps", "position_m"):
            assert method.errors[name]["rms"] == pytest.approx(whole.errors[name]["rms"], rel=0.02)
            assert method.errors[name]["max_abs"] == pytest.approx(whole.errors[name]["max_abs"])


@pytest.mark.parametrize(
    ("methods", "choices", "words"),
    [
        (THREE, {}, ""),
        (THREE, {"window": "hours", "window_from_h": 7.0}, "whole run"),
        (THREE, {"window": "hours", "window_from_h": 3.0, "window_to_h": 2.0}, "whole run"),
        (THREE[:1], {"window": "settled"}, "No method settles"),
    ],
)
def test_a_window_without_rows_measures_the_whole_run_and_says_so(
    methods: Any, choices: dict[str, Any], words: str
) -> None:
    run = run_of(method=methods, run={"duration_h": 6.0})
    window = window_of(run, Display.model_validate(choices))
    assert window.run is run and window.possible is (not words)
    assert words in window.told and bool(words) is bool(window.told)


def test_a_method_that_ended_before_the_window_has_no_numbers() -> None:
    window = window_of(diverging(static_run(), 0, 50), Display(window="hours", window_from_h=5.0))
    numbers = [method.errors["dve_mps"]["rms"] for method in window.run.methods]
    assert list(map(math.isnan, numbers)) == [True, False, False]


def test_velocity_requirement_is_per_axis_from_its_own_time_on() -> None:
    scenario = with_begin(with_limit(static_run().scenario, "velocity_rms_mps", "1"), "2")
    run = simulate(scenario)
    rows = [method.rows[method.t_s >= 7200.0] for method in run.methods]
    wanted = [float(np.sqrt(np.mean(part[:, 3] ** 2 + part[:, 4] ** 2) / 2.0)) for part in rows]
    (velocity,) = (v for v in verdicts(run, scenario.requirement) if v.quantity.key == "velocity_rms_mps")
    assert velocity.measured == pytest.approx(wanted, rel=0.02)
    # a run that was not watched from then on, such as a pin, has no value
    (velocity,) = (v for v in verdicts(static_run(), scenario.requirement) if v.requirement is not None)
    assert velocity.measured == (math.inf,) * 3 and velocity.passed == (False,) * 3


def test_a_change_of_a_limit_runs_no_method_again() -> None:
    run = static_run()
    again = simulate(with_limit(run.scenario, "settling_s", "90"), before=run)
    assert all(new is old for new, old in zip(again.methods, run.methods, strict=True))
    later = simulate(with_begin(with_limit(run.scenario, "tilt_max_arcsec", "9"), "1"), before=run)
    assert not any(new is old for new, old in zip(later.methods, run.methods, strict=True))
