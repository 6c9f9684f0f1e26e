"""The compiled error model against its slow twin, against its eigenvalues and against closed forms."""

import math

import numpy as np
import pytest

from navcore.foundation.earth import EARTH_RATE, SPHERE, WGS84, Earth
from navcore.law.law import Law, prepare_law
from navcore.law.policy import PolicyParameters
from navcore.law.policy.constant import Constant
from navcore.law.policy.threshold import Threshold
from navcore.law.switching.hard import Hard
from navcore.mechanization.error_model import ErrorModelRun, system_matrix
from navcore.mechanization.recorder import make_recorder
from navcore.mechanization.trajectory import coefficients
from navcore.motion.truth import AE, AN, COLUMNS, HEADING, HEIGHT, LAT, VE, VN, VU, Truth  # fmt: skip
from navcore.networks.base import NetworkParameters
from navcore.networks.classic import Classic2Network
from navcore.networks.compass import CompassNetwork
from navcore.networks.complementary import ComplementaryNetwork
from navcore.networks.undamped import UndampedNetwork
from navcore.sensors.base import ReferenceErrors, SensorErrors
from tests.error_model_twin import run_twin
from tests.law_twin import TwinLaw

LAT0 = math.radians(45.7796)
STEPS = 900


def _moving_truth(steps: int, step_s: float) -> np.ndarray:
    """A made-up but smooth motion; the error model does not ask whether position and velocity agree."""
    t = np.arange(2 * steps + 1) * 0.5 * step_s
    rows = np.zeros((len(t), COLUMNS))
    rows[:, LAT] = LAT0 + 1e-5 * t
    rows[:, HEIGHT] = 30.0 + 2.0 * np.sin(0.01 * t)
    rows[:, VE], rows[:, VN], rows[:, VU] = (
        8 + 3 * np.sin(0.01 * t),
        -4 * np.cos(0.02 * t),
        0.02 * np.cos(0.01 * t),
    )
    rows[:, AE], rows[:, AN] = 0.03 * np.cos(0.01 * t), 0.08 * np.sin(0.02 * t)
    rows[:, HEADING] = 0.3
    return rows


def _inputs(steps: int):
    rng = np.random.default_rng(7)
    eps = rng.normal(0, 5e-8, (steps, 3))
    nabla = rng.normal(0, 5e-4, (steps, 3))
    dv_r = rng.normal(0.2, 0.3, (steps + 1, 2))
    valid = np.ones(steps + 1, bool)
    valid[steps // 3 : steps * 2 // 5] = False
    x0 = np.array([0.1, -0.2, 1e-5, 2e-5, 3e-4, -2e-4, 2e-3])
    return eps, nabla, dv_r, valid, x0


def _policy(limit: float | None) -> PolicyParameters:
    return Constant() if limit is None else Threshold(limit_mps=limit)


def _law(
    damping: str, parameters: NetworkParameters, omega_s: float, limit: float | None, step_s: float
) -> Law:
    return prepare_law(damping, parameters, parameters.transfer(omega_s), _policy(limit), Hard(), step_s)


def _compiled(
    truth: np.ndarray, law: Law, earth: Earth, step_s: float, inputs, coupled: bool = True
) -> np.ndarray:
    eps, nabla, dv_r, valid, x0 = inputs
    steps = len(eps)
    run = ErrorModelRun(
        step_s, steps, coefficients(Truth(0.5 * step_s, truth), earth, coupled), SensorErrors(eps, nabla),
        ReferenceErrors(np.arange(steps + 1) * step_s, dv_r, valid, False, 0.5 * step_s), law, x0.copy(),
        make_recorder(steps, step_s, step_s),
    )  # fmt: skip
    states = [x0.copy()]
    while run.position < steps:
        run.advance(1)
        states.append(run.x.copy())
    return np.array(states)


@pytest.mark.known(
    "twin",
    [
        "tilt_max_arcsec",
        "tilt_rms_arcsec",
        "velocity_max_mps",
        "velocity_rms_mps",
        "heading_max_arcmin",
        "heading_rms_arcmin",
        "position_max_m",
        "position_rms_m",
        "position_final_m",
    ],
    kinds=["free", "external", "internal"],
    fidelities=["error_model"],
    source="a slow program in plain Python",
)
@pytest.mark.parametrize("earth", [SPHERE, WGS84], ids=lambda e: e.name)
@pytest.mark.parametrize(
    ("damping", "parameters", "limit"),
    [
        ("free", UndampedNetwork(), None),
        ("external", ComplementaryNetwork(zeta=0.5), None),
        ("external", Classic2Network(), 0.45),
        ("external", CompassNetwork(sigma=0.0088, xi=0.7, realisation="network"), 0.6),
        ("internal", Classic2Network(), None),
        ("external", CompassNetwork(sigma=0.0088, xi=0.7), 0.6),
        ("external", CompassNetwork(sigma=0.0088, xi=0.7, realisation="as_printed"), None),
    ],
    ids=["free", "complementary", "threshold", "compass-network", "internal", "feedback", "deng"],
)
@pytest.mark.parametrize("steps", [40, STEPS])  # the mutation run makes the short one as Python
def test_kernel_equals_twin_sample_by_sample(earth, damping, parameters, limit, steps):
    truth, inputs = _moving_truth(steps, 1.0), _inputs(steps)
    omega_s = earth.schuler_frequency(LAT0)
    compiled = _compiled(truth, _law(damping, parameters, omega_s, limit, 1.0), earth, 1.0, inputs)
    law = None
    if damping != "free":
        law = TwinLaw(damping, parameters, _policy(limit), Hard(), omega_s, 1.0)
    eps, nabla, dv_r, valid, x0 = inputs
    twin = run_twin(truth, eps, nabla, dv_r, valid, x0, law, earth, 1.0)
    scale = np.abs(twin).max(axis=0)
    assert np.all(np.abs(compiled - twin) <= 1e-11 * scale)
    if damping != "free":
        free = run_twin(truth, eps, nabla, dv_r, valid, x0, None, earth, 1.0)
        done = 1e-5 if steps == STEPS else 0.0
        assert np.abs(free - twin).max() > done, "the law must have done something"


def test_kernel_moves_like_its_system_matrix():
    """Free motion at rest is expm(F t): the matrix whose eigenvalues are asserted is the kernel's."""
    from scipy.linalg import expm

    steps = 3000
    truth = np.zeros((1, COLUMNS))
    truth[0, LAT] = LAT0
    quiet = (np.zeros((steps, 3)), np.zeros((steps, 3)), np.zeros((steps + 1, 2)), np.ones(steps + 1, bool))
    x0 = np.array([0.1, -0.2, 1e-5, 2e-5, 3e-4, -2e-4, 2e-3])
    law = _law("free", UndampedNetwork(), SPHERE.schuler_frequency(LAT0), None, 1.0)
    states = _compiled(truth, law, SPHERE, 1.0, (*quiet, x0))
    exact = expm(system_matrix(LAT0, 6378137.0, 9.80665, EARTH_RATE) * steps) @ x0
    assert np.all(np.abs(states[-1] - exact) <= 1e-9 * np.abs(states).max(axis=0))
