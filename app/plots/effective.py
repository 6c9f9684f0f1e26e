"""Transfers of a method's loop that can be plotted, and its 24 h mode in words."""

from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from navcore.analysis import network_step_response, time_response
from navcore.analysis.frequencies import curve_frequencies, undamped
from navcore.analysis.transfers import RADIUS, Output, Source, normalised_transfer
from navcore.analysis.whole_system import duration
from navcore.engine.run import MethodRun
from navcore.foundation.text import Text
from navcore.foundation.units import ARCSEC, DEG_PER_HOUR, MICRO_G
from navcore.networks.base import LinearNetwork


@dataclass(frozen=True)
class TransferView:
    """One transfer as it is plotted.

    Attributes
    ----------
    source, output : str
        As for `navcore.analysis.transfer`.
    title : str
        Over its plot.
    symbol : str
        Before the title, in plotly's markup.
    unit : str
        Of the magnitude; "dB..." for one that is shown in decibel.
    scale : float
        SI magnitude times this is the magnitude in ``unit`` (before dB).
    note : str
        Added to the title in the chooser.
    """

    source: Source
    output: Output
    title: str
    symbol: str
    unit: str
    scale: float
    note: str = ""


_TILT, _SPEED = Text("tilt"), Text("velocity error")
_PER_10_UG = 10.0 * MICRO_G
_LOG = "δV<sub>r</sub>"
_GYRO = 0.01 * DEG_PER_HOUR
_ACCELERATION = 0.01

VIEWS: dict[str, TransferView] = {
    "phi/dv_r": TransferView(
        "dv_r",
        "phi",
        Text("{tilt} from log error", tilt=_TILT),
        f"φ/{_LOG}",
        Text("arcsec per m/s"),
        1.0 / ARCSEC,
    ),
    "dv/dv_r": TransferView(
        "dv_r", "dv", Text("{speed} from log error", speed=_SPEED), f"δV/{_LOG}", "dB", 1.0
    ),
    "R phi/dv_r": TransferView(
        "dv_r",
        "phi",
        Text("R × tilt from log error"),
        f"R φ/{_LOG}",
        Text("dB re 1 s"),
        RADIUS,
        Text("(Liu fig. 3, 5)"),
    ),
    "phi/eps": TransferView(
        "eps",
        "phi",
        Text("{tilt} from gyro error", tilt=_TILT),
        "φ/ε",
        Text("arcsec per 0.01 °/h"),
        _GYRO / ARCSEC,
    ),
    "dv/eps": TransferView(
        "eps", "dv", Text("{speed} from gyro error", speed=_SPEED), "δV/ε", "m/s per 0.01 °/h", _GYRO
    ),
    "phi/nabla": TransferView(
        "nabla",
        "phi",
        Text("{tilt} from accelerometer error", tilt=_TILT),
        "φ/∇",
        Text("arcsec per 10 µg"),
        _PER_10_UG / ARCSEC,
    ),
    "dv/nabla": TransferView(
        "nabla",
        "dv",
        Text("{speed} from accelerometer error", speed=_SPEED),
        "δV/∇",
        "m/s per 10 µg",
        _PER_10_UG,
    ),
    "phi/acceleration": TransferView(
        "acceleration",
        "phi",
        Text("{tilt} from own acceleration", tilt=_TILT),
        "φ/A",
        Text("arcsec per 0.01 m/s²"),
        _ACCELERATION / ARCSEC,
        Text("(internal damping)"),
    ),
    "dv/acceleration": TransferView(
        "acceleration",
        "dv",
        Text("{speed} from own acceleration", speed=_SPEED),
        "δV/A",
        "m/s per 0.01 m/s²",
        _ACCELERATION,
        Text("(internal damping)"),
    ),
}
TRANSFERS: dict[str, str] = {
    key: Text.joined(" ", filter(None, (view.title, view.note))) for key, view in VIEWS.items()
}
"""Transfers that the Bode plot can show: id -> label."""
OPEN_LOOP = Text("open loop")
OMEGA_MIN, OMEGA_MAX = 5e-6, 0.2
"""Range of the curves over frequency, rad/s: periods from 14 days to 31 s."""
_EVEN = np.geomspace(OMEGA_MIN, OMEGA_MAX, 240)
_NEAR = 0.02
SHOWN: dict[str, str] = TRANSFERS | {OPEN_LOOP: Text("open loop: Nyquist plot and margins")}
"""All that the chooser of the frequency side offers: id -> label."""


def growth_text(growth: float | None) -> str:
    """Time in which the whole system grows by e; empty where it does not; ``growth`` in 1/s."""
    if growth is None or not growth > 0.0:
        return ""
    return Text("grows by e in {every}", every=duration(1.0 / growth))


def earth_mode_text(growth: float) -> str:
    """How the 24 h mode behaves, e.g. "grows, e-folding 3.1 days"; ``growth`` in 1/s."""
    if growth == 0.0:
        return Text("neither grows nor decays")
    return (
        Text("grows, e-folding {growth}", growth=duration(1.0 / growth))
        if growth > 0.0
        else Text("decays, e-folding {growth}", growth=duration(1.0 / growth))
    )


