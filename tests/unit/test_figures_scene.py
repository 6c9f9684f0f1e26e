"""The map of true and computed tracks, its lines, labels and ships, and the cameras that look at it."""

import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from navcore.foundation.earth import WGS84, attitude_matrix
from navcore.foundation.units import ARCSEC, DEG
from navcore.mechanization.recorder import D_LAT, D_LON
from navcore.motion.truth import LAT, LON
from schuler_bench.plots.style import method_color, rgb
from schuler_bench.plots.units import round_down, round_up
from schuler_bench.session.pins import Pin
from schuler_bench.views.scene.drawer import ShipPart, ship_parts
from schuler_bench.views.scene.graticule import (
    LocalMap,
    angle_text,
    dashes,
    graticule,
    needed,
    scale_bar,
    segments,
)
from schuler_bench.views.scene.track import HALF_WIDTH, LINE_WIDTH, attitude_quaternions, error_texts, track
from schuler_bench.views.scene.view import CAMERAS, FOLLOW, SIDE, Cameras, Window
from tests.unit.figures_runs import diverging, moving_run, run_of, static_run


@pytest.mark.parametrize("angles_deg", [(0, 0, 0), (6, 8, 75), (-10, 20, 310), (3, -5, 725), (80, -170, 179)])
def test_quaternion_is_the_attitude_matrix(angles_deg: tuple[float, float, float]) -> None:
    pitch, roll, heading = np.deg2rad(angles_deg)
    w, x, y, z = attitude_quaternions(*(np.array([angle]) for angle in (pitch, roll, heading)))[0]
    rotation = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    np.testing.assert_allclose(rotation, attitude_matrix(pitch, roll, heading), atol=1e-14)


class TestMoving:
    def test_truth_is_where_latitude_and_longitude_say(self) -> None:
        run, scene = moving_run(), track(moving_run())
        meridian, normal = WGS84.radii(float(np.mean(run.truth[[0, -1], LAT])))
        step = (scene.truth[-1] - scene.truth[0])[:2] * scene.metres_per_unit
        lat, lon = (run.truth[-1, column] - run.truth[0, column] for column in (LAT, LON))
        expected = [lon * normal * math.cos(run.truth[:, LAT].mean()), lat * meridian]
        np.testing.assert_allclose(step, expected, rtol=3e-3)

    def test_computed_track_is_truth_plus_the_exaggerated_error(self) -> None:
        run, scene = moving_run(), track(moving_run())
        assert not scene.static and scene.methods[2].color == rgb(method_color(2))
        for method, result in zip(scene.methods, run.methods, strict=True):
            error = result.rows[-1, [D_LON, D_LAT]]
            drawn = (method.points[-1] - scene.truth[-1])[:2] * scene.metres_per_unit
            np.testing.assert_allclose(drawn, scene.exaggeration * error, rtol=1e-3, atol=0.05)
            np.testing.assert_array_equal(method.error_m[-1], error)

    def test_exaggeration_is_round_visible_and_named(self) -> None:
        run, scene = moving_run(), track(moving_run())
        assert scene.exaggeration == pytest.approx(round_down(scene.exaggeration))
        peak = max(m.errors["position_m"]["max_abs"] for m in run.methods)
        assert scene.exaggeration * peak / scene.metres_per_unit > 0.5
        assert f"x {scene.exaggeration:g}" in scene.caption
        assert track(run, exaggeration=1.0).caption.startswith("position errors to scale")

    def test_everything_lies_on_the_map(self) -> None:
        scene = track(moving_run())
        for line in (scene.truth, *(m.points for m in scene.methods)):
            assert len(line) <= 2000 and np.max(np.abs(line[:, :2])) <= HALF_WIDTH
        assert np.max(np.abs(scene.truth[:, :2])) > 0.5 * HALF_WIDTH

    def test_truth_is_dashed_and_vectors_lead_to_the_computed_places(self) -> None:
        scene = track(moving_run())
        drawn = np.linalg.norm(np.diff(scene.truth_dashes(), axis=1), axis=2).sum()
        assert 0.4 < drawn / np.linalg.norm(np.diff(scene.truth, axis=0), axis=1).sum() < 0.6
        vectors = scene.place(float(scene.t_s[10])).error_vectors()
        np.testing.assert_array_equal(vectors[:, 0], np.repeat(scene.truth[10:11], 3, axis=0))
        np.testing.assert_array_equal(vectors[1, 1], scene.methods[1].points[10])

    def test_time_finds_its_point_and_between_two_the_ship_is_between_them(self) -> None:
        scene = track(moving_run())
        assert [scene.place(at).index for at in (-5.0, 1e9)] == [0, len(scene.t_s) - 1]
        np.testing.assert_allclose(scene.place(-1.0).truth, scene.truth[0])
        place = scene.place(float(scene.t_s[20:22] @ (0.25, 0.75)))
        assert place.index == 20 and np.linalg.norm(place.wxyz) == pytest.approx(1.0)
        for line, there in ((scene.truth, place.truth), (scene.methods[1].points, place.computed[1])):
            np.testing.assert_allclose(there, 0.25 * line[20] + 0.75 * line[21], rtol=0, atol=1e-6)

    def test_across_the_date_line(self) -> None:
        legs = {"kind": "legs", "leg": [{"duration_s": 7200.0, "speed_kn": 20.0, "heading_deg": 90.0}]}
        scene = track(run_of(run={"duration_h": 2.0}, motion=legs, site={"lat_deg": 10.0, "lon_deg": 179.9}))
        assert np.all(np.diff(scene.truth[:, 0]) >= 0.0)
        assert {"E", "W"} <= {label.text[-1] for label in scene.graticule.labels}

    def test_diverged_method_ends_and_does_not_set_the_scale(self) -> None:
        whole, scene = track(moving_run()), track(diverging(moving_run(), 0, rows=1000))
        assert len(scene.methods[0].points) < len(scene.truth) and scene.exaggeration >= whole.exaggeration
        assert np.isfinite(scene.place(float(scene.t_s[-1])).error_vectors()).all()

    def test_a_method_is_drawn_whole_or_as_far_as_the_ship_has_come(self) -> None:
        method = track(moving_run()).methods[1]
        whole, part = method.drawn(), method.drawn(40)
        np.testing.assert_array_equal([whole[0, 0], whole[-1, 1], part[-1, 1]], method.points[[0, -1, 40]])
        assert distance(method.points[:41], np.concatenate([part[:1, 0], part[:, 1]])) <= 0.2 * LINE_WIDTH
        np.testing.assert_array_equal(method.drawn(10**6), whole)


