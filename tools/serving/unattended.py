"""A server left alone: visitors who come and go, upload and share, while it is ended and started at random.

    python -m tools.serving.unattended --hours 12                 # make soak HOURS=12
    python -m tools.serving.unattended --hours 12 --piece 60      # an hour of it: make soak HOURS=12 PIECE=60

With ``--piece`` a call serves for so many minutes and stops; the next call goes on with the same state
folder, sessions and counts, until the hours are full. ``--again`` begins anew.

Each visitor has a session and comes back to it: the value that was seen to be kept must be there, whatever
has happened to the server meanwhile (half of its ends are kills). The figures of the last third of the time
since the last start are held against those of the third before, log and state folder against their bounds.
Exit code 1 when a row is missed.
"""

import argparse
import json
import os
import random
import re
import shutil
import signal
import statistics
import subprocess
import sys
import threading
import time
from collections import Counter
from contextlib import closing
from dataclasses import asdict, dataclass, field
from http.client import HTTPConnection, HTTPException
from pathlib import Path
from urllib.request import urlopen

from schuler_bench.bench.process import environment, free_port
from schuler_bench.bench.visitor import PAGE_COMMAND, PAGE_STATE, Visitor
from tools.serving.load import WINDOW, ZETA
from tools.serving.soak import HEAD, Row, counted
from tools.serving.table import machine

VISITORS = 10
LOG_BYTES, LOG_FILES = 200_000, 2
"""Bound of the log in this soak: it is to be reached."""
LEAST_MINUTES = 5.0
_EVERY_S = 5.0
_UPLOAD = "Upload a file"
COURSE = "course.json"
KEPT = {"kept_shared": "shared", "upload_bytes": "uploaded"}
"""Figures of ``/metrics`` of what is kept."""


