"""Kinds of files that are not read: refused by name, with what they hold and what to save."""

from __future__ import annotations

import re
import sqlite3
import tarfile
import zipfile
from collections.abc import Callable, Iterable
from contextlib import suppress
from io import BytesIO
from pathlib import Path
from typing import NamedTuple

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.inputs import opened
from navcore.foundation.text import Text

HEAD_BYTES = 1024
_MOST_NAMED = 10
_MOST_BYTES = 1 << 20
_LONGEST_NAME = 60

Contents = Callable[[Path], list[str]]
"""Names of what a file holds."""


class Known(NamedTuple):
    """A kind of file.

    Attributes
    ----------
    name : str
        For people, with the article.
    instead : str
        What to do.
    starts : tuple of bytes
        First bytes.
    at : int
        Where they stand.
    contents : callable, optional
        Names of what it holds.
    """

    name: str
    instead: str
    starts: tuple[bytes, ...]
    at: int = 0
    contents: Contents | None = None


_AS_CSV = Text("save its sheet as CSV (UTF-8), with one line of column names")
_EXPORT = Text("export its messages as CSV, with one line of column names")
_AS_NMEA = Text("convert it to NMEA 0183 or CSV")


def _sheets(path: Path) -> list[str]:
    with zipfile.ZipFile(path) as archive, archive.open("xl/workbook.xml") as stream:
        return re.findall(
            r'<(?:\w+:)?sheet\s[^>]{0,400}?name="([^"]{1,80})"',
            stream.read(_MOST_BYTES).decode("utf-8", "replace"),
        )


def _tables_of_document(path: Path) -> list[str]:
    with zipfile.ZipFile(path) as archive, archive.open("content.xml") as stream:
        text = stream.read(_MOST_BYTES).decode("utf-8", "replace")
    return re.findall(r'<table:table\s[^>]{0,400}?table:name="([^"]{1,80})"', text)


def _tables_of_database(path: Path) -> list[str]:
    with sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro&immutable=1", uri=True) as database:
        rows = database.execute("SELECT name FROM sqlite_master WHERE type = 'table' LIMIT 50").fetchall()
    return [str(name) for (name,) in rows]


def _members(path: Path) -> list[str]:
    with tarfile.open(path) as archive:
        return [member.name for member, _ in zip(archive, range(_MOST_NAMED + 1), strict=False)]


