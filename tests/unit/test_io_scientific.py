"""NetCDF, HDF5 and structs of MAT files: by names, units, epochs, scales and missing values."""

from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from scipy.io import netcdf_file, savemat

from navcore.foundation.errors import InputError
from navcore.foundation.units import DEG, KNOT
from navcore.io.column_map import parse_map
from navcore.io.recording import read_recording
from navcore.io.series import Recording

T0 = 1715938200.0
DAY = 86400.0
K = np.arange(30)
LAT, LON, HEADING = 50.0 + 2e-5 * K, -4.0 + 5e-5 * K, 60.0 + 0.1 * K
Variables = dict[str, tuple[np.ndarray, dict[str, Any]]]

CF: Variables = {
    "time": (T0 - 1514764800.0 + K, {"units": "seconds since 2018-01-01 00:00:00 0:00"}),
    "lat": (LAT, {"units": "degree_N", "standard_name": "latitude"}),
    "lon": (LON, {"units": "degree_E", "standard_name": "longitude"}),
    "heading": (HEADING, {"units": "degree", "missing_value": -9999.0}),
}
FILES: dict[str, Variables] = {
    "ARM": CF,
    "days": CF | {"time": ((T0 + K) / DAY + 7305.0, {"units": "days since 1950-01-01T00:00:00Z"})},
    "hours": CF | {"time": ((T0 + K) / 3600.0 + 613608.0, {"units": "hours since 1900-01-01 00:00:0.0"})},
    "milliseconds": CF | {"time": ((T0 + K) * 1e3, {"units": "milliseconds since 1970-1-1"})},
    "standard names": {
        "obs_time": CF["time"],
        "PLAT": (LAT, {"units": "degrees_north", "standard_name": "latitude"}),
        "PLON": (LON, {"units": "degrees_east", "standard_name": "longitude"}),
        "PLAT_HD": (HEADING * DEG, {"units": "radian", "standard_name": "platform_orientation"}),
    },
    "packed": CF | {
        "lat": (np.round((LAT - 50.0) * 1e6).astype(np.int32), {
            "units": "degrees_north", "scale_factor": 1e-6, "add_offset": 50.0, "_FillValue": np.int32(-99),
        }),
        "heading": (np.round(HEADING * 10.0).astype(np.int16), {"units": "degrees", "scale_factor": 0.1}),
    },
    "without an epoch": CF | {"time": (T0 + K, {"units": "s"})},
}  # fmt: skip


def _classic(path: Path, variables: Variables) -> None:
    with netcdf_file(str(path), "w") as file:
        file.createDimension("time", len(K))
        for name, (values, attributes) in variables.items():
            held = file.createVariable(name, values.dtype, ("time",))
            held[:] = values
            for key, value in attributes.items():
                setattr(held, key, value)
        note = file.createVariable("alt", "f8", ())
        note.units = "m"


def _version_4(path: Path, variables: Variables) -> None:
    with h5py.File(path, "w") as file:
        file.attrs["_NCProperties"] = "version=2,netcdf=4.9.0"
        for name, (values, attributes) in variables.items():
            held = file.create_dataset(name, data=values)
            for key, value in attributes.items():
                held.attrs[key] = value
        file.create_dataset("base_time", data=1)


WRITERS = {"classic": _classic, "version 4": _version_4}
both = pytest.mark.parametrize("kind", WRITERS)


def _is_the_ship(read: Recording) -> None:
    assert read.position is not None and read.heading is not None
    assert read.position.dated
    assert read.position.time_s == pytest.approx(T0 + K, abs=1e-2)
    assert read.position.values[:, :2] == pytest.approx(np.column_stack([LAT, LON]) * DEG, abs=2e-8)
    assert read.heading.values[:, 0] == pytest.approx(HEADING * DEG, abs=1e-3)


@both
@pytest.mark.parametrize("name", FILES)
def test_netcdf_is_read_by_its_attributes(tmp_path: Path, kind: str, name: str) -> None:
    path = tmp_path / "nav.nc"
    WRITERS[kind](path, FILES[name])
    read = read_recording(path)
    _is_the_ship(read)
    assert "NetCDF file with" in read.sources[0].kind


