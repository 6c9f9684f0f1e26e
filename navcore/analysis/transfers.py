"""Every transfer of one level channel: tilt and velocity error from each error source (theory.md section 3).

North channel: phi' = -[dV - Q (dV - dV_r)]/R - eps, dV' = g phi + nabla, Q = 1 - H. In the east channel
(phi_N, dV_E) some signs change. With P = p^2 D + N and p = s / omega_s all transfers are ratios of
polynomials without the cancellations that 1 - H would bring. A network with two outputs adds G dV to dV'.
"""

from dataclasses import dataclass
from typing import Literal, TypedDict, Unpack

import numpy as np

from navcore.analysis.loop import closed_loop_poles
from navcore.analysis.response import impulse_response, step_response
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.networks.base import LinearNetwork
from navcore.networks.state_space import state_space

RADIUS = 6378137.0
"""Earth radius of the single channel, m: omega_s = sqrt(g/a) defines its g (theory.md 3.6)."""

Source = Literal["eps", "nabla", "dv_r", "acceleration", "initial_tilt"]
Output = Literal["phi", "dv"]
Channel = Literal["north", "east"]

SOURCES: dict[Source, str] = {
    "eps": Text("gyro error, rad/s"),
    "nabla": Text("accelerometer error, m/s²"),
    "dv_r": Text("reference velocity error, m/s"),
    "acceleration": Text("vehicle acceleration (no reference), m/s²"),
    "initial_tilt": Text("initial tilt, rad"),
}
OUTPUTS: dict[Output, str] = {"phi": Text("tilt, rad"), "dv": Text("velocity error, m/s")}


class TransferOptions(TypedDict, total=False):
    """Optional arguments of every function on transfers; explained at `transfer`."""

    realisation: str | None
    channel: Channel
    radius: float


_EAST_CHANGES_SIGN = {
    ("eps", "dv"),
    ("nabla", "phi"),
    ("dv_r", "phi"),
    ("acceleration", "phi"),
    ("initial_tilt", "dv"),
}
_ROUNDING = 1e-13


@dataclass(frozen=True, eq=False)
class Transfer:
    """scale * num(p) / prod(p - poles) in p = s / omega_s."""

    scale: float
    num: np.ndarray
    poles: np.ndarray
    omega_s: float

    def denominator(self) -> np.ndarray:
        """Monic denominator in p, descending powers."""
        return np.atleast_1d(np.real(np.poly(self.poles)))

    def response(self, omega: np.ndarray | float) -> np.ndarray:
        """Return the complex response at ``omega`` (rad/s), same shape."""
        p = 1j * np.asarray(omega, dtype=float) / self.omega_s
        value = self.scale * np.polyval(self.num, p)
        for pole in self.poles:
            value = value / (p - pole)
        return value


def normalised_transfer(
    network: LinearNetwork,
    source: Source,
    output: Output,
    *,
    realisation: str | None = None,
    channel: Channel = "north",
    radius: float = RADIUS,
) -> Transfer:
    """Return a transfer in normalised frequency; parameters as for `transfer`."""
    if source not in SOURCES:
        raise InputError(
            Fault("", "source", source, Text("must be one of {sources}", sources=", ".join(SOURCES)))
        )
    if output not in OUTPUTS:
        raise InputError(
            Fault("", "output", output, Text("must be one of {outputs}", outputs=", ".join(OUTPUTS)))
        )
    form = network.realisation if realisation is None else realisation
    scale, num, integrators = _formula(network, source, output, form, radius)
    num, poles = _cancel_at_zero(num, closed_loop_poles(network), integrators)
    sign = -1.0 if channel == "east" and (source, output) in _EAST_CHANGES_SIGN else 1.0
    return Transfer(sign * scale, num, poles, network.omega_s)


def _times_p(polynomial: np.ndarray) -> np.ndarray:
    """Product with P; `numpy.polymul` takes thirty times as long."""
    return np.append(polynomial, 0.0)


