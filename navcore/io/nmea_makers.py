"""Makers' own sentences, decoded to SI by the places of their fields: attitude, and what an INS gives out."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from navcore.foundation.units import DEG
from navcore.io import nmea_values as value
from navcore.io.nmea_fields import Fields
from navcore.io.nmea_flags import flag_of

OTHER_MESSAGE, ABOUT_OTHERS = 1, 2
"""Roles of sentences that are no readings: another message of a maker, one that speaks of others."""
Decoded = dict[str, Any]
"""By name: values of the fields, shape (n,) or (n, k); see `Readings`. ``flags`` are those of the whole
sentence."""
Decoder = Callable[[Fields], Decoded]


def _pashr(fields: Fields) -> Decoded:
    """Attitude of Applanix and others: ``PASHR,hhmmss.sss,heading,T,roll,pitch,...``; others say nothing."""
    time_s = fields.of(value.makers_time, 0)
    attitude = (fields.count >= 5) & fields.are(2, "T") & ~np.isnan(time_s)
    return {
        "role": np.where(attitude, 0, OTHER_MESSAGE),
        "flags": np.where(attitude, fields.codes(flag_of("PASHR", 9), flag_of("PASHR", 10)), 0),
        "time_of_day": np.where(attitude, time_s, math.nan),
        "heading": np.where(attitude, fields.headings(1), math.nan),
        "attitude": _attitude(fields, 4, 3, attitude),
        "heading_sigma": _sigma(fields, (8,), attitude, DEG)[:, 0],
        "attitude_sigma": _sigma(fields, (7, 6), attitude, DEG),
    }


def _psat(fields: Fields) -> Decoded:
    """Attitude of Hemisphere's compasses: ``PSAT,HPR,time,heading,pitch,roll,N``; others say nothing."""
    attitude = fields.are(0, "HPR")
    return {
        "role": np.where(attitude, 0, OTHER_MESSAGE),
        "flags": np.where(attitude, fields.codes(flag_of("PSAT,HPR", 5)), 0),
        "time_of_day": np.where(attitude, fields.of(value.makers_time, 1), math.nan),
        "heading": np.where(attitude, fields.headings(2), math.nan),
        "attitude": _attitude(fields, 3, 4, attitude),
    }


def _psxn(fields: Fields) -> Decoded:
    """Attitude of a Seapath, ``PSXN,23,roll,pitch,heading,heave``; ``PSXN,20`` before it flags it."""
    attitude, quality = fields.are(0, "23"), fields.are(0, "20")
    told = fields.codes(flag_of("PSXN,20", 3))
    flags = np.zeros(fields.count.size, np.int8)
    sources = fields.sources
    for source in set(sources):
        own = np.flatnonzero([source == one for one in sources])
        last = np.maximum.accumulate(np.where(quality[own], np.arange(own.size), -1))
        of_own = np.where(last >= 0, told[own[last]], fields.carried.get(source, 0))
        fields.carried[source] = int(of_own[-1])
        flags[own] = of_own
    return {
        "role": np.where(attitude, 0, np.where(quality, ABOUT_OTHERS, OTHER_MESSAGE)),
        "flags": np.where(attitude, flags, 0),
        "heading": np.where(attitude, fields.headings(3), math.nan),
        "attitude": _attitude(fields, 2, 1, attitude),
    }


def _phoct(fields: Fields) -> Decoded:
    """Attitude of Octans and PHINS, ``PHOCT,01,time,T,00,heading,T,...``; its clock may not be UTC."""
    return {
        "flags": fields.codes(flag_of("PHOCT", 5)),
        "time_of_day": np.where(fields.are(2, "T"), fields.of(value.makers_time, 1), math.nan),
        "heading": fields.headings(4),
    }


def _phinf(fields: Fields) -> Decoded:
    """Status of Octans and PHINS, which speaks of their HEHDT (`_status_of_others`)."""
    return {"role": np.full(fields.count.size, ABOUT_OTHERS)}


def _prdid(fields: Fields) -> Decoded:
    """Attitude as RD Instruments has it: ``PRDID,pitch,roll,heading``."""
    given = np.ones(fields.count.size, bool)
    return {"heading": fields.headings(2), "attitude": _attitude(fields, 0, 1, given)}


def _pixse(fields: Fields) -> Decoded:
    """Output of an iXblue (Exail) INS beside its HDT: ``PIXSE,POSITI``, ``SPEED_``, ``ATITUD``, ``TIME__``.

    Roll counts port up and pitch bow down in it. ``STDHRP``, ``STDPOS`` and ``STDSPD`` are their standard
    deviations. Other messages of the family are passed over.
    """
    names = ("POSITI", "SPEED_", "ATITUD", "TIME__", "STDHRP", "STDPOS", "STDSPD")
    placed, moving, leaning, timed, turning_std, place_std, speed_std = (
        fields.are(0, name) for name in names
    )
    lat, lon = (fields.numbers(place, -most, most) for place, most in ((1, 90.0), (2, 360.0)))
    position = np.column_stack([lat * DEG, lon * DEG, fields.numbers(3, -1e4, 1e5)])
    velocity = np.column_stack([fields.speeds(place, 1.0) for place in (1, 2)])
    with np.errstate(invalid="ignore"):
        attitude = _attitude(fields, 2, 1, leaning) * (-1.0, 1.0)
    told = placed | moving | leaning | timed | turning_std | place_std | speed_std
    return {
        "role": np.where(told, 0, OTHER_MESSAGE),
        "time_of_day": np.where(timed, fields.of(value.makers_time, 1), math.nan),
        "position": np.where(placed[:, None], position, math.nan),
        "velocity": np.where(moving[:, None], velocity, math.nan),
        "attitude": attitude,
        "position_sigma": _sigma(fields, (1, 2), place_std, 1.0),
        "velocity_sigma": _sigma(fields, (1, 2), speed_std, 1.0),
        "heading_sigma": _sigma(fields, (1,), turning_std, DEG)[:, 0],
        "attitude_sigma": _sigma(fields, (3, 2), turning_std, DEG),
    }


def _sigma(fields: Fields, places: tuple[int, ...], given: np.ndarray, unit: float) -> np.ndarray:
    """Standard deviations of the fields at some places, SI, shape (n, k); NaN where one is missing."""
    values = np.column_stack([fields.numbers(place, 0.0, 1e6) for place in places])
    whole = given & np.isfinite(values).all(axis=1)
    return np.where(whole[:, None], values * unit, math.nan)


def _attitude(fields: Fields, pitch: int, roll: int, given: np.ndarray) -> np.ndarray:
    """Pitch (bow up) and roll (starboard down) of the fields at two places, rad; NaN where one is missing."""
    degrees = np.column_stack([fields.numbers(pitch, -90.0, 90.0), fields.numbers(roll, -180.0, 180.0)])
    whole = given & ~np.isnan(degrees).any(axis=1)
    return np.where(whole[:, None], degrees * DEG, math.nan)


MAKERS: dict[str, Decoder] = {
    "PASHR": _pashr, "PHINF": _phinf, "PHOCT": _phoct, "PIXSE": _pixse,
    "PRDID": _prdid, "PSAT": _psat, "PSXN": _psxn,
}  # fmt: skip
"""Decoders of makers' own sentences, by the whole address."""
