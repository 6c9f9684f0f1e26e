"""What runs and seeds are judged by, against the matrix exponential of the equations of theory.md 2 (scipy).

An undamped ship at rest on the sphere has a closed form: x(t) = exp(A t) x(0), with the sensors' constants as
further states. Nothing of navcore's own model is used for it.
"""

import math
from typing import Any

import numpy as np
import pytest
from scipy.linalg import expm

from navcore.design.designs import designs
from navcore.engine.measures import judged
from navcore.engine.simulation import simulate
from navcore.foundation.units import ARCMIN, ARCSEC, DEG, DEG_PER_HOUR, HOUR, KNOT, MICRO_G
from navcore.scenario.model import Scenario

R, G, OMEGA = 6378137.0, 9.80665, 7.292115e-5
LAT, PITCH, HEADING = 40.0 * DEG, 8.0 * DEG, 35.0 * DEG
STEP_S, HOURS = 10.0, 6.0
ANGLES = ("tilt_max_arcsec", "tilt_rms_arcsec", "heading_max_arcmin", "heading_rms_arcmin")
SPEEDS = ("velocity_max_mps", "velocity_rms_mps")
PLACES = ("position_max_m", "position_rms_m", "position_final_m")
SPECIFIED = (
    "heading_seclat_rms_arcmin", "heading_seclat_max_arcmin", "roll_rms_arcmin", "roll_max_arcmin",
    "pitch_rms_arcmin", "pitch_max_arcmin",
)  # fmt: skip
OF_SEEDS = (
    "position_cep50_m", "position_r95_m", "position_2drms_m", "position_trms_m", "position_rate_cep_nmph",
    "reset_interval_h",
)  # fmt: skip


def system() -> np.ndarray:
    """Matrix of dV E, N, dL, dlambda, phi E, N, U, then eps E, N, U and nabla E, N; shape (12, 12)."""
    wz, wy = OMEGA * math.sin(LAT), OMEGA * math.cos(LAT)
    a = np.zeros((12, 12))
    a[0, [1, 5, 10]] = 2.0 * wz, -G, 1.0
    a[1, [0, 4, 11]] = -2.0 * wz, G, 1.0
    a[2, 1], a[3, 0] = 1.0 / R, 1.0 / (R * math.cos(LAT))
    a[4, [1, 5, 6, 7]] = -1.0 / R, wz, -wy, -1.0
    a[5, [0, 2, 4, 8]] = 1.0 / R, -wz, -wz, -1.0
    a[6, [0, 2, 4, 9]] = math.tan(LAT) / R, wy, wy, -1.0
    return a


def courses(start: np.ndarray, step_s: float = STEP_S) -> tuple[np.ndarray, np.ndarray]:
    """Times, s, and the states then for each column of ``start``; shapes (m,), (m, 12, n)."""
    steps = round(HOURS * HOUR / step_s)
    one, states = expm(system() * step_s), [start]
    for _ in range(steps):
        states.append(one @ states[-1])
    return np.arange(steps + 1) * step_s, np.array(states)


def position(states: np.ndarray) -> np.ndarray:
    return np.hypot(R * states[:, 2], R * math.cos(LAT) * states[:, 3])


def turned(body: list[float]) -> np.ndarray:
    """From the ship's axes, starboard, forward, up, into east, north, up."""
    x, y, z = body
    forward, up = y * math.cos(PITCH) - z * math.sin(PITCH), y * math.sin(PITCH) + z * math.cos(PITCH)
    east = x * math.cos(HEADING) + forward * math.sin(HEADING)
    return np.array([east, forward * math.cos(HEADING) - x * math.sin(HEADING), up])


def ship(requirement: list[dict[str, Any]], **blocks: Any) -> Scenario:
    return Scenario.parse(
        {
            "run": {"duration_h": HOURS, "step_s": STEP_S, "earth": "sphere", "seed": 11},
            "site": {"lat_deg": LAT / DEG},
            "motion": {"kind": "static", "pitch_deg": PITCH / DEG, "heading_deg": HEADING / DEG},
            "method": [{"name": "free", "damping": "free"}],
            "requirement": requirement,
            **blocks,
        }
    )


