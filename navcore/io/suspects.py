"""Readings that an instrument cannot mean: values that stand still, and spikes alone or in runs."""

import numpy as np

from navcore.foundation.earth import WGS84
from navcore.foundation.text import Text
from navcore.foundation.units import DEG
from navcore.io.series import Recording, Series, utc_text

LONGEST_STILL_S = 300.0
"""A value that stays the very same for longer is stuck,"""
STILL_RATIO = 10.0
"""... if it never did for a tenth of that time otherwise: a coarse instrument often repeats itself."""
SLOWEST_S = 300.0
"""Between the samples of a log, a gyro or a receiver; more is told."""
FASTEST_LOG_S = 0.02
_LARGEST_STEP = {"water": 2.5, "ground": 2.5, "velocity": 5.0, "heading": 20.0 * DEG}
"""m/s and rad from one sample to the next, which no ship does; also the size of a spike."""
_LONGEST_SPIKE = 15
"""Samples; a longer run is no spike."""
_FASTEST_MPS, _FAR_M = 60.0, 300.0
"""A step between positions that is longer than this way is none of a ship."""
_MOST_RUNS = 5
_STILL_S, _FEWEST_STILL, _STILL_STEP_M = 10.0, 8, 30.0
_TIMES_USUAL, _SLOWEST_MPS = 8.0, 0.5
"""Positions stand still while the ship moves: for so long and so many, before a step so long and so fast."""
_LONGEST_RUN_S, _CLOSE_S, _MOST_STEPS = 600.0, 5.0, 2000
"""Of a heading that is far off between two steps, each from one sample to the next no later than this."""
_NAMES = {
    "water": Text("speed through water"),
    "ground": Text("speed over ground along axes"),
    "velocity": Text("velocity over ground (E, N)"),
    "heading": "heading",
}


def suspect_warnings(recording: Recording) -> list[str]:
    """Say which readings of speeds and heading are stuck or spikes, when, and what to do about them."""
    words: list[str] = []
    for name, series in recording.quantities().items():
        if name in ("water", "ground") and 0.0 < series.interval_s < FASTEST_LOG_S:
            words.append(
                Text(
                    "{name}: {rate:.4g} samples a second are many for a log: is the time in minutes?",
                    name=_NAMES[name],
                    rate=1.0 / series.interval_s,
                )
            )
        if name in _LARGEST_STEP and series.interval_s > SLOWEST_S:
            words.append(
                Text(
                    "{name}: one sample in {interval:.4g} s is slow: is the time in ms, or in another unit?",
                    name=_NAMES[name],
                    interval=series.interval_s,
                )
            )
        if name == "position":
            words += place_words(series)
        if name not in _LARGEST_STEP or np.count_nonzero(series.valid) < 3 * _LONGEST_SPIKE:
            continue
        kept = np.flatnonzero(series.valid)
        values = series.values[kept]
        if name == "heading":
            values = np.unwrap(values, axis=0)
        spikes = _spikes(values, _LARGEST_STEP[name])
        if name == "heading":
            spikes = np.union1d(spikes, _turned_runs(series.time_s[kept], values[:, 0]))
        spikes = kept[spikes]
        if spikes.size:
            words.append(
                Text.plural(
                    "{name}: {count} sample at {when} is far from its neighbours: leave the row out",
                    "{name}: {count} samples from {when} are far from their neighbours: leave the rows out",
                    name=_NAMES[name],
                    count=int(spikes.size),
                    when=_when(series, spikes[0], spikes[-1]),
                )
            )
        begin, end = _still(series.time_s[kept], values)
        if end > begin:
            words.append(
                Text(
                    "{name}: the very same value from {when}: stuck? Leave these rows out",
                    name=_NAMES[name],
                    when=_when(series, kept[begin], kept[end]),
                )
            )
    return words


