"""Parquet, MAT and npz files: logs and IMUs by the names of their columns, or by a map."""

import json
import zipfile
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pyarrow
import pytest
from pyarrow import parquet
from scipy.io import savemat

from navcore.checks.imu import check_mapped
from navcore.foundation.errors import InputError
from navcore.foundation.units import ARCSEC, DEG, KNOT, STANDARD_GRAVITY
from navcore.io.column_map import ColumnMap, parse_map
from navcore.io.containers.opening import open_container
from navcore.io.recording import read_recording
from navcore.sensors.recorded_imu import ImuRecord, read_imu
from schuler_bench.cli import main

Columns = dict[str, np.ndarray]


def _parquet(path: Path, columns: Columns) -> None:
    parquet.write_table(pyarrow.table(columns), path)


def _mat(path: Path, columns: Columns) -> None:
    savemat(path, columns)


def _mat_hdf(path: Path, columns: Columns) -> None:
    """As MATLAB's ``save -v7.3`` writes them: HDF5 behind a header of 512 bytes, axes in reverse."""
    with h5py.File(path, "w", userblock_size=512) as file:
        for name, values in columns.items():
            column = values.reshape(values.shape or (1, 1))
            held = file.create_dataset(name, data=(column[:, None] if column.ndim == 1 else column).T)
            kind = "double" if values.dtype == float else str(values.dtype)
            held.attrs["MATLAB_class"] = np.bytes_(kind)
    with path.open("r+b") as stream:
        stream.write(MAT_HDF)


def _npz(path: Path, columns: Columns) -> None:
    np.savez(path, allow_pickle=False, **columns)


MAT_HDF = b"MATLAB 7.3 MAT-file, Platform: GLNXA64"
WRITERS: dict[str, Callable[[Path, Columns], None]] = {
    "parquet": _parquet,
    "mat": _mat,
    "v7.3.mat": _mat_hdf,
    "npz": _npz,
}
kinds = pytest.mark.parametrize("kind", WRITERS)
TIME = 0.01 * np.arange(1, 401)
IMU_MAP = "\n".join(
    [
        'time = { column = "clock", unit = "ms" }',
        *(f'[quantity.g{axis}_rad_s]\ncolumn = "w{n}"\nunit = "deg/s"' for n, axis in enumerate("xyz", 1)),
        *(f'[quantity.f{axis}_mps2]\ncolumn = "k{n}"\nunit = "0.001 g"' for n, axis in enumerate("xyz", 1)),
    ]
)


def _file(folder: Path, kind: str, columns: Columns) -> Path:
    WRITERS[kind](folder / f"data.{kind}", columns)
    return folder / f"data.{kind}"


def _map(text: str) -> ColumnMap:
    return parse_map(text, "map.toml")


def _rates(record: ImuRecord) -> np.ndarray:
    return record.increments.mean(axis=0) * record.rate_hz


@kinds
def test_an_imu_is_read_by_its_names(tmp_path: Path, kind: str) -> None:
    one = np.ones_like(TIME)
    columns = {"time_ms": 1e3 * TIME, "gyro_x_dps": one, "gyro_y_dps": 2 * one, "gyro_z_dps": 3 * one}
    columns |= {"acc_x_g": 0 * one, "acc_y_g": 0 * one, "acc_z_g": one}
    record = read_imu(_file(tmp_path, kind, columns))
    wanted = [DEG, 2 * DEG, 3 * DEG, 0, 0, STANDARD_GRAVITY]
    np.testing.assert_allclose(_rates(record), wanted, rtol=1e-9, atol=1e-12)
    assert record.rate_hz == pytest.approx(100.0)


@kinds
def test_an_imu_is_read_by_a_map(tmp_path: Path, kind: str) -> None:
    columns: Columns = {"clock": np.rint(1e3 * TIME).astype(np.int64)}
    columns |= {f"w{n}": np.full(TIME.size, float(n)) for n in (1, 2, 3)}
    columns |= {f"k{n}": np.full(TIME.size, 1000.0 * (n == 3)) for n in (1, 2, 3)}
    path = _file(tmp_path, kind, columns)
    wanted = [DEG, 2 * DEG, 3 * DEG, 0, 0, STANDARD_GRAVITY]
    record = read_imu(path, column_map=_map(IMU_MAP))
    np.testing.assert_allclose(_rates(record), wanted, rtol=1e-9, atol=1e-12)
    report = check_mapped(path, _map(IMU_MAP.replace('"k3"', '"up"')))
    assert "up" in str(report.faults[0]) and "is no column of the file" in str(report.faults[0])


@kinds
def test_a_log_is_read_by_a_map(tmp_path: Path, kind: str) -> None:
    columns: Columns = {
        "week": np.full(50, 2300), "tow": np.arange(50) + 1000.0, "fahrt": np.full(50, -9.0),
        "kurs": np.linspace(80.0, 90.0, 50),
    }  # fmt: skip
    text = (
        'time = { column = ["week", "tow"], unit = "gps_week_s" }\n'
        '[quantity.speed]\ncolumn = "fahrt"\nunit = "kn"\nsign = -1\n'
        '[quantity.heading]\ncolumn = "kurs"\nunit = "deg"\n'
    )
    read = read_recording(_file(tmp_path, kind, columns), _map(text))
    assert read.water is not None and read.heading is not None
    np.testing.assert_allclose(read.water.values[:, 1], 9.0 * KNOT)
    assert read.water.time_s[0] == 315964800.0 + 2300 * 604800.0 + 1000.0 - 18.0
    assert read.heading.values[-1, 0] == pytest.approx(90.0 * DEG)


