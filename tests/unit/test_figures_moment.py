"""A moment of a run: what is true, what a method computes, and the pendulum it swings like."""

import math
import re
import threading
from dataclasses import replace

import numpy as np
import pytest

from navcore.engine.simulation import simulate
from navcore.foundation.units import ARCMIN, DEG
from navcore.mechanization.recorder import PHI_E, PHI_N, PHI_U
from navcore.motion.truth import HEADING, VE, VN
from schuler_bench.session.display import Display
from schuler_bench.views.learn.lessons import lessons
from schuler_bench.views.scene.moment import moment, pendulum, pendulum_svg, plane_ends, readout_html, row_at
from schuler_bench.views.scene.playback import MOST_AHEAD, SLOW_S, SPEEDS, TICK_S, Playback, PlayState
from tests.unit.figures_runs import diverging, moving_run, run_of, static_run


def test_the_time_runs_with_its_speed_and_stops_at_the_end() -> None:
    state = PlayState(time_s=100.0, span_s=1000.0, playing=True, speed=300)
    ended, again = state.later(10.0), replace(state, loop=True).later(4.0)
    assert state.later(1.0).time_s == 400.0
    assert (ended.time_s, ended.playing, ended.at_end) == (1000.0, False, True)
    assert (again.time_s, again.playing) == (300.0, True)
    still = replace(state, playing=False)
    assert still.later(5.0) is still


def test_what_is_asked_for_is_held_within_the_run() -> None:
    told: list[PlayState] = []
    playback = Playback(told.append)
    playback.follow(3600.0)
    assert playback.state.time_s == 3600.0  # a new page shows the whole run
    for asked, shown in ((100.0, 100.0), (-5.0, 0.0), (1e9, 3600.0), (1800.0, 1800.0)):
        playback.seek(asked)
        assert playback.state.time_s == told[-1].time_s == shown
    count = len(told)
    for wrong in (float("nan"), float("inf")):
        playback.seek(wrong)
    playback.set_speed(61.0)
    assert len(told) == count and playback.state.speed in SPEEDS
    playback.set_speed(SPEEDS[0])
    playback.set_loop(True)
    assert (told[-1].speed, told[-1].loop) == (SPEEDS[0], True)


def test_a_run_of_another_length_keeps_the_place() -> None:
    playback = Playback(lambda state: None)
    for seek, span, place in (
        (None, 3600.0, 3600.0),
        (None, 7200.0, 7200.0),  # at the end it stays at the end
        (5000.0, 3600.0, 3600.0),
        (1000.0, 7200.0, 1000.0),
    ):
        if seek is not None:
            playback.seek(seek)
        playback.follow(span)
        assert playback.state.time_s == place


def test_it_plays_pauses_and_ends_with_its_page() -> None:
    moved, threads = threading.Event(), set()

    def show(state: PlayState) -> None:
        if state.playing and state.time_s > 50.0:
            threads.add(threading.current_thread())
            moved.set()

    playback = Playback(show)
    playback.follow(1e6)
    playback.toggle()  # from the end it begins anew
    assert playback.state.playing and playback.state.time_s < 1e6
    assert moved.wait(10.0)
    playback.toggle()
    held = playback.state
    assert not held.playing
    (thread,) = [t for t in threads if t.name == "playback"]
    assert playback.state == held
    playback.toggle()
    playback.close()
    thread.join(10.0)
    assert not thread.is_alive()
    playback.seek(1.0)
    assert playback.state.time_s != 1.0


def test_without_a_run_nothing_plays() -> None:
    playback = Playback(lambda state: None)
    playback.toggle()
    assert not playback.state.playing


def test_a_fault_of_the_page_does_not_end_the_playback(caplog: pytest.LogCaptureFixture) -> None:
    calls = []

    def show(state: PlayState) -> None:
        calls.append(state)
        if len(calls) == 3:
            raise ConnectionError("gone")
        if len(calls) == 5:
            done.set()

    done = threading.Event()
    playback = Playback(show)
    playback.follow(1e6)
    playback.toggle()
    assert done.wait(10.0)
    playback.close()
    assert "could not be shown" in caplog.text