def place_words(series: Series) -> list[str]:
    """Say which runs of positions are none of a ship: those that she does not get to, and those that stand.

    Parameters
    ----------
    series : Series
        Latitude and longitude, rad.

    Returns
    -------
    list of str
        What is wrong with each run, with its times; at most five.
    """
    apart, still = _places_apart(series), _still_places(series)
    words = [_told_apart(series, *run) for run in apart] + [_told_still(series, *run) for run in still]
    return words[:_MOST_RUNS]


def _places_apart(series: Series) -> list[tuple[int, int]]:
    """First and last of the runs of positions that no ship gets to from the others, be they at the ends."""
    far = np.flatnonzero(_far_steps(series.values, _since_a_change(series)))
    if far.size == 0:
        return []
    bounds = np.concatenate([[0], far + 1, [series.time_s.size]])
    runs = list(zip(bounds[:-1].tolist(), (bounds[1:] - 1).tolist(), strict=True))
    longest = int(np.argmax(np.diff(bounds)))
    return [*_beyond(series, runs[longest::-1], -1)[::-1], *_beyond(series, runs[longest:], 1)]


def _since_a_change(series: Series) -> np.ndarray:
    """Time of each position, s, but that of the first of those that are the very same: a ship went on."""
    changed = np.concatenate([[True], (np.diff(series.values[:, :2], axis=0) != 0.0).any(axis=1)])
    begin = series.time_s[np.maximum.accumulate(np.where(changed, np.arange(changed.size), 0))]
    return np.stack([begin, series.time_s])


def _still_places(series: Series) -> list[tuple[int, int]]:
    """First and last of the runs of positions that stand until they step to where the ship has got to."""
    begin, time_s = _since_a_change(series)
    if time_s.size < _FEWEST_STILL:
        return []
    ways, step_s = _ways(series.values), np.diff(time_s)
    stood_s = time_s[:-1] - begin[:-1]
    usual = float(np.median(ways / step_s))
    late = (stood_s > np.maximum(_STILL_S, _FEWEST_STILL * step_s)) & (ways > _STILL_STEP_M)
    late &= (ways / step_s > _TIMES_USUAL * usual) & (usual > _SLOWEST_MPS)
    places = np.flatnonzero(late)
    return [(int(np.searchsorted(time_s, begin[at])), int(at)) for at in places]


def _beyond(series: Series, runs: list[tuple[int, int]], way: int) -> list[tuple[int, int]]:
    """Runs of positions on one way from the first of them that a ship does not get to from those before."""
    ends = runs[0]
    found: list[tuple[int, int]] = []
    for run in runs[1:]:
        pair = np.array([ends[1], run[0]] if way > 0 else [run[1], ends[0]])
        if not _far_steps(series.values[pair], np.stack([series.time_s[pair]] * 2)).any():
            ends = run
        elif found and abs(run[0 if way > 0 else 1] - found[-1][1 if way > 0 else 0]) == 1:
            found[-1] = (found[-1][0], run[1]) if way > 0 else (run[0], found[-1][1])
        else:
            found.append(run)
    return found


def _told_still(series: Series, first: int, last: int) -> str:
    return Text(
        "positions: {count} from {when} are the very same though the ship moves, and the next one lies "
        "{off:.0f} m on: leave the rows out",
        count=last - first + 1,
        when=_when(series, first, last),
        off=float(_ways(series.values[[last, last + 1]])[0]),
    )


def _told_apart(series: Series, first: int, last: int) -> str:
    off = _ways(series.values[[first - 1, first] if first else [last, last + 1]])[0] / 1000.0
    count, when = last - first + 1, _when(series, first, last)
    if first and last + 1 < series.time_s.size:
        return Text(
            "positions: {count} from {when} lie {off:.3g} km from those before and after, farther than a "
            "ship gets: leave the rows out",
            count=count,
            when=when,
            off=off,
        )
    return Text(
        "positions: {count} from {when}, at an end of the recording, lie {off:.3g} km from those beside "
        "them, farther than a ship gets: leave the rows out",
        count=count,
        when=when,
        off=off,
    )


