"""From uploaded files to a run on a ship's own INS, and what it says in one sentence."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import Any

from navcore.engine.environment import start_utc
from navcore.engine.measures import measure
from navcore.engine.run import MethodRun, Run
from navcore.foundation.answers import number
from navcore.foundation.text import Text
from navcore.foundation.units import DEG, HOUR
from navcore.io.recording import load
from navcore.motion.truth import LAT, LON
from navcore.quantities import limit_unit
from navcore.scenario.model import Scenario
from navcore.sensors.recorded import recorded_window
from schuler_bench.session.recordings import MOST_ROWS
from schuler_bench.session.uploads import Uploads

JUDGED = {
    "position_max_m": (Text("largest position error"), "m"),
    "position_final_m": (Text("position error at the end"), "m"),
    "velocity_max_mps": (Text("largest velocity error"), "m/s"),
    "velocity_rms_mps": (Text("velocity error RMS"), "m/s"),
    "heading_max_arcmin": (Text("largest heading error"), "arcmin"),
}
"""Quantities by which the best method is named, with their words and units; the first at once."""
METHODS: tuple[dict[str, Any], ...] = (
    {"name": "unity2", "damping": "external", "network": {"id": "unity2", "zeta": 0.5}},
    {"name": "complementary", "damping": "external", "network": {"id": "complementary"}},
    {
        "name": "unity2, whole",
        "damping": "external",
        "network": {"id": "unity2", "zeta": 0.5},
        "azimuth": {"id": "unity2", "zeta": 0.5},
    },
    {
        "name": "compass",
        "damping": "external",
        "network": {"id": "compass", "sigma": 0.0025, "xi": 0.7},
    },
)
"""Four ways to damp an INS; as it ran it stands before them."""
_OF_REFERENCE = re.compile(r"truth|gnss|gps|rtk|ppp|ref", re.IGNORECASE)
_OF_INS = re.compile(r"ins(?!t)|imu|nav|phins|seapath|posmv", re.IGNORECASE)


@dataclass(frozen=True)
class Taken:
    """What uploaded files are taken for, by their names.

    Attributes
    ----------
    ins : tuple of str
        Output of the INS; empty where no file holds positions.
    log : tuple of str
        Speed log.
    truth : tuple of str
        Reference.
    """

    ins: tuple[str, ...] = ()
    log: tuple[str, ...] = ()
    truth: tuple[str, ...] = ()

    @property
    def missing(self) -> str:
        """What is still needed; empty where the files suffice."""
        if not self.ins:
            return Text("Still needed: the output of the INS, with latitude and longitude.")
        if not self.log:
            return Text("Still needed: the speed log.")
        return ""

    def exchanged(self) -> Taken:
        """Return the same with output and reference exchanged."""
        return Taken(self.truth, self.log, self.ins)


def taken(uploads: Uploads) -> Taken:
    """Say what each file is taken for.

    A file with positions is an INS's output or a reference; of two the one whose name says so, else the one
    with a heading, else the one that gives positions more often, is the INS. What holds speeds along the
    ship's axes, or speeds and no position, is the log; a heading beside positions belongs to the INS. A file
    with all of it is both.
    """
    held = {name: one.quantities for name, one in uploads.files.items() if not one.faults}
    placed = [name for name, quantities in held.items() if "position" in quantities]
    logs = [name for name, quantities in held.items() if quantities & {"water", "ground"}]
    whole = [name for name in logs if name in placed]
    logs = logs or [name for name, found in held.items() if "velocity" in found and name not in placed]
    placed = [name for name in placed if name not in logs]
    if not placed and not whole:
        return Taken((), tuple(logs))
    if not placed:  # one file holds it all, as where all instruments are on one line
        return Taken(tuple(whole[:1]), tuple(logs))

    def rank(name: str) -> tuple[bool, bool, bool, float]:
        position = load(uploads.files[name].path).position
        interval_s = math.inf if position is None else position.interval_s
        named, other = _OF_INS.search(name), _OF_REFERENCE.search(name)
        return other is not None, named is None, "heading" not in held[name], interval_s

    first, *others = sorted(placed, key=rank)
    turned = [name for name, found in held.items() if "heading" in found and name not in (*placed, *logs)]
    return Taken((first, *([] if "heading" in held[first] else turned)), tuple(logs), tuple(others[:1]))


def own_scenario(uploads: Uploads, roles: Taken) -> tuple[Scenario, list[str]]:
    """Make the scenario of four ways to damp the INS.

    Parameters
    ----------
    uploads : Uploads
        With the files.
    roles : Taken
        What they are; nothing is missing.

    Returns
    -------
    Scenario, and in words what was done.

    Raises
    ------
    InputError
        The recordings share no time, or cannot serve.
    """

    def paths(names: tuple[str, ...]) -> list[str]:
        return [str(uploads.files[name].path) for name in names]

    data: dict[str, Any] = {
        "title": Text("My ship's INS"),
        "source": ", ".join((*roles.ins, *roles.log, *roles.truth))[:300],
        "ins": {"file": paths(roles.ins)},
        "reference": {"kind": "file", "file": paths(roles.log)},
        "method": [dict(one) for one in METHODS],
    }
    if roles.truth:
        data["truth"] = {"file": paths(roles.truth)}
    parsed = Scenario.parse(data)
    window = recorded_window(parsed.motion, parsed.reference)
    assert window is not None
    span_s = math.floor(window.span_s)
    data["run"] = {
        "duration_h": span_s / HOUR,
        "output_step_s": float(max(10, math.ceil(span_s / MOST_ROWS))),
    }
    start = parsed.motion.truth(1, 1.0, parsed.site.site(), parsed.earth, start_utc(parsed)).values[0]
    lat_deg, lon_deg = float(start[LAT]) / DEG, float(start[LON]) / DEG
    data["site"] = {"lat_deg": round(lat_deg, 6), "lon_deg": round((lon_deg + 180.0) % 360.0 - 180.0, 6)}
    told = Text(
        "Damping is laid on the INS's output, {hours:.1f} h of it, from outside.", hours=span_s / HOUR
    )
    return Scenario.parse(data), [told]


def best(run: Run, key: str) -> MethodRun | None:
    """Best damped method of a run on ``[ins]`` by a quantity; without a reference what moves the output most.

    None where there is no damped method.
    """
    damped = [one for one in run.methods if one.status == "ok" and one.method.kind.uses_network]
    if run.against is None or not damped:
        return None
    if run.against.recorded is None:
        return max(damped, key=_moved_m)
    return min(damped, key=lambda one: measure(one, key))


def sentence(run: Run, key: str) -> str:
    """Say in one sentence what damping would have changed.

    Parameters
    ----------
    run : Run
        On ``[ins]``.
    key : str
        One of `JUDGED`: by what the best method is chosen.
    """
    against, most = run.against, best(run, key)
    if against is None or most is None:
        return ""
    if against.recorded is None:
        return Text(
            "No reference was given: {method} would have moved the position by up to {moved:.0f} m. A GNSS "
            "file would tell whether nearer to the truth.",
            method=most.method.name,
            moved=_moved_m(most),
        )
    unit = limit_unit(key)
    before = measure(against.recorded, key) / unit
    value = measure(most, key) / unit
    quantity, shown = JUDGED[key]
    if not math.isfinite(before) or not math.isfinite(value):
        return Text("The reference does not tell the {quantity}: choose another.", quantity=quantity)
    if value >= before:
        return Text(
            "No method would have been better than the INS as recorded: {quantity} {before} {unit}, "
            "with {method} {value} {unit}.",
            quantity=quantity,
            before=number(before, 3),
            unit=shown,
            method=most.method.name,
            value=number(value, 3),
        )
    return Text(
        "With {method} the {quantity} would have been {value} {unit} in place of {before} {unit}: "
        "{share:.0f} % less.",
        method=most.method.name,
        quantity=quantity,
        value=number(value, 3),
        unit=shown,
        before=number(before, 3),
        share=100.0 * (1.0 - value / before),
    )


def _moved_m(one: MethodRun) -> float:
    return one.errors["position_m"]["max_abs"]


def described(uploads: Uploads, roles: Taken) -> list[tuple[str, str]]:
    """Return each part with the files that are taken for it, in words."""
    parts = (
        (Text("output of the INS"), roles.ins),
        (Text("speed log"), roles.log),
        (Text("reference"), roles.truth),
    )
    return [(what, ", ".join(names) or "-") for what, names in parts if uploads.files]
