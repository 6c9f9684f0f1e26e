"""Ids of sessions, as they stand in addresses: of a visitor's own, of a shared state, of a copy of one."""

from __future__ import annotations

import re
import secrets

SHARED_PREFIX = "share-"
_RANDOM = r"[A-Za-z0-9_-]{24}"
_SHARED = re.compile(rf"{SHARED_PREFIX}{_RANDOM}")
_COPY = re.compile(rf"({SHARED_PREFIX}{_RANDOM})-{_RANDOM}")


def new_session_id() -> str:
    """Return a fresh session id: whoever knows it sees the visitor's work, so it is not to be guessed."""
    return secrets.token_urlsafe(18)


def new_shared_id() -> str:
    """Id of a state that is to be shared."""
    return SHARED_PREFIX + new_session_id()


def is_shared(id: str) -> bool:
    """Whether it is the id of a shared state: it is never worked on itself."""
    return _SHARED.fullmatch(id) is not None


def new_copy_id(shared: str) -> str:
    """Id for one visitor's own copy of a shared state; it says of which, so that nobody has to remember.

    Examples
    --------
    >>> shared = new_shared_id()
    >>> copied_from(new_copy_id(shared)) == shared, copied_from(shared), is_shared(shared)
    (True, None, True)
    """
    return f"{shared}-{new_session_id()}"


def copied_from(id: str) -> str | None:
    """Shared state that the session with this id began as a copy of; None for any other session."""
    found = _COPY.fullmatch(id)
    return None if found is None else found.group(1)
