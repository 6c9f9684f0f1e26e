"""Which error source and which natural period dominate each method's errors.

The source by the error budget (`navcore.design.sources`), the period by least squares on the
natural lines (`navcore.averaging.lines`). The parts of the fit are not orthogonal on a short record: the
share of a part is its mean product with the whole curve, so that all shares and that of what the fit leaves
are 1 together.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from navcore.averaging.lines import line_phases
from navcore.design.ship import Ship
from navcore.design.sources import contributions
from navcore.engine.run import MethodRun, Run
from navcore.foundation.answers import Answer, Column, Table, number
from navcore.foundation.earth import EARTH_RATE
from navcore.foundation.stage_cache import kept, recorded_state
from navcore.foundation.text import Text
from navcore.motion.truth import LAT
from navcore.quantities import COMPONENTS, HEADING, NAMES, POSITION, TILT, Kind, components
from navcore.scenario.model import Scenario

CONSTANT, DRIFT, SCHULER, EARTH, OTHER = "constant", "drift", "schuler", "earth", "other"
_MOST_ROWS = 1500
_RESOLVED = 0.75 * math.tau
"""Phase that a line must pass through to be told from a constant and a trend."""
_BEATS = 0.5 * math.pi
"""Phase by which the two Schuler lines must part to be told from one."""
_BOTH = 0.4
"""Of the larger Schuler line that the smaller must reach for a beat to be seen."""
_RCOND = 1e-6


@dataclass(frozen=True)
class Swing:
    """Parts of a curve.

    Attributes
    ----------
    shares : dict
        `CONSTANT`, `DRIFT`, `SCHULER`, `EARTH`, `OTHER` -> share in the mean square; together 1.
    beats : bool
        Both Schuler lines are strong: the swing comes and goes with the Foucault period.
    """

    shares: dict[str, float]
    beats: bool

    @property
    def largest(self) -> str:
        """The part with the largest share."""
        return max(self.shares, key=self.shares.__getitem__)


@dataclass(frozen=True)
class Cause:
    """Source that dominates one error of one method.

    Attributes
    ----------
    quantity : Kind
        `POSITION`, `TILT` or `HEADING`.
    source : str
        The dominating source; empty when the sources cannot be told apart.
    share : float
        Its share in the sum of the mean squares of all sources, 0..1.
    swing : Swing
        How the error moves.
    """

    quantity: Kind
    source: str
    share: float
    swing: Swing

    def as_dict(self) -> dict[str, Any]:
        """Return the document of interface.md."""
        return {
            "quantity": self.quantity.name,
            "source": self.source or None,
            "share": self.share,
            "parts": self.swing.shares,
            "beats": self.swing.beats,
        }


@dataclass(frozen=True)
class Why(Answer):
    """Sources that dominate a run.

    Attributes
    ----------
    methods : tuple of (str, tuple of Cause)
        For each method its name, and a cause for each error that is not zero.
    schuler_s, foucault_s : float
        Periods at the start of the run, s; the Foucault period may be infinite.
    remarks : tuple of str
        What the statement rests on, where that is not the run itself.
    stopped : bool
        It was cancelled.
    """

    methods: tuple[tuple[str, tuple[Cause, ...]], ...]
    schuler_s: float
    foucault_s: float
    remarks: tuple[str, ...]
    stopped: bool = False

    def document(self) -> dict[str, Any]:
        """Return the document of interface.md."""
        return {
            "schuler_s": self.schuler_s,
            "foucault_s": self.foucault_s if math.isfinite(self.foucault_s) else None,
            "methods": [
                {"name": name, "causes": [one.as_dict() for one in causes]} for name, causes in self.methods
            ],
            "remarks": list(self.remarks),
        }

    def rows(self) -> Iterator[Table | str]:
        """Give for each error of each method its largest source with its share, and how it moves."""
        share = Text("share %")
        heads = Text("method"), Text("error"), Text("source"), share, Text("moves as"), share
        rows = []
        for name, causes in self.methods:
            for k, one in enumerate(causes):
                moves = one.swing.largest
                shares = 100.0 * one.share if one.source else None, 100.0 * one.swing.shares[moves]
                first, second = (number(value, 3) for value in shares)
                cells = one.quantity.name, one.source or "-", first, moves, second
                rows.append((name if k == 0 else "", *cells))
        yield Table(tuple(map(Column, heads)), tuple(rows))
        yield from (Text("note: {text}", text=text) for text in self.remarks)


def why(
    run: Run,
    progress: Callable[[float], None] = lambda fraction: None,
    cancelled: Callable[[], bool] = lambda: False,
) -> Why:
    """Say what dominates a run; its sources by the error budget, on the linear error model.

    Parameters
    ----------
    run : Run
        With at least two output rows.
    progress : callable
        Told the fraction done, 0..1.
    cancelled : callable
        Asked often; True ends the search.
    """
    scenario = run.scenario
    remarks = _remarks(scenario)
    ship = Ship(_as_error_model(scenario))
    known, count = scenario.imu.file is None and not scenario.on_ins, len(run.methods)
    methods = []
    for index, method in enumerate(run.methods):
        if cancelled():
            break

        def partly(fraction: float, index: int = index) -> None:
            progress((index + fraction) / count)

        squares = contributions(ship, method.method, partly, cancelled) if known else {}
        methods.append((method.method.name, _causes(run, method, squares)))
        partly(1.0)
    rate = EARTH_RATE * math.sin(float(run.truth[0, LAT])) if len(run.truth) else 0.0
    return Why(
        methods=tuple(methods),
        schuler_s=math.tau / scenario.omega_s,
        foucault_s=math.tau / abs(rate) if rate else math.inf,
        remarks=remarks,
        stopped=cancelled(),
    )


def _remarks(scenario: Scenario) -> tuple[str, ...]:
    switches = any(method.policy.id != "constant" and not method.undamped for method in scenario.method)
    remarks = {
        Text("A recorded IMU: its errors are not known one by one, so only the periods are given."): (
            scenario.imu.file is not None
        ),
        Text("The output of an INS does not tell the errors of its sensors: only the periods are given."): (
            scenario.on_ins
        ),
        Text("The recorded log counts as one source: what it errs by is not known part by part."): (
            scenario.imu.file is None and scenario.reference.kind == "file" and not scenario.on_ins
        ),
        Text("The shares come from the linear error model, not from the strapdown."): (
            scenario.imu.file is None and scenario.strapdown
        ),
        Text("Where a policy switches, the sources do not simply add up: shares are approximate."): switches,
    }
    return tuple(text for text, holds in remarks.items() if holds)


def _as_error_model(scenario: Scenario) -> Scenario:
    if not scenario.strapdown:
        return scenario
    settings = scenario.run.model_copy(update={"fidelity": "error_model"})
    return scenario.model_copy(update={"run": settings})


def _causes(run: Run, method: MethodRun, squares: dict[str, np.ndarray]) -> tuple[Cause, ...]:
    if len(method.t_s) < 3:
        return ()
    causes = []
    for kind in (POSITION, TILT, HEADING):
        names = components(kind)
        if kind is HEADING and run.scenario.run.fidelity == "channel":
            continue
        moved = _swing_once(run, method, names)
        if moved is None:
            continue
        places = [COMPONENTS.index(name) for name in names]
        sizes = {source: float(np.sum(values[places])) for source, values in squares.items()}
        total, source = sum(sizes.values()), max(sizes, key=sizes.__getitem__, default="")
        share = sizes[source] / total if total > 0.0 else 0.0
        causes.append(Cause(kind, source if share else "", share, moved))
    return tuple(causes)


def _swing_once(run: Run, method: MethodRun, names: tuple[str, ...]) -> Swing | None:
    """`swing`, kept: a slider of one method leaves the curves of the others as they were."""
    scenario = run.scenario
    files = recorded_state(scenario.motion)
    key = ("swing", scenario.motion, files, scenario.site, scenario.run, method.fingerprint, names)
    return kept(key, lambda: swing(run, method, names))


def swing(run: Run, method: MethodRun, names: tuple[str, ...]) -> Swing | None:
    """Shares of constant, trend, Schuler and 24 h lines in some errors of a method; None when they are zero.

    Parameters
    ----------
    run : Run
        The method's.
    method : MethodRun
        One of its methods.
    names : tuple of str
        Of `navcore.quantities.NAMES`; their mean squares are added.
    """
    chosen = np.arange(0, len(method.t_s), -(-len(method.t_s) // _MOST_ROWS))
    curves = method.rows[chosen][:, [NAMES.index(name) for name in names]]
    total = float(np.mean(np.sum(curves**2, axis=1)))
    if not math.isfinite(total) or total == 0.0:
        return None
    columns = _columns(run, method.t_s[chosen], chosen)
    design = np.column_stack([column for columns_of in columns.values() for column in columns_of])
    # By the normal equations: a few columns, and a thousand times less work than the long matrix itself.
    fitted, *_ = np.linalg.lstsq(design.T @ design, design.T @ curves, rcond=_RCOND**2)
    shares, at, lines = {}, 0, []
    for part, columns_of in columns.items():
        coefficients = fitted[at : at + len(columns_of)]
        at += len(columns_of)
        part_of_fit = np.column_stack(columns_of) @ coefficients
        shares[part] = float(np.mean(np.sum(part_of_fit * curves, axis=1)) / total)
        if part == SCHULER:
            lines = [float(np.sum(coefficients[k : k + 2] ** 2)) for k in range(0, len(columns_of), 2)]
    shares[OTHER] = 1.0 - sum(shares.values())
    beats = len(lines) == 2 and min(lines) >= _BOTH**2 * max(lines)
    return Swing(shares, beats)


def _columns(run: Run, time_s: np.ndarray, chosen: np.ndarray) -> dict[str, list[np.ndarray]]:
    """Make the columns of the fit, by part: only lines that the record can tell from each other."""
    scenario = run.scenario
    ramp = (time_s - time_s[0]) / max(float(time_s[-1] - time_s[0]), 1e-9)
    columns = {CONSTANT: [np.ones(len(time_s))], DRIFT: [ramp - 0.5]}
    if scenario.run.fidelity == "channel":
        plus = minus = scenario.omega_s * (time_s - time_s[0])
        earth = np.zeros(len(time_s))
    else:
        plus, minus, earth = line_phases(time_s, run.truth[chosen], scenario.earth).T
    if plus[-1] >= _RESOLVED:
        both = plus[-1] - minus[-1] >= _BEATS
        phases = (plus, minus) if both else (0.5 * (plus + minus),)
        columns[SCHULER] = [wave(phase) for phase in phases for wave in (np.cos, np.sin)]
    if earth[-1] >= _RESOLVED:
        columns[EARTH] = [np.cos(earth), np.sin(earth)]
    return columns