def _formula(
    network: LinearNetwork, source: str, output: str, form: str, radius: float
) -> tuple[float, np.ndarray, int]:
    """Scale, numerator over P, and further integrators in the denominator."""
    w, n, d = network.omega_s, network.num_p, network.den_p
    gravity = w * w * radius
    difference = _difference(d, n)
    p, p2 = np.array([1.0, 0.0]), np.array([1.0, 0.0, 0.0])
    p_d, p_difference = _times_p(d), _times_p(difference)
    tilt: dict[str, tuple[float, np.ndarray, int]] = {
        "eps": (-1.0 / w, p_d, 0),
        "nabla": (-1.0 / gravity, n, 0),
        "dv_r": (-1.0 / (radius * w), p_difference, 0),
        "acceleration": (1.0 / gravity, difference, 0),
        "initial_tilt": (1.0 / w, p_d, 0),
    }
    velocity: dict[str, tuple[float, np.ndarray, int]] = {
        "eps": (-radius, d, 0),
        "nabla": (1.0 / w, p_d, 0),
        "dv_r": (-1.0, difference, 0),
        "acceleration": (1.0 / w, difference, 1),
        "initial_tilt": (radius, d, 0),
    }
    if network.feedback_p is not None:
        # p dV = phi + nabla + G (dV_r - dV) and p phi = -(H dV + Q dV_r) - eps, times D
        g = network.feedback_p
        pushed, none = np.polyadd(p_d, g), np.zeros(1)
        tilt |= {
            "eps": (-1.0 / w, pushed, 0),
            "dv_r": (-1.0 / (radius * w), np.polyadd(p_difference, g), 0),
            "acceleration": (1.0 / gravity, none, 0),
            "initial_tilt": (1.0 / w, pushed, 0),
        }
        velocity |= {
            "dv_r": (1.0, np.polysub(_times_p(g), difference), 0),
            "acceleration": (1.0 / w, none, 0),
        }
    elif form in ("feedback", "as_printed"):
        # theory.md 3.1: K1 = D - p and K2 p + K3 = N - p, in units of omega_s
        pulled = _times_p(_times_p(np.polysub(d, p)))
        velocity |= {
            "eps": (-radius, p, 0),
            "nabla": (1.0 / w, p2, 0),
            "dv_r": (1.0, np.polyadd(pulled, np.polysub(n, p)), 0),
            "initial_tilt": (radius, p, 0),
        }
        if form == "as_printed":
            tilt |= {
                "dv_r": (1.0 / (radius * w), _times_p(n), 0),
                "acceleration": (1.0 / gravity, d, 0),
            }
            velocity |= {
                "dv_r": (1.0, np.polyadd(pulled, n), 0),
                "acceleration": (1.0 / w, np.array([1.0]), 0),
            }
    return (tilt if output == "phi" else velocity)[source]


def _difference(den: np.ndarray, num: np.ndarray) -> np.ndarray:
    """D - N with what is left of exact cancellations removed, or -80 dB/decade would end in a floor."""
    padded = np.concatenate([np.zeros(len(den) - len(num)), num])
    result = den - padded
    result[np.abs(result) <= _ROUNDING * (np.abs(den) + np.abs(padded))] = 0.0
    return result


def _cancel_at_zero(num: np.ndarray, poles: np.ndarray, integrators: int) -> tuple[np.ndarray, np.ndarray]:
    """Add the integrators; cancel all poles at zero against roots of the numerator at zero."""
    num = np.trim_zeros(num, "f")
    size = np.abs(poles)
    at_zero = size <= 1e-12 * np.max(size)
    zeros = int(np.count_nonzero(at_zero)) + integrators
    if len(num) == 0:
        return np.array([0.0]), np.array([])
    while zeros > 0 and num[-1] == 0.0:
        num, zeros = num[:-1], zeros - 1
    return num, np.concatenate([np.zeros(zeros), poles[~at_zero]])


