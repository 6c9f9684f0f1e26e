"""A recorded IMU: read, then aligned and navigated (`imu.file`); what cannot serve is told."""

from typing import Any

import numpy as np
import pytest

from navcore.engine.simulation import simulate
from navcore.foundation.earth import WGS84
from navcore.foundation.errors import InputError
from navcore.foundation.units import ARCSEC, DEG
from navcore.motion.static import StaticMotion
from navcore.motion.truth import HEADING, Site
from navcore.scenario.model import Scenario
from navcore.sensors.imu import Imu
from navcore.sensors.imu_simulation import ImuSimulation
from navcore.sensors.recorded_imu import check_rest, read_imu

RATE, SECONDS = 20.0, 900
SITE = Site(32.06 * DEG, 118.8 * DEG, 0.0)
HEADER = "t_s,dax_rad,day_rad,daz_rad,dvx_mps,dvy_mps,dvz_mps"
METHODS = [{"name": "free"}, {"name": "compass", "damping": "external", "network": {"id": "compass"}}]


@pytest.fixture(scope="module")
def record(tmp_path_factory) -> str:
    """A level vehicle at rest, heading 40 deg, 0.05 deg/h and 50 ug, as a CSV of increments."""
    imu = Imu(gyro_bias_dph=(0.0, 0.05, 0.0), accel_bias_ug=(50.0, 0.0, 0.0))
    simulation = ImuSimulation(StaticMotion(heading_deg=40.0), SITE, WGS84, imu, RATE, int(RATE * SECONDS), 1)
    samples = np.concatenate([chunk.copy() for chunk, _ in simulation.chunks()])
    table = np.column_stack([np.arange(1, len(samples) + 1) / RATE, samples])
    path = tmp_path_factory.mktemp("imu") / "parked.csv"
    np.savetxt(path, table, fmt="%.17g", delimiter=",", header=HEADER, comments="")
    return str(path)


def _run(record: str, **blocks: Any):
    merged = {
        "run": {"fidelity": "strapdown", "duration_h": 0.05} | blocks.pop("run", {}),
        "imu": {"file": record} | blocks.pop("imu", {}),
        "alignment": {"kind": "compass", "duration_s": 700.0} | blocks.pop("alignment", {}),
        "reference": {"kind": "log"},
        "method": METHODS,
    }
    return simulate(Scenario.parse(merged | blocks))


def test_it_is_aligned_and_then_navigated(record):
    run = _run(record)
    assert [m.status for m in run.methods] == ["ok", "ok"]
    assert run.sampling is not None and run.sampling.rate_hz == pytest.approx(RATE)
    # phi_U = -eps_E / (Omega cos L) + tan L nabla_E / g, with eps_E = eps_y sin 40 deg: the heading error.
    eps_e = np.radians(0.05 / 3600.0) * np.sin(40.0 * DEG)
    nabla_e = 50e-6 * np.cos(40.0 * DEG)
    phi_u = -eps_e / (7.292115e-5 * np.cos(SITE.lat)) + np.tan(SITE.lat) * nabla_e
    assert run.truth[0, HEADING] / DEG == pytest.approx(40.0 + phi_u / DEG, abs=0.01)
    assert np.abs(run.methods[0].rows[0, :5]).max() < 1e-15
    free, compass = run.methods
    assert compass.errors["dve_mps"]["max_abs"] < free.errors["dve_mps"]["max_abs"]
    assert any("true attitude of a recorded IMU is not known" in text for text in run.warnings)


def test_without_alignment_it_starts_at_the_attitude_of_the_motion(record):
    run = _run(record, alignment={"kind": "none"}, motion={"kind": "static", "heading_deg": 40.0})
    assert run.truth[0, HEADING] == pytest.approx(40.0 * DEG)
    # At rest the free errors grow from zero: the acceleration's bias, and the tilt that the gyro's makes.
    nabla = 50e-6 * np.cos(40.0 * DEG) * 9.8
    tilting = 9.8 * np.radians(0.05 / 3600.0) * np.cos(40.0 * DEG)
    expected = nabla * 180.0 + tilting * 180.0**2 / 2.0
    assert run.methods[0].errors["dve_mps"]["final"] == pytest.approx(expected, rel=0.02)
    assert any("taken from motion.pitch_deg" in text for text in run.warnings)


def test_settings_that_a_record_leaves_unused_are_told(record):
    run = _run(record, imu={"gyro_bias_dph": [1.0, 0.0, 0.0], "accel_vrw_ugpshz": 1.0})
    assert any("imu.gyro_bias_dph, imu.accel_vrw_ugpshz not used" in text for text in run.warnings)


def test_a_cancel_keeps_what_was_navigated(record):
    run = simulate(
        Scenario.parse(
            {
                "run": {"fidelity": "strapdown", "duration_h": 0.2},
                "imu": {"file": record},
                "motion": {"kind": "static", "heading_deg": 40.0},
            }
        ),
        cancelled=lambda: True,
    )
    assert run.status == "stopped" and 0 < len(run.methods[0].t_s) < len(run.t_s)


@pytest.mark.parametrize(
    ("blocks", "line"),
    [
        (
            {"run": {"duration_h": 0.5}},
            "run.duration_h = 0.5: is longer than the recorded IMU: of its 900 s, 700 s are left out or used "
            "for the alignment, so that 0.05556 h remain",
        ),
        ({"imu": {"begin_s": 5000.0}}, "so that 0 h remain"),
        ({"imu": {"file": "/nowhere.imu"}}, "/nowhere.imu: imu.file: No such file or directory"),
        ({"imu": {"axes": "frd"}}, "the -z axis looks like up, but z must point up"),
        ({"alignment": {"sigma": 1.9, "duration_s": 100.0}}, "alignment.sigma = 2.68"),
    ],
)
def test_what_cannot_serve_is_one_clear_line(record, blocks, line):
    with pytest.raises(InputError) as caught:
        _run(record, **blocks)
    assert len(caught.value.faults) == 1 and line in str(caught.value)


# ---------------------------------------------------------------- reading the file


PSINS = """% PSINS-format SIMU log file.
0 0 -90.6 0 0 0
34.0 108.0 380.0 0.0 10.0 9.780327
0.1 0.1 0.1 125 125 125
{rows}
"""
RATES_HEADER = "t_s,gx_rad_s,gy_rad_s,gz_rad_s,fx_mps2,fy_mps2,fz_mps2"


def _write(tmp_path, text, name="imu.csv"):
    path = tmp_path / name
    path.write_text(text)
    return path


def _rows(times, row="1e-5,2e-5,3e-5,0.1,0.2,9.8"):
    return "\n".join([RATES_HEADER, *(f"{t},{row}" for t in times)])


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
