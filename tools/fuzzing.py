"""``python -m tools.fuzzing``: damaged recordings and maps are read by every importer, or refused by name.

Hypothesis damages good files of each format. With ``--guided`` and atheris installed, the coverage of
`navcore.io` and `navcore.checks` guides the same damage.
"""

import argparse
import gzip
import sys
import time
import traceback
import zipfile
from collections.abc import Callable, Iterator
from contextlib import suppress
from importlib import import_module
from io import BytesIO
from pathlib import Path
from typing import Any

from hypothesis import HealthCheck, given, settings
from hypothesis import seed as seeded
from hypothesis import strategies as st

LONGEST_S = 5.0
"""Processor time that a small file may take."""
BATCH = 500
"""Files that one seed of Hypothesis draws."""
_ROWS = 70
_TOKENS = tuple(
    rb"""nan -inf 1e400 -1e308 - 0x1p3 1_0 1,5 99999999999 1e18 12:61:00 2024-02-30T00:00:00Z 31/12/99
    19+366:00:00:00 " ' $ * ! # % ; | \ S utc date time_(ms) lat_(rad) gps_week sog_(km/h) gyro_x_(deg/h)
    acc_z_[g] hemisphere julian_day mjd time_(GPS) 1,234 1.234,5 1,234,567 GyrX Status
    $GPZDA,240000.00,31,02,0000,,*6B <trkpt>""".split()
) + (b"", b"\xc3\xa9", b"\xff", b"\0", b"\n", b"\r", b"\t", b" ")


def seeds(folder: Path) -> list[bytes]:
    """Write small good files: NMEA 0183, tables with maps, containers, an IMU; GPX and PSINS text too.

    The first ones are tables with their maps, which `read_by_all` maps by damaged maps.
    """
    from navcore.checks.map_guess import guessed_map
    from tests import planted

    track, log = ({k: v[:_ROWS] for k, v in part.items()} for part in planted.ship())
    files = [file for write, _ in planted.FORMATS.values() for file in write(folder, track, log)]
    files.append(planted.write_imu(folder, {k: v[:_ROWS] for k, v in planted.rocking_imu().items()}))
    for table in [file for file in files if file.suffix == ".csv"]:
        files.append(table.with_suffix(".map"))
        files[-1].write_text(guessed_map(str(table)), encoding="utf-8")
    found = [file.read_bytes() for file in (*files, *_containers(folder, track))]
    found += _texts()
    fixes = zip(track["lat"].tolist(), track["lon"].tolist(), strict=True)
    points = "".join(
        f'<trkpt lat="{lat}" lon="{lon}"><time>2024-05-13T09:{k // 60:02d}:{k % 60:02d}Z</time></trkpt>\n'
        for k, (lat, lon) in enumerate(fixes)
    )
    gpx = f'<?xml version="1.0"?>\n<gpx version="1.1"><trk><trkseg>\n{points}</trkseg></trk></gpx>\n'
    psins = "%PSINS\n0 0 0 0 0 0\n34 108 380 0 10 9.8\n.1 .1 .1 1 1 1\n" + "1 2 3 4 5 9800\n" * _ROWS
    return [*found, gpx.encode(), psins.encode()]


def _containers(folder: Path, track: dict[str, Any]) -> Iterator[Path]:
    """Yield a NetCDF file of the classic format, HDF5 with groups, and MAT files with structs."""
    import h5py
    from scipy.io import netcdf_file, savemat

    ship = {name: track[name] for name in ("lat", "lon", "heading")}
    netcdf, hdf = folder / "nav.nc", folder / "nav.h5"
    with netcdf_file(str(netcdf), "w") as file:
        file.createDimension("time", _ROWS)
        for name, values in (("time", track["time"] - 315964800.0 + 18.0), *ship.items()):
            variable = file.createVariable(name, "f8", ("time",))
            variable[:] = values
            variable.units = "seconds since 1980-01-06" if name == "time" else "degrees"
            variable.long_name = "GPS time" if name == "time" else name
    yield netcdf
    with h5py.File(hdf, "w") as file:
        for name, values in (("utc", track["time"]), *ship.items()):
            held = file.create_dataset(f"ship/{name}", data=values)
            held.attrs["scale_factor"], held.attrs["_FillValue"] = 1.0, -9999.0
    yield hdf
    for name, packed in (("struct.mat", False), ("packed.mat", True)):
        fields = {"unix_time": track["time"], **ship}
        savemat(folder / name, {"nav": {"ref": fields}, "rate": 1.0}, do_compression=packed)
        yield folder / name


def _texts() -> list[bytes]:
    """Tables with groups of three digits, of ArduPilot and with Julian dates; sentences of an Octans."""
    tables = (
        ("time_ms;speed_mps;heading_deg", lambda k: f"{1000 * k:,};5.0;90.0"),
        ("t_s;speed_kn;steuerkurs", lambda k: f"{k},5;1.000,5;{90 + k},25"),
        ("TimeUS,I,Status,GWk,Lat,Lng,Spd,GCrs", lambda k: f"{10**6 * k},{k % 2},3,2314,45.{k:03d},12.1,5,8"),
        ("TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ", lambda k: f"{20000 * k},0,.001,.002,.003,.1,.2,-9.8"),
        ("julian_day,latitude,longitude,heading", lambda k: f"{2460444 + k / 86400:.8f},.78{k:03d},.21,.14"),
        ("year,doy,heading", lambda k: f"2024,{138 + k / 86400:.8f},{k}"),
    )
    octans = "".join(
        f"$GPZDA,1200{k % 60:02d},13,05,2024,00,00\n$HEHDT,{k}.5,T\n$PHINF,0000{k:04X}\n"
        for k in range(_ROWS)
    )
    found = ["\n".join([header, *map(row, range(_ROWS))]) + "\n" for header, row in tables]
    return [text.encode() for text in (*found, octans)]


