"""A recorded log as the reference: its error is what it says minus the true velocity of the motion."""

from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np

from navcore.foundation.errors import InputError
from navcore.foundation.text import Text
from navcore.io.courses import course_warnings
from navcore.io.plausible import speed_warnings
from navcore.io.recording import Window, require_cover, require_no_gap, shared_window
from navcore.io.series import Recording, Series
from navcore.io.stretches import stretch_warnings
from navcore.io.suspects import suspect_warnings
from navcore.motion.base import MotionParameters
from navcore.motion.truth import Truth
from navcore.sensors.base import ReferenceErrors
from navcore.sensors.corrections import corrections
from navcore.sensors.log_errors.events import event_velocity
from navcore.sensors.log_files import log_recording, log_series
from navcore.sensors.reference import RECORDED_ONLY, Reference, in_service
from navcore.sensors.simulated_log import hold_time
from navcore.sensors.true_state import arm_velocity, horizontal_state, to_navigation

_MOST_SILENT = 0.9
"""Share of a run in which the log may say nothing at a stretch: nothing bridges that, the run goes on
undamped."""
SCHULER_PERIOD_S = 84.4 * 60.0
_OF_FILES = ("file", "map", *RECORDED_ONLY)
"""Fields of a recorded log alone."""
_RECORDED_FIELDS = {"kind", "frame", "event", "outage", "min_speed_mps", "speed", *_OF_FILES}


def _streams(reference: Reference) -> list[Series]:
    recording = log_recording(reference)
    series, along_axes = log_series(reference, recording)
    turned_by = recording.heading if along_axes and reference.frame == "enu" else None
    return [s for s in (series, turned_by) if s is not None]


def recorded_window(motion: MotionParameters, reference: Reference) -> Window | None:
    """Time that everything recorded in a scenario shares; its start is t = 0 for the track and for the log.

    Parameters
    ----------
    motion : MotionParameters
        Any motion; few are recorded.
    reference : Reference
        Only ``kind = "file"`` is recorded.

    Returns
    -------
    Window, or None when nothing is recorded.

    Raises
    ------
    InputError
        A file is missing or wrong, or the recordings share no time (field names begin with the block).
    """
    streams: list[Series] = []
    try:
        recorded = motion.streams()
    except InputError as error:
        raise error.located("", f"{motion.block}.") from None
    if recorded is not None:
        streams += recorded.series()
    if reference.kind == "file":
        try:
            streams += _streams(reference)
        except InputError as error:
            raise error.located("", "reference.") from None
    return (
        shared_window(streams, "reference.file" if reference.kind == "file" else f"{motion.block}.file")
        if streams
        else None
    )


def recorded_errors(
    reference: Reference, truth: Truth, duration_s: float, start_utc: float | None = None
) -> ReferenceErrors:
    """Errors of a recorded log at its own epochs within the run.

    Speeds along the ship's axes are turned by the true heading of the motion when ``frame = "body"`` (the
    mechanization then adds what the computed heading changes), and by the heading recorded with the log, if
    there is one, when ``frame = "enu"``. Readings that the log itself calls invalid are not valid.

    Parameters
    ----------
    reference : Reference
        With ``kind = "file"``.
    truth : Truth
        True motion over the run.
    duration_s : float
        Length of the run, s.
    start_utc : float, optional
        UTC of t = 0; default: the first epoch of the log.

    Raises
    ------
    InputError
        A file is missing or wrong, it holds no speed, or it is shorter than the run.
    """
    recording = log_recording(reference)
    series, _ = log_series(reference, recording)
    window = shared_window(_streams(reference))
    start = window.start_s if start_utc is None else start_utc
    require_cover(window, start, duration_s, Text("the log"), reference.file)
    require_no_gap(_streams(reference), start, duration_s, _MOST_SILENT, reference.file)
    errors = log_errors(reference, recording, truth, start, duration_s)
    time_s, error, valid = with_silence(
        errors.time_s, errors.error, errors.valid, series.interval_s, errors.hold_s
    )
    return replace(errors, time_s=time_s, error=error, valid=valid)


def log_errors(
    reference: Reference, recording: Recording, truth: Truth, start_s: float, duration_s: float
) -> ReferenceErrors:
    """Errors of a log at the epochs of its readings; that it falls silent is not among them.

    Parameters
    ----------
    reference : Reference
        How the readings are taken.
    recording : Recording
        With the log's speeds, as `navcore.sensors.log_files.log_series` chooses them.
    truth : Truth
        True motion, from ``start_s`` on.
    start_s : float
        UTC of its first row, s.
    duration_s : float
        Time within which readings are taken, s.
    """
    series, along_axes = log_series(reference, recording)
    elapsed = series.time_s - start_s
    within = (elapsed >= 0.0) & (elapsed <= duration_s)
    time_s, values = elapsed[within], series.values[within]
    velocity, heading = horizontal_state(truth, time_s)
    of_arm = arm_velocity(truth, time_s, reference.lever_arm_m)
    if along_axes:
        if reference.frame == "enu" and recording.heading is not None:
            heading = heading_at(recording.heading, series.time_s[within])
        values = to_navigation(values - of_arm, heading)
    else:
        values = values - to_navigation(of_arm, heading)
    valid = series.valid[within] & in_service(reference.outage, time_s)
    valid &= ~(np.hypot(values[:, 0], values[:, 1]) < reference.min_speed_mps)
    error = np.where(valid[:, None], values - velocity + event_velocity(reference.event, time_s), 0.0)
    return ReferenceErrors(
        time_s=time_s,
        error=error,
        valid=valid,
        body_frame=along_axes and reference.frame == "body",
        hold_s=hold_time(series.interval_s),
    )


