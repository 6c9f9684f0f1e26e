"""One moment of a run: attitude, velocity and errors of each method, and the Schuler pendulum's swing.

The pendulum: left a side view in the vertical plane in which the pendulums swung most during the last Schuler
period, right a view from above with their way over that period: there an undamped platform draws the ellipse
that the Foucault rotation turns, and a damped one a spiral or a point. All tilts are drawn larger by the same
factor.
"""

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from navcore.engine.run import MethodRun, Run
from navcore.foundation.earth import attitude_matrix
from navcore.foundation.notation import with_unit
from navcore.foundation.text import Text
from navcore.foundation.units import DEG
from navcore.mechanization.recorder import DV_E, DV_N, PHI_E, PHI_N, PHI_U, POSITION, QUANTITIES
from navcore.motion.truth import HEADING, PITCH, ROLL, VE, VN
from navcore.quantities import TILT, components
from schuler_bench.plots import style
from schuler_bench.plots.units import (
    AUTO,
    NAMED,
    Unit,
    angle_unit,
    duration,
    length_unit,
    number,
    round_down,
    speed_unit,
    wanted_unit,
)
from schuler_bench.session.display import Display

WIDTH, HEIGHT = 296, 134
_WIDEST = 30.0 * DEG
"""The largest tilt of a run is drawn about this large."""
_FACTORS = (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0)
_PIVOT = (74.0, 22.0)
_ROD = 98.0
_PLAN = (222.0, 76.0)
_PLAN_HALF = 52.0
_TRAIL_POINTS = 48
_POINTS = Text("N NNE NE ENE E ESE SE SSE S SSW SW WSW W WNW NW NNW").split()
_TRUE = "#6B7A89"


class Bob(NamedTuple):
    """The lower end of one method's pendulum.

    ``trail``, shape (k, 2): its way east and north over the last Schuler period, rad of tilt, not
    exaggerated, the present end last. The platform's down axis leans by -phi_N and +phi_E.
    """

    color: str
    trail: np.ndarray


class Pendulum(NamedTuple):
    """All methods' pendulums at a time, in the scenario's order.

    All tilts are drawn larger by ``factor``; ``plane``: east and north components of the unit vector to the
    right of the side view.
    """

    bobs: tuple[Bob, ...]
    factor: float
    period_s: float
    plane: tuple[float, float] = (1.0, 0.0)


def pendulum(run: Run, t_s: float) -> Pendulum:
    """Pendulums of a run at a time."""
    period = math.tau / run.scenario.omega_s
    peak = max((_peak(m) for m in run.methods if m.status != "diverged"), default=0.0)
    peak = peak or max((_peak(m) for m in run.methods), default=0.0)
    factor = round_down(_WIDEST / peak, _FACTORS) if 0.0 < peak < _WIDEST else 1.0
    bobs = tuple(bob for method in run.methods if len((bob := _bob(method, t_s, period)).trail))
    return Pendulum(bobs, factor, period, _plane([bob.trail for bob in bobs]))


def _plane(trails: list[np.ndarray]) -> tuple[float, float]:
    """Direction (east, north) in which bobs swung most: the larger principal axis of their ways."""
    points = np.vstack([np.empty((0, 2)), *trails])
    points = points[np.isfinite(points).all(axis=1)]
    if not len(points) or not np.any(points):
        return 1.0, 0.0
    points = points / np.abs(points).max()
    _, axes = np.linalg.eigh(points.T @ points)
    east, north = axes[:, 1]
    # One of both ends is to the right: that of the north-eastern half.
    sign = 1.0 if east + north >= 0.0 else -1.0
    return float(sign * east), float(sign * north)


def plane_ends(plane: tuple[float, float]) -> tuple[str, str]:
    """Points of the compass to the left and to the right of the side view.

    Examples
    --------
    >>> plane_ends((1.0, 0.0)), plane_ends((0.0, 1.0))
    (('W', 'E'), ('S', 'N'))
    """
    point = round(math.degrees(math.atan2(*plane)) / 22.5)
    return _POINTS[(point + 8) % 16], _POINTS[point % 16]


def _peak(method: MethodRun) -> float:
    known = [size for name in components(TILT) if math.isfinite(size := method.errors[name]["max_abs"])]
    return max(known, default=0.0)


