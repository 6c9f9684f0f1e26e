"""Pins that come back with a link: a reviewer's, put beside those of the author."""

from schuler_bench.session.session import Session


def take_pins(session: Session, address: str) -> int | None:
    """Put the pins of a shared state beside those of a session, as a step of undo.

    Parameters
    ----------
    session : Session
        Whose scenario and pins stay.
    address : str
        Holds the link.

    Returns
    -------
    int or None
        How many were not here yet; None where no state was shared under this address.

    Raises
    ------
    InputError, ValueError, TypeError, KeyError
        There are too many, a recording of theirs is not here, or they cannot be read.
    """
    kept = session.shared_pins(address)
    with session.lock:
        fresh = session.pins.take(kept or [])
        session.taken += fresh
        session.select(session.selected, None)  # its state, with what was taken, becomes the history's
    return None if kept is None else len(fresh)
