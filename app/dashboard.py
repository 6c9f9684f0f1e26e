"""What a server shows: the pages that are open, their sessions, and what runs while nobody is served yet."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from navcore.foundation import guarded
from navcore.foundation.errors import InputError
from schuler_bench.jobs import helper, kernels
from schuler_bench.jobs.words import what_failed
from schuler_bench.memory import GiveBack, collect_seldom
from schuler_bench.session.keeping import Keeping
from schuler_bench.session.saving import AGAIN_AFTER_S
from schuler_bench.views import VIEWS, load

if TYPE_CHECKING:
    import viser

    from schuler_bench.http.metrics import Metrics
    from schuler_bench.session.classroom import Classroom
    from schuler_bench.session.sessions import Sessions
    from schuler_bench.session.store import Store
    from schuler_bench.shell.page import Page

_log = logging.getLogger("schuler.serve")


class Dashboard:
    """Gives every browser that opens the page its `schuler_bench.shell.page.Page`.

    Parameters
    ----------
    state : Path or None
        Folder in which sessions outlive the server; None: they do not.
    views : sequence of str
        Packages of the views, in the order of their tabs.
    classroom : Classroom, optional
        The class that the visitors form.

    Attributes
    ----------
    keeping : Keeping
        Whether sessions are kept at present.
    """

    def __init__(
        self,
        state: Path | None = None,
        views: Sequence[str] = VIEWS,
        classroom: Classroom | None = None,
    ) -> None:
        self._state, self._views, self._classroom = state, views, classroom
        self.keeping = Keeping()
        self._memory = GiveBack(self._forget)
        self._pages: dict[int, Page] = {}
        self._lock = threading.Lock()
        self._ended = threading.Event()

    @cached_property
    def sessions(self) -> Sessions:
        """All sessions; made with the first page."""
        from schuler_bench.session.sessions import Sessions

        return Sessions(
            store=self.store,
            on_answer=lambda seconds: self.metrics.answers.observe(seconds),
            keeping=self.keeping,
            classroom=self._classroom,
        )

    @cached_property
    def store(self) -> Store | None:
        """Where sessions are kept; None: nowhere, and `keeping` says why."""
        from schuler_bench.session.store import open_store

        return None if self._state is None else open_store(self._state, self.keeping)

    def _open_later(self) -> None:
        """Try again, until it works or the server ends, to keep what could not be kept at the start."""
        from schuler_bench.session.store import open_store

        assert self._state is not None
        while not self._ended.wait(AGAIN_AFTER_S):
            store = open_store(self._state, self.keeping)
            if store is None:
                continue
            with self._lock:
                self.__dict__["store"] = store
                sessions = self.__dict__.get("sessions")
            if self._ended.is_set():
                store.close()
                return
            if sessions is not None:
                sessions.keep_in(store)
            self.keeping.becomes(None)
            return

    @cached_property
    def metrics(self) -> Metrics:
        """Figures of the server, for ``/metrics``."""
        from schuler_bench.http.metrics import Metrics
        from schuler_bench.jobs.elsewhere import cluster_figures
        from schuler_bench.jobs.scheduler import scheduler

        metrics = Metrics()
        metrics.sources += [lambda: scheduler().figures(), cluster_figures, self._figures]
        return metrics

    def _figures(self) -> dict[str, float]:
        with self._lock:
            pages, sessions = len(self._pages), self.__dict__.get("sessions")
        return {"pages_built": float(pages)} | ({} if sessions is None else sessions.figures())

    def knows(self, session_id: str) -> bool:
        """Whether a session with that id is kept here."""
        with self._lock:
            sessions = self.sessions
        return sessions.knows(session_id)

    def warm_up(
        self,
        prepare: Callable[[], None],
        failed: Callable[[str], None],
        compile_kernels: Callable[[], None] = lambda: None,
    ) -> threading.Thread:
        """Do in the background what the first page would have to wait for.

        Import what it needs, load the compiled kernels, run the scenario that a new visitor sees, and
        ``prepare()`` the files that browsers load; ``failed(reason)`` when that cannot be done. First
        ``compile_kernels()`` begins what takes longest.
        """
        given = prepare, failed, compile_kernels
        thread = threading.Thread(target=self._warm_up, args=given, name="warm-up", daemon=True)
        thread.start()
        return thread

    def _warm_up(
        self,
        prepare: Callable[[], None],
        failed: Callable[[str], None],
        compile_kernels: Callable[[], None],
    ) -> None:
        try:
            with self._lock:
                kept = self.store  # the first thing that is said: whether anything is kept
            if kept is None and self._state is not None:
                threading.Thread(target=self._open_later, name="store-later", daemon=True).start()
            compile_kernels()
            prepare()
            import schuler_bench.shell.page  # noqa: F401
            from navcore.engine.simulation import simulate
            from schuler_bench.session.sessions import first_scenario

            load(self._views)
            guarded.warm()
            with self._lock:
                sessions = self.sessions
            sessions.prepared = kernels.when_there(lambda: simulate(first_scenario()[0]))
            collect_seldom()
        except InputError as error:
            _log.error("no scenario can be run: %s", error)
            failed(what_failed(error))
        except Exception as error:
            _log.exception("warming up failed")
            failed(what_failed(error))

    def on_connect(self, client: viser.ClientHandle, session_id: str) -> None:
        """Build the page of a browser."""
        from schuler_bench.shell.page import Page

        with self._lock:
            sessions = self.sessions
        page = Page(client, sessions.get(session_id), load(self._views))
        with self._lock:
            self._pages[client.client_id] = page

    def on_disconnect(self, client: viser.ClientHandle, session_id: str) -> None:
        """Close the page of a browser that has gone."""
        del session_id
        with self._lock:
            page = self._pages.pop(client.client_id, None)
        if page is not None:
            page.close()
        self._memory.soon()

    def _forget(self) -> None:
        """Drop what was computed for visitors who have gone."""
        with self._lock:
            sessions = self.__dict__.get("sessions")
        if sessions is not None:
            from navcore.foundation.stage_cache import keep_only

            sessions.forget_idle()
            keep_only(sessions.names_with_pages)

    def close(self) -> None:
        """End all sessions and remove what was uploaded and is not kept."""
        self._ended.set()
        if self._classroom is not None:
            self._classroom.close()
        helper.stop()
        kernels.stop()
        if "sessions" in self.__dict__:  # made with the first page
            self.sessions.close()
        elif (store := self.__dict__.get("store")) is not None:
            store.close()