def _bob(method: MethodRun, t_s: float, period: float) -> Bob:
    first, last = np.searchsorted(method.t_s, [t_s - period, t_s])
    chosen = np.unique(np.linspace(first, max(last - 1, first), _TRAIL_POINTS).astype(int))
    trail = np.vstack([method.rows[chosen[chosen < len(method.rows)]], row_at(method.t_s, method.rows, t_s)])
    trail = trail[np.isfinite(trail[:, [PHI_N, PHI_E]]).all(axis=1)]  # of an INS's output it may be unknown
    return Bob(style.method_color(method.place), trail[:, [PHI_N, PHI_E]] * (-1.0, 1.0))


def pendulum_svg(now: Pendulum) -> str:
    """The picture, `WIDTH` x `HEIGHT` px: from the side, and from above."""
    parts = [_background(), *_plane_marks(now.plane)]
    parts += [_swing(bob, now.factor, now.plane) for bob in now.bobs]
    parts += [_way(bob, now.factor) for bob in now.bobs]
    caption = caption_of(now)
    return Text(
        '<svg viewBox="0 0 {width} {height}" width="{width}" height="{height}" role="img" '
        'aria-label="Schuler pendulum: platform {caption}" data-factor="{factor:g}" '
        'font-family="{font}">{parts}</svg>',
        width=WIDTH,
        height=HEIGHT,
        caption=caption,
        factor=now.factor,
        font=style.SVG_FONT,
        parts=Text.joined("", parts),
    )


def caption_of(now: Pendulum) -> str:
    """Describe the picture in words."""
    larger = Text("to scale") if now.factor == 1.0 else f"x {number(now.factor)}"
    return Text("tilt {larger}; length R, period {period_s}", larger=larger, period_s=duration(now.period_s))


_SMALL = f'font-size="12" fill="{style.MUTED}"'


@lru_cache(maxsize=1)
def _background() -> str:
    (x, y), (px, py), half = _PIVOT, _PLAN, _PLAN_HALF
    return (
        f'<path d="M8 {y + 8} Q{x} {y - 8} 140 {y + 8}" fill="none" stroke="#7FB2DC" stroke-width="2"/>'
        f'<path d="M{x - 11} {y - 4} h22 l-4 5 h-14 z M{x - 5} {y - 4} v-5 h9 v5 z" fill="{style.INK}"/>'
        f'<line x1="{x}" y1="{y}" x2="{x}" y2="{y + _ROD + 12}" stroke="{_TRUE}" stroke-dasharray="4 4"/>'
        f'<circle cx="{px}" cy="{py}" r="{half}" fill="none" stroke="{style.GRID}"/>'
        f'<circle cx="{px}" cy="{py}" r="{half / 2}" fill="none" stroke="{style.GRID}"/>'
        f'<path d="M{px - half} {py} h{2 * half} M{px} {py - half} v{2 * half}" stroke="{style.GRID}"/>'
        f'<text x="{px}" y="{py - half - 6}" text-anchor="middle" {_SMALL}>N</text>'
        f'<text x="{px + half + 5}" y="{py + 4}" {_SMALL}>E</text>'
    )


def _plane_marks(plane: tuple[float, float]) -> tuple[str, str]:
    """Where the ends of the side view lie, and its plane in the view from above."""
    left, right = plane_ends(plane)
    (px, py), (east, north) = _PLAN, (_PLAN_HALF * part for part in plane)
    return (
        Text(
            '<text x="2" y="{height}" {small}>{left}</text><text x="146" y="{height}" '
            'text-anchor="end" {small}>{right}</text>',
            height=HEIGHT - 4,
            small=_SMALL,
            left=left,
            right=right,
        ),
        f'<path d="M{px - east:.1f} {py + north:.1f} L{px + east:.1f} {py - north:.1f}" '
        f'stroke="{_TRUE}" stroke-dasharray="4 4"/>',
    )


