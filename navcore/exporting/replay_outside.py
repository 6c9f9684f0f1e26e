"""The program's own box on the inputs of an exported one. Compiled."""

import numpy as np

from navcore.exporting.outside_step import Damped, Output, outside_step
from navcore.foundation.compiled import kernel

OUTSIDE_INPUTS, OUTSIDE_OUTPUTS = Output._fields, Damped._fields
"""Names of the columns."""


@kernel
def _replay(box, law, reading, own, own_reading, inputs, outputs):
    for k in range(inputs.shape[0]):
        row = inputs[k]
        given = Output(row[0], row[1], row[2], row[3], row[4], row[5], row[6], int(row[7]))
        found = outside_step(box, law, reading, own, own_reading, given)
        out = outputs[k]
        out[0], out[1], out[2], out[3] = (
            found.v_e_out_mps,
            found.v_n_out_mps,
            found.lat_out_rad,
            found.lon_out_rad,
        )
        out[4], out[5], out[6], out[7] = found.yaw_out_rad, found.phi_e_rad, found.phi_n_rad, found.phi_u_rad
        out[8] = 1.0 if found.damped else 0.0


def replayed_outside(box, law, reading, own, own_reading, inputs: np.ndarray) -> np.ndarray:
    """Outputs of the box, one call a row.

    Parameters
    ----------
    box : Box
        Its state moves.
    law, reading : Law, Reading
        The law, and how the log comes; their states move.
    own, own_reading : Law, Reading
        The law of an INS that was damped itself; not asked where ``box.p.own_law`` is False.
    inputs : ndarray, shape (n, 8)
        Columns `OUTSIDE_INPUTS`.

    Returns
    -------
    ndarray, shape (n, 9)
        Columns `OUTSIDE_OUTPUTS`.
    """
    outputs = np.empty((len(inputs), len(OUTSIDE_OUTPUTS)))
    _replay(box, law, reading, own, own_reading, np.ascontiguousarray(inputs), outputs)
    return outputs