def transfer(
    network: LinearNetwork,
    source: Source,
    output: Output,
    *,
    realisation: str | None = None,
    channel: Channel = "north",
    radius: float = RADIUS,
) -> tuple[np.ndarray, np.ndarray]:
    """Return the numerator and denominator of one transfer in s.

    Parameters
    ----------
    network : LinearNetwork
        H(s).
    source : {"eps", "nabla", "dv_r", "acceleration", "initial_tilt"}
        See `SOURCES` for meaning and unit. ``acceleration`` is that of the vehicle under *internal* damping,
        which always has the network form; only for ``as_printed`` it acts under external damping too. The
        transfer from ``initial_tilt`` is the Laplace transform of the response itself.
    output : {"phi", "dv"}
        Tilt (rad) or velocity error (m/s).
    realisation : {"network", "feedback", "as_printed"}, optional
        Default: the network's own. Feedback has the same tilt, but pulls the velocity onto the reference
        (theory.md 3.1); as_printed lacks the reference's transport rate (Deng 4).
    channel : {"north", "east"}
        phi_E, dV_N or phi_N, dV_E.
    radius : float
        Earth radius, m.

    Returns
    -------
    num, den : ndarray
        Descending powers of s (rad/s), den monic.

    Raises
    ------
    InputError
        Unknown source or output.
    """
    t = normalised_transfer(network, source, output, realisation=realisation, channel=channel, radius=radius)
    w, den = t.omega_s, t.denominator()
    excess = len(den) - len(t.num)
    return t.scale * t.num * w ** (excess + np.arange(len(t.num))), den * w ** np.arange(len(den))


def frequency_response(
    network: LinearNetwork,
    source: Source,
    output: Output,
    omega: np.ndarray | float,
    **options: Unpack[TransferOptions],
) -> np.ndarray:
    """Complex response at ``omega`` (rad/s), same shape; ``options`` as for `transfer`."""
    return normalised_transfer(network, source, output, **options).response(omega)


def time_response(
    network: LinearNetwork,
    source: Source,
    output: Output,
    time_s: np.ndarray,
    **options: Unpack[TransferOptions],
) -> np.ndarray:
    """Response at ``time_s`` (s, >= 0) to a unit step of the source; of ``initial_tilt`` to 1 rad at t = 0.

    ``options`` as for `transfer`.
    """
    t = normalised_transfer(network, source, output, **options)
    system = state_space(t.scale * t.num, t.poles)
    tau = np.asarray(time_s, dtype=float) * t.omega_s
    if source == "initial_tilt":
        return t.omega_s * impulse_response(system, tau)
    return step_response(system, tau)


def initial_tilt_response(network: LinearNetwork, time_s: np.ndarray) -> np.ndarray:
    """phi(t)/phi_0 at ``time_s`` (s), dimensionless (Zha 15 for `compass`)."""
    return time_response(network, "initial_tilt", "phi", time_s)


def network_step_response(network: LinearNetwork, time_s: np.ndarray) -> np.ndarray:
    """Response of H(s) itself to a unit step at ``time_s`` (s) (Sun 7, fig. 3)."""
    system = state_space(network.num_p, network.poles / network.omega_s)
    return step_response(system, np.asarray(time_s, dtype=float) * network.omega_s)


def steady_state(
    network: LinearNetwork, **options: Unpack[TransferOptions]
) -> dict[str, dict[str, float | None]]:
    """Final values of tilt (rad) and velocity error (m/s) for a constant unit source, [source][output].

    ``inf`` (with sign) where the error grows without end, None where it never comes to rest (undamped or
    unstable loop). ``options`` as for `transfer`.
    """
    result: dict[str, dict[str, float | None]] = {}
    for source in SOURCES:
        result[source] = {
            output: _final_value(
                normalised_transfer(network, source, output, **options),
                step=source != "initial_tilt",
            )
            for output in OUTPUTS
        }
    return result


def _final_value(t: Transfer, step: bool) -> float | None:
    if not np.any(t.num):
        return 0.0
    zero = t.poles == 0.0
    if np.any(np.real(t.poles[~zero]) >= -1e-9 * np.abs(t.poles[~zero])):
        return None
    integrators = int(np.count_nonzero(zero)) + (1 if step else 0) - 1
    leading = t.scale * (t.num[-1] / float(np.real(np.prod(-t.poles[~zero]))))
    if not step:
        leading *= t.omega_s
    if integrators > 0:
        return float(np.copysign(np.inf, leading))
    return float(leading) if integrators == 0 else 0.0
