from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from app.plots.style import method_color, rgb
from app.plots.units import round_down, round_up
from app.session.pins import Pin
from app.views.scene.graticule import LocalMap, angle_text, graticule, scale_bar
from app.views.scene.ship import ship_parts
from app.views.scene.track import HALF_WIDTH, attitude_quaternions, track
from navcore.foundation.earth import WGS84, attitude_matrix
from navcore.foundation.units import ARCSEC, DEG
from navcore.mechanization.recorder import D_LAT, D_LON
from navcore.motion.base import LAT, LON
from tests.unit.figures_runs import diverging, moving_run, run_of, static_run


def rotation(q: np.ndarray) -> np.ndarray:
    w, x, y, z = q
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


@pytest.mark.parametrize("angles_deg", [(0, 0, 0), (6, 8, 75), (-10, 20, 310), (3, -5, 725), (80, -170, 179)])
def test_quaternion_is_the_attitude_matrix(angles_deg: tuple[float, float, float]) -> None:
    pitch, roll, heading = (np.array([math.radians(a)]) for a in angles_deg)
    q = attitude_quaternions(pitch, roll, heading)[0]
    np.testing.assert_allclose(rotation(q), attitude_matrix(pitch[0], roll[0], heading[0]), atol=1e-14)


class TestMoving:
    def test_truth_is_where_latitude_and_longitude_say(self) -> None:
        run = moving_run()
        scene = track(run)
        meridian, normal = WGS84.radii(float(np.mean(run.truth[[0, -1], LAT])))
        step = (scene.truth[-1] - scene.truth[0])[:2] * scene.metres_per_unit
        lat = run.truth[-1, LAT] - run.truth[0, LAT]
        lon = run.truth[-1, LON] - run.truth[0, LON]
        expected = [lon * normal * math.cos(run.truth[:, LAT].mean()), lat * meridian]
        np.testing.assert_allclose(step, expected, rtol=3e-3)

    def test_computed_track_is_truth_plus_the_exaggerated_error(self) -> None:
        run = moving_run()
        scene = track(run)
        assert not scene.static
        for method, result in zip(scene.methods, run.methods, strict=True):
            error = result.rows[-1, [D_LON, D_LAT]]
            drawn = (method.points[-1] - scene.truth[-1])[:2] * scene.metres_per_unit
            np.testing.assert_allclose(drawn, scene.exaggeration * error, rtol=1e-3, atol=0.05)
            np.testing.assert_array_equal(method.error_m[-1], error)

    def test_exaggeration_is_round_visible_and_named(self) -> None:
        run = moving_run()
        scene = track(run)
        mantissa = scene.exaggeration / 10 ** math.floor(math.log10(scene.exaggeration))
        assert mantissa == pytest.approx(1) or mantissa == pytest.approx(2) or mantissa == pytest.approx(5)
        peak = max(m.errors["position_m"]["max_abs"] for m in run.methods)
        assert scene.exaggeration * peak / scene.metres_per_unit > 0.5
        assert f"x {scene.exaggeration:g}" in scene.caption
        assert track(run, exaggeration=1.0).caption.startswith("position errors to scale")

    def test_everything_lies_on_the_map(self) -> None:
        scene = track(moving_run())
        for line in (scene.truth, *(m.points for m in scene.methods)):
            assert len(line) <= 2000
            assert np.max(np.abs(line[:, :2])) <= HALF_WIDTH
        assert np.max(np.abs(scene.truth[:, :2])) > 0.5 * HALF_WIDTH

    def test_lines_and_vectors_for_viser(self) -> None:
        scene = track(moving_run())
        dashes = scene.truth_dashes()
        share = np.sum(np.linalg.norm(dashes[:, 1] - dashes[:, 0], axis=1)) / np.sum(
            np.linalg.norm(np.diff(scene.truth, axis=0), axis=1)
        )
        assert 0.4 < share < 0.6
        vectors = scene.place(float(scene.t_s[10])).error_vectors()
        np.testing.assert_array_equal(vectors[:, 0], np.repeat(scene.truth[10:11], 3, axis=0))
        np.testing.assert_array_equal(vectors[1, 1], scene.methods[1].points[10])
        assert scene.methods[2].color == rgb(method_color(2))

    def test_time_finds_its_point(self) -> None:
        scene = track(moving_run())
        assert scene.place(-5.0).index == 0
        assert scene.place(1e9).index == len(scene.t_s) - 1
        assert scene.t_s[scene.place(7200.0).index] <= 7200.0 < scene.t_s[scene.place(7200.0).index + 1]

    def test_between_two_points_the_ship_is_between_them(self) -> None:
        scene = track(moving_run())
        before, after = scene.t_s[20], scene.t_s[21]
        place = scene.place(float(0.25 * before + 0.75 * after))
        assert place.index == 20
        np.testing.assert_allclose(
            place.truth, 0.25 * scene.truth[20] + 0.75 * scene.truth[21], rtol=0, atol=1e-6
        )
        points = scene.methods[1].points
        np.testing.assert_allclose(place.computed[1], 0.25 * points[20] + 0.75 * points[21], atol=1e-6)
        assert np.linalg.norm(place.wxyz) == pytest.approx(1.0)
        np.testing.assert_allclose(scene.place(-1.0).truth, scene.truth[0])

    def test_across_the_date_line(self) -> None:
        legs = {"kind": "legs", "leg": [{"duration_s": 7200.0, "speed_kn": 20.0, "heading_deg": 90.0}]}
        run = run_of(run={"duration_h": 2.0}, motion=legs, site={"lat_deg": 10.0, "lon_deg": 179.9})
        scene = track(run)
        assert np.all(np.diff(scene.truth[:, 0]) >= 0.0)
        names = [label.text for label in scene.graticule.labels]
        assert any(text.endswith("E") for text in names) and any(text.endswith("W") for text in names)

    def test_diverged_method_ends_and_does_not_set_the_scale(self) -> None:
        whole = track(moving_run())
        scene = track(diverging(moving_run(), 0, rows=1000))
        assert len(scene.methods[0].points) < len(scene.truth)
        assert scene.exaggeration >= whole.exaggeration
        assert np.isfinite(scene.place(float(scene.t_s[-1])).error_vectors()).all()


