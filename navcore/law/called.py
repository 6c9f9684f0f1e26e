"""What a law is given in a call from outside: by a navigation computer, or by the program to a user's law."""

from typing import NamedTuple


class Given(NamedTuple):
    """Inputs of a call, in the order of the contract."""

    v_e_mps: float
    v_n_mps: float
    lat_rad: float
    log_e_mps: float
    log_n_mps: float
    log_valid: int
    yaw_rad: float
    accel_e_mps2: float
    accel_n_mps2: float
