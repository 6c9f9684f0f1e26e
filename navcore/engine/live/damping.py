"""Damping carried on with an INS's output as it comes: the run on the recording, in pieces."""

import math
from dataclasses import dataclass, field, replace

import numpy as np

from navcore.engine.against import damped_output
from navcore.engine.drivers.common import law_of, network_of
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.foundation.units import DEG
from navcore.io.jumps import jumps_of
from navcore.io.recording import shared_window
from navcore.io.rewritten import Moved
from navcore.io.series import Recording, Series
from navcore.law.law import Law
from navcore.mechanization.outside import carry_on, own_corrections, taken_off
from navcore.mechanization.recorder import DV_E, DV_N
from navcore.mechanization.trajectory import coefficients
from navcore.motion.heard_track import SETTLES_S, HeardTrack
from navcore.motion.ins_track import LONGEST_INTERVAL_S
from navcore.motion.smoothing import FEWEST_FIXES
from navcore.motion.truth import HEADING, LAT, LON, VE, VN, Truth
from navcore.scenario.model import Scenario
from navcore.sensors.base import ReferenceErrors
from navcore.sensors.log_files import log_series
from navcore.sensors.recorded import log_errors, with_silence
from navcore.sensors.simulated_log import hold_time

LEAST_DELAY_S = 10.0
"""The damped output belongs to a time so long ago: the smoothing of the track needs what comes after."""
_FIRST_S = 30.0
"""Damping begins once so much of the output is at hand."""
_ENOUGH = 5
"""Readings of the log that tell its interval."""
_MOST_STEPS = 3600
"""Steps of a piece; what is more waits for the next one."""


@dataclass(frozen=True)
class Piece:
    """Damped and recorded output of successive steps.

    Attributes
    ----------
    time_s : ndarray, shape (n,)
        UTC, s.
    recorded : ndarray, shape (n, 5)
        Columns of `navcore.engine.against.OUTPUT`.
    damped : dict of ndarray, shape (n, 5)
        By the method's name.
    moved : dict of ndarray, shape (n, 12)
        Damped minus recorded, columns of `navcore.mechanization.recorder`.
    log : ndarray, shape (n, 2)
        The log minus the recorded velocity, E and N, m/s, held from its last reading; NaN without one.
    """

    time_s: np.ndarray
    recorded: np.ndarray
    damped: dict[str, np.ndarray]
    moved: dict[str, np.ndarray]
    log: np.ndarray

    def moved_by(self, method: str) -> Moved:
        """Return what damping changes, as `navcore.io.rewritten` takes it."""
        place = self.damped[method][:, :2] - self.recorded[:, :2]
        place[:, 1] = np.remainder(place[:, 1] + np.pi, 2.0 * np.pi) - np.pi
        return Moved(
            self.time_s,
            place,
            self.moved[method][:, [DV_E, DV_N]],
            self.moved[method][:, :3],
            np.unwrap(self.recorded[:, 4]),
        )


@dataclass
class _Carried:
    """One method under way."""

    law: Law
    x: np.ndarray = field(default_factory=lambda: np.zeros(7))
    diverged: bool = False


@dataclass(frozen=True)
class _Epoch:
    """Last reading of the log that the laws have taken."""

    utc_s: float
    error: tuple[float, float]
    valid: bool


