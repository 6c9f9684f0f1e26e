"""The program's own law on the inputs of an exported one. Compiled."""

import numpy as np

from navcore.exporting.step import Commands, step
from navcore.foundation.compiled import kernel
from navcore.law.called import Given

INPUTS, OUTPUTS = Given._fields, Commands._fields
"""Names of the columns."""


@kernel
def _replay(law, reading, inputs, outputs):
    for k in range(inputs.shape[0]):
        row = inputs[k]
        given = Given(
            row[0], row[1], row[2], row[3], row[4], int(row[5]), row[6], row[7], row[8]
        )  # fmt: skip
        found = step(law, reading, given)
        outputs[k, 0], outputs[k, 1] = found.v_star_e_mps, found.v_star_n_mps
        outputs[k, 2], outputs[k, 3] = found.feedback_e_mps2, found.feedback_n_mps2
        outputs[k, 4] = found.azimuth_rate_radps
        outputs[k, 5] = 1.0 if found.damped else 0.0
        outputs[k, 6], outputs[k, 7] = found.v_out_e_mps, found.v_out_n_mps


def replayed(law, reading, inputs: np.ndarray) -> np.ndarray:
    """Outputs of the law, one call a row.

    Parameters
    ----------
    law : Law
        Its state moves.
    reading : Reading
        How the log comes; its state moves.
    inputs : ndarray, shape (n, 9)
        Columns `INPUTS`.

    Returns
    -------
    ndarray, shape (n, 8)
        Columns `OUTPUTS`.
    """
    outputs = np.empty((len(inputs), len(OUTPUTS)))
    _replay(law, reading, np.ascontiguousarray(inputs), outputs)
    return outputs
