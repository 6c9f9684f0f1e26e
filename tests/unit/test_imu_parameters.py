"""The `imu` block: ranges element by element, refusals by name, vector fields for the page."""

from typing import Any

import pytest
from pydantic import ValidationError

from navcore.foundation.faults import faults_from
from navcore.foundation.parameters import allowed_range, element_of, extra_of, vector_quantity
from navcore.sensors.imu import Imu

RECORDING = ("file", "map", "axes", "begin_s", "part")
DEVIATIONS = ("gyro_bias_std_dph", "accel_bias_std_ug")
"""For the error budget: not given by default."""
ERRORS = {name: info for name, info in Imu.model_fields.items() if name not in (*RECORDING, *DEVIATIONS)}


def _faults(**fields: Any) -> list[str]:
    try:
        Imu(**fields)
    except ValidationError as error:
        return [str(fault) for fault in faults_from(error, Imu, fields, "")]
    return []


def test_everything_is_zero_by_default() -> None:
    imu = Imu()
    for name, value in imu.model_dump(include=set(ERRORS)).items():
        expected = 3600.0 if name.endswith("tau_s") else 0.0
        assert all(element == expected for element in (value if isinstance(value, tuple) else (value,)))
    assert imu.gyro().perfect
    assert imu.accel().perfect


@pytest.mark.parametrize(
    ("fields", "line"),
    [
        (
            {"gyro_bias_dph": [0.0, 2e5, 0.0]},
            "gyro_bias_dph.1 = 200000.0: must be >= -100000 and <= 100000 (°/h)",
        ),
        (
            {"accel_bias_ug": [0.0, 0.0, -2e6]},
            "accel_bias_ug.2 = -2000000.0: must be >= -1e+06 and <= 1e+06 (µg)",
        ),
        ({"gyro_arw_dpsh": -0.1}, "gyro_arw_dpsh = -0.1: must be >= 0 and <= 100 (°/√h)"),
        ({"accel_vrw_ugpshz": -1.0}, "accel_vrw_ugpshz = -1.0: must be >= 0 and <= 1e+06 (µg/√Hz)"),
        ({"gyro_instability_dph": -1.0}, "gyro_instability_dph = -1.0: must be >= 0 and <= 10000 (°/h)"),
        ({"gyro_tau_s": 0.0}, "gyro_tau_s = 0.0: must be >= 1 and <= 1e+07 (s)"),
        ({"accel_tau_s": 0.5}, "accel_tau_s = 0.5: must be >= 1 and <= 1e+07 (s)"),
        ({"accel_instability_ug": 1e6}, "accel_instability_ug = 1000000.0: must be >= 0 and <= 100000 (µg)"),
        (
            {"gyro_scale_ppm": [1e6, 0, 0]},
            "gyro_scale_ppm.0 = 1000000.0: must be >= -100000 and <= 100000 (ppm)",
        ),
        (
            {"accel_misalignment_arcsec": [0, 0, 0, 0, 0, 4e4]},
            "accel_misalignment_arcsec.5 = 40000.0: must be >= -36000 and <= 36000 (arcsec)",
        ),
        ({"gyro_lsb": [0, 0, -1e-6]}, "gyro_lsb.2 = -1e-06: must be >= 0 and <= 0.01 (rad)"),
        ({"accel_lsb": [2.0, 0, 0]}, "accel_lsb.0 = 2.0: must be >= 0 and <= 1 (m/s)"),
    ],
)
def test_each_field_out_of_range_is_refused(fields: dict[str, Any], line: str) -> None:
    assert _faults(**fields) == [line]


@pytest.mark.parametrize(
    "fields",
    [
        {"gyro_bias_dph": [0.0, 1.0]},
        {"gyro_lsb": 1e-6},
        {"accel_scale_ppm": [0, 0, 0, 0]},
        {"gyro_drift_dph": 1.0},
        {"gyro_bias_dph": [0.0, float("nan"), 0.0]},
        {"gyro_arw_dpsh": "much"},
    ],
)
def test_what_is_no_vector_or_no_field_is_refused(fields: dict[str, Any]) -> None:
    (line,) = _faults(**fields)
    assert line.startswith(next(iter(fields)))


def test_every_field_tells_the_page_its_unit_label_and_range() -> None:
    for name, info in ERRORS.items():
        extra = extra_of(info)
        assert extra["unit"], name
        assert extra["label"], name
        assert info.description, name
        element = element_of(info)
        values = info.default if isinstance(info.default, tuple) else (info.default,)
        assert (element is None) == (not isinstance(info.default, tuple))
        assert element is None or len(extra["elements"]) == len(values)
        bounded = element or info
        assert allowed_range(bounded).startswith("must be >= "), name
        assert extra_of(bounded)["unit"] == extra["unit"], name
        if "slider" in extra:
            low, high = extra["slider"]
            assert all(low <= value <= high for value in values)
            for edge in (low, high):
                Imu(**{name: tuple(edge for _ in values) if element else edge})


def test_a_vector_needs_a_name_for_each_value() -> None:
    with pytest.raises(ValueError, match="2 values but 3 names"):
        vector_quantity((0.0, 0.0))