def _swing(bob: Bob, factor: float, plane: tuple[float, float]) -> str:
    """Rod and bob in the plane of the side view; how far it swung in the last period as an arc."""
    x, y = _PIVOT
    angles = np.clip(factor * (bob.trail @ np.array(plane)), -1.2, 1.2)
    ends = np.array([angles.min(), angles.max(), angles[-1]])
    (x0, x1, tip_x), (y0, y1, tip_y) = x + _ROD * np.sin(ends), y + _ROD * np.cos(ends)
    return (
        f'<path d="M{x0:.1f} {y0:.1f} A{_ROD} {_ROD} 0 0 0 {x1:.1f} {y1:.1f}" '
        f'fill="none" stroke="{bob.color}" stroke-opacity=".35" stroke-width="5"/>'
        f'<line x1="{x}" y1="{y}" x2="{tip_x:.1f}" y2="{tip_y:.1f}" stroke="{bob.color}" '
        f'stroke-width="1.8"/><circle class="sb-bob" cx="{tip_x:.1f}" cy="{tip_y:.1f}" r="5.5" '
        f'fill="{bob.color}"/>'
    )


def _way(bob: Bob, factor: float) -> str:
    """The way of the last period as seen from above, and where the bob is."""
    scale = factor * _PLAN_HALF / _WIDEST
    at = np.clip(scale * bob.trail, -1.1 * _PLAN_HALF, 1.1 * _PLAN_HALF)
    points = " ".join([f"{_PLAN[0] + e:.1f},{_PLAN[1] - n:.1f}" for e, n in at])
    e, n = at[-1]
    return (
        f'<polyline points="{points}" fill="none" stroke="{bob.color}" stroke-width="1.4" '
        f'stroke-opacity=".7"/><circle cx="{_PLAN[0] + e:.1f}" cy="{_PLAN[1] - n:.1f}" r="4" '
        f'fill="{bob.color}"/>'
    )


_AS_IT_FITS = Display()
_LEAST = 0.01
"""Of the smallest units, such as µas: no sensor and no plot knows less."""
_SMALLEST = {choose(1e-30).name: choose(0.0).name for choose in (angle_unit, speed_unit, length_unit)}
"""The smallest units, and the unit in which 0 is shown."""
_COMPUTED = (6, 7, 8)
"""Pitch, roll and heading among the columns of `MethodRun.navigation`."""


class Pose(NamedTuple):
    """Attitude (rad; heading clockwise from north, 0 to 2 pi) and speed over ground (m/s)."""

    heading: float
    pitch: float
    roll: float
    speed: float


@dataclass(frozen=True, eq=False)
class MethodMoment:
    """Pose that one method computes, and its errors.

    Attributes
    ----------
    name, color : str
        The method's.
    pose : Pose
        As computed.
    errors : ndarray, shape (8,)
        The quantities of `navcore.quantities.NAMES`, SI.
    ended : bool
        The method did not come this far: its last values are shown.
    """

    name: str
    color: str
    pose: Pose
    errors: np.ndarray
    ended: bool


class Moment(NamedTuple):
    """One moment: its time in the run (s), the true pose, and the methods in the scenario's order."""

    t_s: float
    truth: Pose
    methods: tuple[MethodMoment, ...]


def moment(run: Run, t_s: float) -> Moment:
    """Attitude, speed and errors at a time, interpolated between the output rows."""
    truth = row_at(run.t_s, run.truth[:, [PITCH, ROLL, HEADING, VE, VN]], t_s)
    pitch, roll, heading, ve, vn = truth.tolist()
    attitude = attitude_matrix(pitch, roll, heading)
    methods = []
    for method in run.methods:
        errors = row_at(method.t_s, method.rows[:, :QUANTITIES], t_s)
        speed = math.hypot(ve + errors[DV_E], vn + errors[DV_N])
        methods.append(
            MethodMoment(
                name=method.method.name,
                color=style.method_color(method.place),
                pose=Pose(*_computed(method, errors, attitude, t_s), speed),
                errors=errors,
                ended=len(method.t_s) == 0 or t_s > method.t_s[-1] + 1e-6,
            )
        )
    return Moment(t_s, Pose(heading % math.tau, pitch, roll, math.hypot(ve, vn)), tuple(methods))


