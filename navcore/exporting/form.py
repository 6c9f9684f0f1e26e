"""A method that is ready for a target: its program, inputs, outputs and vectors."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from navcore.exporting.ir import Program
from navcore.exporting.subject import Subject

WHOLE = ("log_valid", "damped")
"""Inputs and outputs that are whole numbers."""
UNITS = {"mps": "m/s", "mps2": "m/s^2", "rad": "rad", "radps": "rad/s", "valid": "", "damped": "", "m": "m"}
"""Units by the last part of a name."""
ABOUT = {
    "v_e_mps": "computed velocity V_c, east",
    "v_n_mps": "computed velocity V_c, north",
    "lat_rad": "computed latitude",
    "log_e_mps": "velocity of the log, east",
    "log_n_mps": "velocity of the log, north",
    "log_valid": "0 invalid, 1 a sample, 2 none yet",
    "yaw_rad": "computed heading, clockwise from north",
    "accel_e_mps2": "acceleration of the ship, east",
    "accel_n_mps2": "acceleration of the ship, north",
    "v_star_e_mps": "V* = V_c + c, east: forms the transport rate about north",
    "v_star_n_mps": "V* = V_c + c, north: forms the transport rate about east",
    "feedback_e_mps2": "to be added to the velocity's rate, east",
    "feedback_n_mps2": "to be added to the velocity's rate, north",
    "azimuth_rate_radps": "to be added to the commanded rate about up",
    "damped": "1 while the law damps",
    "v_out_e_mps": "velocity to be given out, east",
    "v_out_n_mps": "velocity to be given out, north",
    "lon_rad": "computed longitude",
    "off_v_e_mps": "to be taken off the velocity at once, east",
    "off_v_n_mps": "to be taken off the velocity at once, north",
    "off_lat_rad": "to be taken off the latitude at once",
    "off_lon_rad": "to be taken off the longitude at once",
    "off_phi_e_rad": "misalignment about east that is to be turned back at once",
    "off_phi_n_rad": "misalignment about north that is to be turned back at once",
    "off_phi_u_rad": "misalignment about up that is to be turned back at once",
}
"""What inputs and outputs are."""


USAGE = (
    "In each call give what has just been computed; until the next call",
    "- form the transport rate with v_star: omega_E = -v_star_n/(M + h), omega_N = v_star_e/(N + h);",
    "- add feedback_e, feedback_n to the rate of the velocity, and azimuth_rate to the rate about up;",
    "- leave position and the velocity that is given out as they are computed.",
)
"""What is to be done with the outputs of a law."""


@dataclass(frozen=True)
class Form:
    """A method, ready for a target.

    Attributes
    ----------
    subject : Subject
        What is exported.
    program : Program
        Its law.
    inputs, outputs : tuple of str
        Names, with their units.
    given : ndarray, shape (calls, inputs)
        Inputs along the scenario.
    expected : ndarray, shape (calls, outputs)
        What the program's own law gives for them.
    hold_s : float
        Time for which a sample of the log counts, s; 0 where the law reads none.
    notes : dict of str to str
        What inputs and outputs of its own are.
    usage : tuple of str
        What is to be done in each call.
    """

    subject: Subject
    program: Program
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    given: np.ndarray
    expected: np.ndarray
    hold_s: float
    notes: dict[str, str] = field(default_factory=dict)
    usage: tuple[str, ...] = USAGE

    @property
    def start(self) -> tuple[float, float, float]:
        """Latitude (rad) and velocity (m/s) at the first call."""
        lat, v_e, v_n = (
            float(self.given[0, self.inputs.index(n)]) for n in ("lat_rad", "v_e_mps", "v_n_mps")
        )
        return lat, v_e, v_n


def unit_of(name: str) -> str:
    """Unit of an input or output, by its name."""
    return UNITS.get(name.rsplit("_", 1)[-1], "")
