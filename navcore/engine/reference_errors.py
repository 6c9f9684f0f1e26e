"""Errors of a ship's own INS against a reference: recorded minus reference, at the reference's own epochs."""

from dataclasses import dataclass

import numpy as np

from navcore.foundation.earth import Earth, attitude_matrix
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.stage_cache import kept, recorded_state
from navcore.foundation.text import Text
from navcore.io.jumps import jumps_of
from navcore.io.recording import load, shared_window
from navcore.io.series import GAP_FACTOR, Recording, Series
from navcore.motion.smoothing import smoothed_columns
from navcore.motion.track import position_of
from navcore.quantities import COMPONENTS
from navcore.scenario.model import Scenario

PHI_E, PHI_N, PHI_U, DV_E, DV_N, D_LAT, D_LON = range(7)
_MOST_NAMED = 3
_GRID = 65


@dataclass(frozen=True)
class RecordedErrors:
    """Errors of an INS as it was recorded.

    Attributes
    ----------
    time_s : ndarray, shape (n,)
        Epochs of the reference within the run, s from t = 0.
    values : ndarray, shape (n, 7)
        `navcore.quantities.COMPONENTS`, SI; NaN where the reference or the output does not say.
    longest_s : float
        Distance of two epochs beyond which nothing is said of the time between them, s.
    warnings : tuple of str
        What the reference does not hold.
    """

    time_s: np.ndarray
    values: np.ndarray
    longest_s: float
    warnings: tuple[str, ...]

    @property
    def not_known(self) -> tuple[str, ...]:
        """Errors of which the reference says nothing."""
        return tuple(
            name for name, column in zip(COMPONENTS, self.values.T, strict=True) if np.isnan(column).all()
        )

    def between(self, time_s: np.ndarray, values: np.ndarray) -> np.ndarray:
        """Values at the epochs taken at other times; NaN where no epoch is near.

        Parameters
        ----------
        time_s : ndarray, shape (m,)
            s from t = 0.
        values : ndarray, shape (n, k)
            At the epochs, or at the first of them.
        """
        known = self.time_s[: len(values)]
        out = np.column_stack([np.interp(time_s, known, column) for column in values.T])
        right = np.clip(np.searchsorted(known, time_s), 1, len(known) - 1)
        apart = known[right] - known[right - 1]
        near = np.minimum(np.abs(time_s - known[right]), np.abs(time_s - known[right - 1])) < 1e-6
        outside = (time_s < known[0] - 1e-6) | (time_s > known[-1] + 1e-6)
        out[outside | ((apart > self.longest_s) & ~near)] = np.nan
        return out


def recorded_errors_of(scenario: Scenario, start_utc: float) -> RecordedErrors | None:
    """Errors of the output of a scenario's INS against its reference; None without a reference.

    Parameters
    ----------
    scenario : Scenario
        On ``[ins]``.
    start_utc : float
        UTC of t = 0, s.

    Raises
    ------
    InputError
        The reference cannot be read, jumps, or shares too little time with the output.
    """
    if scenario.truth.file is None:
        return None
    states = recorded_state(scenario.ins), recorded_state(scenario.truth)
    span_s = scenario.steps * scenario.run.step_s
    key = "recorded errors", states, scenario.ins, scenario.truth, scenario.earth.name, start_utc, span_s
    return kept(key, lambda: _made(scenario, start_utc, span_s))


def _made(scenario: Scenario, start_utc: float, span_s: float) -> RecordedErrors:
    try:
        reference = _reference(scenario)
    except InputError as error:
        raise error.located("", "truth.") from None
    position = reference.position
    assert position is not None
    streams = scenario.motion.streams()
    assert streams is not None
    shared_window([streams.position, position], "truth.file")
    ins = streams.recording
    time_s = position.time_s[position.valid] - start_utc
    time_s = time_s[(time_s >= -1e-6) & (time_s <= span_s + 1e-6)]
    time_s = time_s[_covered(streams.position, time_s + start_utc)]
    if time_s.size < 2:
        told = Text("holds fewer than two positions within the run")
        raise InputError(Fault("", "truth.file", scenario.truth.file, told))
    utc = time_s + start_utc
    values = np.full((time_s.size, len(COMPONENTS)), np.nan)
    own, true = _at(streams.position, utc), _at(position, utc)
    height = np.nan_to_num(_height(position), nan=0.0)
    meridian, prime_vertical = _radii(scenario.earth, true[:, 0]).T
    values[:, D_LAT] = (own[:, 0] - true[:, 0]) * (meridian + height)
    turned = np.remainder(own[:, 1] - true[:, 1] + np.pi, 2.0 * np.pi) - np.pi
    values[:, D_LON] = turned * (prime_vertical + height) * np.cos(true[:, 0])
    values[:, [DV_E, DV_N]] = _velocity(ins, streams.position, utc, scenario) - _velocity(
        reference, position, utc, scenario
    )
    warnings: list[str] = []
    if reference.velocity is None:
        warnings.append(Text("the reference holds positions only: its velocity is their rate of change"))
    _angles(ins, reference, utc, values)
    warnings += [told for column, told in _LEFT_OUT.items() if np.isnan(values[:, column]).all()]
    longest = GAP_FACTOR * max(position.interval_s, streams.position.interval_s)
    return RecordedErrors(time_s, values, longest, tuple(warnings))


