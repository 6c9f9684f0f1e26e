"""Switching methods: how the loop passes between damped and undamped; one file and registry line each."""

from __future__ import annotations

from navcore.compiled import inlined
from navcore.control.switching.base import SwitchingParameters
from navcore.control.switching.hard import Hard, switch_hard

SWITCHINGS: dict[str, type[SwitchingParameters]] = {"hard": Hard}

Switching = Hard


@inlined
def switch(p, s, ring, wanted, u_e, u_n):
    """Pass to the wanted state by the method named by ``p[SWITCHING]``."""
    switch_hard(p, s, ring, wanted, u_e, u_n)


__all__ = ["SWITCHINGS", "Switching", "SwitchingParameters", "switch"]
