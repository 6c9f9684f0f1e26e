"""What ``schuler serve`` is told of a live stream, checked before anything is opened."""

from collections.abc import Sequence
from dataclasses import dataclass

from navcore.foundation.errors import Fault, InputError
from navcore.scenario.file import load
from navcore.scenario.model import Scenario
from schuler_bench.live.addresses import SEND, Datagrams, Source, sources_of, target_of
from schuler_bench.session.own_ins import METHODS


@dataclass(frozen=True)
class Settings:
    """A live stream of a server.

    Attributes
    ----------
    scenario : Scenario
        Whose methods are laid on it.
    sources : tuple of Source
        Where to listen.
    target : Datagrams or None
        Where to send the damped output.
    method : str
        Whose output; the first method's if empty.
    """

    scenario: Scenario
    sources: tuple[Source, ...]
    target: Datagrams | None = None
    method: str = ""


def settings_of(
    listen: Sequence[str], send: str | None = None, method: str = "", scenario: str = ""
) -> Settings | None:
    """Read the options of the command; None where it listens to nothing.

    Parameters
    ----------
    listen : sequence of str
        Each ``udp://HOST:PORT`` or ``file:PATH``.
    send : str, optional
        ``udp://HOST:PORT``.
    method : str
        Whose output is sent.
    scenario : str
        Preset or file with the methods, and the ``[ins.damping]`` that the INS runs; empty: four methods.

    Raises
    ------
    InputError
        An option is none, or stands without ``--listen``.
    """
    if not listen:
        for option, value in ((SEND, send), ("--send-method", method), ("--live-scenario", scenario)):
            if value:
                raise InputError(Fault("serve", option, value, "needs --listen: where the INS is heard"))
        return None
    if method and send is None:
        raise InputError(Fault("serve", "--send-method", method, "needs --send: where it goes"))
    sources = sources_of(listen)
    target = None if send is None else target_of(send, sources)
    return Settings(load(scenario) if scenario else _four_ways(), sources, target, method)


def _four_ways() -> Scenario:
    return Scenario.parse({"reference": {"kind": "log"}, "method": [dict(one) for one in METHODS]})
