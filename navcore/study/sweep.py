"""Sweeps: a scenario's run at a few latitudes, errors of the log, sea states and grades of its sensors."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

from navcore.foundation.answers import Answer, Column, Table, number
from navcore.foundation.cores import cores
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.progress import part_of
from navcore.foundation.text import Text
from navcore.motion.sea import fully_developed_peak_period
from navcore.motion.seagoing import SeagoingMotion
from navcore.motion.waves import SeaFields, WavesMotion
from navcore.scenario.model import Scenario
from navcore.study.model import OF_RUNS, Factor, Study
from navcore.study.plan import Plan
from navcore.study.running import Row, run_points

LATITUDES = (0.0, 15.0, 30.0, 45.0, 60.0, 75.0)
"""deg, on the ship's side of the equator."""
LOG_BIASES = (0.0, 0.1, 0.2, 0.5, 1.0)
"""Length of the log's constant error, m/s."""
SEAS = (0.0, 1.25, 2.5, 4.0, 6.0)
"""Significant wave height, m: calm, and the upper ends of the sea states 3 to 6 (WMO code table 3700)."""
GRADES = (0.1, 0.3, 1.0, 3.0, 10.0)
"""All errors of gyros and accelerometers, times their own."""
_LONGEST_S = 2.5
"""Processor time of a quantity beyond which every other value is left out."""
_FEWEST = 3
_WAVES_S = 0.2
"""Processor time of an hour of a course in waves."""


@dataclass(frozen=True)
class Sweep:
    """One quantity of a scenario varied, all else as it is, with the scenario's seed.

    Attributes
    ----------
    key : str
        ``latitude`` (deg), ``log_bias`` (m/s), ``sea`` (wave height, m) or ``grade`` (a factor).
    values : tuple of float
        What it takes, increasing; the present value among them. Empty where it cannot be varied.
    present : float
        Its value in the scenario.
    metrics : dict
        Quantity of `navcore.study.model.OF_RUNS` -> for each method a value at each of ``values``, in the
        unit of the quantity's name; None where the run diverged or has none.
    words : str
        Why it is not varied.
    refused : tuple of str
        Methods that some of the values refuse, and why.
    """

    key: str
    values: tuple[float, ...] = ()
    present: float = math.nan
    metrics: dict[str, tuple[tuple[float | None, ...], ...]] | None = None
    words: str = ""
    refused: tuple[str, ...] = ()


@dataclass(frozen=True)
class Sweeps(Answer):
    """Several quantities varied, one at a time.

    Attributes
    ----------
    found : dict of Sweep
        By key.
    stopped : bool
        It was cancelled: those that were done.
    """

    found: dict[str, Sweep]
    stopped: bool = False

    def document(self) -> dict[str, Any]:
        """Return the document of interface.md."""
        return {
            "sweeps": [
                {
                    "quantity": one.key,
                    "values": list(one.values),
                    "present": one.present if math.isfinite(one.present) else None,
                    "metrics": {
                        name: [list(row) for row in rows] for name, rows in (one.metrics or {}).items()
                    },
                    "not_varied": one.words or None,
                    "refused": list(one.refused),
                }
                for one in self.found.values()
            ],
            "stopped": self.stopped,
        }

    def rows(self) -> Iterator[Table | str]:
        """Give for each quantity the tilt of every method at each of its values."""
        for one in self.found.values():
            if one.metrics is None:
                yield Text("{key}: not varied: {words}", key=one.key, words=one.words)
                continue
            shown = one.metrics[SHOWN]
            heads = [Column(one.key), *(Column(Text("method {k}", k=k)) for k in range(len(shown)))]
            rows = zip(map(number, one.values), *shown, strict=True)
            yield Table(tuple(heads), tuple(rows), SHOWN)
            yield from one.refused


SHOWN = "tilt_rms_arcsec"
"""Metric of the tables; the document has all."""


