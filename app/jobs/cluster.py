"""Heavy jobs on a Dask cluster: sent there, watched, called back. What the cluster does not do is done here.

Jobs go to the workers that give the same numbers as this process (`schuler_bench.jobs.remote.program`). The
others are passed over and named in the log.

The package ``distributed`` is an extra, ``schuler-bench[cluster]``, imported only when an address is given.
"""

from __future__ import annotations

import importlib.util
import ipaddress
import logging
import re
import threading
import time
import uuid
from collections.abc import Callable, Sequence
from concurrent.futures import CancelledError
from typing import TYPE_CHECKING, Any, TypeVar

from navcore.extending.baggage import packed
from navcore.foundation.errors import Fault, InputError
from schuler_bench.jobs.remote import NO_PROGRAM, Outcome, carry_out, misfit, program
from schuler_bench.jobs.worker import ElsewhereLost

if TYPE_CHECKING:
    from distributed import Client

_ADDRESS = re.compile(r"(?:tcp|tls)://(?:([^\s/:@\[\]]+)|\[([0-9a-fA-F:]+)\]):(\d{1,5})")
_LARGEST_PORT = 65535
_CONNECT_S, _ANSWER_S = 10.0, 10.0
_LOOK_S, _AGAIN_S, _POLL_S = 2.0, 15.0, 0.05
"""Between two looks: at a cluster that answers, at one that does not, at jobs that are under way there."""
_AFRESH_S = 60.0
"""Between two questions to a worker which program it has."""
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
    otherwise : str
        What the log says is done while it does not answer; empty: the caller says it.

    Raises
    ------
    InputError
        As `check_address`.
    """

    def __init__(self, address: str, otherwise: str = "heavy jobs are done here") -> None:
        check_address(address)
        self.address, self._otherwise = address, otherwise
        self._client: Client | None = None
        self._fitting: dict[str, int] = {}
        self._passed_over: dict[str, str] = {}
        self._afresh_s = 0.0
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
    def trouble(self) -> str:
        """Why no job may be sent there; empty where one may, and before it has been tried."""
        return "" if self.ready else self._told

    @property
    def threads(self) -> int:
        """Threads of the workers that fit; 0 while no job may be sent there."""
        return sum(self._fitting.values()) if self.ready else 0

    @property
    def lost(self) -> bool:
        """Whether it has been tried, and no job may be sent there."""
        return bool(self._told) and not self.ready

    @property
    def workers(self) -> int:
        """Number of its workers, those that do not fit included."""
        return len(self._fitting) + len(self._passed_over)

    @property
    def passed_over(self) -> tuple[str, ...]:
        """Of each worker that gets no job, in what its program differs."""
        return tuple(self._passed_over.values())

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
        client, workers = self._client, list(self._fitting)
        if client is None:
            raise ElsewhereLost
        ours = program()
        name, fractions = uuid.uuid4().hex, [0.0] * len(items)

        def heard(number: int, fraction: float) -> None:
            fractions[number] = max(fractions[number], fraction)

        self._heard[name] = heard
        futures: list[Any] = []
        try:
            for number, item in enumerate(items):
                report = (self._topic, name, number)
                key = f"schuler-{name}-{number}"
                called, (given,) = packed(function, item)
                futures.append(
                    client.submit(carry_out, ours, report, called, given, key=key, workers=workers)
                )
            reported = 0.0
            while not all(future.done() for future in futures):
                if cancelled():
                    return None
                if self._client is not client or self._fitting.keys().isdisjoint(workers):
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
            self._passed_over = {}
            self._tell(f"cannot be reached ({_line(error)})")
            return
        try:
            self._judge(client)
            client.subscribe_topic(self._topic, self._hear)
        except (Exception, CancelledError) as error:
            self._tell(f"is of no use ({_line(error)})")
            _end(client)
            return
        with self._lock:
            if self._closed.is_set():
                _end(client)
                return
            self._client = client
        self._tell("")

    def _look(self, client: Client) -> None:
        try:
            if client.status != "running":
                self._passed_over = {}
                raise ConnectionError("the connection has ended")
            self._judge(client)
        except (Exception, CancelledError) as error:
            self._lose(client, f"is lost ({_line(error)})")

    def _judge(self, client: Client) -> None:
        """Find the workers that fit; raises RuntimeError when there are none."""
        ask: Any = client.scheduler  # None while it is not connected
        threads: Any = client.sync(ask.ncores, callback_timeout=_ANSWER_S)
        afresh = time.monotonic() >= self._afresh_s  # a worker may have begun anew at its old address
        if afresh:
            self._afresh_s = time.monotonic() + _AFRESH_S
        known: dict[str, str | None] = {**dict.fromkeys(self._fitting, ""), **self._passed_over}
        for address in threads:
            if afresh or address not in known:
                known[address] = self._verdict(client, address, known.get(address))
        self._passed_over = {address: why for address in threads if (why := known[address])}
        self._fitting = {address: count for address, count in threads.items() if known[address] == ""}
        if not self._fitting:
            raise RuntimeError("none of its workers fits" if self._passed_over else "it has no worker")

    def _verdict(self, client: Client, address: str, before: str | None) -> str | None:
        """Say why a worker does not fit: empty where it does; as before where it does not answer in time."""
        try:
            running: Any = client.run(program, workers=[address], callback_timeout=_CONNECT_S + _ANSWER_S)
            why = shown = misfit(running[address], program())
        except OSError:  # among them TimeoutError
            return before
        except Exception as error:
            why, shown = f"{NO_PROGRAM} ({_line(error)})", NO_PROGRAM
        if why and shown != before:
            _log.warning("the Dask cluster %s: worker %s is passed over: %s", self.address, address, why)
        return shown

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
        if not self._otherwise:
            return
        if why:
            _log.warning("the Dask cluster %s %s: %s", self.address, why, self._otherwise)
        else:
            _log.warning("the Dask cluster %s answers: heavy jobs go there", self.address)

    def _hear(self, event: tuple[float, Any]) -> None:
        name, number, fraction = event[1]
        if (heard := self._heard.get(name)) is not None:
            heard(number, fraction)


def check_address(address: str | None, option: str = "--cluster", command: str = "serve") -> None:
    """Refuse what is no address of a cluster; None is let pass.

    Parameters
    ----------
    address : str or None
    option, command : str
        Named in faults.

    Raises
    ------
    InputError
        The address is none, or the extra is not installed.
    """
    if address is None:
        return
    if not _is_address(address):
        allowed = "must be tcp://HOST:PORT or tls://HOST:PORT, the address of a Dask scheduler"
        raise InputError([Fault(command, option, address, allowed)])
    if importlib.util.find_spec("distributed") is None:
        allowed = "needs the package distributed: pip install 'schuler-bench[cluster]'"
        raise InputError([Fault(command, option, address, allowed)])


def _is_address(text: str) -> bool:
    """Whether a text can be the address of a scheduler: a name or number of a machine, and a port."""
    parts = _ADDRESS.fullmatch(text)
    if parts is None or not 1 <= int(parts[3]) <= _LARGEST_PORT:
        return False
    try:
        if parts[2]:
            ipaddress.IPv6Address(parts[2])
        else:
            parts[1].encode("idna")  # what every look-up of a name begins with
    except ValueError:
        return False
    return True


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