def test_a_page_that_falls_behind_gets_fewer_updates(monkeypatch: pytest.MonkeyPatch) -> None:
    paused: list[float] = []
    enough = threading.Event()

    def sleep(seconds: float) -> None:
        paused.append(seconds)
        if len(paused) == MOST_AHEAD + 3:
            playback.heard(0)
        if len(paused) >= MOST_AHEAD + 6:
            enough.set()

    playback = Playback(lambda state: None)
    monkeypatch.setattr("schuler_bench.views.scene.playback.time.sleep", sleep)
    playback.follow(1e9)
    playback.toggle()
    assert enough.wait(10.0)
    playback.close()
    assert paused[:MOST_AHEAD] == [TICK_S] * MOST_AHEAD
    assert paused[MOST_AHEAD : MOST_AHEAD + 3] == [SLOW_S] * 3
    assert paused[MOST_AHEAD + 3 : MOST_AHEAD + 6] == [TICK_S] * 3


def with_errors(phi: tuple[float, float, float], heading_deg: float = 90.0):
    """A still run whose first method has these misalignments all the time."""
    run = static_run()
    rows = run.methods[0].rows.copy()
    rows[:, [PHI_E, PHI_N, PHI_U]] = phi
    truth = run.truth.copy()
    truth[:, HEADING] = heading_deg * DEG
    return replace(run, truth=truth, methods=(replace(run.methods[0], rows=rows), *run.methods[1:]))


def test_rows_are_interpolated_and_held_at_the_ends() -> None:
    t, rows = np.array([0.0, 10.0, 20.0]), np.array([[0.0], [1.0], [5.0]])
    values = [row_at(t, rows, at)[0] for at in (-1.0, 0.0, 5.0, 15.0, 20.0, 99.0)]
    assert values == pytest.approx([0.0, 0.0, 0.5, 3.0, 5.0, 5.0])
    assert [row_at(t[:count], rows[:count], 3.0)[0] for count in (0, 1)] == [0.0, 0.0]


def test_a_turn_about_the_vertical_is_a_heading_error() -> None:
    now = moment(with_errors((0.0, 0.0, 30.0 * ARCMIN)), 1000.0)
    computed = now.methods[0].pose
    # C~ = (I - [phi x]) C turns the computed axes by -phi: clockwise for a positive phi_U
    turned = math.remainder(computed.heading - now.truth.heading, math.tau)
    assert turned == pytest.approx(0.5 * DEG, rel=1e-4) and computed.pitch == pytest.approx(0.0, abs=1e-9)


def test_tilts_are_pitch_and_roll_as_the_ship_heads() -> None:
    phi_e = 10.0 * ARCMIN
    north, east = (
        moment(with_errors((phi_e, 0.0, 0.0), heading), 0.0).methods[0].pose for heading in (0, 90)
    )
    # about east by -phi_E: the bow goes down
    assert (north.pitch, abs(east.roll)) == pytest.approx((-phi_e, phi_e), rel=1e-4)
    assert (north.roll, east.pitch) == pytest.approx((0.0, 0.0), abs=1e-9)


def test_truth_is_that_of_the_run() -> None:
    run = moving_run()
    at = len(run.t_s) // 3
    shown = moment(run, float(run.t_s[at]))
    assert shown.truth.speed == pytest.approx(math.hypot(run.truth[at, VE], run.truth[at, VN]))
    assert math.cos(shown.truth.heading - run.truth[at, HEADING]) == pytest.approx(1.0)
    np.testing.assert_allclose(shown.methods[1].errors, run.methods[1].rows[at, :8])


def test_a_strapdown_run_shows_what_it_computes() -> None:
    run = run_of(
        run={"duration_h": 0.05, "fidelity": "strapdown", "rate_hz": 20.0, "output_step_s": 10.0},
        method=[{"name": "free"}],
    )
    method = run.methods[0]
    assert method.navigation is not None
    pose = moment(run, float(run.t_s[-1])).methods[0].pose
    assert (pose.pitch, pose.heading) == (method.navigation[-1, 6], method.navigation[-1, 8] % math.tau)


def test_the_readout_has_units_and_names_the_method() -> None:
    run = diverging(moving_run(), 0, rows=1000)
    html = readout_html(moment(run, float(run.t_s[-1])), 0)
    assert run.methods[0].method.name in html and "(ended)" in html
    other = readout_html(moment(run, float(run.t_s[-1])), 0, Display(angle="deg", speed="m/s", length="nmi"))
    assert re.search(r"speed</th><td>[\d.]+ m/s</td><td>[\d.]+ m/s</td><td>.* m/s</td>", other)
    assert re.search(r"position</th>.* nmi</td></tr>", other) and "arc" not in other
    for row in ("heading", "pitch", "roll", "speed", "position"):
        cells = re.search(rf"{row}</th>(.*?)</tr>", html)[1]
        assert re.search(r"[\d⁰-⁹²³¹] ?(°|arcsec|arcmin|deg|kn|m|km|nmi|m/s)<", cells), row