@dataclass(frozen=True)
class Loop:
    """A network as the key of a cache: those with the same coefficients are equal.

    Attributes
    ----------
    coefficients : tuple of bytes
        Of the network.
    omega_s : float
        Schuler frequency, rad/s.
    network : LinearNetwork
        One of them.
    """

    coefficients: tuple[bytes, ...]
    omega_s: float
    network: LinearNetwork = field(compare=False)


@dataclass(frozen=True, eq=False)
class FrequencyCurve:
    """A frequency response at the frequencies that show it.

    Attributes
    ----------
    omega : ndarray, shape (n,)
        rad/s, ascending.
    value : ndarray of complex, shape (n,)
        SI.
    poles : ndarray of complex
        Of the response, rad/s.
    """

    omega: np.ndarray
    value: np.ndarray
    poles: np.ndarray

    @property
    def finite(self) -> np.ndarray:
        """Where no undamped resonance is near: what sets the scale of a plot, shape (n,)."""
        resonances = np.abs(self.poles[undamped(self.poles)])
        return np.all(np.abs(self.omega - resonances[:, None]) > _NEAR * resonances[:, None], axis=0)


def loop_of(method: MethodRun) -> Loop:
    """Network that acts in a method, as the key of a cache."""
    return loop_key(method.network)


def loop_key(network: LinearNetwork) -> Loop:
    """Make the key of a network."""
    feedback = b"" if network.feedback_p is None else network.feedback_p.tobytes()
    coefficients = network.num_p.tobytes(), network.den_p.tobytes(), feedback
    return Loop(coefficients, network.omega_s, network)


def azimuth_curve(method: MethodRun) -> FrequencyCurve | None:
    """Frequency response Y(jω) of the azimuth network; None where no network acts there."""
    azimuth = method.method.kind.azimuth(method.method, method.network.omega_s)
    return network_curve(loop_key(azimuth)) if isinstance(azimuth, LinearNetwork) else None


def realisation(method: MethodRun) -> str:
    """How the network is carried out; internal damping always uses the network form."""
    return method.method.kind.acting(method.network).realisation


def reacts(method: MethodRun, source: Source) -> bool:
    """Whether an error source enters this method at all: no log without external damping, and so on."""
    kind = method.method.kind
    if source == "dv_r":
        return kind.referenced
    if source == "acceleration":
        return kind.self_referenced or realisation(method) == "as_printed"
    return True


def transfer_curve(method: MethodRun, source: Source, output: Output) -> FrequencyCurve | None:
    """Frequency response of a method, with points at its resonances; None if the source does not enter."""
    if not reacts(method, source):
        return None
    return curve_of_loop(loop_of(method), realisation(method), source, output)


def response(
    method: MethodRun, source: Source, output: Output, span_s: float, count: int
) -> np.ndarray | None:
    """Time response of a method to a unit source (SI) on `time_grid`; None where it does not enter."""
    if not reacts(method, source):
        return None
    return _over_time(method.network, realisation(method), source, output, span_s, count)


def network_step(method: MethodRun, span_s: float, count: int) -> np.ndarray:
    """Step response of H itself on `time_grid`."""
    return _network_step(method.network, span_s, count)


@lru_cache(maxsize=32)
def time_grid(span_s: float, count: int) -> np.ndarray:
    """``count`` even times from 0 to ``span_s``, s."""
    return _frozen(np.linspace(0.0, span_s, count))


# A slider of one method leaves the loops of the others as they were: half of the time of a figure.
@lru_cache(maxsize=64)
def network_curve(loop: Loop) -> FrequencyCurve:
    """Frequency response of H itself, with points at its zeros and poles."""
    network = loop.network
    omega = _frozen(curve_frequencies(_EVEN, (network.zeros, network.poles)))
    return FrequencyCurve(omega, _frozen(network.response(omega)), network.poles)


@lru_cache(maxsize=256)
def curve_of_loop(loop: Loop, form: str, source: Source, output: Output) -> FrequencyCurve:
    """Return a transfer of a loop in a realisation, with points at its zeros and poles."""
    t = normalised_transfer(loop.network, source, output, realisation=form)
    poles = t.poles * t.omega_s
    omega = _frozen(curve_frequencies(_EVEN, (np.roots(t.num) * t.omega_s, poles)))
    return FrequencyCurve(omega, _frozen(t.response(omega)), poles)


@lru_cache(maxsize=256)
def _over_time(
    network: LinearNetwork, form: str, source: Source, output: Output, span_s: float, count: int
) -> np.ndarray:
    return _frozen(time_response(network, source, output, time_grid(span_s, count), realisation=form))


@lru_cache(maxsize=256)
def _network_step(network: LinearNetwork, span_s: float, count: int) -> np.ndarray:
    return _frozen(network_step_response(network, time_grid(span_s, count)))


def _frozen(values: np.ndarray) -> np.ndarray:
    values.setflags(write=False)
    return values
