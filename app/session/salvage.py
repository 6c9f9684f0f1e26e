"""Documents of a damaged file of sessions, read page by page past what SQLite refuses as a whole.

A row is recognised by the head that SQLite writes before it: the length of the whole, the types of its
columns, and an id. The tree of pages is not needed, so that a row is found whatever else is broken. A long
row goes on in other pages; where that chain is broken, what was read is the beginning of the document.
"""

from __future__ import annotations

import os
import re
import struct
from collections.abc import Iterator
from dataclasses import dataclass

import orjson

from schuler_bench.session.folder import Folder

NAME = "sessions.sqlite"
PAGE_BYTES = 4096
"""Of a database that we make, and of one whose head cannot be read."""
_MAGIC = b"SQLite format 3\0"
_WAL_MAGIC = (0x377F0682, 0x377F0683)
_WAL_HEAD, _FRAME_HEAD = 32, 24
_LARGEST_ROW = (16 << 20) + 4096
_HEAD = re.compile(
    rb"[\x05-\x0b](?P<id>[\x0f-\x7f])(?P<by>[\x00-\x7f])(?P<used>[\x00-\x7f])"
    rb"(?P<content>[\x80-\xff]{0,3}[\x00-\x7f])(?P<served>[\x00-\x7f]?)(?=[A-Za-z0-9_-])"
)
"""Length of a row's head, then the type of each column: id, shared_by, used_s, content, and used_served."""
_ID = re.compile(rb"[A-Za-z0-9_-]{1,64}")
_INDEXED = re.compile(
    rb"(?P<length>[\x04-\xff])\x03(?P<by>[\x00\x0d-\x7f])(?P<id>[\x0f-\x7f])(?=[A-Za-z0-9_-])"
)
"""Begin of an entry of the index of documents: shared_by and id, which tell of rows that are lost."""
_SIZES = (0, 1, 2, 3, 4, 6, 8, 8, 0, 0, 0, 0)


@dataclass(frozen=True)
class Found:
    """A row of the table of documents.

    Attributes
    ----------
    id : str
        Of the session or shared state.
    shared_by : str or None
        Session that a shared state is of.
    used_s : float
        When it was last used, by the clock of that time; 0: not known.
    content : bytes
        The document, or what could be read of it; empty: nothing but that there was one.
    whole : bool
        The content is a document of this id.
    """

    id: str
    shared_by: str | None
    used_s: float
    content: bytes
    whole: bool


def documents(folder: Folder) -> list[Found]:
    """Best version of every document that can be found in the file and in the log beside it.

    Parameters
    ----------
    folder : Folder
        Holds `NAME`, which no connection of this process has open.

    Raises
    ------
    OSError
        The file cannot be read.
    """
    best: dict[str, Found] = {}
    with _Pages(folder) as pages:
        for one in pages.rows():
            other = best.get(one.id)
            if other is None or (one.whole, one.used_s) >= (other.whole, other.used_s):
                best[one.id] = one
        for id in pages.indexed():
            best.setdefault(id, Found(id, None, 0.0, b"", False))
    return list(best.values())


def head_is_broken(folder: Folder) -> bool:
    """Whether the first bytes of the file are not those of a database of ours; one without any is new."""
    with folder.read(NAME) as file:
        head = file.read(100)
    if not head:  # SQLite would remove the log beside it
        log = folder.file(f"{NAME}-wal")
        return log is not None and log.st_size > 0
    size = int.from_bytes(head[16:18])
    return (
        len(head) < 100
        or head[:16] != _MAGIC
        or (size != 1 and (size < 512 or size & (size - 1) != 0))
        or not {1, 2}.issuperset(head[18:20])
        or head[20] > 32
        or head[21:24] != bytes((64, 32, 32))
        # Both are 0 as long as the first table is in the log alone.
        or int.from_bytes(head[44:48]) > 4
        or int.from_bytes(head[56:60]) > 1
    )


