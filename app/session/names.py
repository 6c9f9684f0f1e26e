"""Names that the user of a session has given: a page in another language leaves them as they are."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from schuler_bench.session.session import Session

_MOST_KEPT = 200


class GivenNames:
    """Names of methods, pins and uploads, the last ones that have gone among them: undo speaks of these.

    Parameters
    ----------
    session : Session
        Of the user.
    """

    def __init__(self, session: Session) -> None:
        self._session = session
        self._of: tuple[object, ...] = ()
        self._files: tuple[str, ...] = ()
        self._kept: dict[str, None] = {}
        self._names: frozenset[str] = frozenset()

    def __call__(self) -> frozenset[str]:
        """Return all of them; asked for each message to a page."""
        session = self._session
        run, pins = session.run, session.pins.all
        files = tuple(session.uploads.files)
        now = (session.scenario, None if run is None else run.scenario, pins)
        old = len(now) != len(self._of) or any(a is not b for a, b in zip(now, self._of, strict=True))
        if old or files != self._files:
            scenarios = [session.scenario, *(pin.scenario for pin in pins)]
            scenarios += [] if run is None else [run.scenario]
            fresh = [method.name for scenario in scenarios for method in scenario.method]
            fresh += [pin.name for pin in pins if not pin.unnamed]
            fresh += files
            kept = [name for name in self._kept if name not in fresh][-_MOST_KEPT:]
            self._kept = dict.fromkeys([*kept, *fresh])
            self._names, self._of = frozenset(self._kept), now
            self._files = files
        return self._names
