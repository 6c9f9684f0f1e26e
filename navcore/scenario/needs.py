"""Checks of what a kind of damping needs of the rest of a scenario."""

from collections.abc import Callable, Iterator

from navcore.alignment.loop import LARGEST_LATITUDE_DEG
from navcore.averaging.record import under_way
from navcore.damping.base import Damping
from navcore.foundation.errors import Fault, InputError
from navcore.scenario.fields import ScenarioFields

_SHORT_S = 1e-3
"""Step at which any motion gives its state at t = 0."""


def need_faults(scenario: ScenarioFields) -> Iterator[Fault]:
    """Yield the conditions of the methods' kinds of damping that are not met, each once."""
    faults = (
        fault
        for i, method in enumerate(scenario.method)
        for need in method.kind.needs
        for fault in _UNMET[need.of](scenario, Fault("", f"method.{i}.damping", method.damping, need.because))
    )
    yield from dict.fromkeys(faults)


def meets(scenario: ScenarioFields, kind: Damping) -> bool:
    """Whether a scenario gives what a kind of damping needs."""
    unmet = (_UNMET[need.of](scenario, Fault("", "", None, need.because)) for need in kind.needs)
    return not any(True for faults in unmet for _ in faults)


def _unless(met: Callable[[ScenarioFields], bool]) -> Callable[[ScenarioFields, Fault], Iterator[Fault]]:
    def check(scenario: ScenarioFields, fault: Fault) -> Iterator[Fault]:
        if not met(scenario):
            yield fault

    return check


def _under_way(scenario: ScenarioFields, fault: Fault) -> Iterator[Fault]:
    """Yield the fault of a vehicle under way at t = 0 (that of a recorded track shows when it is run)."""
    if scenario.motion.recorded:
        return
    try:
        row = scenario.motion.truth(1, _SHORT_S, scenario.site.site(), scenario.earth).values[0]
    except InputError:
        return  # a fault of the motion itself
    if moving := under_way(row, fault.allowed):
        yield moving


_UNMET = {
    "reference": _unless(lambda scenario: scenario.reference.kind != "none"),
    "log": _unless(lambda scenario: scenario.reference.kind == "log"),
    "coupled channels": _unless(lambda scenario: scenario.run.fidelity != "channel"),
    "simulated IMU": _unless(lambda scenario: scenario.imu.file is None and not scenario.on_ins),
    "standing start": _under_way,
    "below 85 deg": _unless(lambda scenario: abs(scenario.site.lat_deg) <= LARGEST_LATITUDE_DEG),
}
"""How the conditions of `navcore.damping.base.Need` are checked."""