class TestStatic:
    def test_map_is_as_large_as_the_errors_around_the_ship(self) -> None:
        scene = track(static_run())
        assert scene.static and scene.exaggeration == 1.0 and scene.caption == "position errors to scale"
        np.testing.assert_allclose(scene.truth[:, :2], 0.0, atol=1e-6)
        reach = max(np.max(np.abs(m.points[:, :2])) for m in scene.methods)
        assert 0.5 * HALF_WIDTH < reach <= HALF_WIDTH

    @pytest.mark.parametrize("size", [0.0, 1e-7, 1e-3, 1e3])
    def test_any_size_of_error(self, size: float) -> None:
        run, methods = static_run(), []
        for method in run.methods:
            peak = {"max_abs": method.errors["position_m"]["max_abs"] * size}
            errors = method.errors | {"position_m": peak}
            methods.append(replace(method, rows=method.rows * size, errors=errors))
        scene = track(replace(run, methods=tuple(methods)))
        names = [label.text for label in scene.graticule.labels]
        assert 4 <= len(names) == len(set(names)) <= 20
        assert all(np.isfinite(m.points).all() for m in scene.methods)
        texts = error_texts(scene.methods, 5)
        assert all("e" not in text for text in texts)
        assert len({text.split()[1] for text in texts}) == 1, (
            "one legend, one unit: it was 3.4 km beside 120 m"
        )


class TestGraticule:
    def test_lines_lie_at_their_latitude_and_longitude(self) -> None:
        area = LocalMap(32.06 * DEG, 118.8 * DEG, 6.36e6, 5.4e6, 1000.0)
        grid = graticule(area, 5.0)
        east, north = ([label for label in grid.labels if label.text.endswith(side)] for side in "EN")
        degrees, minutes = north[0].text.rstrip("′N").split("°")
        lat = (int(degrees) + int(minutes) / 60.0) * DEG
        assert north[0].position[1] * 1000.0 == pytest.approx((lat - area.lat0) * 6.36e6, abs=1.0)
        meridians = np.count_nonzero(grid.segments[:, 0, 0] == grid.segments[:, 1, 0])
        assert len(north) == len(grid.segments) - meridians
        assert 2 <= len(east) <= 4 < meridians  # of so many every second one has room for its name
        assert np.all(np.isin(np.float32([label.position[0] for label in east]), grid.segments[:, 0, 0]))

    @pytest.mark.parametrize(
        ("value", "step", "text"),
        [
            (32.06 * DEG, DEG, "32°N"),
            (-(59.0 + 59.999 / 60.0) * DEG, DEG / 60.0, "60°00′S"),
            (1.0 * ARCSEC, 0.5 * ARCSEC, "0°00′01.0″N"),
            (0.05 * ARCSEC, 0.01 * ARCSEC, "0°00′00.05″N"),
        ],
    )
    def test_angle_text(self, value: float, step: float, text: str) -> None:
        assert angle_text(value, step, "NS") == text

    def test_scale_bar_has_the_length_it_names(self) -> None:
        bar, label = scale_bar(437.0, 5.0)
        value, unit = label.text.split()
        assert unit == "m" and (bar[0, 1, 0] - bar[0, 0, 0]) * 437.0 == pytest.approx(float(value), rel=1e-5)

    @pytest.mark.parametrize(
        ("rounded", "values", "wanted"),
        [
            (round_down, (1.0, 1.99, 2.0, 4.9, 5.0, 99.0, 0.03), [1.0, 1.0, 2.0, 2.0, 5.0, 50.0, 0.02]),
            (round_up, (1.0, 1.01, 2.0, 4.9, 5.1, 0.03), [1.0, 2.0, 2.0, 5.0, 10.0, 0.05]),
        ],
    )
    def test_round_numbers(self, rounded: Any, values: tuple[float, ...], wanted: list[float]) -> None:
        assert [rounded(value) for value in values] == pytest.approx(wanted)


