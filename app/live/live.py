"""One live stream of a server: listened to, damped, shown to all visitors, and sent on."""

from __future__ import annotations

import logging
import math
import socket
import threading
import time
from collections import deque
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np

from navcore.engine.live.damping import LiveDamping, Piece
from navcore.engine.live.heard import Heard, Reading
from navcore.engine.live.sent import Sent
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.scenario.model import Scenario
from schuler_bench.jobs.words import what_failed
from schuler_bench.live.addresses import Datagrams, Source
from schuler_bench.live.inlet import Inlet, Listener
from schuler_bench.live.settings import Settings

TICK_S = 1.0
"""Time between two looks at what has come."""
KEPT_BYTES = 32 << 20
"""Sentences that are kept to be run on as a recording."""
_RATE_S = 10.0
_UNDATED_S = 90.0
"""What was heard is kept so long while damping has not begun."""
_EVERY_S, _MOST_POINTS = 10.0, 8640
"""Interval and count of the points of the curves: a day."""
_log = logging.getLogger("schuler.live")


@dataclass(frozen=True)
class Curves:
    """Course of a live stream.

    Attributes
    ----------
    time_s : ndarray, shape (n,)
        UTC, s.
    against_log : ndarray, shape (n, m + 1)
        Length of the velocity minus the log's, m/s: as recorded, then of each method; NaN without a log.
    moved_m : ndarray, shape (n, m)
        By how much each method has moved the position.
    """

    time_s: np.ndarray
    against_log: np.ndarray
    moved_m: np.ndarray


@dataclass(frozen=True)
class Status:
    """What a page shows of a live stream.

    Attributes
    ----------
    sources : tuple of str
        Where it is listened to.
    rate_hz : float
        Sentences a second over the last ten.
    sentences, malformed, dropped : int
        Since the server began: taken, without sense or with a wrong checksum, and dropped.
    left_out : int
        Fixes far off their neighbours.
    taken : str
        Which sentences give what.
    newest_s : float
        UTC of the newest position, s; NaN before the first.
    damped_s : float
        UTC of the newest damped output, s; NaN before the first.
    told : str
        Why it waits, or was begun anew.
    restarts : int
        How often damping was begun anew.
    names : tuple of str
        Of the methods.
    recorded : ndarray, shape (5,), or None
        Output at ``damped_s``, columns of `navcore.engine.against.OUTPUT`.
    damped : dict
        Damped output at that time by method.
    sent : int
        Sentences sent on.
    target : str
        To where, and which method's; empty where nothing is sent.
    """

    sources: tuple[str, ...]
    rate_hz: float = 0.0
    sentences: int = 0
    malformed: int = 0
    dropped: int = 0
    left_out: int = 0
    taken: str = ""
    newest_s: float = math.nan
    damped_s: float = math.nan
    told: str = ""
    restarts: int = 0
    names: tuple[str, ...] = ()
    recorded: np.ndarray | None = None
    damped: dict[str, np.ndarray] | None = None
    sent: int = 0
    target: str = ""

    @property
    def delay_s(self) -> float:
        """Age of the damped output against the newest position, s; NaN before the first."""
        return self.newest_s - self.damped_s


