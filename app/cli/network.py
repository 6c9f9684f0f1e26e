"""``schuler network``: one network's H(s), its closed loop and the whole system on the textbook sphere."""

import math
from dataclasses import dataclass
from typing import Annotated, Any

from tyro.conf import Positional, arg

from navcore.foundation.answers import columns, number
from navcore.foundation.units import UNITS
from schuler_bench.cli.terminal import emit_result


@dataclass(frozen=True)
class NetworkCommand:
    """Show a damping network: H(s), one channel's closed loop, and the whole system at a latitude.

    Attributes
    ----------
    network : str
        As in a scenario, e.g. 'id = "compass", sigma = 0.0088, xi = 0.7'.
    lat : float
        Latitude of the whole system, deg.
    log_period_s : float
        Time between two samples of the log, s: checks the sampled law with the log held as well; 0: no check.
    law_step_s : float
        Time between two calls of the damping law, s; counts with --log-period-s.
    azimuth : str
        Network of the azimuth channel, with the Earth's rate for its Schuler frequency; empty: none.
    margins : bool
        Show the margins of the open loop too: gain, phase and delay, and the disk margin.
    json : bool
        Print one JSON document.
    """

    network: Annotated[Positional[str], arg(metavar="NETWORK")]
    lat: Annotated[float, arg(metavar="DEG")] = 45.0
    log_period_s: Annotated[float, arg(metavar="S")] = 0.0
    law_step_s: Annotated[float, arg(metavar="S")] = 1.0
    azimuth: Annotated[str, arg(metavar="NETWORK")] = ""
    margins: bool = False
    json: bool = False

    def execute(self) -> int:
        """Print the report; 0, also for an unstable loop, which it says."""
        from navcore.analysis.report import network_report
        from navcore.networks import parse_network

        parameters = parse_network(self.network)
        log_period_s = self.log_period_s or None
        azimuth = parse_network(self.azimuth, "--azimuth") if self.azimuth else None
        report = network_report(parameters, self.lat, log_period_s, self.law_step_s, self.margins, azimuth)
        emit_result(self.json, report, lambda: network_text(report))
        return 0


def network_text(report: dict[str, Any]) -> list[str]:
    """Lines for people; rates in rad/s and in units of the Schuler frequency."""
    from navcore.foundation.earth import SPHERE

    omega_s = report.get("omega_s_rad_s", SPHERE.schuler_frequency(0.0))
    place = "where it was designed" if "omega_s_rad_s" in report else "on the sphere"
    settling = report["settling_s"]
    rows = [
        ["numerator", *(number(c, 6) for c in report["num"])],
        ["denominator", *(number(c, 6) for c in report["den"])],
    ]
    if "feedback_num" in report:
        rows.append(["velocity feedback", *(number(c, 6) for c in report["feedback_num"])])
    width = max(len(row) for row in rows)
    rows = [[row[0], *[""] * (width - len(row)), *row[1:]] for row in rows]
    facts = [
        ["H(0)", number(report["h0"], 6), ""],
        ["gain", number(report["gain"], 6), ""],
        ["stable", "yes" if report["stable"] else "NO", ""],
        ["damping ratio", number(report["damping_ratio"]), ""],
        ["natural frequency", number(report["natural_frequency_rad_s"]), "rad/s"],
        ["settling (2 %)", *(("never", "") if settling is None else (number(settling), "s"))],
        ["worst tilt", *_bound(report["worst_tilt_rad_per_mps"], UNITS["arcsec"], "arcsec")],
        ["worst velocity error", *_bound(report["worst_velocity_per_mps"], 1.0, "m/s")],
    ]
    lines = [f"{report['id']} {place}, ωₛ = {omega_s:.6g} rad/s", "", *columns(rows), ""]
    for key, title in (("zeros", "zeros"), ("poles", "poles"), ("closed_loop_poles", "closed loop")):
        lines += columns([[title, "rad/s", "/ ωₛ"], *_roots(report[key], omega_s)]) + [""]
    lines += [*columns(facts), "", *_whole_system(report)]
    if "margins" in report:
        lines += ["", *_margins(report["margins"])]
    if "two_channel" in report:
        lines += ["", *_two_channel(report["two_channel"], report["lat_deg"])]
    return lines + ([""] if report["warnings"] else []) + [f"warning: {text}" for text in report["warnings"]]


