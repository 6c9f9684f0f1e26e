"""Compile, or load from the cache, every kernel once, so that no user waits for it later.

``python -m navcore.warm`` does so and says what is under way. A second process, ``python -m navcore.warm
sensors``, compiles the motions and the simulated IMU meanwhile: two fifths of the work.
``python -m navcore.warm portable`` compiles them for a family of processors instead, into the package itself:
a wheel that is built then holds them.
"""

import os
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from navcore.alignment.fine import coarse_alignment
from navcore.engine.ensemble import outcomes
from navcore.engine.environment import environment
from navcore.engine.simulation import simulate
from navcore.exporting.forms import form_of
from navcore.exporting.subject import subject_of
from navcore.foundation.compiled import COMPILATION, PORTABLE_SETTINGS
from navcore.foundation.earth import WGS84
from navcore.foundation.errors import InputError
from navcore.foundation.kernel_cache import SHIPPED, cache_folder, compiling, complete, note_progress
from navcore.motion.static import StaticMotion
from navcore.motion.truth import Site
from navcore.scenario.model import Scenario
from navcore.sensors.imu import Imu
from navcore.sensors.imu_simulation import ImuSimulation

_NOTE_S, _SAY_S = 0.25, 2.5
_IMU: dict[str, Any] = {
    "gyro_bias_dph": [0.01, 0.01, 0.01],
    "gyro_arw_dpsh": 0.001,
    "accel_vrw_ugpshz": 1.0,
    "gyro_instability_dph": 0.001,
    "accel_instability_ug": 1.0,
    "gyro_scale_ppm": [1.0, 1.0, 1.0],
    "gyro_lsb": [1e-7, 1e-7, 1e-7],
    "accel_lsb": [1e-5, 1e-5, 1e-5],
}
_SWING = {"amplitude_deg": 1.0, "frequency_hz": 0.1}
_MOTIONS: tuple[dict[str, Any], ...] = (
    {"kind": "static"},
    {"kind": "swing", "pitch": _SWING, "roll": _SWING, "heading": _SWING},
    {"kind": "legs", "leg": [{"duration_s": 60.0, "speed_mps": 5.0}, {"duration_s": 60.0, "turn_dps": 1.0}]},
    {"kind": "waves", "components": 8, "speed_mps": 5.0},
    {
        "kind": "profile",
        "point": [{"t_s": 0.0, "velocity_mps": [0.0, 0.0]}, {"t_s": 60.0, "velocity_mps": [1.0, 2.0]}],
    },
)
_TRACK = "t_s,lat_deg,lon_deg,heading_deg\n"


_NETWORK = {"damping": "external", "network": {"id": "complementary"}}
_POLICIES = [
    _NETWORK | {"name": policy, "policy": {"id": policy}, "switching": {"id": switching}}
    for policy, switching in (
        ("threshold", "hard"),
        ("variation", "bumpless"),
        ("yaw_rate", "ramp"),
        ("acceleration", "keep"),
    )
] + [{"damping": "external", "network": {"id": "unity2"}, "policy": {"id": "adaptive"}}]
_COMPASS = {"damping": "external", "network": {"id": "compass"}}
_AVERAGING = {"damping": "averaging"}
_KALMAN = {"damping": "kalman"}
_RATE_HZ = 20.0


def warm() -> None:
    """Run short scenarios of every kind, with every sensor error, so that each kernel is compiled once.

    First what the error model needs, in which most scenarios are opened.
    """
    simulate(_scenario({"duration_h": 0.02}, _MOTIONS[0], 1.0, _POLICIES))
    strapdown = {"fidelity": "strapdown", "duration_h": 0.02, "rate_hz": _RATE_HZ}
    slow_log, fast_log = 1.0, _RATE_HZ
    for log_hz in (slow_log, fast_log):
        simulate(_scenario(strapdown, _MOTIONS[1], log_hz, [_COMPASS, _NETWORK], "compass"))
    for fidelity in ("error_model", "strapdown"):
        simulate(_scenario(strapdown | {"fidelity": fidelity}, _MOTIONS[0], 1.0, [_AVERAGING]))
    for run in ({"duration_h": 0.02}, strapdown):
        simulate(_scenario(run, _MOTIONS[2], 1.0, [_KALMAN]))
    seeds = _scenario(strapdown, _MOTIONS[1], 1.0, [_COMPASS, _NETWORK])
    outcomes(seeds, seeds.method, range(2))
    for motion in _MOTIONS[1:]:
        simulate(_scenario({"duration_h": 0.02}, motion, 1.0, _POLICIES))
    _warm_track()
    _warm_coarse_alignment()
    _warm_exports()


