"""Requirements: what is measured, against hand computations; bad input; who passes; what is drawn."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable
from contextlib import nullcontext
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from pydantic import ValidationError

from app.session.display import Display
from app.session.requirements import (
    MEASURES,
    Requirements,
    error_limits,
    fastest_rate,
    label_of,
    read_limit,
    verdicts,
)
from app.views.poles.figure import allowed_poles
from app.views.requirements.table import requirements_html
from app.views.requirements.view import RequirementsView
from app.views.step.figure import step_limits
from app.views.tune.setting import requirements_as_text
from navcore.design.measures import read_requirement
from navcore.foundation.errors import InputError
from navcore.foundation.units import ARCSEC
from tests.unit.figures_runs import INTERNAL, THREE, UNSTABLE, diverging, run_of, static_run


def measured(name: str) -> tuple[float, ...]:
    return next(v.measured for v in verdicts(static_run(), Requirements()) if v.name == name)


def test_every_limit_is_measured_and_labelled_once() -> None:
    assert list(MEASURES) == list(Requirements.model_fields)
    assert len({label_of(name) for name in MEASURES}) == len(MEASURES)


def test_settling_and_damping_are_the_loops_and_a_free_method_has_none() -> None:
    run = static_run()
    settling = run.methods[1].loop.settling_s
    assert settling is not None
    assert measured("settling_min")[:2] == (math.inf, pytest.approx(settling / 60.0))
    assert measured("damping_ratio") == (0.0, pytest.approx(0.699, abs=2e-3), pytest.approx(0.7))
    free = run_of(method=[{"name": "free", "network": {"id": "classic2"}}])
    assert verdicts(free, Requirements())[2].measured == (0.0,)


def test_overshoot_of_the_compass_is_that_of_its_three_poles() -> None:
    """phi/phi0 = s (s + K1)/((s+sigma)(s^2 + 2 sigma s + sigma^2/xi^2)), by partial fractions."""
    sigma, w = 0.0088, 0.0088 * math.sqrt(1 / 0.7**2 - 1)
    t = np.linspace(0.0, 3000.0, 200_001)
    poles = np.array([-sigma, -sigma + 1j * w, -sigma - 1j * w])
    phi = np.zeros(len(t))
    for p in poles:
        others = poles[poles != p]
        phi += np.real(p * (p + 3 * sigma) / np.prod(p - others) * np.exp(p * t)) if p.imag == 0.0 else 0.0
    p = poles[1]
    phi += 2 * np.real(p * (p + 3 * sigma) / ((p + sigma) * (p - poles[2])) * np.exp(p * t))
    # D/(s^2 D + w_s^2 N) times s: with D = s + K1 the response begins at 1
    assert phi[0] == pytest.approx(1.0)
    assert measured("overshoot_percent")[2] == pytest.approx(-100.0 * phi.min(), rel=2e-3)
    assert measured("overshoot_percent")[0] == pytest.approx(100.0, rel=1e-3)


def test_log_tilt_of_an_internal_and_a_free_method_is_zero() -> None:
    run = run_of(method=[*THREE, INTERNAL])
    values = {v.name: v.measured for v in verdicts(run, Requirements())}["log_tilt_arcsec"]
    assert values[0] == values[3] == 0.0
    assert values[1] > 10.0


def test_slope_at_0_is_that_of_the_network_and_its_limit_may_be_negative() -> None:
    """theory.md 10: classic2 +962.1 s, complementary 0.5, 0.5 -806.5 s; a free method has H = 1."""
    methods = [
        {"name": id, "damping": "external", "network": {"id": id, **more}}
        for id, more in (("classic2", {}), ("complementary", {"zeta": 0.5, "eta": 0.5}))
    ]
    run = run_of(method=[{"name": "free"}, *methods])
    found = {v.name: v for v in verdicts(run, Requirements(h_slope_s=0.0))}["h_slope_s"]
    assert found.measured == (0.0, pytest.approx(962.1, rel=0.03), pytest.approx(-806.5, rel=0.03))
    assert found.passed == (True, False, True)
    assert read_limit("h_slope_s", "-500") == -500.0
    assert requirements_as_text(Requirements(h_slope_s=-500.0)) == ("h_slope_s<=-500",)
    assert read_requirement("h_slope_s<=-500").limit == -500.0


def test_run_measures_are_the_runs_errors() -> None:
    run = static_run()
    for place, method in enumerate(run.methods):
        tilt = max(method.errors[name]["max_abs"] for name in ("phi_e_rad", "phi_n_rad"))
        assert measured("tilt_max_arcsec")[place] == pytest.approx(tilt / ARCSEC)
        assert measured("position_rms_m")[place] == method.errors["position_m"]["rms"]
    assert measured("h0_deviation")[0] == 0.0


def test_unstable_and_diverged_methods_meet_nothing_of_it() -> None:
    run = diverging(run_of(method=[UNSTABLE]), 0, 50)
    found = {v.name: v.measured[0] for v in verdicts(run, Requirements())}
    for name in ("settling_min", "overshoot_percent", "log_tilt_arcsec", "tilt_max_arcsec", "position_rms_m"):
        assert found[name] == math.inf, name
    assert found["damping_ratio"] < 0.0


def test_a_limit_is_met_up_to_its_value() -> None:
    run, at = static_run(), measured("settling_min")[1]
    for limit, met in ((at, True), (at * 0.999, False)):
        settling = verdicts(run, Requirements(settling_min=limit))[0]
        assert settling.passed[:2] == (False, met)
    damping = verdicts(run, Requirements(damping_ratio=0.6))[2]
    assert damping.passed == (False, True, True)
    assert all(v.passed == (True, True, True) for v in verdicts(run, Requirements()))


@pytest.mark.parametrize("text", ["3x", "nan", "inf", "-1", "1e9", "1 2", "--"])
def test_bad_input_is_refused_with_what_is_allowed(text: str) -> None:
    with pytest.raises(InputError) as refused:
        read_limit("settling_min", text)
    assert "settling ≤ (min)" in str(refused.value) and "<= 100000 (min)" in str(refused.value)


def test_what_may_be_typed() -> None:
    assert read_limit("settling_min", "  ") is None
    assert read_limit("settling_min", " 30,5 ") == 30.5
    assert read_limit("damping_ratio", "0.5") == 0.5
    with pytest.raises(InputError):
        read_limit("damping_ratio", "1.5")


def test_kept_and_checked_with_the_display() -> None:
    wanted = Requirements(settling_min=60.0, position_rms_m=1852.0)
    display = Display().with_(requirements=wanted)
    assert Display.model_validate_json(display.model_dump_json()).requirements == wanted
    with pytest.raises(ValidationError):
        Display.model_validate({"requirements": {"settling_min": -3.0}})
    with pytest.raises(ValidationError):
        Display.model_validate({"requirements": {"settling": 3.0}})


def test_what_is_drawn_is_in_si() -> None:
    asked = Requirements(settling_min=60.0, overshoot_percent=40.0, log_tilt_arcsec=20.0,
                         tilt_max_arcsec=30.0, position_rms_m=500.0, damping_ratio=0.4)  # fmt: skip
    rate = fastest_rate(asked)
    assert rate is not None and math.exp(-rate * 3600.0) == pytest.approx(0.02)
    assert allowed_poles(asked).damping_ratio == 0.4
    limits = step_limits(asked)
    assert (limits.settling_s, limits.overshoot) == (3600.0, 0.4)
    assert limits.log_tilt == pytest.approx(20.0 * ARCSEC)
    run = static_run()
    drawn = {"phi_e": 30 * ARCSEC, "phi_n": 30 * ARCSEC, "position": 500.0}
    assert error_limits(asked, run) == pytest.approx(drawn)
    assert error_limits(Requirements(), run) == {} and fastest_rate(Requirements()) is None
    # one far above the curves would press them flat
    assert error_limits(Requirements(position_rms_m=1e8), run) == {}


def test_table_says_in_words_who_meets_what() -> None:
    run = run_of(method=[{"name": "<b>free"}, THREE[1]])
    html = requirements_html(run, Requirements(damping_ratio=0.5, settling_min=10.0))
    assert "✓ met" in html and "✗ missed" in html and "✗ misses 1 of 2" in html
    assert "&lt;b&gt;free" in html and "<b>free" not in html
    assert "nothing asked" in requirements_html(run, Requirements())
    assert "✓ meets it" in requirements_html(run, Requirements(overshoot_percent=150.0))


# ------------------------------------------------------------ the boxes


class _Box:
    """A text box of viser: its value, and what is called when the browser has sent one."""

    def __init__(self, value: str) -> None:
        self.value = value

    def on_update(self, act: Callable[[Any], None]) -> None:
        self.call = act

    def typed(self, text: str) -> None:
        """What viser does first when the browser sends a value."""
        self.value = text


def test_a_limit_that_is_being_typed_is_not_overwritten() -> None:
    """viser stores a typed value before it calls back; other work may bring the boxes up to date between."""
    boxes: dict[str, _Box] = {}

    def add_text(label: str, value: str, hint: str) -> _Box:
        assert hint
        return boxes.setdefault(label, _Box(value))

    session: Any = SimpleNamespace(lock=threading.RLock(), display=Display())

    def show(**choices: Any) -> None:
        session.display = session.display.with_(**choices)
        view.follow_display()

    gui = SimpleNamespace(add_text=add_text, add_html=lambda text: SimpleNamespace(content=text))
    frame: Any = SimpleNamespace(gui=gui, session=session, show=show)
    view = RequirementsView(frame)
    view.build(nullcontext())
    settling, overshoot = (boxes[label_of(name)] for name in ("settling_min", "overshoot_percent"))
    user: Any = SimpleNamespace(client=object())
    settling.typed("90")
    show(requirements=Requirements(settling_min=30.0, overshoot_percent=20.0))  # by another page
    assert (settling.value, overshoot.value) == ("90", "20")
    settling.call(user)
    assert session.display.requirements == Requirements(settling_min=90.0, overshoot_percent=20.0)
    show(requirements=Requirements())
    assert (settling.value, overshoot.value) == ("", "")
