"""Motion `track`: the truth from recorded positions is consistent, follows the record, refuses bad ones."""

import math
import sys
from pathlib import Path

import numpy as np
import pytest

from navcore.foundation.earth import SPHERE, WGS84, Earth
from navcore.foundation.errors import InputError
from navcore.foundation.units import DEG, KNOT
from navcore.motion.pieces import shared_pieces
from navcore.motion.smoothing import smoothed_columns
from navcore.motion.track import TrackMotion
from navcore.motion.truth import (
    AE,
    AN,
    AU,
    HEADING,
    HEADING_RATE,
    HEIGHT,
    LAT,
    LON,
    PITCH,
    PITCH_RATE,
    ROLL,
    VE,
    VN,
    VU,
    Site,
    Truth,
)
from tests.nmea import ship_files, stamped, write

NOWHERE = Site(0.0, 0.0, 0.0)


def table(path: Path, time_s: np.ndarray, **columns: np.ndarray) -> Path:
    values = np.column_stack([time_s, *columns.values()])
    header = ",".join(["t_s", *columns])
    np.savetxt(path, values, fmt="%.12f", delimiter=",", header=header, comments="")
    return path


def circle(tmp_path: Path, noise_m: float = 0.0, **more: np.ndarray) -> Path:
    """Circle of 500 m in 600 s about 60 N on the antimeridian, heading along the track."""
    t = np.arange(1201.0)
    angle = 2.0 * math.pi * t / 600.0
    north, east = 500.0 * np.sin(angle), 500.0 * (1.0 - np.cos(angle))
    if noise_m:
        rng = np.random.default_rng(1)
        north, east = (
            north + noise_m * rng.standard_normal(t.size),
            east + noise_m * rng.standard_normal(t.size),
        )
    meridian, prime_vertical = WGS84.radii(60.0 * DEG)
    lon = 179.998 + east / (prime_vertical * math.cos(60.0 * DEG)) / DEG
    return table(
        tmp_path / "circle.csv",
        t,
        lat_deg=60.0 + north / meridian / DEG,
        lon_deg=np.where(lon > 180.0, lon - 360.0, lon),
        heading_deg=np.mod(angle / DEG, 360.0),
        **more,
    )


def truth_of(path: Path, count: int = 2401, step_s: float = 0.5, earth: Earth = WGS84, **fields) -> Truth:
    return TrackMotion(file=str(path), **fields).truth(count, step_s, NOWHERE, earth)


@pytest.mark.parametrize("earth", [WGS84, SPHERE], ids=lambda earth: earth.name)
def test_velocity_and_acceleration_are_the_derivatives_of_position(tmp_path, earth):
    step = 0.01
    values = truth_of(circle(tmp_path), 50_001, step, earth).values
    lat = values[1:-1, LAT]
    e2 = earth.e2
    w = 1.0 - e2 * np.sin(lat) ** 2
    prime_vertical = 6378137.0 / np.sqrt(w)
    north = (values[2:, LAT] - values[:-2, LAT]) / (2 * step) * prime_vertical * (1.0 - e2) / w
    east = (values[2:, LON] - values[:-2, LON]) / (2 * step) * prime_vertical * np.cos(lat)
    np.testing.assert_allclose(values[1:-1, VN], north, rtol=0.0, atol=2e-6)
    np.testing.assert_allclose(values[1:-1, VE], east, rtol=0.0, atol=2e-6)
    for velocity, acceleration in ((VE, AE), (VN, AN), (HEADING, HEADING_RATE)):
        rate = (values[2:, velocity] - values[:-2, velocity]) / (2 * step)
        np.testing.assert_allclose(values[1:-1, acceleration], rate, rtol=0.0, atol=5e-6)
    assert np.all(values[:, [VU, AU]] == 0.0)


def test_a_smooth_motion_passes_the_smoothing(tmp_path):
    values = truth_of(circle(tmp_path)).values
    t = 0.5 * np.arange(2401)
    inside = slice(60, -60)
    speed = 500.0 * 2.0 * math.pi / 600.0
    angle = 2.0 * math.pi * t[inside] / 600.0
    np.testing.assert_allclose(values[inside, VN], speed * np.cos(angle), rtol=0.0, atol=0.01)
    np.testing.assert_allclose(values[inside, VE], speed * np.sin(angle), rtol=0.0, atol=0.01)
    np.testing.assert_allclose(values[inside, HEADING], angle, rtol=0.0, atol=1e-4)


def test_noise_of_the_positions_is_smoothed_as_stated(tmp_path):
    path = circle(tmp_path, noise_m=1.0)
    rough = truth_of(path, smoothing_s=0.0).values
    smooth = truth_of(path, smoothing_s=5.0).values
    clean = truth_of(circle(tmp_path), smoothing_s=0.0).values
    inside = slice(60, -60)
    # White noise of the positions through w H(w) with H = 1/(1 + (w tau)^4), one sample a second.
    w = np.linspace(0.0, math.pi, 200_001)
    expected = math.sqrt(np.trapezoid(w**2 / (1.0 + (5.0 * w) ** 4) ** 2, w) / math.pi)
    assert np.std((smooth - clean)[inside, VN]) == pytest.approx(expected, rel=0.15)
    assert np.std((rough - clean)[inside, VN]) > 20.0 * expected


