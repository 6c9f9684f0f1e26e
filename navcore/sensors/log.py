"""Errors of the reference velocity at its own epochs, simulated or recorded."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from navcore.motion.truth import Truth
from navcore.sensors.base import ReferenceErrors
from navcore.sensors.recorded import recorded_errors
from navcore.sensors.reference import Reference
from navcore.sensors.simulated_log import simulated_errors, simulated_side_by_side


def reference_errors(
    reference: Reference,
    truth: Truth,
    duration_s: float,
    seed: int,
    *,
    step_s: float | None = None,
    start_utc: float | None = None,
) -> ReferenceErrors:
    """Errors of the reference velocity at its epochs.

    Parameters
    ----------
    reference : Reference
        Settings; ``kind = "none"`` gives no epochs at all.
    truth : Truth
        True motion on a grid over the run (cubic interpolation between its points).
    duration_s : float
        Length of the run; epochs are 0, 1/rate, ... up to it.
    seed : int
        Seed of the run.
    step_s : float, optional
        Step of the mechanization, within which faster samples are averaged; default: two grid steps of the
        truth.
    start_utc : float, optional
        UTC of t = 0 that a recorded log shares with a recorded track; default: the first epoch of the log.

    Raises
    ------
    InputError
        The recorded log is missing, wrong or shorter than the run (field names relative to the block).
    """
    if reference.kind == "none":
        return ReferenceErrors(np.zeros(0), np.zeros((0, 2)), np.zeros(0, dtype=bool), False, 0.0)
    if reference.kind == "file":
        return recorded_errors(reference, truth, duration_s, start_utc=start_utc)
    return simulated_errors(
        reference, truth, duration_s, seed, 2.0 * truth.step_s if step_s is None else step_s
    )


def reference_errors_side_by_side(
    references: Sequence[Reference],
    truth: Truth,
    duration_s: float,
    seeds: Sequence[int],
    width: int,
    *,
    step_s: float,
    start_utc: float | None = None,
) -> ReferenceErrors:
    """Errors of several reference velocities on one motion, with the logs as the last axis.

    Parameters
    ----------
    references, seeds : sequence
        One a log. They differ in their constant errors and their seeds alone.
    truth, duration_s, step_s, start_utc
        As of `reference_errors`.
    width : int
        Size of the last axis. Places without a log repeat the first.

    Returns
    -------
    ReferenceErrors
        With errors of shape (m, 2, width).

    Raises
    ------
    InputError
        As of `reference_errors`.
    """
    if references[0].kind == "log":
        return simulated_side_by_side(references, truth, duration_s, seeds, step_s, width)
    # neither a recorded log nor none draws anything: it is the same for every seed
    one = reference_errors(references[0], truth, duration_s, seeds[0], step_s=step_s, start_utc=start_utc)
    return replace(one, error=np.repeat(one.error[:, :, None], width, axis=2))