@dataclass(frozen=True)
class _Axis:
    """One quantity to vary: its values, and what each of them is in the fields of a scenario."""

    values: tuple[float, ...]
    present: float
    fields: tuple[str, ...]
    assigned: Callable[[float], list[Any]]
    waves_h: float = 0.0


def sweep(
    scenario: Scenario,
    key: str,
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Sweep | None:
    """Run a scenario over the values of one quantity.

    Each run has the scenario's seed, so that only this quantity differs: at the present value it is the
    scenario's own run.

    Parameters
    ----------
    scenario : Scenario
        Complete and checked.
    key : str
        One of `KEYS`.
    progress, cancelled : callable, optional
        Told the fraction done, 0..1; when ``cancelled`` says True, there is no result.

    Returns
    -------
    Sweep or None
        None when it was cancelled.

    Examples
    --------
    >>> from navcore import load
    >>> found = sweep(load("zha-fast", ["run.duration_h=0.1"]), "log_bias")
    >>> found.values, len(found.metrics["tilt_rms_arcsec"])
    ((0.0, 0.1, 0.2, 0.5, 1.0), 3)
    """
    axis = _AXES[key](scenario)
    if isinstance(axis, str):
        return Sweep(key, words=axis)
    planned = _planned(scenario, key, axis)
    if isinstance(planned, str):
        return Sweep(key, words=planned)
    values, plan = planned
    lock, done = threading.Lock(), 0

    def stopped() -> bool:
        with lock:
            return cancelled is not None and cancelled()

    def some(numbers: range) -> list[list[Row]]:
        nonlocal done
        found = []
        for _, rows in run_points(plan, numbers, stopped):
            found.append(rows)
            with lock:
                done += 1
                if progress is not None:
                    progress(done / plan.runs)
        return found

    workers = min(cores(), plan.runs)
    ends = [plan.runs * k // workers for k in range(workers + 1)]
    with ThreadPoolExecutor(workers) as pool:
        rows = [row for part in pool.map(some, map(range, ends, ends[1:])) for row in part]
    if len(rows) < plan.runs:
        return None
    methods = range(len(scenario.method))
    metrics = {name: tuple(tuple(row[k].get(name) for row in rows) for k in methods) for name in OF_RUNS}
    return Sweep(key, values, axis.present, metrics, refused=plan.refused)


def refusals(scenario: Scenario, keys: Sequence[str]) -> Iterator[str]:
    """Methods that a value of a quantity refuses, and why; told before anything runs."""
    for key in keys:
        axis = _AXES[key](scenario)
        planned = axis if isinstance(axis, str) else _planned(scenario, key, axis)
        if not isinstance(planned, str):
            yield from planned[1].refused


def _planned(scenario: Scenario, key: str, axis: _Axis) -> tuple[tuple[float, ...], Plan] | str:
    """Values and their runs; where these take too long, every other value; else why there are none."""
    data = scenario.canonical()
    data.pop("requirement", None)  # the loop need not be judged
    values = axis.values
    while True:
        shown = (*sorted({*values, axis.present}),)
        factor = _factor(key, axis, shown)
        try:
            plan = Plan(Study(scenario=data, factor=(factor,)))
        except InputError as error:
            return error.faults[0].allowed
        waves_s = plan.runs * axis.waves_h * _WAVES_S
        if plan.seconds() + waves_s <= _LONGEST_S or len(values) <= _FEWEST:
            return shown, plan
        values = values[::2]


def _factor(key: str, axis: _Axis, shown: tuple[float, ...]) -> Factor:
    assigned = [axis.assigned(value) for value in shown]
    if len(axis.fields) == 1:
        assigned = [one for (one,) in assigned]
    return Factor(name=key, field=axis.fields, values=(*assigned,), labels=(*map(repr, shown),))


def sweeps(
    scenario: Scenario,
    keys: Sequence[str],
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Sweeps:
    """Vary several quantities of a scenario, one at a time; parameters as of `sweep`."""
    found: dict[str, Sweep] = {}
    for place, key in enumerate(keys):
        one = sweep(scenario, key, part_of(progress, place / len(keys), (place + 1) / len(keys)), cancelled)
        if one is None:
            return Sweeps(found, stopped=True)
        found[key] = one
    return Sweeps(found)


def swept_factor(scenario: Scenario, key: str) -> Factor:
    """Factor of a study that takes the values of a sweep; its labels are numbers in the sweep's unit.

    Raises
    ------
    InputError
        The scenario has nothing of the kind to vary.
    """
    axis = _AXES[key](scenario)
    if isinstance(axis, str):
        raise InputError(Fault("", key, None, axis))
    return _factor(key, axis, (*sorted({*axis.values, axis.present}),))


def _latitude(scenario: Scenario) -> _Axis | str:
    if scenario.imu.file is not None or scenario.motion.recorded:
        return Text("the recording has a latitude of its own")
    present = scenario.site.lat_deg
    values = tuple(math.copysign(value, present) for value in LATITUDES)
    return _Axis(values, present, ("site.lat_deg",), lambda value: [value])


def _log_bias(scenario: Scenario) -> _Axis | str:
    if scenario.reference.kind != "log":
        return Text("the scenario has no simulated log")
    bias = scenario.reference.bias_mps
    present = math.hypot(*bias)
    along = tuple(part / present for part in bias) if present else (math.sqrt(0.5), math.sqrt(0.5))
    fields = ("reference.bias_mps",)
    return _Axis(LOG_BIASES, present, fields, lambda value: [[value * part for part in along]])


def _sea(scenario: Scenario) -> _Axis | str:
    motion = scenario.motion
    if scenario.imu.file is not None:
        return Text("the recorded motion has a sea of its own")
    if motion.kind == "static":
        still = motion.model_dump(mode="json")

        def afloat(height: float) -> list[Any]:
            sea = {"height_m": height, "peak_period_s": _period_s(height)}
            return [{**still, "kind": "waves", **sea} if height else still]

        return _Axis(SEAS, 0.0, ("motion",), afloat)
    if not isinstance(motion, WavesMotion | SeagoingMotion):
        return Text('the motion "{kind}" knows no waves', kind=motion.kind)
    at_rest = isinstance(motion, WavesMotion)
    sea, block = (motion, "motion") if at_rest else (motion.waves, "motion.waves")
    present = sea.height_m

    def rough(height: float) -> list[Any]:
        if height == present:
            return [sea.spectrum, height, sea.peak_period_s]
        return ["bretschneider", height, max(sea.peak_period_s, _period_s(height))]

    fields = f"{block}.spectrum", f"{block}.height_m", f"{block}.peak_period_s"
    return _Axis(SEAS, present, fields, rough, 0.0 if at_rest else scenario.run.duration_h)


def _period_s(height: float) -> float:
    """Peak period of a sea: that of the default, of a high one that of a fully developed sea."""
    default = float(SeaFields().peak_period_s)
    return max(default, fully_developed_peak_period(height)) if height else default


def _grade(scenario: Scenario) -> _Axis | str:
    if scenario.imu.file is not None:
        return Text("the IMU is recorded")
    sizes = {f"imu.{name}": getattr(scenario.imu, name) for part in scenario.imu.all_parts() if part.active
             for name in part.fields}  # fmt: skip
    if not sizes:
        return Text("the scenario's sensors have no error")

    def scaled(factor: float) -> list[Any]:
        return [
            [one * factor for one in size] if isinstance(size, tuple) else size * factor
            for size in sizes.values()
        ]

    return _Axis(GRADES, 1.0, (*sizes,), scaled)


_AXES: dict[str, Callable[[Scenario], _Axis | str]] = {
    "latitude": _latitude,
    "log_bias": _log_bias,
    "grade": _grade,
    "sea": _sea,
}
KEYS = (*_AXES,)
"""Quantities that can be varied, the dearest last."""