def test_recorded_pitch_and_roll_are_used_and_constants_otherwise(tmp_path):
    t = np.arange(1201.0)
    plain = truth_of(circle(tmp_path), pitch_deg=1.0, roll_deg=-2.0).values
    assert np.all(plain[:, PITCH] == 1.0 * DEG)
    assert np.all(plain[:, ROLL] == -2.0 * DEG)
    recorded = circle(tmp_path, pitch_deg=3.0 * np.sin(t / 100.0), roll_deg=np.full(t.size, 4.0))
    values = truth_of(recorded, pitch_deg=1.0).values
    # Within a few time constants of its ends a smoothing spline is straighter than the record.
    assert values[60:-60:2, PITCH] == pytest.approx(3.0 * DEG * np.sin(t / 100.0)[30:-30], abs=1e-6)
    assert values[60:-60:2, PITCH_RATE] == pytest.approx(0.03 * DEG * np.cos(t / 100.0)[30:-30], abs=1e-6)
    assert values[:, ROLL] == pytest.approx(4.0 * DEG)


def test_height_is_the_median_recorded_one(tmp_path):
    t = np.arange(1201.0)
    assert np.all(truth_of(circle(tmp_path)).values[:, HEIGHT] == 0.0)
    values = truth_of(circle(tmp_path, height_m=np.where(t == 7, 90.0, 12.0))).values
    assert np.all(values[:, HEIGHT] == 12.0)


def test_positions_and_heading_of_two_nmea_files_are_joined(tmp_path):
    files = ship_files(tmp_path)
    motion = TrackMotion(file=(str(files["gnss"]), str(files["gyro"])))
    values = motion.truth(601, 0.5, NOWHERE, SPHERE).values
    assert values[:, HEADING] == pytest.approx(30.0 * DEG)
    # The made-up ship runs 60 nautical miles a degree: 1852.25 m a minute on this sphere are 10.0015 kn.
    scale = 6378137.0 * DEG / (60.0 * 1852.0)
    assert np.hypot(values[:, VE], values[:, VN]) == pytest.approx(10.0 * KNOT * scale, rel=1e-4)
    assert tuple(values[0, [LAT, LON]]) == pytest.approx((48.0 * DEG, -123.0 * DEG), abs=1e-9)
    # GNSS 0 to 300 s and a second of reach, gyro 0.01 to 299.51 s and half a second.
    assert motion.window().span_s == pytest.approx(300.01, abs=1e-3)


def test_a_later_start_shifts_the_track(tmp_path):
    path = circle(tmp_path)
    motion = TrackMotion(file=str(path))
    whole = motion.truth(1201, 1.0, NOWHERE, WGS84).values
    late = motion.truth(901, 1.0, NOWHERE, WGS84, start_utc=300.0).values
    assert late == pytest.approx(whole[300:], abs=1e-12)


def test_a_longer_run_than_the_record_is_refused(tmp_path):
    path = circle(tmp_path)
    truth_of(path, 1202, 1.0)
    with pytest.raises(InputError, match=r"lasts 1201.0 s = 0.3336 h .* the run 1202.0 s"):
        truth_of(path, 1203, 1.0)


@pytest.mark.parametrize(
    ("wanted", "said"),
    [
        ((), "file: name at least one file"),
        (("gnss",), "holds no heading"),
        (("gyro",), "holds no position"),
        (("log",), "holds no position"),
    ],
)
def test_a_track_lacks_something(tmp_path, wanted, said):
    files = ship_files(tmp_path)
    with pytest.raises(InputError) as caught:
        TrackMotion(file=tuple(str(files[name]) for name in wanted)).window()
    assert said in str(caught.value)
    assert {fault.field for fault in caught.value.faults} == {"file"}


@pytest.mark.parametrize(
    ("lat_deg", "said"),
    [(60.0 + 0.01 * (np.arange(100) > 50), "off its neighbours"), (np.full(4, 60.0), "only 4 positions")],
    ids=["jump", "few"],
)
def test_positions_that_are_no_track_are_refused(tmp_path, lat_deg, said):
    rest = np.zeros(lat_deg.size)
    time_s = np.arange(float(lat_deg.size))
    path = table(tmp_path / "bad.csv", time_s, lat_deg=lat_deg, lon_deg=rest, heading_deg=rest)
    with pytest.raises(InputError, match=said):
        truth_of(path, 3, 1.0)


def test_a_position_far_off_its_neighbours_is_named(tmp_path):
    path = circle(tmp_path)
    lines = path.read_text().splitlines()
    cells = lines[101].split(",")
    lines[101] = ",".join([cells[0], str(float(cells[1]) + 0.01), *cells[2:]])
    path.write_text("\n".join(lines))
    with pytest.raises(InputError) as caught:
        truth_of(path)
    assert len(caught.value.faults) == 1
    assert "positions: 1 from 100 s lie 1.12 km from those before and after" in str(caught.value)


