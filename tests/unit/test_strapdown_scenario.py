"""A strapdown scenario: its rates, and one clear fault for each field that cannot be so."""

import pytest

from navcore.foundation.errors import InputError
from navcore.scenario.file import load, presets
from navcore.scenario.model import Scenario

FAST = {"amplitude_deg": 2.0, "frequency_hz": 5.0}


def parse(**blocks) -> Scenario:
    run = {"fidelity": "strapdown", "duration_h": 1.0} | blocks.pop("run", {})
    return Scenario.parse({"run": run, **blocks})


@pytest.mark.parametrize(
    ("run", "log_hz", "law_every", "record_every"),
    [
        ({"rate_hz": 100.0}, 1.0, 100, 100),
        ({"rate_hz": 200.0}, 200.0, 1, 200),
        ({"rate_hz": 200.0}, 1000.0, 1, 200),
        ({"rate_hz": 100.0}, 3.0, 25, 100),
        ({"rate_hz": 100.0}, 0.2, 100, 100),
        ({"rate_hz": 100.0, "step_s": 0.1}, 1.0, 10, 10),
        ({"rate_hz": 100.0, "step_s": 10.0}, 1.0, 100, 1000),
        ({"rate_hz": 33.3}, 1.0, 33, 33),
    ],
)
def test_the_law_is_asked_every_step_or_as_often_as_a_faster_log(run, log_hz, law_every, record_every):
    rates = parse(run=run, reference={"kind": "log", "rate_hz": log_hz}).sampling
    assert (rates.law_every, rates.record_every) == (law_every, record_every)
    assert rates.samples == rates.records * record_every
    assert 0.0 <= 3600.0 - rates.duration_s < rates.record_step_s


def test_without_a_log_the_law_runs_at_the_step():
    assert parse(run={"step_s": 0.5}).sampling.law_every == 50


@pytest.mark.parametrize(
    ("blocks", "line"),
    [
        (
            {"site": {"lat_deg": -86.0}, "alignment": {"kind": "compass"}},
            "site.lat_deg = -86.0: compass alignment needs |latitude| <= 85°",
        ),
        (
            {"run": {"rate_hz": 50.0}, "motion": {"kind": "swing", "roll": FAST}},
            "run.rate_hz = 50.0: is too low for the motion: must be >= 80 (Hz), 16 samples a period of "
            "motion.roll.frequency_hz, which is 5 Hz",
        ),
        (
            {
                "run": {"rate_hz": 10.0},
                "motion": {
                    "kind": "legs",
                    "leg": [{"speed_mps": 1.0}, {"speed_mps": 2.0, "accel_mps2": 2.0}],
                },
            },
            "run.rate_hz = 10.0: is too low for the motion: must be >= 32 (Hz), 16 samples a period of "
            "motion.leg.1, which is 2 Hz",
        ),
        (
            {"run": {"rate_hz": 20.0}, "motion": {"kind": "waves", "peak_period_s": 2.0}},
            "run.rate_hz = 20.0: is too low for the motion: must be >= ",
        ),
        ({"run": {"rate_hz": 5.0}}, "run.rate_hz = 5.0: must be >= 10 and <= 1000 (Hz)"),
        ({"run": {"duration_h": 300.0}}, "run.duration_h = 300.0: is 1.08e+08 samples at 100 Hz; at most"),
        (
            {"run": {"duration_h": 100.0}, "reference": {"kind": "log", "rate_hz": 100.0}},
            "reference.rate_hz = 100.0: gives 3.6e+07 log samples in 100 h; at most 10000000",
        ),
        (
            {"alignment": {"kind": "compass", "duration_s": 20000.0}},
            "alignment.duration_s = 20000.0: must be <= 15000 (s) at 100 Hz",
        ),
        (
            {"alignment": {"kind": "compass", "sigma": 9.0, "xi": 0.7}},
            "alignment.sigma = 9.0: must be <= 7 (1/s) at 100 Hz: the loop is too fast",
        ),
        (
            {"imu": {"file": "x.imu"}, "motion": {"kind": "swing"}},
            'motion.kind = \'swing\': must be "static" or "track" with a recorded IMU (imu.file)',
        ),
        ({"imu": {"begin_s": 3.0}}, "imu.begin_s = 3.0: needs a recorded IMU: imu.file"),
        ({"imu": {"axes": "ned"}}, "imu.axes = 'ned': must be one of 'rfu' or 'frd'"),
        ({"run": {"vertical": "free"}}, "run.vertical = 'free': must be one of 'locked' or 'altimeter'"),
    ],
)
def test_each_fault_names_field_value_and_range(blocks, line):
    with pytest.raises(InputError) as caught:
        parse(**blocks)
    (fault,) = caught.value.faults
    assert str(fault).startswith(line)


@pytest.mark.parametrize("fidelity", ["channel", "error_model"])
@pytest.mark.parametrize(
    ("blocks", "field"),
    [
        ({"alignment": {"kind": "compass"}}, "alignment.kind"),
        ({"imu": {"file": "x.imu"}}, "imu.file"),
        ({"run": {"vertical": "altimeter"}}, "run.vertical"),
        ({"run": {"compensation": False}}, "run.compensation"),
    ],
)
def test_what_only_a_strapdown_run_can_do_is_refused_elsewhere(fidelity, blocks, field):
    with pytest.raises(InputError) as caught:
        parse(**blocks | {"run": blocks.get("run", {}) | {"fidelity": fidelity}})
    (fault,) = caught.value.faults
    assert fault.field == field
    assert fault.allowed == f'needs run.fidelity = "strapdown", which is "{fidelity}"'


def test_every_preset_may_be_run_as_strapdown():
    for name in presets():
        assert load(name, ["run.fidelity=strapdown"]).sampling.records > 0


def test_the_path_of_a_recorded_imu_is_relative_to_the_scenario(tmp_path):
    path = tmp_path / "s.toml"
    path.write_text('schema = 1\n[run]\nfidelity = "strapdown"\n[imu]\nfile = "ship.imu"\n')
    assert load(str(path)).imu.file == str(tmp_path / "ship.imu")