def _ways(places: np.ndarray) -> np.ndarray:
    """Distances of neighbouring latitudes and longitudes, shape (n, k), in m."""
    meridian, prime_vertical = WGS84.radii(float(places[0, 0]))
    north, east = np.diff(places[:, 0]), (np.diff(places[:, 1]) + np.pi) % (2.0 * np.pi) - np.pi
    return np.hypot(meridian * north, prime_vertical * np.cos(places[1:, 0]) * east)


def _far_steps(places: np.ndarray, times_s: np.ndarray) -> np.ndarray:
    """Which steps are longer than a ship gets from the first time of a place to the second of the next."""
    return _ways(places) > _FAR_M + _FASTEST_MPS * (times_s[1, 1:] - times_s[0, :-1])


def _when(series: Series, first: int, last: int) -> str:
    ends = [utc_text(series.time_s[i]) if series.dated else f"{series.time_s[i]:g} s" for i in (first, last)]
    return ends[0] if first == last else Text("{first} to {last}", first=ends[0], last=ends[1])


def _spikes(values: np.ndarray, largest: float) -> np.ndarray:
    """Places of the samples, shape (n, k), that lie between a step away and a step back."""
    if not (np.abs(np.diff(values, axis=0)) > largest).any():
        return np.empty(0, dtype=int)
    from scipy.ndimage import median_filter

    middle = median_filter(values, size=(4 * _LONGEST_SPIKE + 1, 1), mode="nearest")
    far = (np.abs(values - middle) > largest).any(axis=1)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], far, [False]])))
    runs = edges.reshape(-1, 2)
    steps = np.abs(np.diff(values, axis=0)).max(axis=1)
    found = [
        np.arange(begin, end)
        for begin, end in runs
        if end - begin <= _LONGEST_SPIKE
        and (begin == 0 or steps[begin - 1] > largest)
        and (end == len(values) or steps[end - 1] > largest)
    ]
    return np.concatenate(found) if found else np.empty(0, dtype=int)


def _turned_runs(time_s: np.ndarray, heading: np.ndarray) -> np.ndarray:
    """Places of the headings, shape (n,), that step away and back farther than the ship turns meanwhile."""
    turns = (np.diff(heading) + np.pi) % (2.0 * np.pi) - np.pi
    steps = np.flatnonzero((np.abs(turns) > _LARGEST_STEP["heading"]) & (np.diff(time_s) <= _CLOSE_S))
    if steps.size > _MOST_STEPS:
        return np.empty(0, dtype=int)
    found: list[np.ndarray] = []
    after = 0
    for out, back in zip(steps[:-1].tolist(), steps[1:].tolist(), strict=True):
        between = abs((heading[back + 1] - heading[out] + np.pi) % (2.0 * np.pi) - np.pi)
        if out < after or time_s[back] - time_s[out] > _LONGEST_RUN_S:
            continue
        if between < 0.5 * min(abs(turns[out]), abs(turns[back])):
            found.append(np.arange(out + 1, back + 1))
            after = back + 1
    return np.concatenate(found) if found else np.empty(0, dtype=int)


def _still(time_s: np.ndarray, values: np.ndarray) -> tuple[int, int]:
    """First and last sample of the longest time without any change; both 0 where it is not remarkable."""
    changes = np.concatenate([[0], 1 + np.flatnonzero((np.diff(values, axis=0) != 0.0).any(axis=1))])
    ends = np.append(changes[1:], len(values)) - 1
    spans = time_s[ends] - time_s[changes]
    longest = int(np.argmax(spans))
    second = float(np.delete(spans, longest).max(initial=0.0))
    if changes.size < 2 or spans[longest] < LONGEST_STILL_S or spans[longest] < STILL_RATIO * second:
        return 0, 0
    if not np.any(values[changes[longest]]):
        return 0, 0  # a ship that lies still
    return int(changes[longest]), int(ends[longest])