@pytest.mark.known(
    "oracle", [*ANGLES, *SPEEDS, *PLACES, *SPECIFIED, *OF_SEEDS], kinds=["free"], fidelities=["error_model"],
    source="theory.md 2 by scipy's matrix exponential",
)  # fmt: skip
def test_what_a_run_is_judged_by() -> None:
    gyro, accel = [0.01, -0.02, 0.015], [40.0, -25.0, 30.0]
    tilts, heading, velocity, place = (0.5, -0.3), 6.0, (0.2, -0.1), (4.0, -7.0)
    eps, nabla = turned(gyro) * DEG_PER_HOUR, turned(accel) * MICRO_G
    level = [*velocity, *(x * ARCSEC for x in place), *(x * ARCMIN for x in (*tilts, heading))]
    t, states = courses(np.array([*level, *eps, *nabla[:2]])[:, None])
    x, r = states[:, :, 0], position(states)[:, 0]
    length = {"tilt": np.hypot(x[:, 4], x[:, 5]), "velocity": np.hypot(x[:, 0], x[:, 1])}
    sin, cos = math.sin(HEADING), math.cos(HEADING)
    single = {
        "heading": x[:, 6],
        "heading_seclat": x[:, 6] * math.cos(LAT),
        "pitch": x[:, 4] * cos - x[:, 5] * sin,
        "roll": (x[:, 4] * sin + x[:, 5] * cos) / math.cos(PITCH),
    }
    wanted = {
        "tilt_max_arcsec": length["tilt"].max() / ARCSEC,
        "tilt_rms_arcsec": math.sqrt(np.mean(length["tilt"] ** 2) / 2.0) / ARCSEC,
        "velocity_max_mps": length["velocity"].max(),
        "velocity_rms_mps": math.sqrt(np.mean(length["velocity"] ** 2) / 2.0),
        "position_max_m": r.max(),
        "position_rms_m": math.sqrt(np.mean(r**2)),
        "position_final_m": r[-1],
        "position_cep50_m": r[round(2.0 * HOUR / STEP_S)],
        "position_r95_m": r[-1],
        "position_2drms_m": r[-1],
        "position_trms_m": math.sqrt(np.mean(r**2)),
        "position_rate_cep_nmph": float(r @ t / (t @ t)) / KNOT,
        "reset_interval_h": t[int(np.argmax(r > 900.0)) - 1] / HOUR,
    }
    for name, error in single.items():
        wanted[f"{name}_max_arcmin"] = np.abs(error).max() / ARCMIN
        wanted[f"{name}_rms_arcmin"] = math.sqrt(np.mean(error**2)) / ARCMIN
    limits = [{"quantity": key, "at_most": 900.0} for key in wanted]
    limits = [one | ({"at_h": 2.0} if one["quantity"] == "position_cep50_m" else {}) for one in limits]
    constants = {
        "imu": {"gyro_bias_dph": gyro, "accel_bias_ug": accel},
        "initial_error": {
            "attitude_arcmin": [*tilts, heading],
            "velocity_mps": list(velocity),
            "position_arcsec": list(place),
        },
    }
    for part in (limits[:12], limits[12:]):
        run = simulate(ship(part, **constants))
        for one in run.scenario.requirement:
            value, _ = judged(one, run.methods[0])
            assert value == pytest.approx(wanted[one.quantity], rel=2e-5), one.quantity


@pytest.mark.known(
    "oracle", OF_SEEDS, kinds=["free"], fidelities=["seeds"],
    source="theory.md 2 by scipy's matrix exponential on own draws",
)  # fmt: skip
def test_what_seeds_are_judged_by() -> None:
    """Each statistic lies within the width of its own interval of that of 4,000 own draws."""
    generator = np.random.default_rng(1)
    stated = (0.3, 0.3, 20 * ARCSEC, 20 * ARCSEC, ARCMIN, ARCMIN, 3 * ARCMIN)
    start = np.zeros((12, 4000))
    start[:7] = generator.standard_normal((7, 4000)) * np.array(stated)[:, None]
    start[7:10] = generator.standard_normal((3, 4000)) * 0.01 * DEG_PER_HOUR
    t, states = courses(start, 30.0)
    r = position(states)
    beyond = r > 8000.0
    held = np.where(beyond.any(axis=0), np.maximum(beyond.argmax(axis=0) - 1, 0), len(t) - 1) * 30.0 / HOUR
    wanted = {
        "position_cep50_m": np.median(r[-1]),
        "position_r95_m": np.quantile(r[-1], 0.95),
        "position_2drms_m": 2.0 * math.sqrt(np.mean(r[-1] ** 2)),
        "position_trms_m": math.sqrt(np.mean(r**2)),
        "position_rate_cep_nmph": np.median(t @ r / (t @ t)) / KNOT,
        "reset_interval_h": np.quantile(held, 0.2),
    }
    limits = [{"quantity": key, "at_most": 2500.0} for key in wanted]
    limits[-1] |= {"at_most": 8000.0, "share": 0.8}
    found = designs(
        ship(
            limits,
            imu={"gyro_bias_std_dph": 0.01},
            initial_error={
                "velocity_std_mps": 0.3,
                "position_std_arcsec": 20.0,
                "level_std_arcmin": 1.0,
                "heading_std_arcmin": 3.0,
            },
        ),
        400,
        as_set=True,
    )
    for limit in found.methods[0].limits:
        key, said = limit.requirement.quantity, limit.judgement
        width = said.value_high - said.value_low
        if key == "reset_interval_h":
            assert said.value == pytest.approx(wanted[key], rel=0.1)
        else:
            assert 0.0 < width < 0.3 * said.value
            assert abs(said.value - wanted[key]) < width, key