class TestStatic:
    def test_map_is_as_large_as_the_errors_around_the_ship(self) -> None:
        scene = track(static_run())
        assert scene.static and scene.exaggeration == 1.0
        np.testing.assert_allclose(scene.truth[:, :2], 0.0, atol=1e-6)
        reach = max(np.max(np.abs(m.points[:, :2])) for m in scene.methods)
        assert 0.5 * HALF_WIDTH < reach <= HALF_WIDTH
        assert scene.caption == "position errors to scale"

    @pytest.mark.parametrize("size", [0.0, 1e-7, 1e-3, 1e3])
    def test_any_size_of_error(self, size: float) -> None:
        run = static_run()
        methods = tuple(
            replace(
                m,
                rows=m.rows * size,
                errors=m.errors | {"position_m": {"max_abs": m.errors["position_m"]["max_abs"] * size}},
            )
            for m in run.methods
        )
        scene = track(replace(run, methods=methods))
        assert all(np.isfinite(m.points).all() for m in scene.methods)
        assert 4 <= len(scene.graticule.labels) <= 20
        assert len({label.text for label in scene.graticule.labels}) == len(scene.graticule.labels)
        assert "e" not in scene.methods[2].error_text(5)


class TestGraticule:
    def test_lines_lie_at_their_latitude_and_longitude(self) -> None:
        area = LocalMap(32.06 * DEG, 118.8 * DEG, 6.36e6, 5.4e6, 1000.0)
        made = graticule(area, 5.0)
        label = next(item for item in made.labels if item.text.endswith("N"))
        degrees, minutes = label.text.rstrip("′N").split("°")
        lat = (int(degrees) + int(minutes) / 60.0) * DEG
        assert label.position[1] * 1000.0 == pytest.approx((lat - area.lat0) * 6.36e6, abs=1.0)
        east = [item for item in made.labels if item.text.endswith("E")]
        north = [item for item in made.labels if item.text.endswith("N")]
        meridians = np.count_nonzero(made.segments[:, 0, 0] == made.segments[:, 1, 0])
        assert len(north) == len(made.segments) - meridians
        assert 2 <= len(east) <= 4 < meridians  # of so many every second one has room for its name
        written = [item.position[0] for item in east]
        assert np.all(np.isin(np.float32(written), made.segments[:, 0, 0]))

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
        assert unit == "m"
        assert (bar[0, 1, 0] - bar[0, 0, 0]) * 437.0 == pytest.approx(float(value), rel=1e-5)

    def test_round_numbers(self) -> None:
        assert [round_down(v) for v in (1.0, 1.99, 2.0, 4.9, 5.0, 99.0, 0.03)] == pytest.approx(
            [1.0, 1.0, 2.0, 2.0, 5.0, 50.0, 0.02]
        )
        assert [round_up(v) for v in (1.0, 1.01, 2.0, 4.9, 5.1, 0.03)] == pytest.approx(
            [1.0, 2.0, 2.0, 5.0, 10.0, 0.05]
        )


