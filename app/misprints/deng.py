"""Deng 2019: periods, the network's extra s, and what the printed damping law leaves out."""

import math

import numpy as np

from navcore.foundation.earth import EARTH_RATE, SEMI_MAJOR_AXIS
from navcore.foundation.text import Text
from navcore.foundation.units import ARCSEC, DEG, DEG_PER_HOUR, HOUR, MICRO_G, MINUTE
from navcore.mechanization.recorder import PHI_N, PHI_U
from navcore.networks.compass import CompassNetwork, gains_from_sigma_xi
from schuler_bench.misprints.base import (
    OMEGA_S,
    TIME,
    Axis,
    Comparison,
    Curve,
    Misprint,
    Number,
    as_network,
    run_scenario,
)
from schuler_bench.misprints.two_loops import TwoLoops
from schuler_bench.plots.units import number

_SIGMA, _XI = 0.0088, 0.7
_COMPASS = CompassNetwork(sigma=_SIGMA, xi=_XI)


def _periods() -> Comparison:
    lat = np.arange(5.0, 85.5, 0.5) * DEG
    here = math.sin(32.06 * DEG)
    day = 2.0 * math.pi / EARTH_RATE
    printed_schuler, printed_day = 2.0 * math.pi * OMEGA_S, 2.0 * math.pi / math.sqrt(EARTH_RATE)
    schuler = 2.0 * math.pi / OMEGA_S
    return Comparison(
        x_axis=Axis("latitude", "rad"),
        y_axis=Axis(Text("Foucault period"), "s"),
        x=lat,
        curves=(
            Curve(Text("2π/ωᵢₑ sin(φ) as printed"), "printed", day * np.sin(lat)),
            Curve("2π/(ωᵢₑ sin(φ))", "corrected", day / np.sin(lat)),
        ),
        numbers=(
            Number(Text("Schuler period"), "s", printed_schuler, schuler),
            Number(Text("Earth period"), "s", printed_day, day),
            Number(Text("Foucault period at 32.06°"), "s", day * here, day / here),
        ),
        words=Text(
            "As printed the Schuler period would be {printed_schuler:.4f} s instead of "
            "{schuler:.1f} min, the Earth's {printed_day:.1f} min instead of {day:.1f} "
            "h, and Foucault's would fall towards the equator ({day_2:.1f} h at 32°) "
            "instead of rising ({day_3:.1f} h).",
            printed_schuler=printed_schuler,
            schuler=schuler / MINUTE,
            printed_day=printed_day / MINUTE,
            day=day / HOUR,
            day_2=day * here / HOUR,
            day_3=day / here / HOUR,
        ),
    )


def _extra_s() -> Comparison:
    right = _COMPASS.transfer(OMEGA_S)
    # the s in the denominator is the velocity integrator, counted once more
    loops = TwoLoops(as_network([*right.num_p / OMEGA_S], [*right.den_p, 0.0]), right)
    assert loops.corrected.settling_s is not None
    return loops.compare(
        np.arange(0.0, 901.0, 2.0),
        (Text("with the extra s"), "((1+K₂)s+K₃)/(s+K₁)"),
        (loops.growth, loops.settling),
        Text(
            "Taken as the network, the printed H makes the loop unstable: e-fold in "
            "{growth_s:.0f} s. Without the extra s it settles in {settling_s:.1f} min.",
            growth_s=loops.growth_s,
            settling_s=loops.corrected.settling_s / MINUTE,
        ),
    )


def _radius() -> Comparison:
    k1, k2, k3 = gains_from_sigma_xi(_SIGMA, _XI, OMEGA_S)
    printed = CompassNetwork(k1=k1, k2=k2, k3=k3 * SEMI_MAJOR_AXIS).transfer(OMEGA_S)
    loops = TwoLoops(printed, _COMPASS.transfer(OMEGA_S))
    return loops.compare(
        np.arange(0.0, 10.01, 0.05),
        ("dp = K₃ dv/s", "dp = K₃ dv/(R s)"),
        (loops.growth,),
        Text(
            "A velocity added to an angular rate: the integral gain is {semi_major_axis} "
            "times too large and the loop grows e-fold every {growth_s:.2f} s.",
            semi_major_axis=number(SEMI_MAJOR_AXIS, 2),
            growth_s=loops.growth_s,
        ),
    )


def _drive(heading_deg: float) -> dict[str, object]:
    return {
        "kind": "legs",
        "leg": [
            {"duration_s": 1200.0, "speed_mps": 0.0, "heading_deg": heading_deg},
            {"duration_s": 3600.0, "speed_mps": 10.0, "accel_mps2": 0.2},
            {"duration_s": 2400.0, "speed_mps": 0.0, "accel_mps2": 0.2},
        ],
    }