def _warm_exports() -> None:
    """Compile what replays an exported law, a Kalman filter and a box beside an INS."""
    for method, outside in ((_NETWORK, False), (_KALMAN, False), (_NETWORK, True)):
        one = _scenario({"duration_h": 0.02}, _MOTIONS[0], 1.0, [method])
        form_of(subject_of(one, hours=0.02), outside)


def warm_sensors() -> None:
    """Compile what needs no law: motions, sensors and log of the error model, then the simulated IMU.

    The legs come first: with the law they are all that the error model of most scenarios needs. The rest
    gives way to the law, on which the first picture waits.
    """
    samples = int(60.0 * _RATE_HZ)
    scenarios = [_scenario({"duration_h": 0.02}, motion, 1.0, [_NETWORK]) for motion in _MOTIONS]
    environment(scenarios[2])
    if sys.platform != "win32":
        os.nice(10)
    for given in scenarios:
        environment(given)
    for given in scenarios[:3]:
        for with_sums in (False, True):
            site = Site(0.5, 0.0, 0.0)
            simulation = ImuSimulation(given.motion, site, WGS84, given.imu, _RATE_HZ, samples, 0)
            for _ in simulation.chunks(with_sums):
                pass


def warm_checks() -> None:
    """Compile what the check of a scenario needs: motions, errors of sensors and log; no law, no IMU."""
    for motion in _MOTIONS:
        environment(_scenario({"duration_h": 0.02}, motion, 1.0, [_NETWORK]))
    _warm_track(environment)


def compile_for_checks(progress: Callable[[str], None] = lambda what: None) -> None:
    """Compile what `navcore.checks` needs of a scenario: a tenth of all; parameters as of `compile_once`."""
    if not complete():
        progress("those of a check are compiled, once: some seconds")
        with _telling(progress):
            warm_checks()


def _scenario(
    run: dict[str, Any],
    motion: dict[str, Any],
    log_hz: float,
    methods: list[dict[str, Any]],
    alignment: str = "none",
) -> Scenario:
    return Scenario.parse(
        {
            "run": run,
            "motion": motion,
            "imu": _IMU,
            "reference": {"kind": "log", "noise_mps": 0.1, "drift_mps": 0.1, "rate_hz": log_hz},
            "alignment": {"kind": alignment, "duration_s": 60.0},
            "method": methods,
        }
    )


def _warm_track(carry: Callable[[Scenario], object] = simulate) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "track.csv"
        rows = (f"{k},{0.5 + 1e-5 * k},{1e-5 * k},45.0\n" for k in range(120))
        path.write_text(_TRACK + "".join(rows), "utf-8")
        track = {"kind": "track", "file": str(path)}
        carry(_scenario({"duration_h": 0.02}, track, 1.0, [_NETWORK]))


def _warm_coarse_alignment() -> None:

    samples = int(60.0 * _RATE_HZ)
    simulation = ImuSimulation(StaticMotion(), Site(0.5, 0.0, 0.0), WGS84, Imu(), _RATE_HZ, samples, 0)
    coarse_alignment(np.concatenate([chunk for chunk, _ in simulation.chunks()]), _RATE_HZ, 0.5)


def compile_once(progress: Callable[[str], None] = lambda what: None) -> None:
    """Compile every kernel into the cache unless that is done; while another process does it, wait.

    Parameters
    ----------
    progress : callable
        Told how far it is, every few seconds.
    """
    if not complete():
        progress("to be compiled, once: about a minute")
    with compiling() as needed:
        if needed:
            # What it has not brought, for whatever reason, is compiled here.
            sensors = [sys.executable, "-m", "navcore.warm", "sensors"]
            with _telling(progress), subprocess.Popen(sensors) as beside:
                try:
                    warm()
                finally:
                    beside.kill()


@contextmanager
def _telling(progress: Callable[[str], None]) -> Iterator[None]:
    """Note meanwhile, for other processes too, how many kernels there are and which one is under way."""
    over = threading.Event()

    def tell() -> None:
        said_s = 0.0
        while not over.wait(_NOTE_S):
            told = note_progress(COMPILATION.under_way()[0])
            if time.monotonic() - said_s > _SAY_S:
                said_s = time.monotonic()
                progress(str(told))

    note_progress("")
    thread = threading.Thread(target=tell, name="progress", daemon=True)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()


def main() -> None:
    """Compile every kernel into the cache, saying what is under way."""
    match sys.argv[1:]:
        case ["sensors"]:
            warm_sensors()
            return
        case ["portable"]:
            os.environ |= {"SCHULER_CACHE_DIR": str(SHIPPED), **PORTABLE_SETTINGS}
            os.execv(sys.executable, [sys.executable, "-m", "navcore.warm"])
    try:
        compile_once(lambda what: print(f"kernels: {what}", file=sys.stderr, flush=True))
    except InputError as error:
        sys.exit(str(error))
    print(f"kernels: ready in {cache_folder()}", file=sys.stderr)


if __name__ == "__main__":
    main()