class LiveDamping:
    """Methods laid on the output of an INS as it comes.

    Parameters
    ----------
    scenario : Scenario
        Its methods, ``[ins.damping]``, ``[reference]`` and step are used; the rest is what is heard.

    Attributes
    ----------
    restarts : int
        How often damping was begun anew after the first time.
    told : str
        Why it waits, or was begun anew; empty where nothing is to be said.
    left_out : int
        Fixes far off their neighbours that were left out.

    Raises
    ------
    InputError
        A method is none that a law carries out from outside.
    """

    def __init__(self, scenario: Scenario) -> None:
        faults = []
        for i, method in enumerate(scenario.method):
            if method.kind.carrying != "law" or method.event:
                allowed = Text("must be free, or damping by a network without events, to be carried on live")
                faults.append(Fault("", f"method.{i}.damping", method.damping, allowed))
        if faults:
            raise InputError(faults)
        self._given, self.restarts, self.told, self.left_out = scenario, 0, "", 0
        self._start_s: float | None = None
        self._interval_s, self._body_frame = 0.0, False
        self._done, self._after_s = 0, -math.inf

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the methods."""
        return tuple(method.name for method in self._given.method)

    @property
    def needed_from_s(self) -> float:
        """UTC before which nothing that was heard is needed any more, s."""
        if self._start_s is None:
            return -math.inf
        return self._start_s + self._done * self._given.run.step_s - 2.0 * SETTLES_S

    @property
    def delay_s(self) -> float:
        """Age of the damped output, s: the smoothing settles, and a log that falls silent is known to."""
        return max(LEAST_DELAY_S, hold_time(self._interval_s) + 2.0)

    def advance(self, heard: Recording) -> Piece | None:
        """Carry all methods on as far as what is heard allows.

        Parameters
        ----------
        heard : Recording
            From `needed_from_s` on, or earlier.

        Returns
        -------
        Piece, or None while there is nothing new.
        """
        heard = _since(heard, self._after_s)
        self.told = self._missing(heard)
        if self.told and (self._start_s is None or heard.position is None or heard.heading is None):
            return None
        track = HeardTrack.of(heard)
        streams = track.streams()
        if streams.position.time_s.size < FEWEST_FIXES:
            return None
        until = min(float(one.time_s[-1]) for one in (streams.position, streams.heading))
        until -= self.delay_s
        if self._broken(track, until):
            return None
        if self._start_s is None and not self._begun(track, heard, until):
            return None
        assert self._start_s is not None
        step_s = self._given.run.step_s
        begin = self._start_s + self._done * step_s
        steps = min(math.floor((until - begin) / step_s + 1e-6), _MOST_STEPS)
        if steps < 1:
            return None
        return self._carried(track, heard, begin, steps)

    def _missing(self, heard: Recording) -> str:
        """Say what is not heard that damping needs; empty where all of it is."""
        if heard.position is None:
            return Text("waiting for positions of the INS: RMC, GGA or GLL sentences")
        if heard.heading is None:
            return Text("waiting for the heading of the INS: HDT or THS sentences")
        if _has_log(heard):
            return ""
        if self._start_s is not None:
            return Text("the log is silent: undamped until it is heard again")
        return Text("waiting for the log: VBW or VHW sentences")

    def _begun(self, track: HeardTrack, heard: Recording, until: float) -> bool:
        """Switch damping on at the first epoch that all share, once enough is at hand."""
        log, _ = log_series(self._given.reference, heard)
        self._interval_s = log.interval_s
        try:
            start = shared_window([*track.streams().series(), log]).start_s
        except InputError as error:
            self.told = str(error)
            return False
        if until + LEAST_DELAY_S - start < _FIRST_S:
            return False
        step_s = self._given.run.step_s
        first = track.between(start, 1, step_s, self._given.earth).values[0]
        lat, lon = (round(float(first[place]) / DEG, 6) for place in (LAT, LON))
        lat = min(max(lat, -89.0), 89.0)
        site = self._given.site.model_copy(update={"lat_deg": lat, "lon_deg": (lon + 180.0) % 360.0 - 180.0})
        placed = self._given.model_copy(update={"site": site}).with_sensors()
        self._placed = placed
        self._methods = {
            one.name: _Carried(law_of(one, network_of(placed, one), step_s)) for one in placed.method
        }
        own = placed.ins.damping
        self._own: Law | None = None
        if own.kind.uses_network:
            own = placed.designed(own)
            self._own = law_of(own, network_of(placed, own), step_s)
        self._held: _Epoch | None = None
        self._start_s, self._done = start, 0
        return True

    def _broken(self, track: HeardTrack, until: float) -> bool:
        """Whether the output was silent or has jumped; damping begins anew behind that."""
        if self._start_s is None:
            return False
        begin = self._start_s + self._done * self._given.run.step_s
        position = track.streams().position
        time_s = position.time_s
        silent = np.flatnonzero((np.diff(time_s) > LONGEST_INTERVAL_S) & (time_s[1:] > begin))
        jumps = [jump for jump in jumps_of(position, track.recording().velocity) if jump.time_s > begin]
        ends = [float(time_s[k + 1]) for k in silent] + [jump.time_s for jump in jumps]
        last_s = float(track.streams().heading.time_s[-1])
        if time_s[-1] - last_s > LONGEST_INTERVAL_S:
            self.begin_anew(Text("the INS's heading is silent"))
            self._after_s = last_s + 1e-3
            return True
        if time_s[0] > begin - self._given.run.step_s and self._done:
            self.begin_anew(Text("what was heard meanwhile is no longer at hand"))
            return True
        if not ends or min(ends) > until + LEAST_DELAY_S:
            return False
        if silent.size:
            told = Text("the INS was silent for {gap:.0f} s", gap=float(np.diff(time_s)[silent[0]]))
        else:
            told = Text("the INS's output jumped ({jump})", jump=jumps[0].text)
        self.begin_anew(told)
        self._after_s = max(ends)
        return True

    def begin_anew(self, why: str) -> None:
        """Switch damping off and on again, from the recorded output."""
        if self._start_s is not None:
            self.restarts += 1
        self._start_s, self._done = None, 0
        self.told = Text("{why}: damping begins anew", why=why)

    def _carried(self, track: HeardTrack, heard: Recording, begin: float, steps: int) -> Piece:
        """Carry all methods on by some steps."""
        placed, step_s = self._placed, self._given.run.step_s
        before = 0 if self._held is None and self._done == 0 else 1
        wide = track.between(begin - before * step_s, steps + before, step_s, placed.earth)
        truth = Truth(wide.step_s, wide.values[2 * before :])
        log = self._log(heard, wide, begin, before * step_s, steps * step_s)
        along = coefficients(truth, placed.earth, coupled=True)
        sensors = None
        if self._own is not None:
            self._own.s["epoch"] = -1 if self._held is None else 0
            sensors = taken_off(own_corrections(self._own, along, log, steps - 1, step_s), along)
        states = np.arange(steps)
        rows = truth.values[2 * states]
        recorded = rows[:, [LAT, LON, VE, VN, HEADING]]
        recorded[:, 4] = np.remainder(recorded[:, 4], 2.0 * np.pi)
        half = along.half[2 * states] if len(along.half) > 1 else along.half
        radii = np.column_stack([half["m"], half["n_cos"]])
        damped, moved = {}, {}
        for name, one in self._methods.items():
            one.law.s["epoch"] = -1 if self._held is None else 0
            found = np.full((steps, 12), np.nan)
            if not one.diverged:
                part, one.diverged = carry_on(one.law, one.x, along, log, steps, step_s, sensors)
                found[: len(part)] = part
            moved[name] = found
            output = damped_output(found, recorded, radii)
            output[:, 1] = np.remainder(output[:, 1] + np.pi, 2.0 * np.pi) - np.pi
            output[:, 4] = np.remainder(output[:, 4], 2.0 * np.pi)
            if heard.heading is None:
                output[:, 4] = np.nan
            damped[name] = output
        self._take(log, begin, (steps - 1) * step_s)
        off = track.left_out_s
        self.left_out += int(np.count_nonzero((off >= begin) & (off < begin + steps * step_s)))
        self._done += steps
        return Piece(begin + states * step_s, recorded, damped, moved, _held_log(log, states * step_s))

    def _log(
        self, heard: Recording, wide: Truth, begin: float, before_s: float, span_s: float
    ) -> ReferenceErrors:
        """Readings of the log since the last one that was taken, which stands before them."""
        held, time_s, error = self._held, np.empty(0), np.empty((0, 2))
        valid, after = np.empty(0, bool), span_s + self.delay_s
        if _has_log(heard):
            errors = self._errors(heard, wide, begin - before_s, before_s + span_s)
            time_s, error, valid = errors.time_s - before_s, errors.error, errors.valid
            series, _ = log_series(self._given.reference, heard)
            # what comes after the piece tells whether the log has fallen silent within it
            later = series.time_s[series.time_s > begin + span_s] - begin
            after = float(later[0]) if later.size else after
        if held is not None:
            fresh = time_s > held.utc_s - begin + 1e-6
            time_s = np.concatenate([[held.utc_s - begin], time_s[fresh]])
            error = np.concatenate([[held.error], error[fresh]])
            valid = np.concatenate([[held.valid], valid[fresh]])
        hold_s = hold_time(self._interval_s)
        time_s, error, valid = with_silence(
            np.append(time_s, after),
            np.vstack([error, np.zeros((1, 2))]),
            np.append(valid, False),
            self._interval_s,
            hold_s,
        )
        within = time_s <= span_s + 1e-9
        if not within.any():
            within[0] = True
        return ReferenceErrors(time_s[within], error[within], valid[within], self._body_frame, hold_s)

    def _errors(self, heard: Recording, wide: Truth, start_s: float, span_s: float) -> ReferenceErrors:
        """Errors of the log's readings along the output, from a time on."""
        reference = self._given.reference
        series, along_axes = log_series(reference, heard)
        if series.time_s.size >= _ENOUGH:
            self._interval_s = series.interval_s
        if along_axes and heard.heading is not None:
            # the heading is the INS's own: the damped one turns the log
            reference = reference.model_copy(update={"frame": "body"})
        errors = log_errors(reference, heard, wide, start_s, span_s)
        self._body_frame = errors.body_frame
        return errors

    def _take(self, log: ReferenceErrors, begin: float, last_s: float) -> None:
        """Keep the newest reading that the laws have taken."""
        taken = np.flatnonzero(log.time_s <= last_s + 1e-9)
        if taken.size:
            place = int(taken[-1])
            error = float(log.error[place, 0]), float(log.error[place, 1])
            self._held = _Epoch(begin + float(log.time_s[place]), error, bool(log.valid[place]))


def _since(heard: Recording, time_s: float) -> Recording:
    """What was heard from a time on."""
    if not math.isfinite(time_s):
        return heard
    parts: dict[str, Series] = {}
    for name, one in heard.quantities().items():
        first = int(np.searchsorted(one.time_s, time_s - 1e-6))
        if first < one.time_s.size:
            arrays = (array[first:].copy() for array in (one.time_s, one.values, one.valid))
            times, values, valid = arrays
            parts[name] = replace(one, time_s=times, values=values, valid=valid)
    return Recording(**parts, sources=heard.sources, deviations={})


def _has_log(heard: Recording) -> bool:
    return heard.water is not None or heard.ground is not None


def _held_log(log: ReferenceErrors, time_s: np.ndarray) -> np.ndarray:
    newest = np.searchsorted(log.time_s, time_s + 1e-9, side="right") - 1
    known = np.maximum(newest, 0)
    valid = (newest >= 0) & log.valid[known] & (time_s - log.time_s[known] <= log.hold_s)
    return np.where(valid[:, None], log.error[known], np.nan)
