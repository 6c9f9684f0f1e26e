"""Which parameters a search may move, and between which ends."""

import math
import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal, get_args, get_origin

import numpy as np
from pydantic import BaseModel, ValidationError
from pydantic.fields import FieldInfo

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.faults import faults_from
from navcore.foundation.notation import symbol
from navcore.foundation.numbers import NotANumber, read_number
from navcore.foundation.parameters import bounds_of, extra_of
from navcore.foundation.text import Text
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario

_WIDEST = 1e6
"""Largest ratio of the ends of an allowed range that is searched."""
_LOG_FROM = 30.0
"""Ratio of two positive ends from which a parameter is searched in equal ratios."""
_END = 1e-3
"""Part of a range within which a value counts as standing at its end."""


@dataclass(frozen=True)
class Varied:
    """One parameter of a search.

    Attributes
    ----------
    field : str
        E.g. ``method.1.network.sigma``.
    method : int
        Index of the method.
    path : tuple of str
        Where it lies in the method.
    low, high : float
        Ends of the range.
    log : bool
        Searched in equal ratios.
    """

    field: str
    method: int
    path: tuple[str, ...]
    low: float
    high: float
    log: bool

    def value(self, place: float) -> float:
        """Value at a place 0..1 of the range."""
        if not 0.0 < place < 1.0:
            return self.low if place <= 0.0 else self.high
        if self.log:
            value = self.low * (self.high / self.low) ** place
        else:
            value = self.low + place * (self.high - self.low)
        return min(max(value, self.low), self.high)

    def place(self, value: float) -> float:
        """Place 0..1 of a value."""
        value = min(max(value, self.low), self.high)
        if self.log:
            return math.log(value / self.low) / math.log(self.high / self.low)
        return (value - self.low) / (self.high - self.low)

    def at_end(self, value: float) -> bool:
        """Whether a value stands at an end of the range."""
        place = self.place(value)
        return place < _END or place > 1.0 - _END


def read_varied(scenario: Scenario, texts: Sequence[str], whole: bool = False) -> tuple[Varied, ...]:
    """Read ``method.1.network.sigma`` or ``method.1.network.sigma=1e-4:0.1``.

    Without ends the range is that of the field's slider, or all that the field allows where it has none.

    Parameters
    ----------
    scenario : Scenario
        Whose method is tuned.
    texts : sequence of str
        One a parameter; all of the same method.
    whole : bool
        Without ends the range is all that the field allows, where that has ends.

    Raises
    ------
    InputError
        No parameter, no number of a method, or ends that the field does not allow.
    """
    if not texts:
        raise InputError(Fault("", "--vary", None, Text("is required: e.g. method.0.network.xi")))
    choices, faults = [], []
    for text in texts:
        try:
            choices.append(_read_one(scenario, text, whole))
        except InputError as error:
            faults += error.faults
    if faults:
        raise InputError(faults)
    methods = {varied.method for varied in choices}
    if len(methods) > 1:
        raise InputError(
            Fault("", "--vary", ", ".join(texts), Text("must be parameters of one and the same method"))
        )
    if len({varied.field for varied in choices}) < len(choices):
        raise InputError(Fault("", "--vary", ", ".join(texts), Text("names a parameter twice")))
    return tuple(choices)


def network_not_in_force(method: Method, field: str = "") -> str:
    """Why a parameter of a method does not act, or (without ``field``) its network; empty where it does.

    Parameters
    ----------
    method : Method
        As configured.
    field : str
        Relative to the method, such as ``network.zeta``.
    """
    if method.undamped:
        return Text('damping = "{damping}" uses no network', damping=method.damping)
    fields = method.policy.sets(method.network)
    if not (field in fields if field else fields):
        return ""
    names = dict.fromkeys(symbol(name.rsplit(".", 1)[-1]) for name in ([field] if field else fields))
    return Text('policy "{id}" sets {names} while it runs', id=method.policy.id, names=", ".join(names))


def tunable_fields(scenario: Scenario, index: int) -> tuple[str, ...]:
    """Numeric fields of a method's network that a search may move without being told a range.

    Parameters
    ----------
    scenario : Scenario
        With the method.
    index : int
        Of the method. A field that does not act (`network_not_in_force`) is left out.
    """
    network = scenario.method[index].network
    given = network.model_fields_set
    fields = []
    for name, info in type(network).model_fields.items():
        field = f"method.{index}.network.{name}"
        # A field without a default of its own is an alternative to others: it varies only where it is given.
        if not _is_number(info) or (info.default is None and name not in given):
            continue
        try:
            _read_one(scenario, field)
        except InputError:
            continue
        fields.append(field)
    return tuple(fields)


