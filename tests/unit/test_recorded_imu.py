"""Recorded IMUs: both formats, and one clear line for each fault."""

import numpy as np
import pytest

from navcore.foundation.errors import InputError
from navcore.foundation.units import ARCSEC
from navcore.sensors.recorded_imu import check_rest, read_imu

PSINS = """% PSINS-format SIMU log file.
0 0 -90.6 0 0 0
34.0 108.0 380.0 0.0 10.0 9.780327
0.1 0.1 0.1 125 125 125
{rows}
"""
HEADER = "t_s,gx_rad_s,gy_rad_s,gz_rad_s,fx_mps2,fy_mps2,fz_mps2"


def _write(tmp_path, text, name="imu.csv"):
    path = tmp_path / name
    path.write_text(text)
    return path


def _rows(times, row="1e-5,2e-5,3e-5,0.1,0.2,9.8"):
    return "\n".join([HEADER, *(f"{t},{row}" for t in times)])


def test_psins_counts_become_increments(tmp_path):
    record = read_imu(_write(tmp_path, PSINS.format(rows="1 -2 3 4 -5 80\n" * 50)))
    assert record.rate_hz == 100.0 and record.duration_s == 0.5 and record.height == 380.0
    np.testing.assert_allclose(record.increments[7, :3], np.array([1, -2, 3]) * 0.1 * ARCSEC)
    np.testing.assert_allclose(record.increments[7, 3:], np.array([4, -5, 80]) * 125e-6 * 9.780327)


@pytest.mark.parametrize(("axes", "sign", "order"), [("rfu", 1.0, [0, 1]), ("frd", -1.0, [1, 0])])
def test_csv_rates_become_increments_in_right_forward_up(tmp_path, axes, sign, order):
    record = read_imu(_write(tmp_path, _rows([0.5, 1.0, 1.5])), axes)
    assert record.rate_hz == 2.0
    np.testing.assert_allclose(record.increments[0, :2], np.array([1e-5, 2e-5])[order] * 0.5)
    assert record.increments[0, 5] == pytest.approx(sign * 4.9)


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        (_rows([1, 2, 3, 7, 8]), r"1 gaps, the first at t = 3 s, the longest 4 s"),
        (_rows([1, 2, 2, 3]), r"runs backwards at t = 2 s"),
        (_rows([1, 2, 3], "1e-5,nan,3e-5,0,0,9.8"), r"3 samples are NaN or infinite, the first at sample 1"),
        (_rows([1, 2]) + "\n3,1,2,x,4,5,6", r"data line 4 is no row of 7 numbers"),
        (_rows([1, 2]) + "\n3,1,2", r"data line 4 is no row of 7 numbers"),
        ("a,b\n1,2\n", r"needs a header with t_s"),
        (_rows([1]), r"fewer than two samples"),
        ("", r"needs a header"),
        (PSINS.format(rows="1 2 3 4 5\n1 2 3 4 5 6"), r"data line 4 is no row of 6 numbers"),
        ("% PSINS\nnothing\n", r"three lines of numbers"),
        (PSINS.replace(" 10.0 ", " 0.0 ").format(rows="1 2 3 4 5 6\n" * 3), r"interval must be > 0"),
    ],
)
def test_faults_are_named_in_one_line(tmp_path, text, wanted):
    with pytest.raises(InputError, match=wanted) as caught:
        read_imu(_write(tmp_path, text))
    assert len(str(caught.value).splitlines()) == 1 and "imu.csv: imu.file" in str(caught.value)


def test_missing_and_binary_files_are_named(tmp_path):
    with pytest.raises(InputError, match="No such file"):
        read_imu(tmp_path / "none.csv")
    binary = tmp_path / "x.bin"
    binary.write_bytes(b"\xff\xfe\x00\x81" * 100)
    with pytest.raises(InputError, match="not a text file"):
        read_imu(binary)


@pytest.mark.parametrize(
    ("row", "wanted"),
    [
        ("0,0,0,0.1,0.2,-9.8", r"the -z axis looks like up"),
        ("0,0,0,9.8,0.2,0.1", r"the \+x axis looks like up"),
        ("0,0,0,0.0,0.0,1.0", r"mean specific force is 1 m/s².*wrong units"),
    ],
)
def test_wrong_axes_and_units_are_refused(tmp_path, row, wanted):
    record = read_imu(_write(tmp_path, _rows([1, 2, 3], row)))
    with pytest.raises(InputError, match=wanted):
        check_rest(record, 9.79)


def test_right_axes_pass(tmp_path):
    check_rest(read_imu(_write(tmp_path, _rows([1, 2, 3], "0,0,0,0.5,-0.3,9.78"))), 9.79)
