"""Switching methods: how the loop passes between damped and undamped; one file and registry line each."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from navcore.compiled import inlined
from navcore.control.layout import ACTION, NOTHING, SWITCHING, TO_XI
from navcore.control.switching.base import SwitchingParameters
from navcore.control.switching.bumpless import Bumpless, switch_bumpless
from navcore.control.switching.hard import Hard, switch_hard
from navcore.control.switching.keep import Keep, switch_keep
from navcore.control.switching.ramp import Ramp, switch_ramp
from navcore.control.switching.step import Step, switch_step

SWITCHINGS: dict[str, type[SwitchingParameters]] = {
    "hard": Hard,
    "keep": Keep,
    "ramp": Ramp,
    "step": Step,
    "bumpless": Bumpless,
}
"""All switching methods by id, in the order in which the page offers them."""

Switching = Annotated[Hard | Keep | Ramp | Step | Bumpless, Field(discriminator="id")]
"""Type of a field that holds any switching method, told apart by ``id``."""


@inlined
def switch(p, s, ring, wanted):
    """Pass to the wanted state by the method named by ``p[SWITCHING]``.

    It sets ``s[DAMPED]`` and ``s[XI]``, and asks for what is to be done to the network: ``s[TO_XI]``,
    ``s[ACTION]``. The law does it, in one place: re-tuning is long, and is compiled in as often as called.
    """
    s[TO_XI], s[ACTION] = 0.0, NOTHING
    code = int(p[SWITCHING])
    if code == 1:
        switch_keep(p, s, wanted)
    elif code == 2:
        switch_ramp(p, s, wanted)
    elif code == 3:
        switch_step(p, s, wanted)
    elif code == 4:
        switch_bumpless(p, s, ring, wanted)
    else:
        switch_hard(p, s, wanted)


__all__ = ["SWITCHINGS", "Switching", "SwitchingParameters", "switch"]
