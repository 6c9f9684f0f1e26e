"""Transfers of a method's loop that can be plotted, and its 24 h mode in words."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from navcore.analysis import frequency_response, network_step_response, time_response
from navcore.analysis.transfers import RADIUS, Output, Source
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


_TILT, _SPEED = "tilt", "velocity error"
_PER_10_UG = 10.0 * MICRO_G
_LOG = "δV<sub>r</sub>"
_GYRO = 0.01 * DEG_PER_HOUR
_ACCELERATION = 0.01

VIEWS: dict[str, TransferView] = {
    "phi/dv_r": TransferView(
        "dv_r", "phi", Text("{tilt} from log error", tilt=_TILT), f"φ/{_LOG}", "arcsec per m/s", 1.0 / ARCSEC
    ),
    "dv/dv_r": TransferView(
        "dv_r", "dv", Text("{speed} from log error", speed=_SPEED), f"δV/{_LOG}", "dB", 1.0
    ),
    "R phi/dv_r": TransferView(
        "dv_r", "phi", "R × tilt from log error", f"R φ/{_LOG}", "dB re 1 s", RADIUS, "(Liu fig. 3, 5)"
    ),
    "phi/eps": TransferView(
        "eps", "phi", Text("{tilt} from gyro error", tilt=_TILT), "φ/ε", "arcsec per 0.01 °/h", _GYRO / ARCSEC
    ),
    "dv/eps": TransferView(
        "eps", "dv", Text("{speed} from gyro error", speed=_SPEED), "δV/ε", "m/s per 0.01 °/h", _GYRO
    ),
    "phi/nabla": TransferView(
        "nabla",
        "phi",
        Text("{tilt} from accelerometer error", tilt=_TILT),
        "φ/∇",
        "arcsec per 10 µg",
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
        "arcsec per 0.01 m/s²",
        _ACCELERATION / ARCSEC,
        "(internal damping)",
    ),
    "dv/acceleration": TransferView(
        "acceleration",
        "dv",
        Text("{speed} from own acceleration", speed=_SPEED),
        "δV/A",
        "m/s per 0.01 m/s²",
        _ACCELERATION,
        "(internal damping)",
    ),
}
TRANSFERS: dict[str, str] = {key: f"{view.title} {view.note}".rstrip() for key, view in VIEWS.items()}
"""Transfers that the Bode plot can show: id -> label."""
OPEN_LOOP = "open loop"
SHOWN: dict[str, str] = TRANSFERS | {OPEN_LOOP: "open loop: Nyquist plot and margins"}
"""All that the chooser of the frequency side offers: id -> label."""


def earth_mode_text(growth: float) -> str:
    """How the 24 h mode behaves, e.g. "grows, e-folding 3.1 days"; ``growth`` in 1/s."""
    if growth == 0.0:
        return "neither grows nor decays"
    return (
        Text("grows, e-folding {growth}", growth=duration(1.0 / growth))
        if growth > 0.0
        else Text("decays, e-folding {growth}", growth=duration(1.0 / growth))
    )


def realisation(method: MethodRun) -> str:
    """How the network is carried out; internal damping always uses the network form."""
    return method.network.realisation if method.method.damping == "external" else "network"


def reacts(method: MethodRun, source: Source) -> bool:
    """Whether an error source enters this method at all: no log without external damping, and so on."""
    damping = method.method.damping
    if source == "dv_r":
        return damping == "external"
    if source == "acceleration":
        return damping == "internal" or realisation(method) == "as_printed"
    return True


def frequency(method: MethodRun, source: Source, output: Output, omega: np.ndarray) -> np.ndarray | None:
    """Frequency response of a method at ``omega`` (rad/s), SI; None when the source does not enter it."""
    if not reacts(method, source):
        return None
    return _at_frequencies(method.network, realisation(method), source, output, omega.tobytes())


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
@lru_cache(maxsize=256)
def _at_frequencies(
    network: LinearNetwork, form: str, source: Source, output: Output, omega: bytes
) -> np.ndarray:
    return _frozen(frequency_response(network, source, output, np.frombuffer(omega), realisation=form))


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
