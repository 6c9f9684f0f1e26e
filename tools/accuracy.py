"""The figures that engine and budget are accurate to, as a table: ``make accuracy``.

Each is held by a test of the acceptance or unit tests, with a limit; here it is printed.
"""

import sys
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from navcore.alignment.fine import CompassLoop, fine_alignment, steady_misalignment
from navcore.design.budget import budget
from navcore.design.figures import Figures
from navcore.engine.simulation import simulate
from navcore.foundation.earth import WGS84
from navcore.foundation.units import ARCSEC, DEG, DEG_PER_HOUR, MICRO_G
from navcore.mechanization.recorder import DV_E, DV_N, MAX_ABS, PHI_E, PHI_N
from navcore.mechanization.strapdown.attitude import misalignment, quaternion_of
from navcore.mechanization.strapdown.run import turned_by
from navcore.motion.base import MotionParameters
from navcore.motion.static import StaticMotion
from navcore.motion.truth import HEADING, PITCH, ROLL
from navcore.networks.compass import CompassNetwork
from navcore.scenario.model import Scenario
from navcore.sensors.imu import Imu
from navcore.sensors.imu_simulation import ImuSimulation
from tests.acceptance.test_design_values import FLOOR, OPTIMA, OPTIMAL, TABLE, set_a
from tests.acceptance.test_strapdown_motions import METHODS, ORDERS, VOYAGE, both, worst
from tests.motions import MANOEUVRES, SEA, SUN, ZHAO, circle_track
from tests.strapdown import DENG_SWING, DRIVE, SITE, navigate, reference

Row = tuple[str, str, str]

ATTITUDES = ((0, 0, 0), (0, 0, 90), (10, 20, 310), (6, 8, 75), (-30, 45, 200))
MOTIONS: dict[str, tuple[MotionParameters, str, float]] = {
    "swing (Deng)": (DENG_SWING, "locked", 1.5),
    "legs": (DRIVE, "locked", 1.5),
    "profile": (MANOEUVRES, "locked", 1.5),
    "profile (Zhao)": (ZHAO, "locked", 6.0),
    "profile (Sun)": (SUN, "locked", 1.5),
    "waves, altimeter": (SEA, "altimeter", 1.5),
}
RATES_HZ = (50.0, 100.0, 200.0, 400.0)


def at_rest() -> Iterator[Row]:
    """Measure the errors that perfect sensors leave after 3 h at rest."""
    for attitude in ATTITUDES:
        pitch, roll, heading = attitude
        motion = StaticMotion(pitch_deg=pitch, roll_deg=roll, heading_deg=heading)
        stats = navigate(motion, 200.0, 3 * 3600.0).recorder.stats
        found = stats[[DV_E, DV_N], MAX_ABS].max()
        yield f"at rest 3 h, 200 Hz, attitude {attitude}", f"{found:.1e} m/s", "1e-9 m/s"


def in_motion() -> Iterator[Row]:
    """Measure the errors that perfect sensors leave in motion, and how they fall with the rate."""
    limit = "1e-8 rad, 1e-5 m/s, 0.05 m (swing)"
    for name, (motion, vertical, hours) in MOTIONS.items():
        found = worst(motion, 200.0, hours * 3600.0, vertical=vertical)
        yield f"{name}, {hours:g} h, 200 Hz", _three(found), limit
    with TemporaryDirectory() as folder:
        yield "track, 20 min, 200 Hz", _three(worst(circle_track(Path(folder)), 200.0, 1190.0)), limit
    for name, (motion, vertical, wanted) in ORDERS.items():
        errors = np.array([worst(motion, rate, 3600.0, vertical=vertical)[:2] for rate in RATES_HZ])
        attitude, velocity = -np.polyfit(np.log(RATES_HZ), np.log(errors), 1)[0]
        order = f"attitude {attitude:.2f}, velocity {velocity:.2f}"
        yield f"order of convergence, 50 to 400 Hz: {name}", order, "{:g}, {:g}".format(*wanted)


def _three(found: np.ndarray) -> str:
    return f"{found[0]:.1e} rad, {found[1]:.1e} m/s, {found[2]:.1e} m"


def reference_values() -> Iterator[Row]:
    """Values of theory.md 9.5 and 9.6."""
    v_e = navigate(StaticMotion(), 100.0, 3600.0, Imu(gyro_bias_dph=(0.0, 0.02, 0.0))).navigation[:, 3]
    for t, wanted in ((1800, "0.9951"), (2533, "1.2309"), (3600, "0.7646")):
        yield f"9.5, V_E at {t} s", f"{v_e[t]:.5f} m/s", f"{wanted} m/s"
    imu = Imu(gyro_bias_dph=(0.0, 0.02, 0.0), accel_bias_ug=(50.0, 50.0, 0.0))
    for law_step_s in (1.0, 0.01):
        run = navigate(
            StaticMotion(),
            100.0,
            3600.0,
            imu,
            [0, 0, 0, 0, 0.1 * DEG, 0.1 * DEG, 0],
            "external",
            CompassNetwork(sigma=0.0088, xi=0.7),
            reference((0, 0), 3600.0, law_step_s),
            law_step_s,
        )
        for name, column, wanted in (
            ("E", PHI_E, "-0.002868 deg, 541 s"),
            ("N", PHI_N, "0.002868 deg, 545 s"),
        ):
            phi = run.recorder.rows[:, column] / DEG
            settled = np.flatnonzero(np.abs(phi - phi[-1]) > 0.02 * 0.1)[-1]
            label = f"9.6, phi_{name}, law at {1 / law_step_s:g} Hz"
            yield label, f"{phi[-1]:.6f} deg, {settled} s", wanted