@both
def test_missing_values_are_missing(tmp_path: Path, kind: str) -> None:
    heading = HEADING.copy()
    heading[3:6], lat = -9999.0, LAT.copy()
    lat[7] = 91.5
    path = tmp_path / "nav.nc"
    WRITERS[kind](path, CF | {
        "heading": (heading, {"units": "degree", "missing_value": -9999.0}),
        "lat": (lat, {"units": "degree_N", "valid_max": 90.0}),
    })  # fmt: skip
    read = read_recording(path)
    assert read.heading is not None and read.position is not None
    assert (read.heading.time_s.size, read.position.time_s.size) == (27, 29)


@both
@pytest.mark.parametrize(
    ("attributes", "said"),
    [
        ({"units": "days since 1970-01-01", "calendar": "360_day"}, "calendar 360_day"),
        ({"units": "months since 1970-01-01"}, "months since"),
        ({"units": "seconds since the start"}, "the start"),
    ],
)
def test_a_time_that_is_not_understood_is_refused(
    tmp_path: Path, kind: str, attributes: dict[str, str], said: str
) -> None:
    path = tmp_path / "nav.nc"
    WRITERS[kind](path, CF | {"time": (T0 + K, attributes)})
    with pytest.raises(InputError, match=said):
        read_recording(path)


@both
def test_a_netcdf_file_of_something_else_names_its_variables(tmp_path: Path, kind: str) -> None:
    path = tmp_path / "sst.nc"
    WRITERS[kind](path, {"time": CF["time"], "sst": (HEADING, {"units": "degree_Celsius"})})
    with pytest.raises(InputError, match=r"columns found: .*sst"):
        read_recording(path)


def test_groups_and_records_of_hdf5_are_columns(tmp_path: Path) -> None:
    path = tmp_path / "nav.h5"
    rows = np.zeros(len(K), [("unix_time", float), ("latitude", float), ("longitude", float), ("hdg", float)])
    for name, values in zip(rows.dtype.names or (), (T0 + K, LAT, LON, HEADING), strict=True):
        rows[name] = values
    with h5py.File(path, "w") as file:
        file["nav/fix"] = rows
        file["nav/other"] = np.zeros(3)
        file["far"] = h5py.ExternalLink("/etc/hostname", "x")
    _is_the_ship(read_recording(path))
    with h5py.File(tmp_path / "groups.h5", "w") as file:
        for name, values in (("utc", T0 + K), ("lat", LAT), ("lon", LON)):
            file[f"ship/{name}"] = values
        file["ship/heading"] = HEADING * DEG
        file["ship/heading"].attrs["units"] = "rad"
    _is_the_ship(read_recording(tmp_path / "groups.h5"))


SHIP = {"unix_time": T0 + K, "lat": LAT * DEG, "lon": LON * DEG, "yaw": HEADING * DEG}
STRUCTS: dict[str, dict[str, Any]] = {
    "a struct": {"ref": SHIP},
    "columns": {"ref": {name: values[:, None] for name, values in SHIP.items()}},
    "within another": {"data": {"nav": SHIP, "freq": 1.0}, "note": "x"},
    "beside others": {"imu": {"fb": np.zeros((len(K), 3))}, "ref": SHIP},
    "an array of structs": {
        "p": np.array([tuple(row) for row in zip(*SHIP.values(), strict=True)], [(n, float) for n in SHIP])
    },
    "in degrees": {"ref": SHIP | {"lat": LAT, "lon": LON, "yaw": HEADING}},
    "with units in the names": {
        "ref": {"unix_time": T0 + K, "lat_rad": LAT * DEG, "lon_rad": LON * DEG, "yaw_deg": HEADING}
    },
    "of datenum": {"ref": SHIP | {"unix_time": np.zeros(1), "time": (T0 + K) / DAY + 719529.0}},
}


@pytest.mark.parametrize("packed", [False, True])
@pytest.mark.parametrize("name", STRUCTS)
def test_fields_of_structs_are_columns(tmp_path: Path, name: str, packed: bool) -> None:
    path = tmp_path / "ref.mat"
    held = dict(STRUCTS[name])
    if name == "of datenum":
        held["ref"] = {key: value for key, value in held["ref"].items() if key != "unix_time"}
    savemat(path, held, do_compression=packed)
    read = read_recording(path)
    _is_the_ship(read)
    told = any("taken as radians" in words for words in read.warnings)
    assert told == (name not in ("in degrees", "with units in the names"))


def test_structs_of_version_7_3_are_columns(tmp_path: Path) -> None:
    path = tmp_path / "ref.mat"
    with h5py.File(path, "w", userblock_size=512) as file:
        file.create_group("ref").attrs["MATLAB_class"] = np.bytes_("struct")
        for name, values in SHIP.items():
            held = file.create_dataset(f"ref/{name}", data=values[None, :])
            held.attrs["MATLAB_class"] = np.bytes_("double")
    with path.open("r+b") as stream:
        stream.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64")
    _is_the_ship(read_recording(path))