def test_rounding_is_no_error() -> None:
    html = readout_html(moment(with_errors((2e-16, 0.0, 0.0)), 5000.0), 0)
    assert (
        re.search(r"pitch</th>.*<td>0 [µa][a-z]+</td></tr>", html) and "e-" not in html and "×10" not in html
    )
    assert "µ" not in html


class TestPendulum:
    def test_it_hangs_along_the_computed_vertical(self) -> None:
        trail = pendulum(with_errors((3.0 * ARCMIN, 5.0 * ARCMIN, 0.0)), 5000.0).bobs[0].trail
        np.testing.assert_allclose(trail, [[-5.0 * ARCMIN, 3.0 * ARCMIN]] * len(trail))

    def test_all_methods_share_one_factor_and_the_period_is_schulers(self) -> None:
        run = static_run()
        shown = pendulum(run, float(run.t_s[-1]))
        assert shown.period_s == pytest.approx(84.4 * 60.0, rel=0.005)
        peak = max(m.errors[n]["max_abs"] for m in run.methods for n in ("phi_e_rad", "phi_n_rad"))
        assert 10.0 * DEG < shown.factor * peak <= 30.0 * DEG
        assert len(shown.bobs) == len(run.methods)

    def test_the_trail_is_the_last_period_and_damping_shortens_it(self) -> None:
        run = run_of(
            run={"duration_h": 12.0},
            initial_error={"attitude_arcmin": [0.0, 3.0, 0.0]},
            method=[
                {"name": "free"},
                {"name": "damped", "damping": "internal", "network": {"id": "classic2"}},
            ],
        )
        shown = pendulum(run, float(run.t_s[-1]))
        # the Foucault rotation has turned the plane of the swing meanwhile
        free, damped = (float(np.linalg.norm(np.ptp(bob.trail, axis=0))) for bob in shown.bobs)
        assert free > 5.0 * ARCMIN  # from side to side within the trail
        assert damped < 0.1 * free

    def test_the_picture_stays_in_its_frame_and_says_what_it_is(self) -> None:
        for run in (moving_run(), static_run(), diverging(moving_run(), 0, rows=1000)):
            for at in (0.0, 1234.5, float(run.t_s[-1])):
                svg = pendulum_svg(pendulum(run, at))
                assert svg.count('class="sb-bob"') == len(run.methods)
                assert 'aria-label="Schuler pendulum: platform tilt' in svg
                assert "nan" not in svg and "inf" not in svg
                for x, y in re.findall(r'cx="([-\d.]+)" cy="([-\d.]+)"', svg):
                    assert -5 <= float(x) <= 301 and -5 <= float(y) <= 155

    def test_it_swings_from_side_to_side_in_its_own_lesson(self) -> None:
        lesson = next(one for one in lessons() if one.title == "The Schuler pendulum")
        run = simulate(lesson.scenario_of(0))
        period = math.tau / run.scenario.omega_s
        tips = []
        for at in (period, 1.5 * period):
            shown = pendulum(run, at)
            assert plane_ends(shown.plane) == ("S", "N")
            svg = pendulum_svg(shown)
            assert ">S</text>" in svg and ">W</text>" not in svg
            tips.append(float(re.search(r'class="sb-bob" cx="([-\d.]+)"', svg)[1]))
        assert tips[0] - tips[1] > 60.0  # px, from one end to the other within half a period

    def test_the_side_view_lies_in_the_plane_of_the_largest_tilt(self) -> None:
        for east, north, ends in ((5.0, 0.0, ("W", "E")), (0.0, 5.0, ("S", "N")), (4.0, 4.0, ("SW", "NE")),
                                  (-4.0, -4.0, ("SW", "NE"))):  # fmt: skip
            run = with_errors((north * ARCMIN, -east * ARCMIN, 0.0))
            assert plane_ends(pendulum(replace(run, methods=run.methods[:1]), 5000.0).plane) == ends
