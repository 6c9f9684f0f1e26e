"""The transfers of the closed loop that can be plotted: what each is called and in which unit it is shown."""

from __future__ import annotations

from dataclasses import dataclass

from navcore.analysis.transfers import RADIUS, Output, Source
from navcore.foundation.text import Text
from navcore.foundation.units import ARCSEC, DEG_PER_HOUR, MICRO_G


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
