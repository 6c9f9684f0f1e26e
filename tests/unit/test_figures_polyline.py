"""Lines with few points lie where the many points are, and dashes are as long as their gaps."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from app.views.scene.polyline import dashes, needed, segments
from app.views.scene.track import LINE_WIDTH, track
from tests.unit.figures_runs import moving_run


def distance(points: np.ndarray, line: np.ndarray) -> float:
    """Largest distance of the points from a line."""
    drawn = shapely.linestrings(line[:, :2])
    return float(np.max(shapely.distance(drawn, shapely.points(points[:, :2]))))


@given(
    st.lists(st.tuples(st.floats(-5, 5), st.floats(-5, 5)), min_size=0, max_size=60),
    st.floats(1e-3, 1.0),
)
def test_what_is_left_out_lies_within_the_tolerance(
    corners: list[tuple[float, float]], tolerance: float
) -> None:
    points = np.array([(*corner, 0.0) for corner in corners], dtype=np.float32).reshape(-1, 3)
    chosen = needed(points, tolerance)
    assert np.all(np.diff(chosen) > 0)
    if len(points) > 1:
        assert chosen[0] == 0 and chosen[-1] == len(points) - 1
        assert distance(points, points[chosen]) <= tolerance * (1 + 1e-6) + 1e-7


def test_a_swinging_track_keeps_its_shape_with_a_quarter_of_its_points() -> None:
    t = np.linspace(0.0, 17.0 * 2.0 * np.pi, 1000)
    points = np.column_stack([t / 11.0, 2.0 * np.sin(t), 0.0 * t])
    chosen = needed(points, 0.2 * LINE_WIDTH)
    assert len(chosen) < 260
    assert distance(points, points[chosen]) <= 0.2 * LINE_WIDTH


def test_segments_are_pairs_of_neighbours() -> None:
    points = np.arange(12.0).reshape(4, 3)
    pairs = segments(points)
    np.testing.assert_array_equal(pairs[:, 0], points[:-1])
    np.testing.assert_array_equal(pairs[:, 1], points[1:])


def test_dashes_are_cut_by_length_and_bend_with_the_line() -> None:
    corner = np.array([[0, 0, 0], [2.5, 0, 0], [2.5, 2.0, 0]], dtype=np.float32)
    drawn = dashes(corner, 1.0)
    expected = [[(0, 0), (1, 0)], [(2, 0), (2.5, 0)], [(2.5, 0), (2.5, 0.5)], [(2.5, 1.5), (2.5, 2.0)]]
    np.testing.assert_allclose(drawn[:, :, :2], expected)


@pytest.mark.parametrize("count", [0, 1])
def test_a_line_without_length_has_no_dashes(count: int) -> None:
    assert len(dashes(np.zeros((count + 1, 3), dtype=np.float32), 1.0)) == 0


def test_a_method_is_drawn_whole_or_as_far_as_the_ship_has_come() -> None:
    method = track(moving_run()).methods[1]
    whole, part = method.drawn(), method.drawn(40)
    np.testing.assert_array_equal(whole[0, 0], method.points[0])
    np.testing.assert_array_equal(whole[-1, 1], method.points[-1])
    np.testing.assert_array_equal(part[-1, 1], method.points[40])
    assert distance(method.points[:41], np.concatenate([part[:1, 0], part[:, 1]])) <= 0.2 * LINE_WIDTH
    np.testing.assert_array_equal(method.drawn(10**6), whole)
