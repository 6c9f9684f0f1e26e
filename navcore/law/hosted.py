"""A user's law in plain Python in place of the program's: what it is, and how the kernels call it.

The kernels call the address of a callback (`navcore.law.added_call`), some microseconds a call. A law that
raises, gives something that is no number, or does not return ends its method, with the reason; nothing else.
"""

import ctypes
import math
import os
import threading
import time
import traceback
from abc import abstractmethod
from collections.abc import Callable, Mapping, Sequence
from contextvars import copy_context
from typing import Any, ClassVar, NamedTuple, Protocol

import numpy as np

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.parameters import Parameters
from navcore.foundation.registry import place_of
from navcore.foundation.text import Text
from navcore.law.added_call import COMMANDED, GIVEN
from navcore.law.called import Given
from navcore.law.history import USE_HEADING
from navcore.law.law import Law

LIMIT_S = 10.0
"""Time after which a call of a law counts as one that does not return, s."""
_REPLAYED = 50
"""First calls that are repeated with a fresh law at the end: another answer shows a shared state."""
_LOOK_S = 0.05
_STEP = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_int64, ctypes.c_void_p)


class Start(NamedTuple):
    """What a law is told at the start of a run, as an exported law is."""

    lat_rad: float
    v_e_mps: float
    v_n_mps: float
    step_s: float


class Commands(NamedTuple):
    """Outputs of a call, those of an exported law."""

    v_star_e_mps: float
    v_star_n_mps: float
    feedback_e_mps2: float = 0.0
    feedback_n_mps2: float = 0.0
    azimuth_rate_radps: float = 0.0
    damped: bool = True


Step = Callable[[Given], Any]


class Host(Protocol):
    """One law that runs, in whatever language."""

    fault: str

    def put_into(self, law: Law) -> Law:
        """Have a free law ask this one."""
        ...

    def advance(self, work: Callable[[], bool]) -> bool:
        """Do a part of a run; True when it is over, or the law has ended it."""
        ...

    def shared_state(self) -> str:
        """Say what the law shares with others of its kind; empty where nothing is known."""
        ...


def put_into(law: Law, address: int, handle: int) -> Law:
    """Have a free law ask the function at an address (`navcore.law.added_call.call_user_law`)."""
    law.p["user"]["step"], law.p["user"]["handle"] = address, handle
    law.p["azimuth_order"], law.p["remembers"] = 1, USE_HEADING
    law.s["user"]["epoch"] = -1
    return law


class UserLaw(Parameters):
    """Base of a law of the user's own: its parameters are fields, as of a network.

    A scenario names it as its kind of damping, ``damping = "mine"``, and gives its fields in the block of the
    method that bears its id.

    Attributes
    ----------
    id : str
        Name in the scenario.
    help : str
        What it does, in one clause.
    limit_s : float
        Time that one call may take, s.
    speed : str
        What is said of its speed with each run; empty for nothing.
    """

    id: ClassVar[str]
    help: ClassVar[str] = "a law of the user's own"
    limit_s: ClassVar[float] = LIMIT_S
    speed: ClassVar[str] = Text("the law runs in Python, which takes some microseconds a call")

    def host(self, at: Start) -> Host:
        """Return the law for one run as the kernels call it."""
        return Hosted(self, at)

    @abstractmethod
    def start(self, at: Start) -> Step:
        """Return the law for one run: a callable that keeps its own state and nothing outside of itself.

        Parameters
        ----------
        at : Start
            Where the run begins.

        Returns
        -------
        callable
            Given `Given`, it returns `Commands`, or a mapping, an object or a sequence with the same.
        """


