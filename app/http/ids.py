"""Ids of sessions, as they stand in addresses: of a visitor's own, of a shared state, of a copy of one.

Whoever knows an id sees the visitor's work, so ids are not to be guessed; and a stranger must not choose one
and lure a visitor into it, so only ids that a server has made and signed are accepted.
"""

import base64
import hashlib
import hmac
import re
import secrets
from collections.abc import Callable
from dataclasses import dataclass, field

SHARED_PREFIX = "share-"
_RANDOM = r"[A-Za-z0-9_-]{24}"
_SHARED = re.compile(rf"{SHARED_PREFIX}{_RANDOM}")
_LINK = re.compile(rf"{SHARED_PREFIX}{_RANDOM}(?![A-Za-z0-9_-])")
_COPY = re.compile(rf"({SHARED_PREFIX}{_RANDOM})-{_RANDOM}")


_SIGNATURE = 8
"""Characters at the end of an id that are its signature: 48 bits, to be tried only by asking the server."""


def new_shared_id() -> str:
    """Id of a state that is to be shared."""
    return SHARED_PREFIX + secrets.token_urlsafe(18)


def is_shared(id: str) -> bool:
    """Whether it is the id of a shared state: it is never worked on itself."""
    return _SHARED.fullmatch(id) is not None


def shared_in(text: str) -> str | None:
    """Id of the shared state that an address names; None where it names none, or a copy of one.

    Examples
    --------
    >>> link = f"https://bench.example/s/{new_shared_id()}/?tab=Compare"
    >>> shared_in(link) in link, shared_in(f"/s/{SessionIds().new_copy(new_shared_id())}/")
    (True, None)
    """
    match = _LINK.search(text)
    return None if match is None else match.group()


def copied_from(id: str) -> str | None:
    """Shared state that the session with this id began as a copy of; None for any other session."""
    match = _COPY.fullmatch(id)
    return None if match is None else match.group(1)


def log_name(id: str) -> str:
    """Name of a session for logs and threads: says which is the same one, does not open it."""
    return hashlib.sha256(id.encode()).hexdigest()[:8]


def _never(_: str) -> bool:
    return False


@dataclass(frozen=True)
class SessionIds:
    """Makes and recognises the ids of one server, or of several that share a key.

    Attributes
    ----------
    key : bytes
        Signs the ids; kept with the sessions, so that a restarted server recognises them.
    known : callable
        ``known(id)``: further ids that are accepted, those of sessions that were kept before ids were signed.

    Examples
    --------
    >>> ids, shared = SessionIds(), new_shared_id()
    >>> copy = ids.new_copy(shared)
    >>> copied_from(copy) == shared, copied_from(shared), is_shared(shared)
    (True, None, True)
    >>> ids.accepts(ids.new()), ids.accepts(copy)
    (True, True)
    >>> ids.accepts("chosen-by-a-stranger-000"), SessionIds().accepts(copy)
    (False, False)
    """

    key: bytes = field(default_factory=lambda: secrets.token_bytes(32), repr=False)
    known: Callable[[str], bool] = _never

    def new(self) -> str:
        """Return a fresh session id."""
        return self._signed("", secrets.token_urlsafe(12))

    def new_copy(self, shared: str) -> str:
        """Id for one visitor's own copy of a shared state; it says of which."""
        return self._signed(f"{shared}-", secrets.token_urlsafe(12))

    def accepts(self, id: str) -> bool:
        """Whether a server with this key has made the id."""
        head, signature = id[:-_SIGNATURE], id[-_SIGNATURE:]
        return hmac.compare_digest(signature.encode(), self._signature(head).encode()) or self.known(id)

    def _signed(self, prefix: str, random: str) -> str:
        return prefix + random + self._signature(prefix + random)

    def _signature(self, text: str) -> str:
        digest = hmac.new(self.key, text.encode(), hashlib.sha256).digest()
        return base64.urlsafe_b64encode(digest)[:_SIGNATURE].decode()
