"""Report of ``schuler network``: one network on the sphere and its closed loop (theory.md 3.6).

A network that states the Schuler frequency it was designed for is judged at that one.
"""

import math
from collections.abc import Iterable
from typing import Any

import numpy as np

from navcore.analysis import analyse, disk_margin, margins
from navcore.analysis.held_log import held_log
from navcore.analysis.two_channel import two_channel
from navcore.analysis.whole_system import WholeSystem, whole_system
from navcore.analysis.worst_step import worst_step
from navcore.foundation.earth import SPHERE
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.units import DEG
from navcore.networks.base import LinearNetwork, NetworkParameters

HIGHEST_LAT_DEG = 89.0


def network_report(
    parameters: NetworkParameters,
    lat_deg: float = 45.0,
    log_period_s: float | None = None,
    law_step_s: float = 1.0,
    with_margins: bool = False,
    azimuth: NetworkParameters | None = None,
) -> dict[str, Any]:
    """Return the ``network --json`` document; complex numbers as [re, im], no value that JSON cannot hold.

    Parameters
    ----------
    parameters : NetworkParameters
        The network, under external damping.
    lat_deg : float
        Latitude of the whole system, deg.
    log_period_s : float, optional
        Time between two epochs of the log, s; when given, the sampled law is checked too.
    law_step_s : float
        Time between two calls of the law, s; counts with ``log_period_s`` only.
    with_margins : bool
        Add the margins of the open loop, the disk margin among them, which takes a second.
    azimuth : NetworkParameters, optional
        Network Y(s) of the azimuth channel.

    Raises
    ------
    InputError
        The parameters make no network, or an argument is out of range.
    """
    _check(lat_deg, log_period_s, law_step_s)
    own = parameters.stated_omega_s
    network = parameters.transfer(SPHERE.schuler_frequency(0.0) if own is None else own)
    loop = analyse(network)
    slow = None if azimuth is None else azimuth.at_earth_rate()
    whole = whole_system(network, lat_deg * DEG, azimuth=slow)
    warnings = [*network.warnings, *loop.warnings, *whole.warnings]
    growth = max(mode.growth for mode in whole.modes)
    if log_period_s is not None:
        sampled = held_log(network, log_period_s, law_step_s, lat_deg * DEG, azimuth=slow)
        warnings += sampled.warnings
        growth = sampled.growth_per_s
    worst = worst_step(network)
    return {
        "id": network.id,
        **({} if own is None else {"omega_s_rad_s": own}),
        "num": [float(c) for c in network.num],
        "den": [float(c) for c in network.den],
        "zeros": _pairs(network.zeros),
        "poles": _pairs(network.poles),
        "gain": network.gain,
        **_feedback(network),
        "h0": _finite(network.h0),
        "closed_loop_poles": _pairs(loop.poles),
        "stable": loop.stable,
        "damping_ratio": _finite(loop.damping_ratio),
        "natural_frequency_rad_s": _finite(loop.natural_frequency),
        "settling_s": loop.settling_s,
        "worst_tilt_rad_per_mps": worst.tilt_rad,
        "worst_velocity_per_mps": worst.velocity_mps,
        "lat_deg": lat_deg,
        **whole_system_report(whole),
        "growth_per_s": _finite(growth),
        **({"margins": _margins(network)} if with_margins else {}),
        **_two_channel(parameters, network, lat_deg * DEG),
        "warnings": list(dict.fromkeys(warnings)),
    }


def whole_system_report(whole: WholeSystem) -> dict[str, Any]:
    """Return what documents say of the whole system (interface.md)."""
    slow = whole.slow_mode
    return {
        "earth_mode_growth_per_s": whole.earth_growth,
        "h_slope_s": _finite(whole.h_slope),
        "whole_system_stable": whole.stable,
        "slow_mode_damping_ratio": None if slow is None else slow.damping_ratio,
        "slow_mode_natural_frequency_rad_s": None if slow is None else abs(slow.eigenvalue),
    }


def _feedback(network: LinearNetwork) -> dict[str, list[float]]:
    """Numerator of a = G(s) (V_r - V_c) over the same denominator, 1/s; nothing where there is none."""
    if network.feedback_p is None:
        return {}
    missing = network.order - len(network.feedback_p)
    powers = 2.0 + missing + np.arange(len(network.feedback_p))
    return {"feedback_num": [float(c) for c in network.feedback_p * network.omega_s**powers]}


def _two_channel(
    parameters: NetworkParameters, network: LinearNetwork, lat: float
) -> dict[str, dict[str, Any] | None]:
    """Return what the optimum of both channels leaves beside a network that is optimal for one."""
    problem = parameters.control_problem()
    if problem is None:
        return {}
    found = two_channel(network, problem, lat)
    if found is None:
        return {"two_channel": None}
    one = found.one_channel
    return {
        "two_channel": {
            "floor": found.floor._asdict(),
            "both_channels": found.both_channels._asdict(),
            "one_channel": None if one is None else one._asdict(),
        }
    }


def _margins(network: LinearNetwork) -> dict[str, float | None] | None:
    """Return the margins of the open loop omega_s^2 H/s^2; None where there are none to give."""
    classical, disk = margins(network), disk_margin(network)
    if classical is None or disk is None:
        return None
    return {
        "gain_up": classical.gain_up,
        "gain_down": classical.gain_down,
        "phase_rad": classical.phase_rad,
        "crossover_rad_s": classical.crossover_rad_s,
        "delay_s": classical.delay_s,
        "disk_size": disk.size,
        "disk_gain": _finite(disk.gain),
        "disk_phase_rad": disk.phase_rad,
    }


def _check(lat_deg: float, log_period_s: float | None, law_step_s: float) -> None:
    if not abs(lat_deg) <= HIGHEST_LAT_DEG:
        allowed = f"must be >= {-HIGHEST_LAT_DEG:g} and <= {HIGHEST_LAT_DEG:g} (deg)"
        raise InputError(Fault("--lat", "", lat_deg, allowed))
    for name, value in (("--log-period-s", log_period_s), ("--law-step-s", law_step_s)):
        if value is not None and not 1e-3 <= value <= 1e4:
            raise InputError(Fault(name, "", value, "must be >= 0.001 and <= 10000 (s)"))


def _pairs(values: Iterable[complex]) -> list[list[float]]:
    return [[float(v.real) + 0.0, float(v.imag) + 0.0] for v in values]


def _finite(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None