def log_is_broken(folder: Folder) -> bool:
    """Whether the log beside the file holds changes behind one that is broken: SQLite would drop them."""
    if folder.file(f"{NAME}-wal") is None:
        return False
    with folder.read(f"{NAME}-wal") as file:
        head = file.read(_WAL_HEAD)
        if len(head) < _WAL_HEAD:
            return any(head)
        magic, _, size, _, *salt, first, second = struct.unpack(">8I", head)
        if magic not in _WAL_MAGIC or size < 512 or size & (size - 1) or size > 65536:
            return any(head) or any(file.read())
        words = f"{'>' if magic & 1 else '<'}{{}}I"
        if (sums := _checksum(words, head[:24], (0, 0))) != (first, second):
            return True
        broken = False
        while len(frame := file.read(_FRAME_HEAD + size)) == _FRAME_HEAD + size:
            *_, frame_salt, other_salt, first, second = struct.unpack_from(">6I", frame)
            ours = [frame_salt, other_salt] == salt
            if broken and ours:
                return True
            sums = _checksum(words, frame[:8] + frame[_FRAME_HEAD:], sums)
            # What was written before the log began anew has another salt.
            broken = broken or not ours or sums != (first, second)
    return False


def _checksum(words: str, data: bytes, before: tuple[int, int]) -> tuple[int, int]:
    """Checksum of the log's format, carried on from the one before."""
    first, second = before
    values = struct.unpack(words.format(len(data) // 4), data)
    for one, other in zip(values[::2], values[1::2], strict=True):
        first = (first + one + second) & 0xFFFFFFFF
        second = (second + other + first) & 0xFFFFFFFF
    return first, second


class _Pages:
    """Pages of the file, and every version of a page that the log holds, the newest last."""

    def __init__(self, folder: Folder) -> None:
        self._file = folder.open(NAME)
        self._log = folder.open(f"{NAME}-wal") if folder.file(f"{NAME}-wal") is not None else None
        self._size = self._page_size()
        self._count = os.fstat(self._file).st_size // self._size + 1
        self._newer: dict[int, list[int]] = {}
        self._read_log()

    def __enter__(self) -> _Pages:
        return self

    def __exit__(self, *_: object) -> None:
        os.close(self._file)
        if self._log is not None:
            os.close(self._log)

    def _page_size(self) -> int:
        head = os.pread(self._file, 18, 0)
        size = int.from_bytes(head[16:18]) if head[:16] == _MAGIC else 0
        if size == 1:
            size = 65536
        if (size < 512 or size & (size - 1)) and self._log is not None:
            size = int.from_bytes(os.pread(self._log, 4, 8))
        return PAGE_BYTES if size < 512 or size & (size - 1) or size > 65536 else size

    def _read_log(self) -> None:
        if self._log is None:
            return
        length, at = _FRAME_HEAD + self._size, _WAL_HEAD
        salt = os.pread(self._log, 8, 16)
        frames: list[tuple[int, bytes, int]] = []
        while len(head := os.pread(self._log, _FRAME_HEAD, at)) == _FRAME_HEAD:
            frames.append((int.from_bytes(head[:4]), head[8:16], at + _FRAME_HEAD))
            at += length
        if all(one != salt for _, one, _ in frames):  # its head is broken: the first two that agree
            pairs = zip(frames, frames[1:], strict=False)
            salt = next((one for (_, one, _), (_, other, _) in pairs if one == other), b"")
        for number, one, start in frames:
            if one == salt and 0 < number < 1 << 24:
                self._newer.setdefault(number, []).append(start)

    def _versions(self, number: int) -> Iterator[bytes]:
        """Versions of a page, the newest first."""
        for start in reversed(self._newer.get(number, ())):
            assert self._log is not None
            yield os.pread(self._log, self._size, start)
        yield os.pread(self._file, self._size, (number - 1) * self._size)

    def rows(self) -> Iterator[Found]:
        """Every version of every row; those of the log last."""
        for page in self._all():
            yield from self._rows_of(page)

    def indexed(self) -> Iterator[str]:
        """Ids of which the index says that there is a document."""
        for page in self._all():
            for entry in _INDEXED.finditer(page):
                by, id = ((entry[name][0] - 12) // 2 if entry[name] != b"\0" else 0 for name in ("by", "id"))
                named = page[entry.end() + by : entry.end() + by + id]
                if entry["length"][0] == 3 + by + id and _ID.fullmatch(named) is not None:
                    yield named.decode()

    def _all(self) -> Iterator[bytes]:
        """Every version of every page; those of the log last."""
        for number in range(1, self._count + 1):
            yield os.pread(self._file, self._size, (number - 1) * self._size)
        for start in sorted(start for starts in self._newer.values() for start in starts):
            assert self._log is not None
            yield os.pread(self._log, self._size, start)

    def _rows_of(self, page: bytes) -> Iterator[Found]:
        at = 0
        while (match := _HEAD.search(page, at)) is not None:
            at = match.start() + 1
            found = self._row(page, match.start())
            if found is not None:
                yield found

    def _row(self, page: bytes, head: int) -> Found | None:
        """Row whose head begins there, if it is one."""
        end, types, at = head + page[head], list[int](), head + 1
        while at < min(end, len(page)):
            value, at = _varint(page, at)
            types.append(value)
        if at != end or not 4 <= len(types) <= 5:
            return None
        sizes = [_SIZES[kind] if kind < 12 else (kind - 12) // 2 for kind in types]
        length = page[head] + sum(sizes)
        before = _as_varint(length)
        if length > _LARGEST_ROW or page[max(0, head - len(before)) : head] != before:
            return None
        found = [self._found(row[page[head] :], types, sizes) for row in self._payloads(page, head, length)]
        return next((one for one in found if one is not None and one.whole), found[0])

    @staticmethod
    def _found(row: bytes, types: list[int], sizes: list[int]) -> Found | None:
        """Row of these types, if the first of them is an id."""
        parts = []
        for size in sizes:
            parts.append(row[:size])
            row = row[size:]
        if types[0] % 2 == 0 or types[0] < 13 or _ID.fullmatch(parts[0]) is None:
            return None
        id, content = parts[0].decode(), parts[3]
        shared_by = parts[1].decode() if _ID.fullmatch(parts[1]) is not None else ""
        whole = len(content) == sizes[3] and _is_document(id, content)
        return Found(id, shared_by if types[1] else None, _number(types[2], parts[2]), content, whole)

    def _payloads(self, page: bytes, start: int, length: int) -> Iterator[bytes]:
        """Bytes of a row, as far as they can be followed: by the newest pages, then by those of the file."""
        most, least = (self._size - 12) * 64 // 255 - 23, (self._size - 12) * 32 // 255 - 23
        rest = least + (length - least) % (self._size - 4)
        local = length if length <= most else rest if rest <= most else least
        first = page[start : start + local]
        if local == length:
            yield first
            return
        following = int.from_bytes(page[start + local : start + local + 4])
        # A change that was never finished may have begun to use a page for something else.
        for version in (0, -1):
            yield self._chain(first, following, length, version)

    def _chain(self, first: bytes, number: int, length: int, version: int) -> bytes:
        parts, have = [first], len(first)
        for _ in range(length // (self._size - 4) + 2):
            if have >= length or not 0 < number <= 1 << 24:
                break
            page = list(self._versions(number))[version]
            parts.append(page[4 : 4 + length - have])
            have += len(parts[-1])
            number = int.from_bytes(page[:4])
        return b"".join(parts)


def _is_document(id: str, content: bytes) -> bool:
    try:
        document = orjson.loads(content)
    except ValueError:
        return False
    return isinstance(document, dict) and document.get("id") == id


def _number(kind: int, data: bytes) -> float:
    if kind == 7 and len(data) == 8:
        value = struct.unpack(">d", data)[0]
        return value if 0.0 <= value < 1e12 else 0.0
    return float(int.from_bytes(data, signed=True)) if 1 <= kind <= 6 else 0.0


def _varint(data: bytes, at: int) -> tuple[int, int]:
    """Number of SQLite's variable length, at most four bytes of it, and where it ends."""
    value = 0
    for end in range(at, min(at + 4, len(data))):
        value = value << 7 | data[end] & 0x7F
        if data[end] < 0x80:
            return value, end + 1
    return value, len(data) + 1


def _as_varint(value: int) -> bytes:
    parts = [value & 0x7F]
    while value := value >> 7:
        parts.append(value & 0x7F | 0x80)
    return bytes(reversed(parts))