def test_level_4_is_read(tmp_path: Path) -> None:
    path = tmp_path / "old.mat"
    savemat(path, {"unix_time": T0 + K, "speed_kn": 8.0 + 0.1 * K}, format="4")
    water = read_recording(path).water
    assert water is not None
    assert water.values[1, 1] == pytest.approx(8.1 * KNOT)


def test_a_struct_of_something_else_names_its_fields(tmp_path: Path) -> None:
    savemat(tmp_path / "x.mat", {"run": {"voltage": np.zeros(9), "temp": np.zeros(9)}})
    with pytest.raises(InputError, match=r"run\.voltage, run\.temp"):
        read_recording(tmp_path / "x.mat")


def test_a_struct_that_unpacks_to_too_much_is_refused_before_it_is_held(tmp_path: Path) -> None:
    path = tmp_path / "bomb.mat"
    savemat(path, {"ref": {"lat": np.zeros((5000, 7000))}}, do_compression=True)
    assert path.stat().st_size < 1 << 20
    with pytest.raises(InputError, match="unpacks to more than 256 MiB"):
        read_recording(path)


GPS = T0 - 315964800.0 + K
"""UTC by the count from the epoch of GPS time; the receiver's own clock is 18 s ahead."""
EPOCH = "seconds since 1980-01-06 00:00:00"
CLOCKS: dict[str, tuple[np.ndarray, dict[str, Any], str]] = {
    "called GPS time": (GPS + 18.0, {"units": EPOCH, "long_name": "GPS time"}, "leap seconds removed"),
    "called GPST": (GPS + 18.0, {"units": EPOCH, "time_system": "GPST"}, "leap seconds removed"),
    "in milliseconds": (
        (GPS + 18.0) * 1e3, {"units": "ms since 1980-01-06", "comment": "clock of the receiver (gps_time)"},
        "leap seconds removed",
    ),
    "of the same epoch": (GPS, {"units": EPOCH, "long_name": "time"}, 'say time.epoch = "gps" by a map'),
    "UTC by a GPS receiver": (GPS, {"units": EPOCH, "long_name": "GPS time, UTC"}, "taken as UTC"),
    "of another epoch": (
        T0 + K, {"units": "seconds since 1970-01-01", "long_name": "GPS time"}, "taken as UTC",
    ),
    "Julian date": ((T0 + K) / DAY + 2440587.5, {"units": "Julian date"}, "counts Julian date"),
    "MJD": ((T0 + K) / DAY + 40587.0, {"units": "MJD"}, "counts MJD"),
    "days of 4713 BC": ((T0 + K) / DAY + 2440587.5, {"units": "days since -4713-01-01 12:00:00"}, ""),
    "Gregorian days of 4714 BC": (
        (T0 + K) / DAY + 2440587.5, {"units": "days since -4713-11-24T12:00:00Z"}, "",
    ),
}  # fmt: skip


@both
@pytest.mark.parametrize("name", CLOCKS)
def test_the_clock_of_a_variable_is_that_of_its_attributes(tmp_path: Path, kind: str, name: str) -> None:
    values, attributes, said = CLOCKS[name]
    path = tmp_path / "nav.nc"
    WRITERS[kind](path, CF | {"time": (values, attributes)})
    read = read_recording(path)
    _is_the_ship(read)
    assert any(said in told for told in read.warnings) or not said


@both
def test_a_map_calls_a_dated_variable_gps_time(tmp_path: Path, kind: str) -> None:
    path = tmp_path / "nav.nc"
    WRITERS[kind](path, CF | {"time": (GPS + 18.0, {"units": EPOCH})})
    text = 'time = {{ column = "time", epoch = "{}" }}\n' + "".join(
        f'[quantity.{stem}]\ncolumn = "{name}"\nunit = "deg"\n'
        for stem, name in (
            ("lat", "lat [degree_N]"),
            ("lon", "lon [degree_E]"),
            ("heading", "heading [degree]"),
        )
    )
    _is_the_ship(read_recording(path, parse_map(text.format("gps"), "map")))
    with pytest.raises(InputError, match="time.epoch = 'mjd': must be left out"):
        read_recording(path, parse_map(text.format("mjd"), "map"))
