"""Who has a place: connections still at the door, pages that are open, and which of them is evicted.

Everything here runs in the event loop of the server; nothing is locked.
"""

import time
from collections import Counter, OrderedDict
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Protocol

from schuler_bench.http.limits import Limits

_INVITED_S = 60.0
_MOST_INVITED = 4096


class Connected(Protocol):
    """The part of a connection that is read here."""

    address: str
    session_id: str
    active_s: float

    @property
    def asked(self) -> bool:
        """Whether a request has arrived."""
        ...

    def turn_away(self) -> None:
        """Close a connection that is still at the door."""

    def give_up_place(self) -> None:
        """Close a page that has long been idle."""


@dataclass
class Door:
    """Connections that are no open page: half-open requests, and answers that are still being sent.

    When there are too many, the oldest one of the busiest address is closed in favour of the newcomer, one
    that has not sent a request first: sockets that stay silent keep nobody out.

    Attributes
    ----------
    limits : Limits
        How many there may be.
    turned_away : int
        Connections closed so far in favour of newer ones.
    """

    limits: Limits
    turned_away: int = 0
    _waiting: OrderedDict[int, Connected] = field(default_factory=OrderedDict)

    def __len__(self) -> int:
        return len(self._waiting)

    def enter(self, newcomer: Connected) -> None:
        """Take note of a new connection; another one may have to go."""
        self._waiting[id(newcomer)] = newcomer
        if len(self._waiting) > self.limits.half_open:
            oldest = self._longest_silent()
            self.leave(oldest)
            self.turned_away += 1
            oldest.turn_away()

    def leave(self, connection: Connected) -> None:
        """Forget a connection: it was closed, or has become an open page."""
        self._waiting.pop(id(connection), None)

    def _longest_silent(self) -> Connected:
        silent = [c for c in self._waiting.values() if not c.asked] or list(self._waiting.values())
        busiest, _ = Counter(c.address for c in silent).most_common(1)[0]
        return next(c for c in silent if c.address == busiest)


@dataclass
class Places:
    """The open pages. When all places are taken, the one that has been idle longest may have to go.

    Only a page that a person has just opened or come back to is `invited` to take the place of an idle one. A
    page that was closed for this reason connects again by itself, but waits until a place is free: pages that
    nobody looks at do not drive each other out in turn.

    Attributes
    ----------
    limits : Limits
        How many there may be.
    clock : callable
        Seconds, monotonic.
    given_up : int
        Idle pages closed so far in favour of others.
    """

    limits: Limits
    clock: Callable[[], float] = time.monotonic
    given_up: int = 0
    _pages: dict[int, Connected] = field(default_factory=dict)
    _invited: OrderedDict[str, float] = field(default_factory=OrderedDict)

    def __len__(self) -> int:
        return len(self._pages)

    def invite(self, session_id: str) -> None:
        """A person has opened this session's page, or has come back to it."""
        self._invited.pop(session_id, None)
        self._invited[session_id] = self.clock() + _INVITED_S
        while len(self._invited) > _MOST_INVITED:
            self._invited.popitem(last=False)

    def has_room(self, address: str, session_id: str) -> bool:
        """Whether a page of this session could be opened now."""
        of_address = sum(page.address == address for page in self._pages.values())
        if of_address >= self.limits.pages_per_address:
            return False
        full = len(self._pages) >= self.limits.visitors
        invited = self._invited.get(session_id, 0.0) > self.clock()
        return not full or (invited and self._idlest() is not None)

    def take(self, page: Connected) -> bool:
        """Give the page a place, in exchange for an idle one if need be; False when there is no room."""
        if not self.has_room(page.address, page.session_id):
            return False
        if len(self._pages) >= self.limits.visitors:
            idlest = self._idlest()
            assert idlest is not None
            self.leave(idlest)
            self.given_up += 1
            idlest.give_up_place()
        self._invited.pop(page.session_id, None)
        page.active_s = self.clock()
        self._pages[id(page)] = page
        return True

    def leave(self, page: Connected) -> None:
        """Forget a page that was closed."""
        self._pages.pop(id(page), None)

    def _idlest(self) -> Connected | None:
        page = min(self._pages.values(), key=lambda page: page.active_s, default=None)
        idle = page is not None and self.clock() - page.active_s >= self.limits.idle_s
        return page if idle else None
