"""Curves of the Bode plots: each method's, the measured dots of its filter, and the optimal network's."""

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from navcore.engine.run import MethodRun, Run
from navcore.foundation.errors import InputError
from navcore.foundation.text import Text
from navcore.networks.base import ComplexArray, LinearNetwork
from navcore.networks.lqg import SensorFigures
from navcore.networks.optimal import OptimalNetwork
from navcore.scenario.model import Scenario
from schuler_bench.plots import style
from schuler_bench.plots.effective import realisation
from schuler_bench.plots.plotly_data import packed

LOWEST, HIGHEST = 2e-4, 0.15
"""Range of the measured frequencies, rad/s: the slowest takes nine hours of the filter's time."""
_COUNT = 14
_OF_NYQUIST = 0.8


def law_step_s(run: Run) -> float:
    """Time between two steps of the damping filter, s."""
    return run.scenario.run.step_s if run.sampling is None else run.sampling.law_step_s


def measured_gain(method: MethodRun, step_s: float) -> tuple[np.ndarray, ComplexArray] | None:
    """Frequencies (rad/s) and complex gains of a method's filter; None where no filter runs.

    None runs in a free method, nor for gains that act as velocity feedback; a filter that does not come to
    rest cannot be measured.
    """
    network = method.network
    gains = realisation(method) != "network" and network.feedback_p is None
    if network.order == 0 or gains:
        return None
    return _measure(method.network, step_s)


# A slider of one method leaves the filters of the others as they were.
@lru_cache(maxsize=32)
def _measure(network: LinearNetwork, step_s: float) -> tuple[np.ndarray, ComplexArray] | None:
    from navcore.analysis.measured import measured_response
    from navcore.foundation.errors import InputError
    from navcore.networks.discrete import discretise

    omega = np.geomspace(LOWEST, min(HIGHEST, _OF_NYQUIST * math.pi / step_s), _COUNT)
    try:
        gain = measured_response(discretise(network, step_s), omega)
    except InputError:
        return None
    return None if gain is None else (omega, gain)


@dataclass(frozen=True, eq=False)
class Reference:
    """Optimal network that is drawn, or why there is none.

    Attributes
    ----------
    label : str
        In the legend.
    network : LinearNetwork or None
        None where these sensors have no optimal network.
    """

    label: str
    network: LinearNetwork | None = None


def optimal_reference(scenario: Scenario) -> Reference:
    """Optimal network (theory.md 17) with its default weights, for the scenario's own sensors and log."""
    return _reference(scenario.figures(), scenario.reference.kind, scenario.omega_s)


@lru_cache(maxsize=16)
def _reference(figures: SensorFigures, log: str, omega_s: float) -> Reference:
    if log == "none":
        return Reference(Text("no optimal H: the scenario has no log"))
    known = {"gyros and accelerometers": figures.inertial, "log": figures.log}
    missing = [sensors for sensors, there in known.items() if not there]
    if missing:
        return Reference(
            Text("no optimal H: no random error of {missing}", missing=Text.joined(" and ", missing))
        )
    try:
        optimal = OptimalNetwork().with_sensors(figures)
        network = optimal.transfer(omega_s)
    except InputError as error:
        return Reference(Text("no optimal H: {allowed}", allowed=error.faults[0].allowed))
    fragile = ", fragile" if network.warnings else ""
    return Reference(
        Text("optimal for these sensors (ρ = {rho:g}{fragile})", rho=optimal.rho, fragile=fragile), network
    )


_MOST_DECADES = 8.0
NOTHING = packed(np.array([]))


def decibel(value: np.ndarray) -> np.ndarray:
    """Magnitude in dB; -inf for 0."""
    size = np.abs(value)
    return 20.0 * np.log10(size, out=np.full(size.shape, -np.inf), where=size > 0.0)


