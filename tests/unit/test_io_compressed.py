"""Compressed recordings: gzip, zip and zstd give the same as the text; what cannot be unpacked is told."""

import gzip
import io
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pyarrow
import pytest

from navcore.checks.file import check_file
from navcore.checks.imu import IMU_CHECKER
from navcore.foundation.errors import InputError
from navcore.io.compressed import unpacked
from navcore.io.recording import read_recording

LOG = b"t_s,speed_kn\n" + b"".join(b"%d,%.1f\n" % (k, 5 + 0.1 * k) for k in range(40))
IMU = b"t_s,gx_rad_s,gy_rad_s,gz_rad_s,fx_mps2,fy_mps2,fz_mps2\n" + b"".join(
    b"%.2f,1e-5,2e-5,3e-5,0.1,0.2,9.8\n" % (0.01 * k) for k in range(1, 40)
)


def _zip(content: bytes, *others: str) -> bytes:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("log.csv", content)
        archive.writestr("__MACOSX/._log.csv", b"\0")
        for name in others:
            archive.writestr(name, content)
    return packed.getvalue()


def _zstd(content: bytes) -> bytes:
    sink = pyarrow.BufferOutputStream()
    with pyarrow.CompressedOutputStream(sink, "zstd") as stream:
        stream.write(content)
    return sink.getvalue().to_pybytes()


PACKERS = [gzip.compress, _zip, _zstd]


@pytest.mark.parametrize("pack", PACKERS)
def test_a_packed_log_is_read_as_the_log(tmp_path: Path, pack: Callable[[bytes], bytes]) -> None:
    path = tmp_path / "log.csv.packed"
    path.write_bytes(pack(LOG))
    water = read_recording(path).water
    assert water is not None and water.time_s.size == 40
    assert water.values[10, 1] == pytest.approx(6.0 * 1852 / 3600)


@pytest.mark.parametrize("pack", PACKERS)
def test_a_packed_imu_is_recognised(tmp_path: Path, pack: Callable[[bytes], bytes]) -> None:
    path = tmp_path / "imu.packed"
    path.write_bytes(pack(IMU))
    assert check_file(path, [IMU_CHECKER]).details["samples"] == 39


@pytest.mark.parametrize("pack", PACKERS)
def test_what_unpacks_to_too_much_is_refused(tmp_path: Path, pack: Callable[[bytes], bytes]) -> None:
    path = tmp_path / "bomb"
    path.write_bytes(pack(bytes(4 << 20)))
    assert path.stat().st_size < 20_000
    with pytest.raises(InputError, match="unpacks to more than 1 MiB"):
        unpacked(path, 1 << 20)


@pytest.mark.parametrize("pack", PACKERS)
@pytest.mark.parametrize("part", [0.2, 0.9])
def test_a_truncated_file_is_refused(tmp_path: Path, pack: Callable[[bytes], bytes], part: float) -> None:
    content = np.random.default_rng(1).bytes(3000)
    packed = pack(content)
    path = tmp_path / "cut.gz"
    path.write_bytes(packed[: int(part * len(packed))])
    with pytest.raises(InputError, match=r"cut\.gz: cannot be unpacked as a (gzip|zip|zstd) file"):
        unpacked(path, 1 << 20)


def test_a_zip_of_several_files_is_refused_by_their_names(tmp_path: Path) -> None:
    path = tmp_path / "two.zip"
    path.write_bytes(_zip(LOG, "heading.csv"))
    with pytest.raises(InputError, match=r"zip file of 2 files \(log.csv, heading.csv\): one is read"):
        read_recording(path)
