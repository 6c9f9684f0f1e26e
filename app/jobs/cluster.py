"""Heavy jobs on a Dask cluster: sent there, watched, called back. What the cluster does not do is done here.

The package ``distributed`` is an extra, ``schuler-bench[cluster]``, imported only when an address is given.
"""

from __future__ import annotations

import importlib.util
import logging
import re
import threading
import time
import uuid
from collections.abc import Callable, Sequence
from concurrent.futures import CancelledError
from typing import TYPE_CHECKING, Any, TypeVar

from app.jobs.remote import Outcome, carry_out, nothing
from app.jobs.worker import ElsewhereLost
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.version import __version__

if TYPE_CHECKING:
    from distributed import Client

_ADDRESS = re.compile(r"(tcp|tls)://[^\s/:@]+:\d{1,5}|(tcp|tls)://\[[0-9a-fA-F:]+\]:\d{1,5}")
_CONNECT_S, _ANSWER_S = 10.0, 10.0
_LOOK_S, _AGAIN_S, _POLL_S = 2.0, 15.0, 0.05
"""Between two looks: at a cluster that answers, at one that does not, at jobs that are under way there."""
_log = logging.getLogger("schuler.cluster")

Item = TypeVar("Item")
Found = TypeVar("Found")
Compute = Callable[[Item, Callable[[float], None], Callable[[], bool]], Found]


class Cluster:
    """The connection to one cluster; a thread keeps it up and looks whether somebody works there.

    Parameters
    ----------
    address : str
        ``tcp://HOST:PORT`` or ``tls://HOST:PORT`` of its scheduler.

    Raises
    ------
    InputError
        As `check_address`.
    """

    def __init__(self, address: str) -> None:
        check_address(address)
        self.address = address
        self._client: Client | None = None
        self._threads = 0
        self._topic = f"schuler-{uuid.uuid4().hex}"
        self._heard: dict[str, Callable[[int, float], None]] = {}
        self._told = ""
        self._lock = threading.Lock()
        self._closed, self._wake = threading.Event(), threading.Event()
        self._keeper = threading.Thread(target=self._keep, name="cluster", daemon=True)
        self._keeper.start()

    @property
    def ready(self) -> bool:
        """Whether jobs may be sent there now."""
        return self._client is not None

    @property
    def threads(self) -> int:
        """Threads of its workers; 0 while no job may be sent there."""
        return self._threads if self.ready else 0

    def compute(
        self,
        function: Compute[Item, Found],
        items: Sequence[Item],
        progress: Callable[[float], None],
        cancelled: Callable[[], bool],
    ) -> list[Found] | None:
        """Carry ``function(item, progress, cancelled)`` out for each item, on the cluster.

        Parameters
        ----------
        function : callable
            Found by its name on the workers too, or small enough to be sent along.
        items : sequence
            One job each.
        progress, cancelled : callable
            Told the part that is done, of all items together; asked whether to stop.

        Returns
        -------
        list or None
            In the order of the items; None when it was cancelled.

        Raises
        ------
        ElsewhereLost
            The cluster has not done it.
        Exception
            Whatever the function has raised.
        """
        client = self._client
        if client is None:
            raise ElsewhereLost
        name, fractions = uuid.uuid4().hex, [0.0] * len(items)

        def heard(number: int, fraction: float) -> None:
            fractions[number] = max(fractions[number], fraction)

        self._heard[name] = heard
        futures: list[Any] = []
        try:
            for number, item in enumerate(items):
                report = (self._topic, name, number)
                key = f"schuler-{name}-{number}"
                futures.append(client.submit(carry_out, __version__, report, function, item, key=key))
            reported = 0.0
            while not all(future.done() for future in futures):
                if cancelled():
                    return None
                if self._client is not client:
                    raise ElsewhereLost
                parts = [1.0 if f.done() else part for f, part in zip(futures, fractions, strict=True)]
                if (now := sum(parts) / len(parts)) > reported:
                    reported = now
                    progress(now)
                time.sleep(_POLL_S)
            outcomes: list[Outcome] = [future.result(_ANSWER_S) for future in futures]
        except ElsewhereLost:
            raise
        except (Exception, CancelledError) as error:
            self._lose(client, f"has not done a job ({_line(error)})")
            raise ElsewhereLost from error
        finally:
            del self._heard[name]
            if self._client is client:
                _let_go(client, futures)
        failed = next((outcome.error for outcome in outcomes if outcome.error is not None), None)
        if failed is not None:
            raise failed
        return [outcome.found for outcome in outcomes]

    def close(self) -> None:
        """Leave the cluster."""
        self._closed.set()
        self._wake.set()
        self._keeper.join(1.0)
        self._drop()

    # ------------------------------------------------------------ the connection

    def _keep(self) -> None:
        while not self._closed.is_set():
            client = self._client
            if client is None:
                self._connect()
            else:
                self._look(client)
            self._wake.wait(_LOOK_S if self.ready else _AGAIN_S)

    def _connect(self) -> None:
        try:
            import distributed

            for name in ("distributed", "distributed.client"):  # its own traces of a lost connection
                logging.getLogger(name).setLevel(logging.CRITICAL)
            client = distributed.Client(
                self.address, timeout=_CONNECT_S, set_as_default=False, name="schuler-bench"
            )
        except Exception as error:
            self._tell(f"cannot be reached ({_line(error)})")
            return
        try:
            threads = _threads(client)
            if threads == 0:
                raise RuntimeError("it has no worker")
            # Whether its workers have this program, in this version.
            first = client.submit(carry_out, __version__, ("", "", 0), nothing, None, pure=False)
            first.result(_CONNECT_S + _ANSWER_S)
            client.subscribe_topic(self._topic, self._hear)
        except (Exception, CancelledError) as error:
            self._tell(f"is of no use ({_line(error)})")
            _end(client)
            return
        with self._lock:
            if self._closed.is_set():
                _end(client)
                return
            self._client, self._threads = client, threads
        self._tell("")

    def _look(self, client: Client) -> None:
        try:
            if client.status != "running":
                raise ConnectionError("the connection has ended")
            self._threads = _threads(client)
            if self._threads == 0:
                raise RuntimeError("it has no worker")
        except (Exception, CancelledError) as error:
            self._lose(client, f"is lost ({_line(error)})")

    def _lose(self, client: Client, why: str) -> None:
        """From now on jobs are done here, until the cluster answers again."""
        with self._lock:
            if self._client is not client:
                return
            self._client = None
        self._tell(why)
        threading.Thread(target=_end, args=(client,), name="cluster-end", daemon=True).start()

    def _drop(self) -> None:
        with self._lock:
            client, self._client = self._client, None
        if client is not None:
            _end(client)

    def _tell(self, why: str) -> None:
        """Write a change into the log, each once."""
        before, self._told = self._told, why or "answers"
        if self._told == before or self._closed.is_set():
            return
        if why:
            _log.warning("the Dask cluster %s %s: heavy jobs are done here", self.address, why)
        else:
            _log.warning("the Dask cluster %s answers: heavy jobs go there", self.address)

    def _hear(self, event: tuple[float, Any]) -> None:
        name, number, fraction = event[1]
        if (heard := self._heard.get(name)) is not None:
            heard(number, fraction)