def with_silence(
    time_s: np.ndarray, error: np.ndarray, valid: np.ndarray, interval_s: float, hold_s: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Epochs with an invalid one where a reading is missing that begins a gap longer than a reading is held.

    What comes after is at hand: that the log falls silent is known at once, not when a reading is too old.

    Parameters
    ----------
    time_s, error, valid : ndarray
        As of `ReferenceErrors`.
    interval_s : float
        Usual time between two readings, s.
    hold_s : float
        A reading older than this counts as missing, s.
    """
    gaps = np.flatnonzero(np.diff(time_s) > hold_s)
    if not gaps.size or interval_s <= 0.0:
        return time_s, error, valid
    missing = time_s[gaps] + interval_s
    return (
        np.insert(time_s, gaps + 1, missing),
        np.insert(error, gaps + 1, 0.0, axis=0),
        np.insert(valid, gaps + 1, False),
    )


def heading_at(heading: Series, time_s: np.ndarray) -> np.ndarray:
    """Recorded heading at UTC times, linear between readings, rad, not wrapped; shape (m,)."""
    return np.interp(time_s, heading.time_s, np.unwrap(heading.values[:, 0]))


def recording_notices(motion: MotionParameters, reference: Reference) -> tuple[str, ...]:
    """Return the notices about the recordings of a scenario, and about settings they leave unused.

    Raises
    ------
    InputError
        As `recorded_window`.
    """
    recorded_window(motion, reference)
    notices = list(motion.notices())
    if reference.kind == "file":
        notices += _log_notices(motion, reference)
    else:
        notices += _unused(reference, _OF_FILES)
    return tuple(dict.fromkeys(notices))


def _log_notices(moving: MotionParameters, reference: Reference) -> Iterator[str]:
    track = moving.streams()
    recording = log_recording(reference)
    series, along_axes = log_series(reference, recording)
    yield from recording.warnings
    yield from stretch_warnings(series)
    if along_axes and series is not getattr(recording, reference.speed):
        yield Text(
            "{file} holds no {speed} speed: its other speed is used", file=series.file, speed=reference.speed
        )
    if not along_axes and reference.frame == "body":
        yield Text(
            '{source} gives east and north: reference.frame = "body" has no effect', source=series.source
        )
    if track is None:
        yield (
            Text(
                "a recorded log without a recorded track: the ship follows the simulated "
                "motion ({kind}), and the log errs by all its difference from it",
                kind=moving.kind,
            )
        )
    else:
        yield from speed_warnings(Recording(track.position, track.recording.velocity, recording.water))
        yield from course_warnings(track.recording)
        yield from suspect_warnings(Recording(position=track.position, heading=track.recording.heading))
        yield from (one.notice for one in corrections(moving, reference))
    if track is not None and not along_axes and series.file == track.position.file:
        yield Text(
            "{source}: the log comes from the same receiver as the track, its errors cancel in part",
            source=series.source,
        )
    count, longest = series.gaps()
    if count:
        gaps = Text("{count} gaps (longest {longest:.1f} s)", count=count, longest=longest)
        yield Text(
            "{source}: {gaps}, undamped in those longer than {hold_time:.1f} s",
            source=series.source,
            gaps=gaps,
            hold_time=hold_time(series.interval_s),
        )
    yield from _unused(reference, [name for name in Reference.model_fields if name not in _RECORDED_FIELDS])


def short_run_notices(motion: MotionParameters, recorded: bool, duration_s: float) -> list[str]:
    """Say so when a run on recordings is too short to tell anything about damping.

    Parameters
    ----------
    motion : MotionParameters
        May be recorded.
    recorded : bool
        Whether the log or the IMU is recorded.
    duration_s : float
        Length of the run, s.
    """
    if duration_s >= SCHULER_PERIOD_S or not (recorded or motion.streams() is not None):
        return []
    return [
        Text(
            "the run of {duration_s:.1f} min is {duration_s_2:.2g} of a Schuler period "
            "({schuler_period_s:.1f} min): it shows little more than the initial errors, "
            "and conclusions about damping need a longer recording",
            duration_s=duration_s / 60.0,
            duration_s_2=duration_s / SCHULER_PERIOD_S,
            schuler_period_s=SCHULER_PERIOD_S / 60.0,
        )
    ]


def _unused(reference: Reference, fields: Iterable[str]) -> list[str]:
    given = (name for name in fields if getattr(reference, name) != Reference.model_fields[name].default)
    names = [f"reference.{name}" for name in given]
    verb = "is" if len(names) == 1 else "are"
    return (
        [
            Text(
                '{names} {verb} not used with reference.kind = "{kind}"',
                names=", ".join(names),
                verb=verb,
                kind=reference.kind,
            )
        ]
        if names
        else []
    )