def row_at(t_s: np.ndarray, rows: np.ndarray, at_s: float) -> np.ndarray:
    """Row of a series at a time, shape (columns,): interpolated, the first or last one outside."""
    if len(t_s) == 0:
        return np.zeros(rows.shape[1])
    after = int(np.clip(np.searchsorted(t_s, at_s), 1, max(len(t_s) - 1, 1)))
    if after >= len(t_s):
        return rows[0].copy()
    span = t_s[after] - t_s[after - 1]
    part = min(max((at_s - t_s[after - 1]) / span, 0.0), 1.0)
    return (1.0 - part) * rows[after - 1] + part * rows[after]


def _computed(
    method: MethodRun, errors: np.ndarray, attitude: np.ndarray, t_s: float
) -> tuple[float, float, float]:
    """Heading, pitch and roll that a method computes: C~ = (I - [phi x]) C, or what the strapdown says."""
    if method.navigation is not None and len(method.navigation):
        at = int(np.clip(np.searchsorted(method.t_s, t_s, side="right") - 1, 0, len(method.navigation) - 1))
        pitch, roll, heading = (float(value) for value in method.navigation[at, _COMPUTED])
        return heading % math.tau, pitch, roll
    e, n, u = errors[PHI_E : PHI_U + 1]
    cross = np.array([[0.0, -u, n], [u, 0.0, -e], [-n, e, 0.0]])
    c = attitude - cross @ attitude
    heading = math.atan2(c[0, 1], c[1, 1])
    pitch = math.asin(min(max(c[2, 1], -1.0), 1.0))
    return heading % math.tau, pitch, math.atan2(-c[2, 0], c[2, 2])


def readout_html(now: Moment, selected: int, display: Display = _AS_IT_FITS) -> str:
    """True and computed attitude and speed of one method, and its errors, in the units that are asked for.

    Attitude is in degrees and speed in knots unless speeds are asked for in another unit.
    """
    method = now.methods[min(selected, len(now.methods) - 1)]
    true, computed = now.truth, method.pose
    turned = math.remainder(computed.heading - true.heading, math.tau)
    attitude = (
        ("heading", true.heading, computed.heading, turned),
        ("pitch", true.pitch, computed.pitch, computed.pitch - true.pitch),
        ("roll", true.roll, computed.roll, computed.roll - true.roll),
    )
    rows = [
        (name, _degrees(a), _degrees(b), _signed(off, wanted_unit(display.angle, abs(off), angle_unit)))
        for name, a, b, off in attitude
    ]
    way = NAMED["kn" if display.speed == AUTO else display.speed]
    a, b = (f"{pose.speed / way.si:.2f} {way.name}" for pose in (true, computed))
    faster, off = computed.speed - true.speed, float(method.errors[POSITION])
    rows.append(("speed", a, b, _signed(faster, wanted_unit(display.speed, abs(faster), speed_unit))))
    rows.append(("position", "", "", _signed(off, wanted_unit(display.length, off, length_unit)).lstrip("+")))
    cells = Text.joined(
        "",
        (
            Text(
                "<tr><th scope='row'>{name}</th><td>{a}</td><td>{b}</td><td>{c}</td></tr>",
                name=name,
                a=a,
                b=b,
                c=c,
            )
            for name, a, b, c in rows
        ),
    )
    name = Text("{name} (ended)", name=method.name) if method.ended else method.name
    return Text(
        "<table data-t='{t_s:.3f}'><thead><tr><th scope='col'>{duration}</th><th scope='col'>"
        "true</th><th scope='col'><span class='sb-name' style='border-color:{color}'>"
        "{name:html}</span></th><th scope='col'>error</th></tr></thead><tbody>"
        "{cells}</tbody></table>",
        t_s=now.t_s,
        duration=duration(now.t_s),
        color=method.color,
        name=name,
        cells=cells,
    )


def _degrees(angle: float) -> str:
    return f"{round(angle / DEG, 2) + 0.0:.2f}°"


def _signed(value: float, unit: Unit) -> str:
    """Error with its sign; what is below a hundredth of the smallest unit is rounding, and reads as 0."""
    rounded = float(f"{value / unit.si:.3g}")
    if unit.name in _SMALLEST and abs(rounded) < _LEAST:
        return f"0 {_SMALLEST[unit.name]}"
    return f"{'+' if rounded > 0 else ''}{with_unit(number(rounded), unit.name)}"