class Hosted:
    """One law that runs: the callback that the kernels call, and what went wrong.

    Attributes
    ----------
    fault : str
        Why the law has ended its method; empty while it goes on.
    """

    def __init__(self, settings: UserLaw, at: Start) -> None:
        self.fault = ""
        self._settings, self._at = settings, at
        self._began_s, self._thread, self._calls = 0.0, 0, 0
        self._first: list[tuple[Given, tuple[float, ...]]] = []
        self._callback = _STEP(self._call)
        self._step = self._started()

    @property
    def address(self) -> int:
        """Address of the callback."""
        return ctypes.cast(self._callback, ctypes.c_void_p).value or 0

    def put_into(self, law: Law) -> Law:
        """Have a free law ask this one."""
        return put_into(law, self.address, 0)

    def advance(self, work: Callable[[], bool]) -> bool:
        """Do a part of a run in a thread of its own, and leave it there if a call does not return.

        Returns
        -------
        bool
            Whether the run is over.
        """
        found: list[bool] = []
        raised: list[BaseException] = []

        def carry_out() -> None:
            try:
                found.append(work())
            except BaseException as error:
                raised.append(error)

        thread = threading.Thread(
            target=copy_context().run, args=(carry_out,), name=f"law {self._settings.id}", daemon=True
        )
        thread.start()
        while thread.is_alive():
            thread.join(_LOOK_S)
            began_s = self._began_s
            if began_s and time.monotonic() - began_s > self._settings.limit_s:
                self._abandon()
                return True
        if raised:
            raise raised[0]
        return found[0] or bool(self.fault)

    def shared_state(self) -> str:
        """Say whether a fresh law gives other answers to the first calls; empty where it gives the same."""
        if self.fault:
            return ""
        try:
            again = self._started()
            for k, (given, before) in enumerate(self._first):
                now = _commands(again(given))
                if not np.array_equal(now, before):
                    why = Text("keeps state between methods or draws numbers: differs at call {k}", k=k + 1)
                    return self._named(why)
        except Exception as error:
            return self._named(self._why(error))
        return ""

    def _started(self) -> Step:
        try:
            step = self._settings.start(self._at)
        except Exception as error:
            raise self._refused(self._why(error)) from error
        if not callable(step):
            raise self._refused(Text("start() must return a callable"))
        return step

    def _refused(self, why: str) -> InputError:
        return InputError(Fault(place_of(type(self._settings)), self._settings.id, None, why))

    def _call(self, handle: int, pointer: int) -> int:
        del handle
        if self.fault:
            return 1
        numbers = (ctypes.c_double * (GIVEN + COMMANDED)).from_address(pointer)
        values = numbers[:GIVEN]
        given = Given._make((*values[:5], int(values[5]), *values[6:]))
        self._calls += 1
        self._thread, self._began_s = threading.get_ident(), time.monotonic()
        try:
            commands = _commands(self._step(given))
        except Exception as error:
            self.fault = self.fault or self._named(self._why(error))
            return 1
        finally:
            self._began_s = 0.0
        if self.fault:
            return 1
        for name, value in zip(Commands._fields, commands, strict=True):
            if not math.isfinite(value):
                self.fault = self._named(Text("gives {name} = {value}", name=name, value=value))
                return 1
        numbers[GIVEN:] = commands
        if len(self._first) < _REPLAYED:
            self._first.append((given, commands))
        return 0

    def _abandon(self) -> None:
        why = Text("does not return within {limit:g} s", limit=self._settings.limit_s)
        self.fault = self._named(why)
        # ends a loop in Python; what waits in the system stays behind in its thread
        ctypes.pythonapi.PyThreadState_SetAsyncExc(
            ctypes.c_ulong(self._thread), ctypes.py_object(TimeoutError)
        )

    def _named(self, why: str) -> str:
        kind = type(self._settings)
        return Text(
            'law "{id}" ({place}) {why}, call {call}',
            id=kind.id,
            place=place_of(kind),
            why=why,
            call=self._calls,
        )

    def _why(self, error: Exception) -> str:
        """What was raised, and the line."""
        last = traceback.extract_tb(error.__traceback__)[-1]
        place = f"{os.path.basename(last.filename)}:{last.lineno}"
        kind = type(error).__name__
        return Text("raises {kind}: {error} ({place})", kind=kind, error=str(error), place=place)


def _commands(found: Any) -> tuple[float, ...]:
    """Numbers of the commands that a law has given.

    Raises
    ------
    TypeError
        They are none.
    """
    if isinstance(found, Mapping):
        given = Commands(**found)
    elif hasattr(found, "v_star_e_mps"):
        given = [getattr(found, name) for name in Commands._fields]
    elif isinstance(found, Sequence | np.ndarray):
        given = Commands(*list(found)[:COMMANDED])
    else:
        raise TypeError(f"gives {type(found).__name__}, not Commands")
    return tuple(float(one) for one in given)
