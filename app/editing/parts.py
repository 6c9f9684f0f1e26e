"""The choice of a sensor of the list: its published figures fill what is not given beside it."""

from typing import Any

from navcore.scenario.model import Scenario
from navcore.sensors.data_sheets import data_sheets, differing
from schuler_bench.editing.form import NONE, Path

PARTS: tuple[Path, ...] = (("imu", "part"), ("reference", "part"))
"""Fields that name a sensor of the list."""


def choose_part(scenario: Scenario, data: dict[str, Any], path: Path, chosen: Any) -> str | None:
    """Make room for the figures of a part: a field that is left in its block would win.

    Parameters
    ----------
    scenario : Scenario
        Before the choice.
    data : dict
        Its canonical mapping; what its part has given and what the chosen one states is left out of it.
    path : tuple
        One of `PARTS`.
    chosen : object
        Name of a part, or `schuler_bench.editing.form.NONE`.

    Returns
    -------
    str or None
        Value of the field.
    """
    block, sheets = data[str(path[0])], data_sheets()
    if (before := sheets.get(block.get("part", ""))) is not None:
        own = {*differing(getattr(scenario, before.block), before)}
        for field in before.values.keys() - own:
            block.pop(field, None)
    for field in sheets[chosen].values if chosen in sheets else ():
        block.pop(field, None)
    return None if chosen == NONE else chosen


def shown_part(value: None, path: Path) -> str | None:
    """What the control of a field shows that is left out: no part is a choice too."""
    return NONE if path in PARTS else value