@dataclass
class Kept:
    """The server, started again on the same state folder and port.

    Attributes
    ----------
    folder : Path
        For state and log.
    port : int
        Where it listens.
    counts : Counter
        What has happened.
    figures : list of dict
        Since its last start.
    held : dict
        By visitor: session, and the value that was seen to be kept in it.
    """

    folder: Path
    port: int = field(default_factory=free_port)
    counts: Counter[str] = field(default_factory=Counter)
    figures: list[dict[str, float]] = field(default_factory=list)
    process: subprocess.Popen[bytes] | None = None
    held: dict[int, tuple[str | None, float | None]] = field(default_factory=dict)

    def start(self) -> None:
        """Start it and wait until it answers."""
        variables = {"XDG_STATE_HOME": str(self.folder / "state")}
        variables |= {"SCHULER_LOG_FILE": str(self.folder / "log"), "SCHULER_LOG_BYTES": str(LOG_BYTES)}
        words = [sys.executable, "-m", "schuler_bench", "serve", "--port", str(self.port)]
        out = subprocess.DEVNULL
        self.process = subprocess.Popen(words, env=environment() | variables, stdin=out, stdout=out)
        self.figures.clear()
        while self.session() is None:
            if self.process.poll() is not None:
                raise RuntimeError(f"the server ended with exit code {self.process.returncode}")
            time.sleep(0.1)

    def end(self, number: int) -> None:
        """End it; it must obey within 5 s."""
        assert self.process is not None
        self.process.send_signal(number)
        try:
            self.process.wait(5.0)
        except subprocess.TimeoutExpired:
            self.counts["late"] += 1
            self.process.kill()
            self.process.wait()
        self.counts["ends"] += 1

    def session(self) -> str | None:
        """Id of a new session; None while nobody answers."""
        try:
            with closing(HTTPConnection("127.0.0.1", self.port, timeout=10.0)) as connection:
                connection.request("GET", "/")
                return connection.getresponse().headers["Location"].split("/")[1]
        except (OSError, HTTPException):
            return None

    def metric(self, name: str) -> float:
        """Figure of ``/metrics``."""
        with urlopen(f"http://127.0.0.1:{self.port}/metrics", timeout=30.0) as answer:
            return float(re.findall(rf"^schuler_{name} (\S+)$", answer.read().decode(), re.MULTILINE)[0])

    def note(self) -> None:
        """Take the figures of the process, and of the disk."""
        assert self.process is not None
        place = Path(f"/proc/{self.process.pid}")
        with_log = [path.stat().st_size for path in self.folder.glob("log*")]
        state = [path.stat() for path in (self.folder / "state").rglob("*") if path.is_file()]
        try:
            now = {
                "memory": int((place / "statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 2**20,
                "files": float(len(list((place / "fd").iterdir()))),
                "threads": float(len(list((place / "task").iterdir()))),
            }
        except OSError:
            return
        disk = sum({one.st_ino: one.st_size for one in state}.values()) / 2**20
        self.figures.append(now | {"log": sum(with_log) / 1e3, "disk": disk})


def live(kept: Kept, number: int, piece: int, ended: threading.Event) -> None:
    """One visitor: comes, looks whether all is there, moves, uploads, shares, goes; again and again."""
    chance = random.Random(f"{number} of {piece}")
    session, value = kept.held.get(number, (None, None))
    while not ended.wait(chance.uniform(1.0, 5.0)):
        try:
            session = session or kept.session()
            if session is None:
                continue
            kept.held[number] = session, value
            with Visitor(kept.port, session) as visitor:
                visitor.set(PAGE_STATE, WINDOW)
                visitor.wait(lambda v=visitor: v.run_number >= 1, "its run", 60.0)
                if value is not None:
                    kept.counts["compared"] += 1
                    kept.counts["lost"] += visitor.held(ZETA) != value
                value = fresh = None  # until it is seen to be kept
                kept.held[number] = session, None
                for step in range(chance.randrange(1, 6)):
                    before, fresh = visitor.run_number, round(chance.uniform(0.3, 0.9), 4)
                    visitor.set(ZETA, fresh)
                    visitor.wait(lambda v=visitor, n=before: v.run_number > n, "an answer", 60.0)
                    kept.counts["answers"] += 1
                    visitor.rest(chance.uniform(0.3, 1.5))
                    if step == 3:
                        visitor.upload(_UPLOAD, f"{number}.csv", log_of(chance))
                        visitor.set(PAGE_COMMAND, f'[[{kept.counts["answers"]},"share",""]]')
                        visitor.rest(3.0)
                        kept.counts["uploads"] += 1
                        break
                else:
                    visitor.rest(3.0)  # it is written half a second after the change
                    value = fresh
                    kept.held[number] = session, value
        except Exception as error:  # the server was ended; the websocket has errors of its own
            kept.counts[f"interrupted ({type(error).__name__})"] += 1


def log_of(chance: random.Random) -> bytes:
    """A small speed log that is like no other."""
    speeds = "".join(f"{t},{chance.uniform(4.0, 6.0):.3f},90.0\n" for t in range(120))
    return f"t_s,speed_mps,heading_deg\n{speeds}".encode()


@dataclass
class Course:
    """What all pieces so far have seen; kept as JSON beside the state folder.

    Attributes
    ----------
    seconds : float
        Served.
    counts : Counter
        What has happened.
    growth : dict of list
        By figure, for each piece: the last third since its last start over the third before.
    level : dict of list
        By figure, for each piece: in the last third.
    most : dict
        Largest log (kB) and state folder (MB).
    there : dict
        What was kept at the end.
    held : dict
        As of `Kept`.
    """

    seconds: float = 0.0
    counts: Counter[str] = field(default_factory=Counter)
    growth: dict[str, list[float]] = field(default_factory=dict)
    level: dict[str, list[float]] = field(default_factory=dict)
    most: dict[str, float] = field(default_factory=dict)
    there: dict[str, float] = field(default_factory=dict)
    held: dict[int, tuple[str | None, float | None]] = field(default_factory=dict)

    @classmethod
    def of(cls, path: Path) -> "Course":
        """The course that a file holds; a new one when there is none."""
        if not path.exists():
            return cls()
        known = json.loads(path.read_text("utf-8"))
        held = {int(number): tuple(one) for number, one in known.pop("held").items()}
        return cls(**(known | {"counts": Counter(known["counts"]), "held": held}))

    def write(self, path: Path) -> None:
        """Keep it for the next piece."""
        path.write_text(json.dumps(vars(self)) + "\n", "utf-8")

    @property
    def pieces(self) -> int:
        """How many pieces have been served."""
        return len(self.growth.get("memory", ()))

    def add(self, kept: Kept, seconds: float, there: dict[str, float]) -> None:
        """Add a piece that has been served."""
        third = len(kept.figures) // 3
        parts = kept.figures[third:-third], kept.figures[-third:]
        for key in ("memory", "files", "threads"):
            before, last = (statistics.median(one[key] for one in part) for part in parts)
            self.growth.setdefault(key, []).append(last / before)
            self.level.setdefault(key, []).append(last)
        for key in ("log", "disk"):
            self.most[key] = max(self.most.get(key, 0.0), *(one[key] for one in kept.figures))
        self.seconds, self.held = self.seconds + seconds, kept.held
        self.counts.update(kept.counts)
        self.there = there

    def rows(self) -> list[Row]:
        """What is wanted, and what was seen."""
        counts, rows = self.counts, list[Row]()
        for key, unit in (("memory", "MB"), ("files", ""), ("threads", "")):
            growth, level = max(self.growth[key]), self.level[key]
            what = f"{key}: last third of a piece ({level[-1]:.0f} {unit}) over the one before"
            rows.append(Row(f"alone_{key}", what, growth, "", most=1.05, strict=True))
            if self.pieces > 1:
                what = f"{key}: last piece over the first"
                rows.append(Row(f"alone_{key}_pieces", what, level[-1] / level[0], "", most=1.1, strict=True))
        most_kb = LOG_BYTES * (LOG_FILES + 1) / 1e3
        log_kb, disk_mb = self.most["log"], self.most["disk"]
        rows += [
            Row("alone_log", "log with its older files", log_kb, "kB", most=most_kb, strict=True),
            Row("alone_disk", "state folder", disk_mb, "MB", most=64.0, strict=True),
            counted("alone_lost", "visits to a session without what was kept", counts["lost"]),
            counted("alone_late", "ends that took more than 5 s", counts["late"]),
        ]
        some = {
            "answers": ("answers", counts["answers"]),
            "compared": ("visits to a session of before", counts["compared"]),
            "ends": ("ends of the server, half of them kills", counts["ends"]),
        }
        some |= {name: (f"kept at the end: {name}", self.there.get(key, 0.0)) for key, name in KEPT.items()}
        return rows + [Row(f"alone_{k}", what, n, "", least=1, strict=True) for k, (what, n) in some.items()]


def serve_piece(kept: Kept, seconds: float, piece: int, chance: random.Random) -> None:
    """Serve visitors for a time; the server is ended at random in the first 0.4 of it."""
    ended = threading.Event()
    visitors = [
        threading.Thread(target=live, args=(kept, number, piece, ended), daemon=True)
        for number in range(VISITORS)
    ]
    for one in visitors:
        one.start()
    began = time.monotonic()
    # Of the last third of the time the figures are taken: the server is not ended any more.
    next_end = chance.uniform(0.02, 0.2) * seconds
    while (now := time.monotonic() - began) < seconds:
        time.sleep(_EVERY_S)
        kept.note()
        if now > next_end and now < 0.4 * seconds:
            # which of the two an end is goes on over the pieces
            kept.end(signal.SIGKILL if (kept.counts["ends"] + piece) % 2 else signal.SIGTERM)
            kept.start()
            next_end = now + chance.uniform(0.02, 0.2) * seconds
    ended.set()
    for one in visitors:
        one.join(30.0)


def main() -> int:
    """Serve for the whole time or a piece of it, print the table; 1 when a row is missed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--hours", type=float, default=12.0)
    parser.add_argument("--piece", type=float, help="minutes of this call; the next one goes on")
    parser.add_argument("--again", action="store_true", help="begin anew, not with what is in the folder")
    parser.add_argument("--folder", type=Path, default=Path("build/unattended"), help="state, log and course")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--json", type=Path, help="file for the rows")
    arguments = parser.parse_args()
    if arguments.piece is not None and arguments.piece < LEAST_MINUTES:
        parser.error(f"--piece must be at least {LEAST_MINUTES:g} minutes, of which the thirds are compared")
    folder, whole_s = arguments.folder.absolute(), 3600.0 * arguments.hours
    if arguments.again or arguments.piece is None:
        shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True, exist_ok=True)
    course = Course.of(folder / COURSE)
    left_s = whole_s - course.seconds
    if left_s > 0.0:
        seconds = left_s if arguments.piece is None else min(left_s, 60.0 * arguments.piece)
        kept = Kept(folder, held=course.held)
        kept.start()
        serve_piece(kept, seconds, course.pieces, random.Random(arguments.seed + course.pieces))
        there = {key: kept.metric(key) for key in KEPT}
        kept.end(signal.SIGTERM)
        course.add(kept, seconds, there)
        course.write(folder / COURSE)
    rows = course.rows()
    served, pieces = course.seconds / 3600.0, course.pieces
    circumstances = f"{served:.3g} h of {arguments.hours:g} h, {pieces} pieces; {machine()}"
    print("\n".join([circumstances, "", *HEAD, *(row.line for row in rows), "", str(dict(course.counts))]))
    if arguments.json:
        arguments.json.parent.mkdir(parents=True, exist_ok=True)
        record = {"circumstances": circumstances, "rows": [asdict(row) | {"met": row.met} for row in rows]}
        arguments.json.write_text(json.dumps(record, indent=2) + "\n")
    return int(any(not row.met for row in rows))


if __name__ == "__main__":
    sys.exit(main())