@pytest.mark.parametrize("kind", ["mat", "v7.3.mat", "npz"])
def test_a_matrix_is_columns_and_a_number_the_interval(tmp_path: Path, kind: str) -> None:
    counts = np.tile(np.array([[10, 0, 0, 0, 0, 8000]], dtype=np.int16), (500, 1))
    path = _file(tmp_path, kind, {"counts": counts, "dt_s": np.array(0.01)})
    text = 'time = { column = "dt_s" }\n' + "\n".join(
        f'[quantity.{name}]\ncolumn = "counts_{n}"\nunit = "{unit}"'
        for n, (name, unit) in enumerate(
            [("dax", "0.1 arcsec"), ("day", "0.1 arcsec"), ("daz", "0.1 arcsec"),
             ("dvx", "1.2e-3 m/s"), ("dvy", "1.2e-3 m/s"), ("dvz", "1.2e-3 m/s")], 1,
        )
    )  # fmt: skip
    record = read_imu(path, column_map=_map(text))
    np.testing.assert_allclose(record.increments[0], [ARCSEC, 0, 0, 0, 0, 9.6], rtol=1e-12)
    assert record.rate_hz == pytest.approx(100.0)


@kinds
def test_the_guess_is_written_and_read_again(
    tmp_path: Path, kind: str, capsys: pytest.CaptureFixture[str]
) -> None:
    columns = {"t_s": TIME * 100, "lat": 48 + 1e-5 * TIME, "lon": 2 + 1e-5 * TIME, "heading": 10 + TIME}
    file, target = str(_file(tmp_path, kind, columns)), str(tmp_path / "m.toml")
    assert main(["check", file, "--write-map", target, "--json"]) == 0
    before = json.loads(capsys.readouterr().out)
    assert main(["check", file, "--map", target, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["quantities"] == before["quantities"]
    assert "1.0, 2.0, 3.0" in Path(target).read_text()


def test_what_is_no_table_of_numbers_is_refused_by_name(tmp_path: Path) -> None:
    np.savez(tmp_path / "objects.npz", t_s=np.arange(3.0), speed_mps=np.array(["a", "b", "c"]))
    with pytest.raises(InputError, match="speed_mps: must be a column of numbers"):
        read_recording(tmp_path / "objects.npz")
    (tmp_path / "cut.mat").write_bytes(MAT_HDF.ljust(600, b" "))
    with pytest.raises(InputError, match="cannot be read as a MAT file of version 7.3"):
        read_recording(tmp_path / "cut.mat")


def test_a_mat_file_reads_nothing_from_other_files(tmp_path: Path) -> None:
    """Links, virtual datasets and external storage of HDF5 may name any file of the machine."""
    other = tmp_path / "other.h5"
    with h5py.File(other, "w") as file:
        file["speed_mps"] = np.arange(3.0)
    np.arange(3.0).tofile(tmp_path / "raw.bin")
    virtual = h5py.VirtualLayout((1, 3), float)
    virtual[0] = h5py.VirtualSource(str(other), "speed_mps", (3,))
    path = tmp_path / "linked.mat"
    _mat_hdf(path, {"t_s": np.arange(3.0)})
    with h5py.File(path, "r+") as file:
        file["speed_mps"] = h5py.ExternalLink(str(other), "speed_mps")
        file["lat"] = h5py.SoftLink("/t_s")
        file.create_virtual_dataset("heading", virtual)
        stored = [(str(tmp_path / "raw.bin"), 0, 24)]
        file.create_dataset("pitch", (1, 3), float, external=stored)
        for name in ("heading", "pitch"):
            file[name].attrs["MATLAB_class"] = np.bytes_("double")
    assert open_container(path).names == ["t_s"]


def test_a_small_mat_file_that_unpacks_to_gigabytes_is_refused_unread(tmp_path: Path) -> None:
    path = tmp_path / "bomb.mat"
    _mat_hdf(path, {"t_s": np.arange(3.0)})
    with h5py.File(path, "r+") as file:
        for name in ("x_s", "speed_mps"):
            held = file.create_dataset(name, (1, 1 << 30), float, chunks=(1, 1 << 16), compression="gzip")
            held.attrs["MATLAB_class"] = np.bytes_("double")
        del file["t_s"]
        file.move("x_s", "t_s")
    assert path.stat().st_size < 100_000
    with pytest.raises(InputError, match="at most 6000000 cells are read"):
        read_recording(path)


def test_a_small_npz_that_unpacks_to_gigabytes_is_refused_unread(tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "bomb.npz", "w", zipfile.ZIP_DEFLATED) as archive:
        for name in ("t_s", "speed_mps"):
            with archive.open(f"{name}.npy", "w") as stream:
                form = {"descr": "<f8", "fortran_order": False, "shape": (1 << 30,)}
                np.lib.format.write_array_header_1_0(stream, form)  # pyright: ignore[reportArgumentType]
                for _ in range(8):
                    stream.write(bytes(1 << 20))
    assert (tmp_path / "bomb.npz").stat().st_size < 100_000
    with pytest.raises(InputError, match="at most 6000000 cells are read"):
        read_recording(tmp_path / "bomb.npz")
