"""Standard deviations of constants: which field states each of them, and which are stated in no way."""

from navcore.scenario.model import Scenario
from navcore.scenario.stochastic import CONSTANTS, tells_constants


def assumed_zero(scenario: Scenario, steady: bool = False) -> tuple[str, ...]:
    """Fields of standard deviations that the scenario states in no way, so that 0 is assumed.

    Parameters
    ----------
    scenario : Scenario
        Complete and checked.
    steady : bool
        True for the steady state, which no initial error reaches.
    """
    fields = []
    for _, block, deviation, number in CONSTANTS:
        settings = getattr(scenario, block)
        if not tells_constants(scenario, block):
            continue
        if steady and block == "initial_error":
            continue
        if getattr(settings, deviation) is None and number not in settings.model_fields_set:
            fields.append(f"{block}.{deviation}")
    return tuple(fields)


def fields_of_sources(scenario: Scenario) -> dict[str, str]:
    """Field of the scenario that gives the size of each source of the error budget."""
    fields = {}
    for source, block, deviation, number in CONSTANTS:
        given = getattr(getattr(scenario, block), deviation) is not None
        fields[source] = f"{block}.{deviation if given else number}"
    for block, settings in {"imu": scenario.imu, "reference": scenario.reference}.items():
        for part in settings.all_parts():
            fields.setdefault(part.source, f"{block}.{part.fields[0]}")
    return fields
