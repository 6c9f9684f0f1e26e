"""The load of a job, from its scenario: which lane it waits in, and the memory it is admitted by."""

from dataclasses import replace

from navcore.engine.load import estimated_bytes, estimated_seconds
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.foundation.units import HOUR
from navcore.scenario.file import names_files
from navcore.scenario.model import Scenario
from schuler_bench.jobs.elsewhere import cluster, note_of
from schuler_bench.jobs.scheduler import GIB, Lane, Load, largest_run_bytes

LONG_S = 0.6
"""Processor time beyond which a run is no answer to a control any more."""

MOST_SAMPLES = 2_500_000
"""IMU samples, all methods together, of a strapdown run that still follows every change: half a second."""


def run_load(scenario: Scenario) -> Load:
    """Load of a run that a visitor waits for."""
    lane = Lane.LONG if estimated_seconds(scenario) > LONG_S else Lane.ANSWER
    return Load(lane, estimated_bytes(scenario))


def spare_load(scenario: Scenario) -> Load:
    """Load of work on a scenario that nobody waits for."""
    return Load(Lane.SPARE, estimated_bytes(scenario))


def heavy_load(scenario: Scenario) -> Load:
    """Load of heavy work on a scenario, which a cluster does if there is one that can.

    A scenario that names files is computed where they lie.
    """
    there = cluster()
    if there is None or names_files(scenario):
        return spare_load(scenario)
    note = note_of(there)
    return Load(Lane.CLUSTER, note=note) if there.ready else replace(spare_load(scenario), note=note)


def refuse_too_large(scenario: Scenario) -> None:
    """Refuse a run that takes more memory than one visitor may have.

    Raises
    ------
    InputError
        Says how much it would take.
    """
    needed, most = estimated_bytes(scenario), largest_run_bytes()
    if needed > most:
        allowed = Text(
            "this run would take about {needed:.1f} GB of memory and this server gives a "
            "run at most {most:.1f} GB: shorten it, lengthen step_s and output_step_s, "
            "or remove methods",
            needed=needed / GIB,
            most=most / GIB,
        )
        raise InputError([Fault("", "run.duration_h", scenario.run.duration_h, allowed)])


def runs_on_demand(scenario: Scenario) -> bool:
    """Whether a run takes so long that it should not follow every move of a slider."""
    run = scenario.run
    if run.fidelity != "strapdown":
        return False
    return run.duration_h * HOUR * run.rate_hz * len(scenario.method) > MOST_SAMPLES
