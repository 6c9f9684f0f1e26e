"""The program's own Kalman filter on the inputs of an exported one. Compiled."""

import numpy as np

from navcore.exporting.filter_step import FilterCommands, filter_step
from navcore.foundation.compiled import kernel
from navcore.law.called import Given

FILTER_OUTPUTS = FilterCommands._fields
"""Names of the columns."""


@kernel
def _replay(motion, model, f, inputs, outputs):
    for k in range(inputs.shape[0]):
        row = inputs[k]
        given = Given(
            row[0], row[1], row[2], row[3], row[4], int(row[5]), row[6], row[7], row[8]
        )  # fmt: skip
        found = filter_step(motion, model, f, given)
        out = outputs[k]
        out[0], out[1] = found.v_star_e_mps, found.v_star_n_mps
        out[2], out[3] = found.feedback_e_mps2, found.feedback_n_mps2
        out[4] = found.azimuth_rate_radps
        out[5] = 1.0 if found.damped else 0.0
        for i in range(7):
            out[6 + i] = f.errors[i]


def replayed_filter(motion, model, state, inputs: np.ndarray) -> np.ndarray:
    """Outputs of the filter, one call a row.

    Parameters
    ----------
    motion : Motion
        Its state moves.
    model : FilterModel
        What the filter is told.
    state : FilterState
        Moves.
    inputs : ndarray, shape (n, 9)
        As of a law.

    Returns
    -------
    ndarray, shape (n, 13)
        Columns `FILTER_OUTPUTS`.
    """
    outputs = np.empty((len(inputs), len(FILTER_OUTPUTS)))
    _replay(motion, model, state, np.ascontiguousarray(inputs), outputs)
    return outputs
