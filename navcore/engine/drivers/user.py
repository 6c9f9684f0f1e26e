"""Runs of methods whose corrections a user's law commands, in both fidelities."""

from typing import Any

from navcore.engine.drivers.common import law_of, network_of
from navcore.law.hosted import Host, Start
from navcore.law.law import Law
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario


class UserRun:
    """A run under way that a user's law may end: as the run itself, and its fault.

    Parameters
    ----------
    run : ErrorModelRun or StrapdownRun
        With the law of `hosted`.
    host : Host
        The user's law.
    """

    def __init__(self, run: Any, host: Host) -> None:
        self._run, self._host = run, host

    def __getattr__(self, name: str) -> Any:
        """Whatever else is asked of a run."""
        return getattr(self._run, name)

    @property
    def fault(self) -> str:
        """Why the law has ended the run; empty where it has not."""
        return self._host.fault

    @property
    def shared_state(self) -> str:
        """Whether the law shares something with others of its kind; empty where it does not."""
        return self._host.shared_state()

    def advance(self, part: Any) -> bool:
        """Advance as the run does; True when it is complete, or ended by the law."""
        return self._host.advance(lambda: self._run.advance(part))


def hosted(scenario: Scenario, method: Method, law_step_s: float, at: Start) -> tuple[Law, Host]:
    """Make the law of a method that asks a user's one.

    Raises
    ------
    InputError
        The law cannot be started; named with its class and line.
    """
    host = method.settings.host(at)
    return host.put_into(law_of(method, network_of(scenario, method), law_step_s)), host
