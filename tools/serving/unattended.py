"""A server left alone: visitors who come and go, upload and share, while it is ended and started at random.

    python -m tools.serving.unattended --hours 12    # make soak HOURS=12

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
import signal
import statistics
import subprocess
import sys
import tempfile
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
_EVERY_S = 5.0
_UPLOAD = "Upload a file"


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
    """

    folder: Path
    port: int = field(default_factory=free_port)
    counts: Counter[str] = field(default_factory=Counter)
    figures: list[dict[str, float]] = field(default_factory=list)
    process: subprocess.Popen[bytes] | None = None

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


def live(kept: Kept, number: int, ended: threading.Event) -> None:
    """One visitor: comes, looks whether all is there, moves, uploads, shares, goes; again and again."""
    chance, session, value = random.Random(number), None, None
    while not ended.wait(chance.uniform(1.0, 5.0)):
        try:
            session = session or kept.session()
            if session is None:
                continue
            with Visitor(kept.port, session) as visitor:
                visitor.set(PAGE_STATE, WINDOW)
                visitor.wait(lambda v=visitor: v.run_number >= 1, "its run", 60.0)
                if value is not None:
                    kept.counts["compared"] += 1
                    kept.counts["lost"] += visitor.held(ZETA) != value
                value = fresh = None  # until it is seen to be kept
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
        except Exception as error:  # the server was ended; the websocket has errors of its own
            kept.counts[f"interrupted ({type(error).__name__})"] += 1


def log_of(chance: random.Random) -> bytes:
    """A small speed log that is like no other."""
    speeds = "".join(f"{t},{chance.uniform(4.0, 6.0):.3f},90.0\n" for t in range(120))
    return f"t_s,speed_mps,heading_deg\n{speeds}".encode()


def rows_of(kept: Kept) -> list[Row]:
    """What is wanted, and what was seen."""
    third = len(kept.figures) // 3
    counts, rows = kept.counts, list[Row]()
    for key, unit in (("memory", "MB"), ("files", ""), ("threads", "")):
        last = [
            statistics.median(f[key] for f in part)
            for part in (kept.figures[third:-third], kept.figures[-third:])
        ]
        what = f"{key}: last third since the last start ({last[1]:.0f} {unit}) over the one before"
        rows.append(Row(f"alone_{key}", what, last[1] / last[0], "", most=1.05, strict=True))
    most_kb = LOG_BYTES * (LOG_FILES + 1) / 1e3
    log_kb, disk_mb = (max(one[key] for one in kept.figures) for key in ("log", "disk"))
    return [
        *rows,
        Row("alone_log", "log with its older files", log_kb, "kB", most=most_kb, strict=True),
        Row("alone_disk", "state folder", disk_mb, "MB", most=64.0, strict=True),
        Row("alone_answers", "answers", counts["answers"], "", least=1, strict=True),
        Row("alone_compared", "visits to a session of before", counts["compared"], "", least=1, strict=True),
        counted("alone_lost", "of these, without what was kept", counts["lost"]),
        Row("alone_ends", "ends of the server, half of them kills", counts["ends"], "", least=1, strict=True),
        counted("alone_late", "ends that took more than 5 s", counts["late"]),
    ]


def main() -> int:
    """Serve for the whole time, print the table; 1 when a row is missed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--hours", type=float, default=12.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--json", type=Path, help="file for the rows")
    arguments = parser.parse_args()
    chance, ended = random.Random(arguments.seed), threading.Event()
    seconds, circumstances = 3600.0 * arguments.hours, f"{arguments.hours:g} h; {machine()}"
    with tempfile.TemporaryDirectory(prefix="schuler-soak-") as folder:
        kept = Kept(Path(folder))
        kept.start()
        visitors = [
            threading.Thread(target=live, args=(kept, number, ended), daemon=True)
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
                kept.end(signal.SIGKILL if kept.counts["ends"] % 2 else signal.SIGTERM)
                kept.start()
                next_end = now + chance.uniform(0.02, 0.2) * seconds
        ended.set()
        for one in visitors:
            one.join(30.0)
        kinds = (("shared", "kept_shared"), ("uploaded", "upload_bytes"))
        there = [
            Row(f"alone_{key}", f"kept at the end: {name}", kept.metric(name), "", least=1, strict=True)
            for key, name in kinds
        ]
        kept.end(signal.SIGTERM)
        rows = [*rows_of(kept), *there]
    print("\n".join([circumstances, "", *HEAD, *(row.line for row in rows), "", str(dict(kept.counts))]))
    if arguments.json:
        arguments.json.parent.mkdir(parents=True, exist_ok=True)
        record = {"circumstances": circumstances, "rows": [asdict(row) | {"met": row.met} for row in rows]}
        arguments.json.write_text(json.dumps(record, indent=2) + "\n")
    return int(any(not row.met for row in rows))


if __name__ == "__main__":
    sys.exit(main())
