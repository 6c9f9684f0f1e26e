"""A file that is not read is refused by the name of its kind, with what it holds and what to save instead."""

import bz2
import gzip
import io
import lzma
import pickle
import sqlite3
import tarfile
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from scipy.io import savemat

from navcore.foundation.errors import InputError
from navcore.io.known_files import KNOWN, TEXTS
from navcore.io.recording import read_recording
from navcore.sensors.recorded_imu import read_imu


def _zip(members: dict[str, str]) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for name, text in members.items():
            archive.writestr(name, text)
    return buffer.getvalue()


def _tar() -> bytes:
    buffer = io.BytesIO()
    with tarfile.open(fileobj=buffer, mode="w") as archive:
        for name in ("cruise/track.nmea", "cruise/log.nmea"):
            member = tarfile.TarInfo(name)
            member.size = 5
            archive.addfile(member, io.BytesIO(b"hello"))
    return buffer.getvalue()


def _database(folder: Path) -> bytes:
    path = folder / "made.db"
    with sqlite3.connect(path) as database:
        database.execute("CREATE TABLE fixes (t REAL, lat REAL)")
    database.close()
    return path.read_bytes()


def _npy() -> bytes:
    buffer = io.BytesIO()
    np.save(buffer, np.zeros((5, 3)))
    return buffer.getvalue()


def _mat() -> bytes:
    buffer = io.BytesIO()
    savemat(buffer, {"x": np.zeros(5)})
    return buffer.getvalue()


WORKBOOK = {
    "[Content_Types].xml": "<Types/>",
    "xl/workbook.xml": '<book><sheets><sheet name="Fahrt 12" id="1"/><sheet name="Log"/></sheets></book>',
    "xl/worksheets/sheet1.xml": "<worksheet/>",
}
DOCUMENT = {
    "mimetype": "application/vnd.oasis.opendocument.spreadsheet",
    "content.xml": '<office:document-content><table:table table:name="Tabelle1"/></office:document-content>',
}
FILES: dict[str, tuple[Callable[[Path], bytes], list[str]]] = {
    "log.xlsx": (lambda _: _zip(WORKBOOK), ["an Excel workbook (Fahrt 12, Log)", "CSV"]),
    "log.xlsm": (lambda _: _zip(WORKBOOK | {"xl/vbaProject.bin": ""}), ["an Excel workbook (Fahrt 12, Log)"]),
    "log.ods": (lambda _: _zip(DOCUMENT), ["LibreOffice (.ods)", "(Tabelle1)", "CSV"]),
    "log.docx": (
        lambda _: _zip({"[Content_Types].xml": "", "word/document.xml": ""}),
        ["an Office document"],
    ),
    "log.xls": (
        lambda _: b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(600),
        ["Excel workbook of the old format"],
    ),
    "log.db3": (_database, ["a SQLite database", "(fixes)", "export its table"]),
    "log.pkl": (lambda _: pickle.dumps({"t": [1, 2]}), ["a Python pickle", "not opened"]),
    "log.npy": (lambda _: _npy(), ["one array of numpy", "numpy.savez"]),
    "log.tar": (lambda _: _tar(), ["a tar archive (cruise/track.nmea, cruise/log.nmea)", "unpack it"]),
    "log.tar.gz": (lambda _: gzip.compress(_tar()), ["a tar archive (cruise/track.nmea", "unpack it"]),
    "log.zip": (lambda _: _zip({"a.nmea": "", "b.nmea": ""}), ["zip file of 2 files (a.nmea, b.nmea)"]),
    "log.mat.gz": (lambda _: gzip.compress(_mat()), ["holds a MAT table inside of gzip"]),
    "log.txt.gz.gz": (
        lambda _: gzip.compress(gzip.compress(b"x" * 50)),
        ["holds a gzip table inside of gzip"],
    ),
    "log.feather": (lambda _: b"ARROW1\0\0" + bytes(80), ["an Arrow or Feather table", "Parquet"]),
    "log.bag": (lambda _: b"#ROSBAG V2.0\n" + bytes(200), ["a ROS bag", "CSV"]),
    "log.nc": (lambda _: b"CDF\x05" + bytes(100), ["NetCDF of version 5", "nccopy"]),
    "log.pdf": (lambda _: b"%PDF-1.7\n" + bytes(range(256)) * 3, ["a PDF document"]),
    "log.ubx": (lambda _: b"\xb5\x62\x01\x07" + bytes(range(256)), ["u-blox", "NMEA 0183"]),
    "log.html": (lambda _: b"<!DOCTYPE html>\n<html><body>Sign in</body></html>\n", ["a web page"]),
    "log.kml": (lambda _: b'<?xml version="1.0"?>\n<kml><Placemark/></kml>\n', ["a KML document", "GPX"]),
    "log.json": (lambda _: b'[{"t": 1, "lat": 50.0}]\n', ["is JSON", "one row a record"]),
    "log.24o": (
        lambda _: b"     3.04           OBSERVATION DATA    M                   RINEX VERSION / TYPE\n",
        ["RINEX"],
    ),
    "log.asc": (lambda _: b"#BESTPOSA,COM1,0,78.5,FINESTEERING,1419,336208.000;SOL_COMPUTED\n", ["NovAtel"]),
}


@pytest.mark.parametrize("name", FILES)
def test_the_refusal_names_the_kind_and_what_it_holds(tmp_path: Path, name: str) -> None:
    content, said = FILES[name]
    path = tmp_path / name
    path.write_bytes(content(tmp_path))
    with pytest.raises(InputError) as caught:
        read_recording(path)
    for words in said:
        assert words in str(caught.value)
    assert len(str(caught.value).splitlines()) == 1 and name in str(caught.value)
    with pytest.raises(InputError):
        read_imu(path)


def test_every_kind_has_a_name_and_a_way_out() -> None:
    for known in (*KNOWN, *TEXTS):
        assert known.name and known.instead


@pytest.mark.parametrize("pack", [bz2.compress, lzma.compress, gzip.compress])
def test_text_that_is_packed_is_read(tmp_path: Path, pack: Callable[[bytes], bytes]) -> None:
    path = tmp_path / "log.csv.packed"
    path.write_bytes(pack(b"t_s,heading_deg\n" + b"".join(b"%d,60\n" % k for k in range(9))))
    heading = read_recording(path).heading
    assert heading is not None and heading.time_s.size == 9