def _transport_rate() -> Comparison:
    def method(realisation: str) -> dict[str, object]:
        network = {"id": "compass", "sigma": _SIGMA, "xi": _XI, "realisation": realisation}
        return {"name": realisation, "damping": "external", "network": network}

    t, (printed, corrected) = run_scenario(
        {
            "run": {"duration_h": 2.0, "earth": "sphere"},
            "motion": _drive(90.0),
            "reference": {"kind": "log"},
            "method": [method("as_printed"), method("feedback")],
        },
        PHI_N,
    )
    peaks = float(np.nanmax(np.abs(printed))), float(np.nanmax(np.abs(corrected)))
    return Comparison(
        x_axis=TIME,
        y_axis=Axis(Text("tilt φN"), "rad"),
        x=t,
        curves=(
            Curve(Text("Deng 4 as printed"), "printed", printed),
            Curve(Text("with the reference's transport rate"), "corrected", corrected),
        ),
        numbers=(Number(Text("largest tilt"), "rad", peaks[0], peaks[1]),),
        words=Text(
            "Perfect sensors and log, 0 to 10 m/s and back: as printed every change of "
            "speed tilts the platform by up to {peaks:.0f} arcsec; with Vᵣ/R the tilt "
            "stays below {peaks_2:.2g} arcsec.",
            peaks=peaks[0] / ARCSEC,
            peaks_2=max(peaks[1] / ARCSEC, 1e-3),
        ),
    )


def _coriolis() -> Comparison:
    speed, lat = 10.0, 32.06 * DEG
    transport_up = speed * math.tan(lat) / SEMI_MAJOR_AXIS
    coriolis_north = -(2.0 * EARTH_RATE * math.sin(lat) + transport_up) * speed
    # What the computer leaves out acts like a sensor error of the opposite sign (body x is south here).
    left_out = {
        "accel_bias_ug": [coriolis_north / MICRO_G, 0.0, 0.0],
        "gyro_bias_dph": [0.0, 0.0, -transport_up / DEG_PER_HOUR],
    }

    def heading(imu: dict[str, list[float]]) -> tuple[np.ndarray, np.ndarray]:
        t, (value,) = run_scenario(
            {
                "run": {"duration_h": 2.0, "output_step_s": 20.0, "earth": "sphere"},
                "motion": {"kind": "legs", "leg": [{"speed_mps": speed, "heading_deg": 90.0}]},
                "imu": imu,
                "reference": {"kind": "log"},
                "method": [{"damping": "external", "network": {"id": "compass"}}],
            },
            PHI_U,
        )
        return t, value

    t, printed = heading(left_out)
    _, corrected = heading({})
    ends = float(printed[-1]), float(corrected[-1])
    return Comparison(
        x_axis=TIME,
        y_axis=Axis(Text("heading error φU"), "rad"),
        x=t,
        curves=(
            Curve(Text("no Coriolis, no up command"), "printed", printed),
            Curve(Text("with both"), "corrected", corrected),
        ),
        numbers=(
            Number(Text("heading error after 2 h"), "rad", ends[0], ends[1]),
            Number(Text("Coriolis term left out"), "m/s²", coriolis_north, 0.0),
        ),
        words=Text(
            "Due east at 10 m/s in 32° north the terms left out act like "
            "{coriolis_north:.0f} µg and {transport_up:.2f} °/h: after 2 h the heading "
            "is off by {ends:.2f}°.",
            coriolis_north=coriolis_north / MICRO_G,
            transport_up=transport_up / DEG_PER_HOUR,
            ends=abs(ends[0]) / DEG,
        ),
    )


DENG = (
    Misprint(
        id="deng-intro",
        paper="Deng 2019",
        where=Text("introduction"),
        printed=Text("2π/√(R/g), 2π/√(ωᵢₑ), 2π/ωᵢₑ sin(φ)"),
        right=Text("2π √(R/g), 2π/ωᵢₑ, 2π/(ωᵢₑ sin(φ))"),
        consequence=Text("none of the three periods comes out"),
        compute=_periods,
    ),
    Misprint(
        id="deng-1",
        paper="Deng 2019",
        where="eq. 1",
        printed=Text("H has an extra s in the denominator"),
        right=Text("H = ((1+K₂)s+K₃)/(s+K₁): that s is the velocity integrator"),
        consequence=Text("the loop is unstable"),
        compute=_extra_s,
    ),
    Misprint(
        id="deng-3",
        paper="Deng 2019",
        where="eq. 3 and 4",
        printed=Text("dp = K₃ dv/s, added to a rate"),
        right="dp = K₃ dv/(R s)",
        consequence=Text("the integral gain is R times too large: the loop explodes within seconds"),
        compute=_radius,
    ),
    Misprint(
        id="deng-4-transport",
        paper="Deng 2019",
        where="eq. 3 and 4",
        printed=Text("the platform turns with the difference dv alone"),
        right=Text("plus the reference's transport rate Vᵣ/R"),
        consequence=Text("a moving vehicle has transients at every change of speed"),
        compute=_transport_rate,
    ),
    Misprint(
        id="deng-4-coriolis",
        paper="Deng 2019",
        where="eq. 3 and 4",
        printed=Text("no Coriolis term, no up command"),
        right=Text("add both"),
        consequence=Text("a moving vehicle's heading drifts"),
        compute=_coriolis,
    ),
)
"""Misprints of Deng 2019 in the order of the paper."""
