"""The 24 h mode of the whole system: runs that grow as the eigenvalues say; test_theory has the table."""

import math

import numpy as np
import pytest

from navcore.analysis.whole_system import whole_system
from navcore.engine.run import MethodRun
from navcore.engine.simulation import simulate
from navcore.foundation.earth import SPHERE
from navcore.foundation.units import DEG
from navcore.mechanization.recorder import NAMES
from navcore.networks import LinearNetwork, parse_network
from navcore.scenario.model import Scenario

DAY = 86400.0
DLAT = NAMES.index("dlat_m")
OMEGA_S = SPHERE.schuler_frequency(0.0)


def network(text: str) -> LinearNetwork:
    return parse_network(text).transfer(OMEGA_S)


def test_pole2_exact_of_physics_10():
    """H(0) = 0.648; printed to one decimal."""
    h = network('id = "pole2", xi = 0.5')
    for lat, printed in ((32.0, 2.0), (45.0, 1.6), (60.0, 1.3)):
        assert whole_system(h, lat * DEG).e_folding_s / DAY == pytest.approx(printed, abs=0.055)


def measured(scenario: dict, skip_h: float) -> list[tuple[complex, MethodRun]]:
    """Eigenvalue of the slow mode in the latitude error of each method (1/s), by linear prediction."""
    run = simulate(Scenario.parse(scenario))
    found = []
    for method in run.methods:
        assert method.status == "ok"
        kept = method.t_s >= skip_h * 3600.0
        x = method.rows[kept, DLAT]
        lag = round(4.0 * 3600.0 / scenario["run"]["output_step_s"])
        before, middle, after = x[: -2 * lag], x[lag:-lag], x[2 * lag :]
        a, b = np.linalg.lstsq(np.column_stack([middle, before]), after, rcond=None)[0]
        roots = np.log(np.roots([1.0, -a, -b]).astype(complex)) / (4.0 * 3600.0)
        found.append((roots[np.argmax(roots.imag)], method))
    return found


def scenario(fidelity: str, days: float, networks: list[str], **run) -> dict:
    return {
        "run": {"fidelity": fidelity, "duration_h": 24.0 * days, "output_step_s": 600.0} | run,
        "site": {"lat_deg": 45.0, "lon_deg": 0.0},
        "reference": {"kind": "log"},
        "initial_error": {"attitude_arcmin": [0.0, 0.0, 1.0]},
        "method": [
            {"name": text, "damping": damping, "network": parse_network(text).model_dump(exclude_none=True)}
            for text, damping in zip(networks, ("external", "internal", "external"), strict=False)
        ],
    }


def test_the_error_model_grows_as_the_eigenvalues_say():
    """Runs of 20 days at 45 N from 1' of heading; classic2 ends at 522 km RMS of latitude (theory.md 10)."""
    networks = ['id = "classic2"', 'id = "unity2"', 'id = "complementary"']
    given = scenario("error_model", 20.0, networks, step_s=2.0)
    for rate, method in measured(given, skip_h=48.0):
        whole = method.whole
        assert rate.real == pytest.approx(whole.earth_growth, rel=0.01)
        assert rate.imag == pytest.approx(whole.named("24 h")[0].eigenvalue.imag, rel=2e-3)
        assert whole.stable == (whole.earth_growth < 0.0)
    classic = simulate(Scenario.parse(given)).methods[0]
    last = classic.rows[classic.t_s >= 19.0 * DAY, DLAT]
    assert math.sqrt(np.mean(last**2)) == pytest.approx(522e3, rel=0.1)


def test_the_full_mechanization_grows_as_the_eigenvalues_say():
    given = scenario("strapdown", 6.0, ['id = "classic2"'], step_s=2.0, rate_hz=10.0)
    [(rate, method)] = measured(given, skip_h=36.0)
    assert rate.real == pytest.approx(method.whole.earth_growth, rel=0.01)
    assert any("24 h mode grows, e-folding time 3.1 days" in text for text in method.warnings)


def test_a_free_system_and_velocity_feedback_do_not_grow():
    given = scenario("error_model", 4.0, ['id = "compass", sigma = 0.0015'], step_s=2.0)
    given["method"].append({"name": "free", "damping": "free"})
    given["method"].append({"name": "average", "damping": "averaging"})
    compass, free, average = simulate(Scenario.parse(given)).methods
    for method in (compass, free, average):
        assert method.whole.stable
        assert method.whole.earth_growth == 0.0
    first, last = (np.abs(free.rows[m, DLAT]).max() for m in (free.t_s <= DAY, free.t_s >= 3.0 * DAY))
    assert last == pytest.approx(first, rel=0.05)
    # feedback pulls the velocity onto the log's: latitude stays where it is
    assert np.ptp(compass.rows[compass.t_s >= DAY, DLAT]) < 0.5 * np.abs(compass.rows[:, DLAT]).max()