def _covered(series: Series, utc: np.ndarray) -> np.ndarray:
    """Whether readings lie on both sides of times, or at them, and no gap between."""
    known = series.time_s[series.valid]
    right = np.clip(np.searchsorted(known, utc), 1, known.size - 1)
    inside = (utc >= known[0] - 1e-6) & (utc <= known[-1] + 1e-6)
    near = np.minimum(np.abs(utc - known[right]), np.abs(utc - known[right - 1])) < 1e-6
    return inside & (near | (known[right] - known[right - 1] <= GAP_FACTOR * series.interval_s))


_LEFT_OUT = {
    PHI_U: Text("output and reference do not both hold a heading: its error is not known, and left out"),
    PHI_E: Text(
        "output and reference do not both hold pitch, roll and heading: the tilt is not known, and left out"
    ),
}


def _reference(scenario: Scenario) -> Recording:
    truth = scenario.truth
    recording = load(truth.file or (), field="file", map_file=truth.map)
    streams = {name: one.shifted(truth.clock_s) for name, one in recording.quantities().items()}
    recording = Recording(**streams, sources=recording.sources, deviations={})
    position = position_of(recording, truth.file)
    found = jumps_of(position, recording.velocity)
    if found:
        named = Text.joined("; ", (jump.text for jump in found[:_MOST_NAMED]))
        told = Text(
            "{source}: the reference jumps ({named}): leave the times beside it out of the file, or take "
            "another receiver",
            source=position.source,
            named=named,
        )
        raise InputError(Fault("", "file", truth.file, told))
    return recording


def _at(series: Series, utc: np.ndarray) -> np.ndarray:
    """Columns of a series at UTC times, shape (m, k): a spline through the readings, angles unwrapped."""
    kept_ = series.valid
    values = series.values[kept_][:, :2]
    unwrapped = np.unwrap(values, axis=0)
    return smoothed_columns(series.time_s[kept_], unwrapped, 0.0).at(utc)


def _height(position: Series) -> float:
    heights = position.values[np.isfinite(position.values[:, 2]), 2]
    return float(np.median(heights)) if heights.size else 0.0


def _velocity(recording: Recording, position: Series, utc: np.ndarray, scenario: Scenario) -> np.ndarray:
    """East and north velocity at UTC times: as recorded, else the rate of the positions."""
    velocity = recording.velocity
    if velocity is not None:
        known = velocity.valid
        return smoothed_columns(velocity.time_s[known], velocity.values[known], 0.0).at(utc)
    known = position.valid
    spline = smoothed_columns(position.time_s[known], np.unwrap(position.values[known, :2], axis=0), 5.0)
    lat, rate = spline.at(utc)[:, 0], spline.rate(utc)
    meridian, prime_vertical = _radii(scenario.earth, lat).T
    height = _height(position)
    return np.column_stack(
        [rate[:, 1] * (prime_vertical + height) * np.cos(lat), rate[:, 0] * (meridian + height)]
    )


def _angles(ins: Recording, reference: Recording, utc: np.ndarray, values: np.ndarray) -> None:
    """Fill in the errors of heading and tilt that both recordings tell."""
    if ins.heading is None or reference.heading is None:
        return
    own, true = (_at(one, utc)[:, 0] for one in (ins.heading, reference.heading))
    turned = np.remainder(own - true + np.pi, 2.0 * np.pi) - np.pi
    if ins.attitude is None or reference.attitude is None:
        values[:, PHI_U] = turned
        return
    computed = _matrices(_at(ins.attitude, utc), own)
    actual = _matrices(_at(reference.attitude, utc), true)
    # C_computed = (1 - phi x) C_true
    error = np.einsum("nij,nkj->nik", computed, actual)
    for column, (i, j) in ((PHI_E, (1, 2)), (PHI_N, (2, 0)), (PHI_U, (0, 1))):
        values[:, column] = 0.5 * (error[:, i, j] - error[:, j, i])


def _matrices(attitude: np.ndarray, heading: np.ndarray) -> np.ndarray:
    """Matrices from the ship's axes to E, N, U, shape (n, 3, 3)."""
    return np.array(
        [
            attitude_matrix(float(angles[0]), float(angles[1]), float(turn))
            for angles, turn in zip(attitude, heading, strict=True)
        ]
    )


def _radii(earth: Earth, lat: np.ndarray) -> np.ndarray:
    """Radii of curvature M and N along latitudes (rad), m, shape (n, 2)."""
    grid = np.linspace(lat.min(), lat.max(), _GRID)
    radii = np.array([earth.radii(float(one)) for one in grid])
    return np.column_stack([np.interp(lat, grid, column) for column in radii.T])
