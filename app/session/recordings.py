"""From the uploaded recordings of a session to a scenario that runs on them."""

import math
from pathlib import Path

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.foundation.units import DEG, HOUR
from navcore.motion.truth import LAT, LON
from navcore.scenario.model import Scenario
from schuler_bench.session.uploads import IMU, Uploads

_ALIGNED_S = 600.0
_ALIGNED_PART = 0.5
"""Of a short IMU record, that is at most spent on the alignment."""
MOST_ROWS = 50_000
"""Output rows of a run on a recording; one for each step of a long one takes gigabytes."""
_SPEEDS = ("water", "ground", "velocity")


def recorded_scenario(scenario: Scenario, uploads: Uploads) -> tuple[Scenario, list[str]]:
    """Let a scenario run on the uploaded recordings.

    A log among them becomes the reference; positions and heading become the motion, and the site is set to
    the track's start. The duration is set to the time that all of them share.

    Parameters
    ----------
    scenario : Scenario
        Its methods, sensors and initial errors are kept.
    uploads : Uploads
        At least one file.

    Returns
    -------
    Scenario, and in words what was changed.

    Raises
    ------
    InputError
        The recordings share no time, or cannot be used.
    """
    from navcore.sensors.recorded import recorded_window

    if uploads.holding(IMU):
        return _on_recorded_imu(scenario, uploads)
    data, notes = scenario.canonical(), []
    for block in ("ins", "truth"):
        data.pop(block, None)
    speeds = uploads.holding(*_SPEEDS)
    if uploads.holding("position") and uploads.holding("heading"):
        data["motion"] = {"kind": "track", "file": uploads.holding("position", "heading", "attitude")}
        notes.append(Text("The ship follows the uploaded track and heading."))
    elif uploads.holding("position", "heading"):
        missing = "heading" if uploads.holding("position") else Text("track (positions)")
        notes.append(
            Text("The track is not used yet: a {missing} is missing. Upload it too.", missing=missing)
        )
    # A speed log proper has speeds along the ship's axes; a receiver has its course and speed.
    logs = uploads.holding("water", "ground") or speeds
    if logs:
        kept = {k: v for k, v in data["reference"].items() if k in ("event", "outage")}
        data["reference"] = {"kind": "file", "file": logs, **kept, "frame": "body"}
        notes.append(
            Text(
                "The reference is the uploaded log {name}.",
                name=Text.joined(", ", (Path(path).name for path in logs)),
            )
        )
    parsed = Scenario.parse(data)
    window = recorded_window(parsed.motion, parsed.reference)
    if window is None:
        raise InputError(
            Fault("", "upload", None, Text("holds neither a log nor a track with heading: nothing to run on"))
        )
    step_s = parsed.run.step_s
    span_s = math.floor(window.span_s / step_s) * step_s
    data["run"] |= {
        "duration_h": span_s / HOUR,
        "output_step_s": max(
            min(parsed.run.output_step_s, max(step_s, 1.0)), math.ceil(span_s / step_s / MOST_ROWS) * step_s
        ),
    }
    notes.append(Text("The duration is the {span_s:g} s that all uploaded streams share.", span_s=span_s))
    if parsed.motion.recorded:
        start = parsed.motion.truth(1, 1.0, parsed.site.site(), parsed.earth, window.start_s).values[0]
        lat_deg, lon_deg = float(start[LAT]) / DEG, float(start[LON]) / DEG
        data["site"] |= {"lat_deg": round(lat_deg, 6), "lon_deg": round(lon_deg, 6)}
        notes.append(
            Text(
                "The site is the track's start, {lat_deg:.4f}°, {lon_deg:.4f}°.",
                lat_deg=lat_deg,
                lon_deg=lon_deg,
            )
        )
    data["title"], data["source"] = Text("Uploaded recording"), Text.joined(", ", uploads.files)[:300]
    return Scenario.parse(data), notes


def _on_recorded_imu(scenario: Scenario, uploads: Uploads) -> tuple[Scenario, list[str]]:
    """Align and navigate on the newest uploaded IMU record, of a vehicle that stands."""
    name, upload = next((n, u) for n, u in reversed(uploads.files.items()) if IMU in u.quantities)
    data, details = scenario.canonical(), upload.details
    place, span_s = details["place"], float(details["span_s"])
    aligned_s = math.floor(min(_ALIGNED_S, _ALIGNED_PART * span_s))
    data["imu"] = {"file": str(upload.path), "axes": "frd" if details["up_axis"] == "-z" else "rfu"}
    data["motion"], data["reference"] = {"kind": "static"}, {"kind": "log"}
    data["alignment"] = {"kind": "compass", "duration_s": float(aligned_s)}
    data["run"] |= {
        "fidelity": "strapdown",
        "rate_hz": details["rate_hz"],
        "duration_h": math.floor(span_s - aligned_s - 1.0) / HOUR,
        "output_step_s": min(scenario.run.output_step_s, 1.0),
    }
    notes: list[str] = [
        Text(
            "Full strapdown on {name}: {aligned_s} s of alignment, then navigation, with "
            "a log that reads zero: the vehicle is taken to stand.",
            name=name,
            aligned_s=aligned_s,
        )
    ]
    if place is not None:
        data["site"] = place
        notes.append(
            Text(
                "The site is that of the file, {lat_deg:.4f}°, {lon_deg:.4f}°.",
                lat_deg=place["lat_deg"],
                lon_deg=place["lon_deg"],
            )
        )
    data["title"], data["source"] = Text("Recorded IMU"), name[:300]
    return Scenario.parse(data), notes
