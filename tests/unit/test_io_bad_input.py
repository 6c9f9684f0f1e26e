"""Bad input of every kind is refused by name with a remedy, in bounded time."""

import gzip
import time
from pathlib import Path

import pyarrow
import pytest
from pyarrow import parquet

from navcore.checks.file import check_log
from navcore.checks.imu import check_mapped
from navcore.foundation.errors import InputError
from navcore.io.recording import read_recording
from navcore.sensors.recorded_imu import read_imu

LOG = "t_s,speed_mps\n" + "".join(f"{k},5.0\n" for k in range(200))
SUMMER = "\n".join(["wann;stw", *(f"2024-03-31 0{k}:30:00;5" for k in range(1, 5))])
BAD: dict[str, tuple[bytes, str]] = {
    "a truncated gzip file": (gzip.compress(LOG.encode())[:-30], "cannot be unpacked as a gzip file"),
    "a bomb": (gzip.compress(bytes(100 << 20)), "unpacks to more than 64 MiB: cut it"),
    "another encoding": (LOG.encode("cp037"), "binary content; expected a text file"),
    "100000 columns": (
        ("t_s,speed_mps," + "x," * 100_000 + "\n1,2\n").encode(),
        "has more than 1000 columns",
    ),
    "no number": (b"t_s,speed_mps\n" + b"".join(b"%d,nan\n" % k for k in range(9)), "must be a number from"),
    "a missing column": (
        b"t_s,pressure\n1,2\n2,3\n",
        "no column of a quantity; columns found: t_s, pressure",
    ),
    "a cut row": (b"t_s,speed_mps\n1,2\n2\n3,4\n4,5\n", "row 3: has 1 cells, the header 2"),
    "a time past all calendars": (b"t_s,speed_mps\n1,2\n9e11,3\n", "must be a number from -6e+10 to 2.5e+11"),
    "time backwards": (b"t_s,speed_mps\n1,2\n0,3\n3,4\n", "row 3: t_s: time runs backwards by 1 s"),
}


@pytest.mark.parametrize("name", BAD)
def test_a_bad_file_is_refused_by_name_in_time(tmp_path: Path, name: str) -> None:
    content, wanted = BAD[name]
    (tmp_path / "log.csv").write_bytes(content)
    begin = time.process_time()
    with pytest.raises(InputError) as caught:
        read_recording(tmp_path / "log.csv")
    assert wanted in str(caught.value) and str(caught.value).startswith("log.csv")
    assert time.process_time() - begin < 10.0


def test_a_map_names_the_column_that_is_missing_and_the_hour_that_is_left_out(tmp_path: Path) -> None:
    (tmp_path / "log.csv").write_text(SUMMER)
    text = (
        'time = {{ column = "{}", unit = "iso", zone = "Europe/Berlin" }}\n'
        '[quantity.speed_mps]\ncolumn = "stw"\n'
    )
    for column, wanted in (("when", "is no column of the file; columns found: wann, stw"), ("wann", "row 3")):
        (tmp_path / "m.toml").write_text(text.format(column))
        faults = check_mapped(tmp_path / "log.csv", tmp_path / "m.toml").faults
        assert wanted in " ".join(map(str, faults))


def test_fixes_that_lie_years_apart_take_no_time(tmp_path: Path) -> None:
    """Found by fuzzing: a leg of 10 s each, from 1970 on, took seconds and gigabytes."""
    rows = [(0, 1.0), (1, 1.0), (2, 1.0), *((2e11 + k, 1.0) for k in range(9))]
    text = "t_s,lat_deg,lon_deg,speed_mps\n" + "".join(f"{t:.0f},{lat},2.0,5.0\n" for t, lat in rows)
    (tmp_path / "log.csv").write_text(text)
    begin = time.process_time()
    check_log(tmp_path / "log.csv")
    assert time.process_time() - begin < 5.0


def test_a_parquet_file_whose_account_is_damaged_is_refused(tmp_path: Path) -> None:
    """Found by fuzzing: a letter of a column's name that is none, where the sizes of the columns stand."""
    path = tmp_path / "log.parquet"
    parquet.write_table(pyarrow.table({"unix_time": [1.7e9, 1.7e9 + 1.0], "speed_kn": [5.0, 5.0]}), path)
    content = path.read_bytes()
    at = content.rindex(b"speed_kn", 0, content.index(b"ARROW:schema"))
    path.write_bytes(content[:at] + b"\x80" + content[at + 1 :])
    with pytest.raises(InputError, match="cannot be read as a Parquet table"):
        read_recording(path)


@pytest.mark.parametrize(
    ("cell", "wanted"),
    [
        ("-1e308", "1 samples are NaN or infinite, the first at sample 8"),
        ("1_0", "data line 9 is no row of 7 numbers"),
        ("59.2 N", "data line 9 is no row of 7 numbers"),
    ],
)
def test_numbers_that_no_sensor_gives_are_refused(tmp_path: Path, cell: str, wanted: str) -> None:
    """Found by fuzzing: a mean force of 1e308 m/s² has no size, and pyarrow reads less than Python does."""
    rows = "".join(f"{0.01 * k},0,0,0,0,0,{cell if k == 7 else 9.8}\n" for k in range(20))
    (tmp_path / "imu.csv").write_text("t_s,gx_rad_s,gy_rad_s,gz_rad_s,fx_mps2,fy_mps2,fz_mps2\n" + rows)
    with pytest.raises(InputError, match=wanted):
        read_imu(tmp_path / "imu.csv")


@pytest.mark.parametrize("cell", ["2_0", "\uff12"])
def test_a_number_of_python_alone_is_refused_in_psins_text(tmp_path: Path, cell: str) -> None:
    """Found by fuzzing: `float` takes both, numpy's reader neither."""
    rows = "".join(f"1 {cell if k == 3 else 2} 3 4 5 9800\n" for k in range(9))
    (tmp_path / "psins.txt").write_text("%PSINS\n0 0 0 0 0 0\n34 108 380 0 10 9.8\n.1 .1 .1 1 1 1\n" + rows)
    with pytest.raises(InputError, match="data line 7 is no row of 6 numbers"):
        read_imu(tmp_path / "psins.txt")
