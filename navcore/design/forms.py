"""Forms in which a network is offered: level, whole with an azimuth network, with a gyrocompass."""

from collections.abc import Iterator
from typing import Any, Literal, NamedTuple, get_args

from navcore.foundation.errors import InputError
from navcore.networks import NETWORKS
from navcore.networks.unity2 import Unity2Network
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario

_REALISATIONS = "network", "feedback"


class Form(NamedTuple):
    """A method of default settings, of which a search chooses some.

    Attributes
    ----------
    name : str
        Of the method that is offered; of several forms with one name the best is.
    scenario : Scenario
        With the method alone, designed for the sensors.
    fields : tuple of str
        What may vary, such as ``network.zeta``.
    own : tuple of Method
        Settings of this form among the scenario's own methods.
    """

    name: str
    scenario: Scenario
    fields: tuple[str, ...]
    own: tuple[Method, ...]

    @property
    def method(self) -> Method:
        """The method with its default settings."""
        return self.scenario.method[0]


def default_method(scenario: Scenario, name: str) -> Method:
    """Give a network with its defaults as a method; raises ValueError where a parameter has none."""
    damping = "external" if scenario.reference.kind != "none" else "internal"
    return Method.model_validate({"name": name, "damping": damping, "network": {"id": name}})


def forms_of(scenario: Scenario, name: str) -> list[Form]:
    """Forms of a network that a scenario can carry out.

    Parameters
    ----------
    scenario : Scenario
        Complete and checked.
    name : str
        Id of the network.

    Raises
    ------
    InputError, ValueError
        There is none: why the level form is refused.
    """
    default = default_method(scenario, name)
    level = _form(scenario, default, default)
    found = [level]
    for method in (*_other_realisations(default), *_beside_level(scenario, default)):
        try:
            found.append(_form(scenario, default, method))
        except (InputError, ValueError):  # a form that this ship or this network does not have
            continue
    return found


def _other_realisations(default: Method) -> Iterator[Method]:
    """Give the network in its other realisations with external damping."""
    info = type(default.network).model_fields.get("realisation")
    if info is None or not default.kind.referenced:
        return
    choices = {choice for part in (info.annotation, *get_args(info.annotation)) for choice in get_args(part)}
    for realisation in _REALISATIONS:
        if realisation in choices and getattr(default.network, "realisation", None) != realisation:
            yield _with(default, {"network": {"id": default.network.id, "realisation": realisation}})


def _beside_level(scenario: Scenario, default: Method) -> Iterator[Method]:
    """Give the network with the scenario's azimuth networks, or one of ours, and its gyrocompasses."""
    if scenario.run.fidelity == "channel":
        return
    own = [one.azimuth for one in scenario.method if one.azimuth.id != "none"]
    network = {"id": default.network.id}
    if "realisation" in type(default.network).model_fields:
        network["realisation"] = "network"  # velocity feedback leaves an azimuth network nothing to do
    for azimuth in dict.fromkeys(own) or (Unity2Network(),):
        block = azimuth.model_dump(mode="json", exclude_none=True)
        yield _with(default, {"name": f"{default.name}, whole", "network": network, "azimuth": block})
    for gyrocompass in dict.fromkeys(one.gyrocompass for one in scenario.method if one.gyrocompass):
        block = gyrocompass.model_dump(mode="json", exclude_none=True)
        yield _with(default, {"name": f"{default.name}, gyrocompass", "gyrocompass": block})


def _with(method: Method, changes: dict[str, Any]) -> Method:
    return Method.model_validate(method.model_dump(mode="json", exclude_none=True) | changes)


def _form(scenario: Scenario, default: Method, method: Method) -> Form:
    other = scenario.model_copy(update={"method": (method,)}).with_sensors()
    faults = [*other.faults()]
    if faults:
        raise InputError(faults)
    kind = _kind(method)
    fields = [f"network.{field}" for field in method.network.design_fields()]
    if kind == "whole":
        fields += [f"azimuth.{field}" for field in method.azimuth.design_fields()[:1]]
    if method.gyrocompass is not None:
        fields += ["gyrocompass.sigma", "gyrocompass.xi"]
    own = tuple(
        one.model_copy(update={"name": method.name})
        for one in scenario.method
        if _alike(one, method) and one.damping == default.damping
    )
    return Form(method.name, other, tuple(fields), own)


def _kind(method: Method) -> Literal["level", "whole", "gyrocompass"]:
    if method.gyrocompass is not None:
        return "gyrocompass"
    return "whole" if method.azimuth.id != "none" else "level"


def _alike(one: Method, other: Method) -> bool:
    """Whether two methods are of one form: the same networks, in the same realisation, and the same kind."""
    realisations = (getattr(each.network, "realisation", None) for each in (one, other))
    return (
        not one.undamped
        and _kind(one) == _kind(other)
        and (one.network.id, one.azimuth.id) == (other.network.id, other.azimuth.id)
        and len({*realisations}) == 1
        and one.policy.id == other.policy.id
        and one.switching.id == other.switching.id
    )


def offered() -> tuple[str, ...]:
    """Return the networks that are offered: those with a design of their own."""
    return tuple(name for name in NETWORKS if name not in ("none", "custom"))