def test_a_gap_in_a_turn_is_no_outlier(tmp_path):
    path = circle(tmp_path)
    lines = path.read_text().splitlines()
    path.write_text("\n".join(lines[:400] + lines[460:]))
    truth = truth_of(path)
    assert np.all(np.isfinite(truth.values))


def test_a_single_heading_is_no_heading_along_the_track(tmp_path):
    gnss = ship_files(tmp_path)["gnss"]
    gyro = write(tmp_path / "one.txt", [stamped(1.0, "HEHDT,45.0,T")])
    with pytest.raises(InputError, match="share no time"):
        TrackMotion(file=(str(gnss), str(gyro))).truth(1, 1.0, NOWHERE, WGS84)


def test_two_headings_turn_evenly(tmp_path):
    gnss = ship_files(tmp_path)["gnss"]
    gyro = write(tmp_path / "two.txt", [stamped(t, f"HEHDT,{h},T") for t, h in ((0, 350.0), (100, 10.0))])
    values = TrackMotion(file=(str(gnss), str(gyro))).truth(101, 1.0, NOWHERE, WGS84).values
    assert values[50, HEADING] == pytest.approx(360.0 * DEG)
    assert values[:, HEADING_RATE] == pytest.approx(0.2 * DEG)


@pytest.mark.parametrize(("given", "largest"), [(False, 1.0), (True, 0.02), ("wrong", 1.0)])
def test_velocity_columns_give_the_velocity_at_the_start_of_a_turn(tmp_path, given, largest):
    """A circle at 5 m/s, 0.5 deg/s: positions alone are off by 0.29 m/s at the start."""
    turn, speed, lat = np.radians(0.5), 5.0, np.radians(48.0)
    t = np.arange(300.0)
    heading = np.radians(30.0) + turn * t
    meridian, prime_vertical = WGS84.radii(lat)
    north = speed / turn * (np.sin(heading) - np.sin(heading[0]))
    east = -speed / turn * (np.cos(heading) - np.cos(heading[0]))
    velocity = speed * np.column_stack([np.sin(heading), np.cos(heading)])
    columns = [t, 48.0 + np.degrees(north / meridian)]
    columns += [-123.0 + np.degrees(east / (prime_vertical * np.cos(lat))), np.degrees(heading) % 360.0]
    names = "t_s,lat_deg,lon_deg,heading_deg"
    if given:
        columns += list((velocity if given is True else velocity[::-1]).T)
        names += ",ve_mps,vn_mps"
    np.savetxt(tmp_path / "t.csv", np.column_stack(columns), "%.9f", ",", header=names, comments="")
    truth = TrackMotion(file=str(tmp_path / "t.csv")).truth(300, 1.0, Site(0.0, 0.0, 0.0), WGS84).values
    error = np.hypot(*(truth[:, [VE, VN]] - velocity).T)
    assert error[0] < largest
    assert (error[0] > 0.2) == (given is not True)
    assert error[30:-30].max() < 0.02
    assert np.gradient(truth[:, VE]) == pytest.approx(truth[:, AE], abs=0.02)


def test_the_smoothing_spline_is_the_one_that_is_least():
    """Against scipy's, on uneven times."""
    from scipy.interpolate import make_smoothing_spline

    rng = np.random.default_rng(4)
    x = np.cumsum(rng.uniform(0.5, 1.5, 400))
    y = np.column_stack([np.cumsum(rng.normal(size=x.size)), 100.0 * np.sin(x / 30.0)])
    spline = smoothed_columns(x, y, 5.0)
    penalty = 5.0**4 / float(np.median(np.diff(x)))
    known = make_smoothing_spline(x - x[0], y, lam=penalty)
    fine = np.linspace(x[0], x[-1], 4001)
    np.testing.assert_allclose(spline.at(fine), known(fine - x[0]), rtol=0.0, atol=1e-8)
    np.testing.assert_allclose(spline.rate(fine), known(fine - x[0], 1), rtol=0.0, atol=1e-8)


def test_a_million_points_are_smoothed_without_a_loop_over_them():
    """A loop in Python takes 35 us a point: half a minute for a recording of 16 MiB."""
    counted = [0]

    def count(frame: object, event: str, argument: object) -> None:
        counted[0] += 1

    sys.setprofile(count)
    try:
        smoothed_columns(np.arange(20000.0), np.zeros((20000, 2)), 5.0)
    finally:
        sys.setprofile(None)
    assert counted[0] < 20000


def test_a_few_rows_of_a_long_track_are_those_of_all_and_need_few_pieces(tmp_path, monkeypatch):
    """The start of a track of 16 MiB, or its mean course, took as many pieces as the track has fixes."""
    path, laid = circle(tmp_path), []
    monkeypatch.setattr(
        "navcore.motion.track.shared_pieces", lambda *given: laid.append(shared_pieces(*given)) or laid[-1]
    )
    every = truth_of(path, 2401, 0.5).values
    few = truth_of(path, 13, 100.0).values
    np.testing.assert_array_equal(few, every[::200])
    np.testing.assert_array_equal(truth_of(path, 1, 1.0).values, every[:1])
    assert [len(pieces) for pieces in laid[1:]] == [13, 1] and len(laid[0]) > 1000