def _bound(value: float | None, size: float, unit: str) -> tuple[str, str]:
    """Write the largest error for a log within 1 m/s."""
    return ("no bound", "") if value is None else (number(value / size), f"{unit}, log within 1 m/s")


def _whole_system(report: dict[str, Any]) -> list[str]:
    """Both channels, heading and latitude at one latitude."""
    from navcore.analysis.whole_system import duration

    growth = report["earth_mode_growth_per_s"]
    if growth == 0.0:
        mode = "neither grows nor decays"
    else:
        mode = f"{'GROWS' if growth > 0.0 else 'decays'}, e-folding time {duration(1.0 / growth)}"
    slope, slow = report["h_slope_s"], report["slow_mode_natural_frequency_rad_s"]
    ratio = report["slow_mode_damping_ratio"]
    return [
        f"whole system at latitude {report['lat_deg']:g}° (--lat sets it)",
        *columns(
            [
                ["H'(0)", number(slope), "" if slope is None else "s"],
                ["stable", "yes" if report["whole_system_stable"] else "NO", ""],
                ["24 h mode", mode, ""],
                ["slow oscillation", *(("none", "") if slow is None else (number(slow), "rad/s"))],
                ["its damping ratio", "" if slow is None else number(ratio), ""],
            ]
        ),
    ]


def _margins(margins: dict[str, float | None] | None) -> list[str]:
    """List how far the open loop may change before the loop becomes unstable."""
    title = "margins of the open loop ωₛ² H/s²"
    if margins is None:
        return [title, "none: the loop is undamped or unstable"]

    def margin(name: str, scale: float = 1.0) -> str:
        value = margins[name]
        return "no limit" if value is None else number(value * scale)

    degrees = 180.0 / math.pi
    return [
        title,
        *columns(
            [
                ["gain up", margin("gain_up"), "times"],
                ["gain down", margin("gain_down"), "times"],
                ["phase", margin("phase_rad", degrees), "°"],
                ["delay", margin("delay_s"), "s"],
                ["disk margin: gain", margin("disk_gain"), "times"],
                ["disk margin: phase", margin("disk_phase_rad", degrees), "°"],
            ]
        ),
    ]


def _two_channel(found: dict[str, Any] | None, lat_deg: float) -> list[str]:
    """List what the network leaves on both channels, and what the optimum of both would."""
    title = f"steady errors of both channels at latitude {lat_deg:g}°, standard deviations"
    if found is None:
        return [title, "none: the optimum of both channels does not exist for these figures"]
    units = UNITS["arcsec"], UNITS["arcsec"], UNITS["arcmin"], 1.0, 1.0
    rows = [
        ["", "tilt E", "tilt N", "heading", "velocity E", "N"],
        ["", *["arcsec"] * 2, "arcmin", *["m/s"] * 2],
    ]
    for key, words in (
        ("floor", "floor"),
        ("both_channels", "optimum of both channels"),
        ("one_channel", "this network on each"),
    ):
        values = found[key]
        if values is None:
            rows.append([words, "no steady state", "", "", "", ""])
        else:
            sizes = zip(values.values(), units, strict=True)
            rows.append([words, *(number(value / unit) for value, unit in sizes)])
    return [title, *columns(rows)]


def _roots(roots: list[list[float]], omega_s: float) -> list[list[str]]:
    rows = [["", _complex(re, im), _complex(re / omega_s, im / omega_s)] for re, im in roots]
    return rows or [["", "none", ""]]


def _complex(re: float, im: float) -> str:
    return number(re) if im == 0.0 else f"{number(re)} {'+' if im > 0 else '-'} {number(abs(im))}j"
