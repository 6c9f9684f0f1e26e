"""No causal linear method of the catalogue is ever better than the floor."""

from typing import Any

from hypothesis import assume, given, settings
from hypothesis import strategies as st

from navcore.design.budget import budget
from navcore.foundation.errors import InputError
from navcore.networks import NETWORKS
from navcore.scenario.model import Scenario
from tests.random_models import raw_blocks

any_network = st.one_of(*(raw_blocks(model) for name, model in NETWORKS.items() if name != "none"))
size = st.one_of(st.just(0.0), st.floats(0.1, 10.0))


@given(
    network=any_network,
    imu=st.tuples(size, size, size, size),
    log=st.tuples(size, size),
    taus=st.tuples(*[st.floats(30.0, 1e5)] * 3),
)
@settings(max_examples=300, deadline=None)
def test_no_network_is_better_than_the_floor(
    network: dict[str, Any], imu: tuple[float, ...], log: tuple[float, ...], taus: tuple[float, ...]
) -> None:
    """Tilt and velocity of every network with random sensors stay above the floor of these sensors.

    Without any noise of the log, and with few errors of the others, a filter may come to no steady state.
    """
    data = {
        "run": {"earth": "sphere"},
        "imu": {
            "gyro_arw_dpsh": 0.003 * imu[0],
            "gyro_instability_dph": 0.003 * imu[1],
            "accel_vrw_ugpshz": 10.0 * imu[2],
            "accel_instability_ug": 10.0 * imu[3],
            "gyro_tau_s": taus[0],
            "accel_tau_s": taus[1],
        },
        "reference": {
            "kind": "log",
            "noise_mps": 0.1 * log[0],
            "drift_mps": 0.1 * log[1],
            "drift_tau_s": taus[2],
        },
        "method": [{"damping": "external", "network": network}],
    }
    try:
        found = budget(Scenario.parse(data), steady=True)
    except InputError:
        assume(False)
        return
    own, least = found.methods[0].total.rms, found.floor.rms
    assume(own.tilt_rad is not None and own.velocity_mps is not None)
    assume(least.tilt_rad is not None)
    assert least.tilt_rad is not None and least.velocity_mps is not None
    assert own.tilt_rad is not None and own.velocity_mps is not None
    assert own.tilt_rad >= least.tilt_rad * (1.0 - 1e-6)
    assert own.velocity_mps >= least.velocity_mps * (1.0 - 1e-6)


def test_there_is_a_floor_wherever_gyros_and_log_err() -> None:
    """Only where a filter goes on learning for ever there is none: then it says so."""
    for imu, log, exists in (
        ({"gyro_arw_dpsh": 0.003}, {"noise_mps": 0.2}, True),
        ({"gyro_arw_dpsh": 0.003}, {"drift_mps": 3.0, "drift_tau_s": 2e5, "noise_mps": 0.02}, True),
        ({"gyro_arw_dpsh": 0.003, "accel_instability_ug": 10.0}, {}, True),
        ({"accel_vrw_ugpshz": 10.0, "accel_instability_ug": 10.0}, {}, False),
    ):
        method = {"damping": "external", "network": {"id": "compass", "sigma": 1.0, "xi": 1.0}}
        data = {"imu": imu, "reference": {"kind": "log", **log}, "method": [method]}
        found = budget(Scenario.parse(data), steady=True)
        assert (found.floor.rms.tilt_rad is not None) is exists
        assert bool(found.floor_reason) is not exists