class TestShip:
    def test_points_the_bow_forward_and_is_one_unit_long(self) -> None:
        assert np.ptp(np.concatenate([part.vertices for part in ship_parts()])[:, 1]) == pytest.approx(
            1.0, abs=1e-6
        )
        hull = next(part for part in ship_parts() if part.name == "hull").vertices
        bow, stern = hull[np.argmax(hull[:, 1])], hull[np.argmin(hull[:, 1])]
        assert abs(bow[0]) < 0.01 < abs(stern[0])
        np.testing.assert_allclose(np.sort(hull[:, 0]), np.sort(-hull[:, 0]), atol=1e-7)

    @pytest.mark.parametrize("part", ship_parts(), ids=lambda part: part.name)
    def test_faces_look_outward(self, part: ShipPart) -> None:
        assert part.faces.max() < len(part.vertices)
        corners = part.vertices[part.faces].astype(float)
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        if part.name == "deck":
            assert (normals[:, 2] > 0.0).all()
            return
        # the hull is one body, boxes have eight vertices each
        if part.name == "hull":
            along = np.clip(corners[:, :, 1].mean(axis=1), -0.4, 0.45)
            middle = np.column_stack([0.0 * along, along, 0.0 * along + 0.02])
        else:
            middle = part.vertices.reshape(-1, 8, 3).mean(axis=1)[part.faces[:, 0] // 8]
        # enclosed volume is positive when all normals point outward (the open deck lies in z ~ 0.06)
        centre = (0.0, 0.0, 0.06 if part.name == "hull" else 0.0)
        assert np.sum(np.einsum("ij,ij->i", corners[:, 0] - centre, normals)) > 0.0
        assert (np.einsum("ij,ij->i", corners.mean(axis=1) - middle, normals) > 0.0).all()


class TestPinned:
    def test_a_pinned_run_lies_where_its_errors_are_on_the_present_way(self) -> None:
        run = moving_run()
        pin = Pin(1, "before", "", "magenta", True, run.scenario, "", run)
        scene, alone = track(run, exaggeration=2.0, pins=[pin]), track(run, exaggeration=2.0)
        assert [other.label for other in scene.pinned] == [f"before: {m.method.name}" for m in run.methods]
        for other, own in zip(scene.pinned, scene.methods, strict=True):
            np.testing.assert_allclose(other.segments, own.drawn(), atol=1e-5)
            assert other.color == rgb(pin.hex)
        np.testing.assert_allclose(scene.methods[1].points, alone.methods[1].points, atol=1e-6)

    def test_a_shorter_and_larger_one_fits_the_map_and_stays_on_it(self) -> None:
        run = moving_run()
        methods = tuple(replace(m, rows=3.0 * m.rows[:50], t_s=m.t_s[:50]) for m in run.methods)
        pin = Pin(1, "a", "", "black", True, run.scenario, "", replace(run, methods=methods))
        scene = track(run, exaggeration=20.0, pins=[pin])
        for other in scene.pinned:
            assert np.max(np.abs(other.segments[..., :2])) <= HALF_WIDTH
            assert np.linalg.norm(other.segments[-1, 1] - scene.methods[0].points[-1]) > 0.1


def distance(points: np.ndarray, line: np.ndarray) -> float:
    """Largest distance of the points from a line."""
    return float(np.max(shapely.distance(shapely.linestrings(line[:, :2]), shapely.points(points[:, :2]))))


class TestPolyline:
    @given(
        st.lists(st.tuples(st.floats(-5, 5), st.floats(-5, 5)), min_size=0, max_size=60),
        st.floats(1e-3, 1.0),
    )
    def test_what_is_left_out_lies_within_the_tolerance(
        self, corners: list[tuple[float, float]], tolerance: float
    ) -> None:
        points = np.array([(*corner, 0.0) for corner in corners], dtype=np.float32).reshape(-1, 3)
        chosen = needed(points, tolerance)
        assert np.all(np.diff(chosen) > 0)
        if len(points) > 1:
            assert (chosen[0], chosen[-1]) == (0, len(points) - 1)
            assert distance(points, points[chosen]) <= tolerance * (1 + 1e-6) + 1e-7

    def test_a_swinging_track_keeps_its_shape_with_a_quarter_of_its_points(self) -> None:
        t = np.linspace(0.0, 17.0 * 2.0 * np.pi, 1000)
        points = np.column_stack([t / 11.0, 2.0 * np.sin(t), 0.0 * t])
        chosen = needed(points, 0.2 * LINE_WIDTH)
        assert len(chosen) < 260 and distance(points, points[chosen]) <= 0.2 * LINE_WIDTH

    def test_segments_are_pairs_of_neighbours(self) -> None:
        points = np.arange(12.0).reshape(4, 3)
        np.testing.assert_array_equal(segments(points), np.stack([points[:-1], points[1:]], axis=1))

    def test_dashes_are_cut_by_length_and_bend_with_the_line(self) -> None:
        corner = np.array([[0, 0, 0], [2.5, 0, 0], [2.5, 2.0, 0]], dtype=np.float32)
        expected = [[(0, 0), (1, 0)], [(2, 0), (2.5, 0)], [(2.5, 0), (2.5, 0.5)], [(2.5, 1.5), (2.5, 2.0)]]
        np.testing.assert_allclose(dashes(corner, 1.0)[:, :, :2], expected)
        for count in (1, 2):
            assert len(dashes(np.zeros((count, 3), dtype=np.float32), 1.0)) == 0


FOV = math.radians(75.0)
WINDOWS = (
    Window(580, 1080, 285, 132),
    Window(312, 720, 195, 176),
    Window(600, 380, 0, 52),
    Window(1280, 720, 195, 52),
    Window(3000, 600, 195, 132),
)


def seen(camera: Any, window: Window, point: tuple[float, float]) -> tuple[float, float]:
    """Where a place of the map is in the window, px from its upper left corner."""
    position: np.ndarray = np.array(camera.position, dtype=float)
    ahead: np.ndarray = np.array(camera.look_at, dtype=float) - position
    ahead /= np.linalg.norm(ahead)
    right: np.ndarray = np.cross(ahead, np.array(camera.up_direction, dtype=float))
    right /= np.linalg.norm(right)
    away = np.array([*point, 0.0]) - position
    scale = 0.5 * window.height / math.tan(0.5 * FOV) / float(np.dot(away, ahead))
    x, y = (scale * float(np.dot(away, side)) for side in (right, np.cross(ahead, right)))
    return 0.5 * window.width + x, 0.5 * window.height + y


@pytest.mark.parametrize("name", [name for name in CAMERAS if name != FOLLOW])
@pytest.mark.parametrize("window", WINDOWS, ids=lambda window: f"{window.width}x{window.height}")
def test_the_map_fills_what_is_free(name: str, window: Window) -> None:
    camera: Any = SimpleNamespace(fov=FOV, position=None, look_at=None, up_direction=None)
    Cameras(camera).choose(name, window, None)
    edges = [(x, y) for x in (-HALF_WIDTH, HALF_WIDTH) for y in (-HALF_WIDTH, HALF_WIDTH)]
    left, top = np.min([seen(camera, window, edge) for edge in edges], axis=0)
    right, bottom = np.max([seen(camera, window, edge) for edge in edges], axis=0)
    bar = seen(camera, window, (HALF_WIDTH, -HALF_WIDTH - 1.4))[1]
    label = seen(camera, window, (-HALF_WIDTH - 0.12, -HALF_WIDTH))[0]
    assert label >= 29  # half of "48°11′00″N" with its ground
    assert left >= 0.05 * window.width and right <= 0.95 * window.width
    assert top >= window.above - 1 and bar <= window.height - window.below - 17
    # One of the two directions is filled, and what is left of the other is the same on both sides.
    across = (right - left) / window.width
    arrow = seen(camera, window, (-HALF_WIDTH, HALF_WIDTH + 0.5))[1]
    above, below = arrow - window.above, window.height - window.below - 18 - bar
    assert left == pytest.approx(window.width - right)
    if name != SIDE:  # from there the map is low, and its far edge near the horizon
        assert across > 0.79 or above + below < 3.0
        assert abs(above - below) <= 0.2 * (window.height - window.above - window.below)
