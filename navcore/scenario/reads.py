"""Recordings on which a scenario runs, and their maps: the files that no result of it may replace."""

from navcore.foundation.stage_cache import recorded_files
from navcore.scenario.file import FILE_FIELDS
from navcore.scenario.model import Scenario


def recordings(scenario: Scenario) -> list[str]:
    """Return the paths of the recordings of a scenario and of their maps, also those beside a recording.

    Parameters
    ----------
    scenario : Scenario
        As it was loaded.

    Returns
    -------
    list of str
        They need not exist.
    """
    blocks = dict.fromkeys(block for block, _ in FILE_FIELDS)
    return [file for block in blocks for file in recorded_files(getattr(scenario, block))]