class TestShip:
    def test_points_the_bow_forward_and_is_one_unit_long(self) -> None:
        everything = np.concatenate([part.vertices for part in ship_parts()])
        assert np.ptp(everything[:, 1]) == pytest.approx(1.0, abs=1e-6)
        hull = next(part for part in ship_parts() if part.name == "hull")
        bow = hull.vertices[np.argmax(hull.vertices[:, 1])]
        stern = hull.vertices[np.argmin(hull.vertices[:, 1])]
        assert abs(bow[0]) < 0.01 < abs(stern[0])
        np.testing.assert_allclose(np.sort(hull.vertices[:, 0]), np.sort(-hull.vertices[:, 0]), atol=1e-7)

    @pytest.mark.parametrize("name", [part.name for part in ship_parts()])
    def test_faces_look_outward(self, name: str) -> None:
        part = next(part for part in ship_parts() if part.name == name)
        assert part.faces.max() < len(part.vertices)
        corners = part.vertices[part.faces].astype(float)
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        if name == "deck":
            assert (normals[:, 2] > 0.0).all()
        else:
            # enclosed volume is positive when all normals point outward (the open deck lies in z ~ 0.06)
            centre = np.array([0.0, 0.0, 0.06]) if name == "hull" else np.zeros(3)
            assert np.sum(np.einsum("ij,ij->i", corners[:, 0] - centre, normals)) > 0.0
            outward = np.einsum("ij,ij->i", corners.mean(axis=1) - _box_centre(part, corners), normals)
            assert (outward > 0.0).all()


def _box_centre(part, corners: np.ndarray) -> np.ndarray:
    """Middle of the body each face belongs to: boxes have eight vertices each, the hull is one body."""
    if part.name == "hull":
        middle = np.zeros((len(corners), 3))
        middle[:, 1] = np.clip(corners[:, :, 1].mean(axis=1), -0.4, 0.45)
        middle[:, 2] = 0.02
        return middle
    boxes = part.vertices.reshape(-1, 8, 3).mean(axis=1)
    return boxes[part.faces[:, 0] // 8]


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
        longer = replace(
            run, methods=tuple(replace(m, rows=3.0 * m.rows[:50], t_s=m.t_s[:50]) for m in run.methods)
        )
        scene = track(run, exaggeration=20.0, pins=[Pin(1, "a", "", "black", True, run.scenario, "", longer)])
        for other in scene.pinned:
            assert np.max(np.abs(other.segments[..., :2])) <= HALF_WIDTH
            assert np.linalg.norm(other.segments[-1, 1] - scene.methods[0].points[-1]) > 0.1