def alignment() -> Iterator[Row]:
    """Compass alignment (6.1): what it leaves without noise, and its steady state."""
    tilted = StaticMotion(pitch_deg=6.0, roll_deg=8.0, heading_deg=75.0)
    for name, motion, rate_hz in (("at rest", tilted, 50.0), ("swing", DENG_SWING, 200.0)):
        phi = np.abs(_aligned(motion, Imu(), 600, rate_hz)) / DEG
        found = f"heading {phi[2]:.5f} deg, level {phi[:2].max():.1e} deg"
        yield f"alignment, 600 s, {name}", found, "0.003 deg, 1e-5 deg"
    imu = Imu(gyro_bias_dph=(0.02, 0.02, 0.02), accel_bias_ug=(50.0, -80.0, 0.0))
    eps, nabla = np.full(3, 0.02 * DEG_PER_HOUR), np.array([50.0, -80.0, 0.0]) * MICRO_G
    wanted = steady_misalignment(eps, nabla, SITE.lat, WGS84.gravity(SITE.lat), CompassLoop())
    off = np.abs(_aligned(StaticMotion(), imu, 1500, 50.0) / wanted - 1.0).max()
    yield "alignment, steady-state formulas", f"{100 * off:.2f} % off", "1 %"


def _aligned(motion: MotionParameters, imu: Imu, seconds: int, rate_hz: float) -> np.ndarray:
    samples = int(seconds * rate_hz)
    sim = ImuSimulation(motion, SITE, WGS84, imu, rate_hz, samples, 1)
    increments = np.concatenate([chunk.copy() for chunk, _ in sim.chunks()])
    rows = sim.truth_rows(seconds + 1, 1.0)
    first, last = (np.array(quaternion_of(*rows[i][[PITCH, ROLL, HEADING]])) for i in (0, -1))
    start = turned_by(-np.array([0.1, 0.1, 1.0]) * DEG, first)
    found = fine_alignment(increments, rate_hz, start, SITE.lat, SITE.height, WGS84)
    return np.array(misalignment(*found.quaternion, *last))


def fidelities() -> Iterator[Row]:
    """The linear error model against the strapdown, 6 h, the same errors."""
    for name, motion in (("static", StaticMotion()), ("legs", VOYAGE), ("swing", DENG_SWING)):
        for method in METHODS:
            strapdown, linear = both(motion, method)
            peak = np.abs(linear).max(axis=0)
            off = (np.abs(strapdown - linear).max(axis=0) / np.where(peak > 0.0, peak, np.inf)).max()
            yield f"error_model against strapdown, 6 h: {name}, {method}", f"{100 * off:.2f} % of peak", "2 %"


def design() -> Iterator[Row]:
    """Steady budgets of the reference sensors: the table by network, the optima, `optimal`, the floor."""
    cases: list[tuple[dict[str, object], float, float | None]] = [
        *((network, tilt, velocity) for network, _, tilt, velocity in TABLE),
        *((network, tilt, None) for network, tilt in OPTIMA),
        *(({"id": "optimal", "rho": rho, "q": 0.0}, tilt, velocity) for rho, tilt, velocity in OPTIMAL),
    ]
    for network, tilt, velocity in cases:
        found = budget(set_a(network), steady=True)
        name = ", ".join(str(value) for value in network.values())
        wanted = f"{tilt:.3f} arcsec" + ("" if velocity is None else f", {velocity:.4g} m/s")
        yield f"steady tilt and velocity: {name}", _figures(found.methods[0].total.rms), wanted
        if network is cases[-1][0]:
            yield "floor", _figures(found.floor.rms), f"{FLOOR[0]:.3f} arcsec, {FLOOR[1]:.4g} m/s"


def _figures(rms: Figures) -> str:
    return f"{(rms.tilt_rad or 0.0) / ARCSEC:.3f} arcsec, {rms.velocity_mps:.4g} m/s"


def recorded(file: Path) -> Iterator[Row]:
    """A parked vehicle's ring-laser gyros: heading, and V_E free and damped with V_r = 0."""
    if not file.is_file():
        yield f"recorded IMU: no {file.name} beside this folder", "left out", ""
        return
    damped = {
        "name": "compass",
        "damping": "external",
        "network": {"id": "compass", "sigma": 0.0088, "xi": 0.7},
    }
    run = simulate(
        Scenario.parse(
            {
                "run": {"fidelity": "strapdown", "duration_h": 0.24, "output_step_s": 1.0},
                "imu": {"file": str(file), "begin_s": 570.0},
                "alignment": {"kind": "compass", "duration_s": 380.0},
                "reference": {"kind": "log"},
                "method": [{"name": "free"}, damped],
            }
        )
    )
    yield "recorded IMU, aligned 570-950 s", f"heading {run.truth[0, HEADING] / DEG:.2f} deg", "90.7 deg"
    for method in run.methods:
        curve = ", ".join(f"{value:+.4f}" for value in method.rows[::108, DV_E])
        yield f"  {method.method.name}: dV_E every 108 s, m/s", curve, ""


def main() -> int:
    """Print the table."""
    file = Path(__file__).resolve().parents[2] / "shared" / "data" / "imu" / "lasergyro.imu"
    for part in (
        at_rest(),
        in_motion(),
        reference_values(),
        alignment(),
        fidelities(),
        design(),
        recorded(file),
    ):
        for what, found, wanted in part:
            print(f"{what:<58} {found:<44} {wanted}", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