def _read_one(scenario: Scenario, text: str, whole: bool = False) -> Varied:
    field, equals, ends = (part.strip() for part in text.partition("="))
    names = field.split(".")

    def refuse(allowed: str) -> InputError:
        return InputError(Fault("", "--vary", text, allowed))

    if len(names) < 4 or names[0] != "method" or not names[1].isdigit():
        raise refuse(Text("must not vary: must be a number of a method, such as method.0.network.xi"))
    index = int(names[1])
    if index >= len(scenario.method):
        raise refuse(
            Text(
                "there is no method.{index}: must be 0 to {method}",
                index=index,
                method=len(scenario.method) - 1,
            )
        )
    model: Any = scenario.method[index]
    reason = network_not_in_force(model, ".".join(names[2:]))
    if reason:
        raise refuse(Text("must not vary: {reason}", reason=reason))
    for name in names[2:-1]:
        model = getattr(model, name, None) if isinstance(model, BaseModel) else None
    fields = type(model).model_fields if isinstance(model, BaseModel) else {}
    info = fields.get(names[-1])
    if info is None:
        numbers = ", ".join(name for name, one in fields.items() if _is_number(one))
        raise refuse(Text("is no field of this method; numbers there: {numbers}", numbers=numbers or "none"))
    if not _is_number(info):
        raise refuse(Text("must not vary: it is not a number"))
    allowed = _allowed(info)
    low, high = _read_ends(text, ends, allowed) if equals else _own_ends(text, info, allowed, whole)
    if not low < high:
        raise refuse(Text("the lower end must be below the upper one"))
    log = low > 0.0 and (high / low >= _LOG_FROM or bool(extra_of(info).get("log")))
    return Varied(field, index, tuple(names[2:]), low, high, log)


def _is_number(info: FieldInfo) -> bool:
    kinds = get_args(info.annotation) or (info.annotation,)
    return get_origin(info.annotation) is not Literal and float in kinds


def _allowed(info: FieldInfo) -> tuple[float, float]:
    low, high = bounds_of(info)
    return (0.0 if 0.0 < low < sys.float_info.min else low), high


def _read_ends(text: str, ends: str, allowed: tuple[float, float]) -> tuple[float, float]:
    parts = ends.split(":")
    try:
        low, high = (read_number(part) for part in parts)
    except NotANumber as error:
        told = Text("must end in LOW:HIGH, two numbers: {error}", error=str(error))
        raise InputError(Fault("", "--vary", text, told)) from None
    except ValueError:
        raise InputError(Fault("", "--vary", text, Text("must end in LOW:HIGH, two numbers"))) from None
    if low < allowed[0] or high > allowed[1]:
        reason = Text(
            "its range must lie within {allowed:g} and {allowed_2:g}",
            allowed=allowed[0],
            allowed_2=allowed[1],
        )
        raise InputError(Fault("", "--vary", text, reason))
    return low, high


def _own_ends(text: str, info: FieldInfo, allowed: tuple[float, float], whole: bool) -> tuple[float, float]:
    slider = extra_of(info).get("slider")
    if slider and not whole:
        return float(slider[0]), float(slider[1])
    low, high = allowed
    if math.isfinite(low) and math.isfinite(high):
        if low > 0.0 and high / low <= _WIDEST:
            return low, high
        if low == 0.0 and high <= 10.0:
            return 1e-3 * high, high
    if slider:
        return float(slider[0]), float(slider[1])
    raise InputError(
        Fault("", "--vary", text, Text("has no range of its own: give one, as in FIELD=LOW:HIGH"))
    )


def changed(scenario: Scenario, varied: Sequence[Varied], values: Sequence[float]) -> Method:
    """Method with the parameters at new values, checked, for the sensors of the scenario.

    Raises
    ------
    InputError
        The values do not go together.
    """
    method = scenario.method[varied[0].method]
    data = method.model_dump(mode="json", by_alias=True, exclude_none=True)
    for one, value in zip(varied, values, strict=True):
        place = data
        for name in one.path[:-1]:
            place = place.setdefault(name, {})
        place[one.path[-1]] = float(value)
    try:
        method_changed = Method.model_validate(data)
    except ValidationError as error:
        at = f"method.{varied[0].method}"
        faults = faults_from(error, Method, data, "")
        raise InputError([replace(fault, field=f"{at}.{fault.field}") for fault in faults]) from None
    return scenario.designed(method_changed)


def present(scenario: Scenario, varied: Sequence[Varied]) -> np.ndarray:
    """Values of the parameters as the scenario has them; NaN where one is not given."""
    values = []
    for one in varied:
        value: Any = scenario.method[one.method]
        for name in one.path:
            value = getattr(value, name, None)
        values.append(float("nan") if value is None else float(value))
    return np.array(values)