def check_address(address: str | None) -> None:
    """Refuse what is no address of a cluster; None is let pass.

    Raises
    ------
    InputError
        The address is none, or the extra is not installed.
    """
    if address is None:
        return
    if not _ADDRESS.fullmatch(address):
        allowed = "must be tcp://HOST:PORT or tls://HOST:PORT, the address of a Dask scheduler"
        raise InputError([Fault("serve", "--cluster", address, allowed)])
    if importlib.util.find_spec("distributed") is None:
        allowed = "needs the package distributed: pip install 'schuler-bench[cluster]'"
        raise InputError([Fault("serve", "--cluster", address, allowed)])


def _threads(client: Client) -> int:
    ask: Any = client.scheduler  # None while it is not connected
    cores: Any = client.sync(ask.ncores, callback_timeout=_ANSWER_S)
    return sum(cores.values())


def _let_go(client: Client, futures: Sequence[Any]) -> None:
    """Call back what is not done, and let the cluster forget the rest."""
    try:
        client.cancel([future for future in futures if not future.done()])
        for future in futures:
            future.release()
    except Exception as error:  # the connection has just ended: the cluster forgets them by itself
        _log.debug("jobs could not be called back: %s", error)


def _end(client: Client) -> None:
    try:
        client.close(timeout=2.0)
    except Exception as error:
        _log.debug("the connection to the cluster did not end well: %s", error)


def _line(error: BaseException) -> str:
    text = str(error).strip().splitlines()
    return f"{type(error).__name__}: {text[0]}"[:200] if text else type(error).__name__
