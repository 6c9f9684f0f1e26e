"""The azimuth channel as the covariance sees it: one call of `navcore.law.azimuth.steer` as a linear map."""

import math
from dataclasses import dataclass

import numpy as np

from navcore.mechanization.trajectory import named
from navcore.networks.azimuth_loop import AzimuthChannel, AzimuthGains
from navcore.networks.discrete import discretise

DV_E, LATITUDE, PHI_U = 0, 2, 6
"""Places among the seven errors."""


@dataclass(frozen=True, eq=False)
class AzimuthForm:
    """Law about the vertical: z' = A z + B u, c_U = C z + D u, at the step of the law.

    Attributes
    ----------
    external : bool
        u = omega_Ur - omega_U, held from the log's epoch, else u = -omega_U (theory.md 3.7). Of a
        gyrocompass, u is the north difference V_r - V_c (theory.md 3.8).
    step_s : float
        s.
    A : ndarray, shape (n, n)
    B, C : ndarray, shape (n,)
    D : float
    compass : AzimuthGains or None
        Gains of a gyrocompass, which takes the place of the north network.
    """

    external: bool
    step_s: float
    A: np.ndarray
    B: np.ndarray
    C: np.ndarray
    D: float
    compass: AzimuthGains | None = None

    @property
    def order(self) -> int:
        """States of the network, or of the gyrocompass."""
        return len(self.B)

    @property
    def dead_reckons(self) -> bool:
        """Whether it keeps the latitude that the log gives, against the computed one."""
        return self.external and self.compass is None

    @property
    def states(self) -> int:
        """States in all: the network's; L_r - L_c and the held u where it dead-reckons."""
        return self.order + (2 if self.dead_reckons else 0)

    def rest(self, u: np.ndarray) -> np.ndarray:
        """State at which inputs u (rad/s) leave the network at rest, shape (n, *u.shape)."""
        steady = np.linalg.solve(np.eye(self.order) - self.A, self.B)
        return np.multiply.outer(steady, u)


def azimuth_form(channel: AzimuthChannel | None, external: bool, step_s: float) -> AzimuthForm | None:
    """Form of what acts in the azimuth channel; None where nothing does.

    Parameters
    ----------
    channel : LinearNetwork or AzimuthGains, optional
        Of `navcore.damping.base.Damping.azimuth`.
    external : bool
        Whether the log enters.
    step_s : float
        Time between two calls of the law, s.
    """
    if channel is None:
        return None
    if isinstance(channel, AzimuthGains):
        left = math.exp(-channel.k4 * step_s)
        gain = -channel.k3 * (1.0 - left) / channel.k4
        one = np.ones(1)
        return AzimuthForm(
            True, step_s, left * np.eye(1), gain * one, 0.5 * (1.0 + left) * one, 0.5 * gain, channel
        )
    y = discretise(channel, step_s)
    return AzimuthForm(external, step_s, np.eye(y.order) + y.dA, y.B, -y.C, 1.0 - y.D)


def up_rate(half: np.ndarray) -> np.ndarray:
    """Error of the computed omega_U by the seven errors, for rows of coefficients; shape (g, 7)."""
    c = named(half)
    row = np.zeros((len(half), 7))
    row[:, DV_E], row[:, LATITUDE] = c["tan_lat"] * c["inv_n"], c["earth_n"] + c["up_lat"]
    return row


def put_azimuth(
    form: AzimuthForm,
    half: np.ndarray,
    turned: np.ndarray,
    difference: tuple[np.ndarray, np.ndarray],
    first: int,
    fresh: bool,
    enters: int,
    Phi: np.ndarray,
    B: np.ndarray,
) -> None:
    """Add the azimuth channel to the map of one call.

    Parameters
    ----------
    form : AzimuthForm
    half : ndarray, shape (g, COLUMNS)
        Coefficients.
    turned : ndarray, shape (g, 7)
        Errors after the step by a rate c_U that is held over it.
    difference : tuple of ndarray, shapes (2, g, n) and (2, g, INPUTS)
        The differences V_r - V_c (E, N) that the law holds, by states and by inputs.
    first : int
        Place of the channel's first state.
    fresh : bool
        A new sample of the log is taken.
    enters : int
        Column of the input minus omega_U.
    Phi, B : ndarray, shapes (g, n, n) and (g, n, INPUTS)
        The map, changed in place.
    """
    c, z = named(half), slice(first, first + form.order)
    by_state, by_input = np.zeros(Phi[:, 0].shape), np.zeros(B[:, 0].shape)
    north = difference[0][1], difference[1][1]
    if form.compass is not None:
        by_state, by_input = (part / c["earth_n"][:, None] for part in north)
    elif not form.external:
        by_state[:, :7], by_input[:, enters] = -up_rate(half), 1.0
    else:
        latitude, held = z.stop, z.stop + 1
        if fresh:
            by_v_e = (c["tan_lat"] * c["inv_n"])[:, None]
            by_state, by_input = by_v_e * difference[0][0], by_v_e * difference[1][0]
            by_state[:, latitude] = c["earth_n"] + c["up_lat"]
            Phi[:, held], B[:, held] = by_state, by_input
        else:
            by_state[:, held] = 1.0
        metres = (form.step_s * c["inv_m"])[:, None]
        Phi[:, latitude] += metres * north[0]
        B[:, latitude] += metres * north[1]
    Phi[:, :7, z] += turned[:, :, None] * form.C
    Phi[:, :7] += form.D * turned[:, :, None] * by_state[:, None]
    B[:, :7] += form.D * turned[:, :, None] * by_input[:, None]
    Phi[:, z, z] = form.A
    Phi[:, z] += form.B[:, None] * by_state[:, None]
    B[:, z] += form.B[:, None] * by_input[:, None]