def phase(value: np.ndarray) -> np.ndarray:
    """Continuous phase in deg that starts within (-180, 180]; numpy's unwrap takes five times as long."""
    turns = np.angle(value) / (2.0 * math.pi)
    turns[1:] -= np.cumsum(np.rint(np.diff(turns)))
    return 360.0 * turns


def pair(
    common: dict[str, Any],
    omega: np.ndarray | None,
    curves: tuple[np.ndarray, np.ndarray] | None,
    xaxis: str,
    yaxes: tuple[str, str],
    hover: str,
) -> list[dict[str, Any]]:
    """Magnitude and phase traces in one column; empty ones keep their place in the legend.

    Parameters
    ----------
    common : dict
        What both traces share: name, group, line.
    omega : ndarray or None
        Frequencies, rad/s.
    curves : (ndarray, ndarray) or None
        Magnitude in the axis's unit, and phase in deg.
    xaxis : str
        Of the column; the legend stands in the first one's magnitude.
    yaxes : (str, str)
        Of magnitude and phase.
    hover : str
        How the magnitude is shown.
    """
    ys = (NOTHING, NOTHING) if curves is None else tuple(packed(curve) for curve in curves)
    both = common | {"x": NOTHING if omega is None else packed(omega), "xaxis": xaxis}
    return [
        both | {"y": y, "yaxis": yaxis, "hovertemplate": text, "showlegend": yaxis == "y"}
        for y, yaxis, text in zip(ys, yaxes, (hover, "%{y:.1f}°"), strict=True)
    ]


def level_axis(title: str, curves: list[np.ndarray]) -> dict[str, Any]:
    """Axis of curves in dB."""
    return _even_axis(title, curves, 160.0, 6.0, (1.0, 2.0, 5.0, 10.0, 20.0, 40.0))


def phase_axis(curves: list[np.ndarray]) -> dict[str, Any]:
    """Axis of phases in degrees."""
    return _even_axis(Text("phase (°)"), curves, 1800.0, 40.0, (15.0, 30.0, 45.0, 90.0, 180.0, 360.0))


def _even_axis(
    title: str, curves: list[np.ndarray], widest: float, least: float, steps: tuple[float, ...]
) -> dict[str, Any]:
    low, high = _range(curves, widest=widest, least=least)
    step = _tick_step(high - low, steps)
    return style.axis(title, range=_calm(low, high, step), dtick=step)


def log_axis(title: str, curves: list[np.ndarray]) -> dict[str, Any]:
    """Logarithmic axis of positive curves."""
    low, high = _range([np.log10(c[c > 0.0]) for c in curves], widest=_MOST_DECADES, least=1.0)
    step = int(_tick_step(high - low, (1.0, 2.0, 3.0, 4.0)))
    low, high = _calm(low, high, 0.5)
    decades = [k for k in range(math.ceil(low), math.floor(high) + 1) if k % step == 0]
    return style.axis(
        title,
        type="log",
        range=[low, high],
        tickvals=[10.0**k for k in decades],
        ticktext=[style.power(k) for k in decades],
        minor={"showgrid": True, "dtick": 1, "gridcolor": style.GRID_FINE},
    )


def _tick_step(span: float, steps: tuple[float, ...], most: float = 5.0) -> float:
    return next((step for step in steps if span <= most * step), steps[-1])


def _calm(low: float, high: float, step: float) -> list[float]:
    """Range out to half steps: the axis stands still while a slider moves the curves, and is not laid out."""
    half = 0.5 * step
    return [half * math.floor(low / half), half * math.ceil(high / half)]


def _range(curves: list[np.ndarray], *, widest: float, least: float) -> tuple[float, float]:
    """Range over all finite values: padded, at least ``least``, at most ``widest`` below the top."""
    values = np.concatenate([[], *(curve[np.isfinite(curve)] for curve in curves)])
    if not len(values):
        return -least, least
    top, bottom = float(np.max(values)), float(np.min(values))
    bottom = max(bottom, top - widest)
    pad = max(0.06 * (top - bottom), 0.5 * (least - (top - bottom)))
    return bottom - pad, top + pad
