"""`schuler check` on a recorded IMU: rate, span, which axis looks like up, gaps and NaN."""

import json

import pytest

from app.cli import main

HEADER = "t_s,gx_rad_s,gy_rad_s,gz_rad_s,fx_mps2,fy_mps2,fz_mps2"
PSINS = """% PSINS-format SIMU log file.
0 0 -90.6 0 0 0
34.0 108.0 380.0 0.0 10.0 9.780327
0.1 0.1 0.1 125 125 125
{rows}
"""


def _csv(tmp_path, times, force="0.1,0.2,9.8"):
    path = tmp_path / "imu.csv"
    path.write_text("\n".join([HEADER, *(f"{t},1e-5,2e-5,3e-5,{force}" for t in times)]) + "\n")
    return str(path)


def _check(path, capsys):
    code = main(["check", path, "--json"])
    return code, json.loads(capsys.readouterr().out)


def test_a_csv_is_described(tmp_path, capsys):
    code, told = _check(_csv(tmp_path, [k / 50 for k in range(1, 101)]), capsys)
    assert (code, told["kind"], told["warnings"]) == (0, "recorded IMU, CSV", [])
    assert (told["samples"], told["rate_hz"], told["span_s"], told["gaps"]) == (100, 50.0, 2.0, 0)
    assert told["up_axis"] == "+z" and told["mean_force_mps2"] == [0.1, 0.2, 9.8]
    assert told["mean_turn_dph"][0] == pytest.approx(2.0626, abs=1e-3)


def test_psins_gives_its_place(tmp_path, capsys):
    path = tmp_path / "a.imu"
    path.write_text(PSINS.format(rows="1 -2 3 4 -5 80\n" * 50))
    code, told = _check(str(path), capsys)
    assert (code, told["kind"]) == (0, "recorded IMU, PSINS")
    assert told["place"] == {"lat_deg": 34.0, "lon_deg": 108.0, "height_m": 380.0}


@pytest.mark.parametrize(
    ("force", "warning"),
    [
        ("0.1,0.2,-9.8", 'the -z axis looks like up: forward, right, down? Then give imu.axes = "frd"'),
        ("9.8,0.1,0.2", "the +x axis looks like up"),
        ("0,0,1.0", "is 1 m/s², far from gravity"),
    ],
)
def test_wrong_axes_and_scales_are_warned_of(force, warning, tmp_path, capsys):
    code, told = _check(_csv(tmp_path, [k / 50 for k in range(1, 101)], force), capsys)
    assert code == 0 and len(told["warnings"]) == 1 and warning in told["warnings"][0]


@pytest.mark.parametrize(
    ("times", "force", "fault"),
    [
        ([1, 2, 3, 7, 8], "0,0,9.8", "1 gaps, the first at t = 3 s, the longest 4 s"),
        ([1, 2, 2, 3], "0,0,9.8", "time stands still or runs backwards at t = 2 s"),
        ([1, 2, 3, 4], "0,nan,9.8", "4 samples are NaN or infinite, the first at sample 1"),
    ],
)
def test_gaps_and_nan_are_faults(times, force, fault, tmp_path, capsys):
    code, told = _check(_csv(tmp_path, times, force), capsys)
    assert code == 2 and not told["ok"] and fault in told["faults"][0]["allowed"]


def test_people_get_the_same_in_words(tmp_path, capsys):
    assert main(["check", _csv(tmp_path, range(1, 20))]) == 0
    out = capsys.readouterr().out
    for word in (
        "19 samples at 1 Hz",
        "the +z axis looks like up",
        "the Earth: 15.041",
        "warning: 1 Hz is slow",
    ):
        assert word in out