class Live:
    """Listens, damps and sends on, until it is closed; whatever comes, it goes on.

    Parameters
    ----------
    scenario : Scenario
        Its methods and ``[ins.damping]`` are laid on what is heard.
    sources : iterable of Source
        Where to listen.
    target : Datagrams, optional
        Where to send the damped output.
    method : str
        Whose output is sent; the first method unless given.

    Raises
    ------
    InputError
        An address cannot be bound, a method cannot be carried on live, or none has that name.
    """

    def __init__(
        self, scenario: Scenario, sources: Iterable[Source], target: Datagrams | None = None, method: str = ""
    ) -> None:
        self._scenario, self._sources = scenario, tuple(sources)
        self._damping, self._heard, self._inlet = LiveDamping(scenario), Heard(), Inlet()
        names = self._damping.names
        if method and method not in names:
            allowed = f"must be one of {', '.join(names)}"
            raise InputError(Fault("serve", "--send-method", method, allowed))
        self._target, self._sender = target, Sent(method or names[0])
        self._outlet: socket.socket | None = None
        if target is not None:
            family = socket.AF_INET6 if ":" in target.host else socket.AF_INET
            self._outlet = socket.socket(family, socket.SOCK_DGRAM)
            self._outlet.setblocking(False)
        self._changed = threading.Condition()
        self._ended = False
        self._number = 0
        self._kept: deque[str] = deque()
        self._kept_bytes = 0
        self._rates: deque[tuple[float, int]] = deque()
        self._points: deque[tuple[float, ...]] = deque(maxlen=_MOST_POINTS)
        self._sent = self._unsent = 0
        self._last: Piece | None = None
        self._newest_s = math.nan
        self.status = Status(tuple(map(str, self._sources)), names=names)
        self._listener = Listener(self._sources, self._inlet)
        self._thread = threading.Thread(target=self._loop, name="live", daemon=True)
        self._thread.start()

    # ------------------------------------------------------------ for the pages

    def wait(self, after: int, timeout_s: float) -> tuple[int, Status]:
        """Wait for a status newer than number ``after``; return the newest with its number."""
        with self._changed:
            self._changed.wait_for(lambda: self._number > after or self._ended, timeout_s)
            return self._number, self.status

    @property
    def ended(self) -> bool:
        """Whether it was closed."""
        return self._ended

    def curves(self) -> Curves:
        """Course since damping began, at most a day."""
        with self._changed:
            points = list(self._points)
        count = len(self._damping.names)
        table = np.array(points, float).reshape(-1, 2 * count + 2)
        return Curves(table[:, 0], table[:, 1 : count + 2], table[:, count + 2 :])

    def recording(self) -> bytes:
        """Sentences that were heard, the newest 32 MiB."""
        with self._changed:
            return "".join(self._kept).encode("ascii", "replace")

    def close(self) -> None:
        """End listening."""
        with self._changed:
            self._ended = True
            self._changed.notify_all()
        self._listener.close()
        self._thread.join(2.0)
        if self._outlet is not None:
            self._outlet.close()

    # ------------------------------------------------------------ its own thread

    def _loop(self) -> None:
        from navcore.foundation.kernel_cache import ready

        due = time.monotonic()
        while not self._ended:
            due = max(due + TICK_S, time.monotonic())
            with self._changed:
                self._changed.wait_for(lambda: self._ended, due - time.monotonic())
            if self._ended:
                return
            try:
                self.step(time.monotonic(), damps=ready())
            except InputError as error:
                self._tell(str(error))
            except Exception as error:
                # it goes on: what could not be read is behind with the next lines
                _log.exception("live damping failed")
                self._begin_anew(what_failed(error))

    def step(self, now_s: float, *, damps: bool = True) -> None:
        """Look once at what has come.

        Parameters
        ----------
        now_s : float
            Monotonic time, s.
        damps : bool
            Not while the kernels are still compiled: what comes meanwhile is counted.
        """
        text = self._inlet.drain()
        self._keep(text)
        self._rate(now_s)
        if text and damps:
            self._take(text)
        self._publish()

    def _take(self, text: str) -> None:
        heard = self._heard
        reading = heard.add(text)
        if heard.ran_back:
            self._damping.begin_anew(Text("the times ran back"))
            self._sender.begin_anew()
        if reading is None:
            self._damping.told = Text("waiting for sentences with a time: RMC, GGA or ZDA")
            heard.forget_before(math.inf)
            return
        while (piece := self._damping.advance(reading.recording)) is not None:
            self._point(piece)
            self._send(reading, piece)
            self._last = piece
        heard.forget_before(max(self._damping.needed_from_s, reading.newest_s - 2.0 * _UNDATED_S))
        self._newest_s = reading.newest_s

    def _begin_anew(self, why: str) -> None:
        self._heard.begin_anew()
        self._damping.begin_anew(why)
        self._sender.begin_anew()

    def _keep(self, text: str) -> None:
        if not text:
            return
        with self._changed:
            self._kept.append(text)
            self._kept_bytes += len(text)
            while self._kept_bytes > KEPT_BYTES:
                self._kept_bytes -= len(self._kept.popleft())

    def _rate(self, now_s: float) -> None:
        self._rates.append((now_s, self._heard.counts.sentences))
        while self._rates[0][0] < now_s - _RATE_S:
            self._rates.popleft()

    def _point(self, piece: Piece) -> None:
        """Add points of the curves, one in ten seconds."""
        names = self._damping.names
        last = self._points[-1][0] if self._points else -math.inf
        for k in range(len(piece.time_s)):
            if piece.time_s[k] - last < _EVERY_S:
                continue
            last = float(piece.time_s[k])
            log = piece.log[k]
            against = [math.hypot(*log)]
            against += [math.hypot(*(log - piece.moved[name][k, 3:5])) for name in names]
            moved = [math.hypot(*piece.moved[name][k, 5:7]) for name in names]
            with self._changed:
                self._points.append((last, *against, *moved))

    def _send(self, reading: Reading, piece: Piece) -> None:
        if self._outlet is None or self._target is None:
            return
        for line in self._sender.lines(reading, piece, self._heard.pinned):
            try:
                sentence = f"{line}\r\n".encode("ascii", "replace")
                self._outlet.sendto(sentence, (self._target.host, self._target.port))
                self._sent += 1
            except OSError:
                self._unsent += 1

    def _tell(self, why: str) -> None:
        self._damping.told = why
        self._publish()

    def _publish(self) -> None:
        counts, piece = self._heard.counts, self._last
        (first_s, first), (last_s, last) = self._rates[0], self._rates[-1]
        target = ""
        if self._target is not None:
            target = Text("{method} to {address}", method=self._sender.method, address=str(self._target))
        status = Status(
            tuple(map(str, self._sources)),
            (last - first) / (last_s - first_s) if last_s > first_s else 0.0,
            counts.sentences,
            counts.malformed,
            self._inlet.dropped + self._unsent,
            self._damping.left_out,
            self._heard.described,
            self._newest_s,
            math.nan if piece is None else float(piece.time_s[-1]),
            self._damping.told,
            self._damping.restarts,
            self._damping.names,
            None if piece is None else piece.recorded[-1],
            None if piece is None else {name: rows[-1] for name, rows in piece.damped.items()},
            self._sent,
            target,
        )
        with self._changed:
            self.status = status
            self._number += 1
            self._changed.notify_all()


_present: list[Live] = []


def use_live(live: Live | None) -> None:
    """Show a live stream on all pages from now on; None: no more."""
    _present[:] = [] if live is None else [live]


def present() -> Live | None:
    """Live stream of this server; None where it listens to none."""
    return _present[0] if _present else None


@contextmanager
def listening(settings: Settings | None) -> Iterator[Live | None]:
    """Listen as a server is told to, and show it on all its pages; raises `InputError`."""
    if settings is None:
        yield None
        return
    live = Live(settings.scenario, settings.sources, settings.target, settings.method)
    use_live(live)
    try:
        yield live
    finally:
        use_live(None)
        live.close()