def damaged(good: list[bytes]) -> st.SearchStrategy[bytes]:
    """Files with up to eight places cut, doubled, overwritten or exchanged, some of them packed."""
    place, token = st.floats(0.0, 1.0), st.sampled_from(_TOKENS) | st.binary(max_size=8)
    edits = st.lists(st.tuples(st.integers(0, 6), place, place, token), max_size=8)
    packing = st.sampled_from((bytes, bytes, bytes, bytes, gzip.compress, _zipped))
    return st.builds(_damaged, st.sampled_from(good), st.sampled_from(good), edits, packing)


def _zipped(content: bytes) -> bytes:
    buffer = BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("log", content)
    return buffer.getvalue()


def _damaged(
    content: bytes,
    other: bytes,
    edits: list[tuple[int, float, float, bytes]],
    pack: Callable[[bytes], bytes],
) -> bytes:
    for kind, first, second, token in edits:
        begin, end = sorted((int(first * len(content)), int(second * len(content))))
        if kind < 2:  # by cells or by lines, where most of what is read hangs on
            mark = b"," if kind == 0 else b"\n"
            parts = content.split(mark)
            parts[min(int(first * len(parts)), len(parts) - 1)] = token
            content = mark.join(parts)
        elif kind == 2:
            content = content[:begin] + token + content[begin + len(token) :]
        elif kind == 3:
            content = content[:begin] + token + content[begin:]
        elif kind == 4:
            content = content[:begin] + content[end:]
        elif kind == 5:
            content = content[:end] + content[begin:]
        else:
            content = content[:begin] + other[int(second * len(other)) :]
    return pack(content[: 1 << 20])


def read_by_all(path: Path) -> None:
    """Check, read and preview a file by every importer; what they refuse by name is well.

    A file that is a map maps the good tables that `seeds` wrote beside it.
    """
    from navcore.checks.file import check_file
    from navcore.checks.imu import IMU_CHECKER, check_mapped
    from navcore.checks.map_guess import preview_of
    from navcore.foundation.errors import InputError
    from navcore.io.column_map import read_map
    from navcore.io.recording import read_recording
    from navcore.sensors.recorded_imu import read_imu

    "\n".join(check_file(path, [IMU_CHECKER]).lines())
    for read in (read_recording, read_imu, preview_of):
        with suppress(InputError):
            read(path)
    with suppress(InputError):
        column_map = read_map(path)
        for table in path.parent.glob("*/*.csv"):
            "\n".join(check_mapped(table, column_map).lines())


def property_of(path: Path) -> Any:
    """Test that Hypothesis runs: each damaged file is read or refused, in time."""
    good = path.parent / "good"
    good.mkdir(exist_ok=True)

    @settings(
        max_examples=BATCH,
        deadline=None,
        database=None,
        report_multiple_bugs=False,
        suppress_health_check=[HealthCheck.too_slow],
    )
    @given(content=damaged(seeds(good)))
    def is_read_or_refused(content: bytes) -> None:
        path.write_bytes(content)
        began = time.process_time()
        read_by_all(path)
        assert time.process_time() - began < LONGEST_S, "takes too long"

    return is_read_or_refused


def main(arguments: list[str] | None = None) -> int:
    """Fuzz for some minutes; 1 with the exception, its file kept, when something is found."""
    parser = argparse.ArgumentParser(prog="python -m tools.fuzzing", description=__doc__)
    parser.add_argument("--minutes", type=float, default=10.0)
    parser.add_argument("--seed", type=int, default=0, help=f"of the first {BATCH} files")
    parser.add_argument("--guided", action="store_true", help="by coverage; needs atheris")
    parser.add_argument("--keep", type=Path, default=Path("build/fuzzed"), help="file that is read")
    options = parser.parse_args(arguments)
    options.keep.parent.mkdir(parents=True, exist_ok=True)
    if options.guided:
        atheris: Any = import_module("atheris")
        with atheris.instrument_imports(include=["navcore.io", "navcore.checks"]):
            read_by_all(Path(__file__))
        fuzzed = property_of(options.keep).hypothesis.fuzz_one_input
        atheris.Setup([sys.argv[0], f"-max_total_time={60.0 * options.minutes:.0f}"], fuzzed)
        atheris.Fuzz()
        return 0
    end, batch = time.monotonic() + 60.0 * options.minutes, options.seed
    while time.monotonic() < end:
        try:
            seeded(batch)(property_of(options.keep))()
        except Exception as problem:
            problem.__notes__ = []  # Hypothesis adds the bytes of the file
            traceback.print_exc(limit=-8)
            print(f"batch {batch}: {options.keep} is neither read nor refused by name")
            return 1
        batch += 1
    print(f"{BATCH * (batch - options.seed)} damaged files read or refused by name")
    return 0


if __name__ == "__main__":
    sys.exit(main())
