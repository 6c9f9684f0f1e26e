"""Faults of compiled functions that no test noticed when they were planted, held by single plain calls."""

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from navcore.foundation.compiled import plain
from navcore.foundation.earth import WGS84
from navcore.law.azimuth import _compass, steer
from navcore.law.records import NOTHING, E, N, U
from navcore.law.step import Correction
from navcore.law.switching.bridge import _recognise
from navcore.law.switching.bumpless import _put_aside
from navcore.mechanization.kalman.filter import STATES, update
from navcore.motion.course import _position_rate


@pytest.mark.parametrize("axis", [E, N])
@pytest.mark.parametrize(("off", "known"), [(0.05, True), (0.5, False)])
def test_a_level_is_recognised_only_where_both_axes_have_come_back(
    axis: int, off: float, known: bool
) -> None:
    """3 sigma of a level known to 0.045 m/s are 0.13 m/s."""
    z, old = np.zeros((2, 3)), np.zeros(2)
    old[axis] = off
    P = np.diag([1e-4, 1e-4, 1e-3])
    memory = SimpleNamespace(
        z=z, P=P, old=old, old_variance=1e-3, since=100, known=False, level=np.zeros(2), gain=np.zeros(3)
    )
    plain(_recognise)(SimpleNamespace(earliest=60, latest=900), memory)
    assert memory.known is known
    assert z[axis, 2] == pytest.approx(0.5 * off if known else 0.0) and z[1 - axis, 2] == 0.0


@pytest.mark.parametrize(("fill", "kept"), [(139, False), (140, True)])
def test_what_is_put_aside_lies_a_whole_window_before_the_event(fill: int, kept: bool) -> None:
    """An age of 110 calls and a window of 30 need 140 of them."""
    calls: list[Any] = []
    rows = [SimpleNamespace(damped=True, x=np.full((3, 4), 7.0))] * 200
    law = SimpleNamespace(s=SimpleNamespace(ring_fill=fill), p=SimpleNamespace(order=4))
    memory = SimpleNamespace(mean=np.zeros(2), x=np.zeros((2, 4)), valid=False)
    namespace = plain(_put_aside).__globals__
    with pytest.MonkeyPatch.context() as patched:
        patched.setitem(namespace, "row_of_age", lambda law, age: rows[age])
        patched.setitem(
            namespace, "mean_of", lambda law, what, age, window: calls.append((age, window)) or 0.3
        )
        plain(_put_aside)(SimpleNamespace(age=110, window=30), memory, law)
    assert bool(calls) is kept and calls in ([], [(110, 30), (110, 30)])


def compass_law(*, damped: bool) -> Any:
    s = SimpleNamespace(
        x=np.full((3, 4), 5.0), correction=np.full(3, 9.0), difference=np.array([0.1, 0.2]), damped=damped,
        steered=True, action=NOTHING, level_only=False, internal=False,
    )  # fmt: skip
    p = SimpleNamespace(
        gyrocompass=True, compass=SimpleNamespace(left=0.5, gain=2.0, k1=0.1, k2=0.3), azimuth_order=1
    )
    return SimpleNamespace(s=s, p=p)


def test_an_undamped_gyrocompass_forgets_its_state_and_both_corrections() -> None:
    law, c = compass_law(damped=False), Correction(0.01, 0.02, 0.03, 0.04)
    found, c_u = plain(_compass)(law, c, SimpleNamespace(earth_n=5e-5))
    assert law.s.x[U, 0] == 0.0 and law.s.correction[N] == law.s.correction[U] == 0.0
    assert law.s.correction[E] == 9.0 and c_u == 0.0 and tuple(found) == (0.01, 0.0, 0.03, 0.0)


def test_a_damped_gyrocompass_steers_by_the_north_channel() -> None:
    law, c = compass_law(damped=True), Correction(0.01, 0.02, 0.03, 0.04)
    found, c_u = plain(_compass)(law, c, SimpleNamespace(earth_n=5e-5))
    after = 0.5 * 5.0 - 2.0 * 0.2 / 5e-5
    assert law.s.x[U, 0] == pytest.approx(after) and c_u == pytest.approx(0.5 * (5.0 + after))
    assert tuple(found) == pytest.approx((0.01, -0.06, 0.03, 0.02))


def test_a_method_without_an_azimuth_loop_or_undamped_corrects_no_heading(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setitem(plain(steer).__globals__, "_difference", lambda law, up: 1e-6)
    c = Correction(0.01, 0.02, 0.03, 0.04)
    for level_only in (True, False):
        law = compass_law(damped=False)
        law.p.gyrocompass, law.s.level_only = False, level_only
        law.s.epoch = law.s.azimuth_epoch = law.s.azimuth_input = 0
        found, c_u = plain(steer)(law, c, SimpleNamespace(rate=7e-5, by_lat=1.0, by_v_e=1.0))
        assert c_u == 0.0 and law.s.correction[U] == 0.0 and found == c
        assert law.s.steered is not level_only


@pytest.mark.parametrize(("v_e", "v_n"), [(0.0, 8.0), (6.0, 0.0), (-5.0, 3.0)])
def test_a_filter_reads_the_heading_off_a_log_in_the_ships_axes(v_e: float, v_n: float) -> None:
    """A heading error phi turns the velocity of the log: phi V_N more to the east, phi V_E less north."""
    phi = 0.01
    P = np.zeros((STATES, STATES))
    P[6, 6] = 0.02**2
    f = SimpleNamespace(
        P=P, scratch=np.zeros((2, STATES)), errors=np.zeros(STATES), sensors=np.zeros(0), known=False,
        gains=np.zeros((0, 2, STATES)),
    )  # fmt: skip
    model = SimpleNamespace(
        moored=np.zeros(0, bool), body_frame=True, axis=np.zeros(0, int), log_white=1e-12, moored_white=1e-12
    )
    plain(update)(model, 0, phi * v_n, -phi * v_e, v_e, v_n, f)
    assert f.errors[6] == pytest.approx(phi, rel=1e-6)
    assert P[6, 6] < 1e-8


def test_the_way_over_the_ellipsoid_counts_the_height_in_both_radii() -> None:
    lat, height = 0.8, 5000.0
    meridian, prime_vertical = WGS84.radii(lat)
    rates = plain(_position_rate)(lat, 100.0, 50.0, height, WGS84.e2)
    expected = 50.0 / (meridian + height), 100.0 / ((prime_vertical + height) * math.cos(lat))
    assert rates == pytest.approx(expected, rel=1e-12)