_TAR = Known(Text("a tar archive"), Text("unpack it, and give its files"), (b"ustar",), 257, _members)
KNOWN = (
    Known(
        Text("an Excel workbook of the old format (.xls), or another Office document"),
        _AS_CSV,
        (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1",),
    ),
    Known(
        Text("a SQLite database (ROS 2 bags and many apps are such)"),
        Text("export its table as CSV"),
        (b"SQLite format 3\0",),
        contents=_tables_of_database,
    ),
    Known(
        Text("a Python pickle, which may run any program when it is opened: not opened"),
        Text("save its columns as CSV, Parquet or npz (numpy.savez)"),
        tuple(b"\x80" + bytes([version]) for version in range(2, 6)),
    ),
    Known(
        Text("one array of numpy (.npy), without names of columns"),
        Text("save the columns by name: numpy.savez('log.npz', utc=..., lat_deg=...)"),
        (b"\x93NUMPY",),
    ),
    Known(Text("an Arrow or Feather table"), Text("save it as Parquet"), (b"ARROW1", b"FEA1")),
    Known(Text("a ROS bag"), _EXPORT, (b"#ROSBAG V",)),
    Known(Text("an MCAP recording"), _EXPORT, (b"\x89MCAP",)),
    Known(Text("a PX4 log (ULog)"), Text("convert it: ulog2csv log.ulg"), (b"ULog\x01\x12\x35",)),
    Known(
        Text("an ArduPilot log (DataFlash)"),
        Text("convert it: mavlogdump.py --format csv --types GPS log.bin"),
        (b"\xa3\x95\x80\x80",),
    ),
    Known(Text("a LabVIEW recording (TDMS)"), Text("export its channels as CSV"), (b"TDSm",)),
    Known(Text("an MDF recording of a vehicle's bus"), Text("export its channels as CSV"), (b"MDF     ",)),
    Known(
        Text("NetCDF of version 5 (64-bit data)"),
        Text("convert it: nccopy -k nc4 in.nc out.nc"),
        (b"CDF\x05",),
    ),
    Known(Text("HDF of version 4"), Text("convert it to HDF5: h4toh5"), (b"\x0e\x03\x13\x01",)),
    Known(Text("a 7-Zip archive"), Text("unpack it"), (b"7z\xbc\xaf\x27\x1c",)),
    Known(Text("a RAR archive"), Text("unpack it"), (b"Rar!\x1a\x07",)),
    Known(Text("a PDF document"), Text("ask for the numbers as CSV"), (b"%PDF-",)),
    Known(Text("a picture"), Text("ask for the numbers as CSV"), (b"\x89PNG\r\n", b"\xff\xd8\xff", b"GIF8")),
    Known(Text("a UBX recording of a u-blox receiver"), _AS_NMEA, (b"\xb5\x62",)),
    Known(Text("an SBF recording of a Septentrio receiver"), _AS_NMEA, (b"$@",)),
    Known(
        Text("a binary recording of a NovAtel receiver"),
        _AS_NMEA,
        (b"\xaa\x44\x12", b"\xaa\x44\x13", b"\xaa\x44\x14"),
    ),
    Known(Text("an ADCP's or DVL's recording (RDI PD0)"), _EXPORT, (b"\x7f\x7f",)),
    Known(
        Text("a recording of a Kongsberg echo sounder (.kmall)"),
        Text("export its positions and attitude as CSV or NMEA 0183"),
        tuple(b"#" + name for name in (b"IIP", b"IOP", b"SPO", b"SKM", b"SVP", b"SDE", b"MRZ", b"FCF")),
        4,
    ),
    Known(
        Text("a recording of a Simrad echo sounder (.raw)"),
        Text("export its NMEA 0183 sentences"),
        (b"XML0", b"CON0"),
        4,
    ),
    Known(
        Text("network packets (pcap)"),
        Text("export the payload of the packets as text"),
        (b"\xd4\xc3\xb2\xa1", b"\xa1\xb2\xc3\xd4", b"\x4d\x3c\xb2\xa1", b"\x0a\x0d\x0d\x0a"),
    ),
    Known(Text("a FIT activity"), Text("convert it to GPX or CSV"), (b".FIT",), 8),
    Known(
        Text("a Matroska or MP4 video"), Text("give the log that was recorded beside it"), (b"\x1aE\xdf\xa3",)
    ),
    _TAR,
)
"""By their first bytes."""


class KnownText(NamedTuple):
    """A kind of text, by a pattern in its first characters."""

    name: str
    instead: str
    pattern: re.Pattern[str]


_XML = r"(?:<\?xml[^>]{0,200}\?>\s*)?(?:<!--.{0,400}?-->\s*)?"
DATAFLASH = re.compile(r"FMT, ?\d{1,3}, ?\d{1,3}, ?FMT,")
"""First line of an ArduPilot log as text, whose lines are of many kinds, though some look like a table's."""
TEXTS = (
    KnownText(
        Text("a web page"),
        Text("save the file itself, not the page that offers it"),
        re.compile(r"<!doctype html|<html", re.IGNORECASE),
    ),
    KnownText(
        Text("a KML document"),
        Text("convert it to GPX, with its times"),
        re.compile(_XML + "<kml", re.DOTALL),
    ),
    KnownText(
        Text("a TCX document"),
        Text("convert it to GPX"),
        re.compile(_XML + "<TrainingCenterDatabase", re.DOTALL),
    ),
    KnownText(
        Text("an XML document"),
        Text("convert it to GPX or CSV"),
        re.compile(r"<\?xml(?!.{0,200}<(?:\w{1,20}:)?gpx[\s>])", re.DOTALL),
    ),
    KnownText(
        "JSON",
        Text("write its records as CSV, one row a record"),
        re.compile(r'\{\s{0,80}"|\[\s{0,80}[\[{]'),
    ),
    KnownText(
        Text("a RINEX file of raw observations"),
        Text("compute positions from it, and give these as CSV, .pos or NMEA 0183"),
        re.compile(".{0,200}RINEX VERSION / TYPE", re.DOTALL),
    ),
    KnownText(
        Text("an ArduPilot log (DataFlash, as text)"),
        Text("convert it: mavlogdump.py --format csv --types GPS log.log"),
        DATAFLASH,
    ),
    KnownText(
        "NMEA 2000",
        Text("convert it to NMEA 0183 or CSV"),
        re.compile(
            r"\(\d{9,10}\.\d{3,6}\) \w{1,16} [0-9A-F]{8}#|"
            r"\d\d:\d\d:\d\d\.\d{3} [RT] [0-9A-F]{8} |"
            r"\d{4}-\d\d-\d\d[T-]\d\d:\d\d:\d\d\.\d{3}Z?,\d,\d{5,6},\d{1,3},\d{1,3},\d{1,3},[0-9a-fA-F]{2},"
        ),
    ),
    KnownText(
        Text("an RTF document"),
        Text("save it as plain text (UTF-8)"),
        re.compile(r"\{\\rtf\d"),
    ),
    KnownText(
        Text("a log of NovAtel messages"),
        _AS_NMEA,
        re.compile(r"[#%](?:BEST|INS|RAW|MARK|RANGE)\w{2,20},"),
    ),
)
"""By their first characters, where no format recognises a text."""
_SPREADSHEETS: tuple[tuple[str, str, Contents], ...] = (
    ("xl/workbook.xml", Text("an Excel workbook"), _sheets),
    (
        "content.xml",
        Text("a spreadsheet of LibreOffice (.ods), or another OpenDocument"),
        _tables_of_document,
    ),
)


def refuse_known(path: Path, field: str = "", content: bytes | None = None) -> None:
    """Refuse a file of a known kind that is not read, or such a content; raises `InputError`."""
    if content is None:
        with opened(path) as stream:
            head = stream.read(HEAD_BYTES)
        if head.startswith(b"PK\x03\x04"):
            _refuse_spreadsheet(path, field)
    else:
        head = content[:HEAD_BYTES]
    found = next((one for one in KNOWN if head.startswith(one.starts, one.at)), None)
    if found is None:
        return
    held: list[str] = []
    if found.contents is not None and content is None:
        with suppress(OSError, ValueError, sqlite3.Error, tarfile.TarError, EOFError):
            held = found.contents(path)
    elif found is _TAR and content is not None:
        with (
            suppress(OSError, ValueError, tarfile.TarError, EOFError),
            tarfile.open(fileobj=BytesIO(content)) as archive,
        ):
            held = [member.name for member, _ in zip(archive, range(_MOST_NAMED + 1), strict=False)]
    raise _refusal(path, field, found.name, found.instead, held)


def _refuse_spreadsheet(path: Path, field: str) -> None:
    try:
        with zipfile.ZipFile(path) as archive:
            names = set(archive.namelist()[:10_000])
    except (OSError, ValueError, zipfile.BadZipFile, NotImplementedError):
        return
    office = "[Content_Types].xml" in names or "mimetype" in names
    for member, name, contents in _SPREADSHEETS:
        if member in names:
            held: list[str] = []
            with suppress(
                OSError, ValueError, KeyError, RuntimeError, zipfile.BadZipFile, NotImplementedError
            ):
                held = contents(path)
            raise _refusal(path, field, name, _AS_CSV, held)
    if office:
        raise _refusal(path, field, Text("an Office document"), Text("save its table as CSV (UTF-8)"), [])


def known_text(text: str) -> KnownText | None:
    """Kind of a text that no format reads; None for all others."""
    return next((one for one in TEXTS if one.pattern.match(text[:4096].lstrip())), None)


def refuse_known_text(name: str, text: str) -> None:
    """Refuse a text of a known kind that no format reads; raises `InputError`."""
    found = known_text(text)
    if found is not None:
        allowed = Text("is {name}: {instead}", name=found.name, instead=found.instead)
        raise InputError(Fault(name, "", None, allowed))


def _refusal(path: Path, field: str, name: str, instead: str, held: Iterable[str]) -> InputError:
    names = [one[:_LONGEST_NAME] for one in held]
    more = Text(" and more") if len(names) > _MOST_NAMED else ""
    inside = Text(" ({names}{more})", names=", ".join(names[:_MOST_NAMED]), more=more) if names else ""
    allowed = Text("is {name}{inside}: {instead}", name=name, inside=inside, instead=instead)
    return InputError(Fault(path.name, field, None, allowed))
