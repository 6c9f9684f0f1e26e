"""Random raw input made from the parameter models themselves: ranges, choices and lengths as declared."""

import types
from collections.abc import Callable
from functools import cache
from typing import Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints

from hypothesis import strategies as st
from pydantic import BaseModel, TypeAdapter, ValidationError
from pydantic.fields import FieldInfo

from navcore.foundation.errors import InputError
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario

SKIPPED = ("file", "map", "axes", "speed")
"""Fields that only mean something with a recorded file."""
_MOST_ITEMS = 3
_ATTEMPTS = 4
_SMALLEST = 1e-9


def raw_values(annotation: Any, info: FieldInfo | None = None) -> st.SearchStrategy[Any]:
    """Strategy for raw input of an annotation, as TOML would give it."""
    origin, args = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        extra = next((item for item in args[1:] if isinstance(item, FieldInfo)), None)
        return raw_values(args[0], extra or info)
    if origin in (Union, types.UnionType):
        return st.one_of(*(raw_values(arg, info) for arg in args if arg is not type(None)))
    if origin is Literal:
        return st.sampled_from(args)
    if origin is tuple:
        return _tuples(args, info)
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return raw_blocks(annotation)
    if isinstance(annotation, type) and issubclass(annotation, tuple):
        hints = get_type_hints(annotation, include_extras=True)
        return st.tuples(*(raw_values(hint) for hint in hints.values())).map(list)
    if annotation is bool:
        return st.booleans()
    if annotation is int:
        low, high = _bounds(info, -1000, 1000)
        return st.integers(int(low), int(min(high, 10**6)))
    if annotation is float:
        return _floats(info)
    if annotation is str:
        return st.text(max_size=_rule(info, "max_length") or 20)
    raise AssertionError(f"no strategy for {annotation!r}: the models have a new kind of field")


def raw_blocks(model: type[BaseModel]) -> st.SearchStrategy[dict[str, Any]]:
    """Strategy for the raw fields of a model; each may be left out but the one that names the kind."""
    fixed, free = {}, {}
    for name, info in model.model_fields.items():
        if name in SKIPPED:
            continue
        target = fixed if name in ("id", "kind") and get_origin(info.annotation) is Literal else free
        target[info.alias or name] = raw_values(info.annotation, info)
    return st.fixed_dictionaries(fixed, optional=free)


@cache
def _field(model: type[BaseModel], name: str) -> tuple[st.SearchStrategy[Any], TypeAdapter[Any]]:
    info = model.model_fields[name]
    return raw_values(info.annotation, info), TypeAdapter(info.rebuild_annotation())


def valid_value(draw: Callable[..., Any], model: type[BaseModel], name: str) -> Any:
    """Raw input that a model's field takes, or None when a few attempts did not find any."""
    strategy, adapter = _field(model, name)
    for _ in range(_ATTEMPTS):
        raw = draw(strategy)
        try:
            adapter.validate_python(raw)
        except (ValidationError, InputError):
            continue
        return raw
    return None


@st.composite
def raw_scenarios(draw: Callable[..., Any], duration_h: float | None = None) -> dict[str, Any]:
    """Raw scenarios whose blocks are valid one by one; the whole may still be refused.

    Parameters
    ----------
    draw : callable
        From hypothesis.
    duration_h : float, optional
        Length of every run, for tests that carry them out; steps are then of 1 s or more, IMU rates of
        100 Hz or less.
    """
    data: dict[str, Any] = {}
    for name in Scenario.model_fields:
        if name in ("schema_version", "method") or not draw(st.booleans()):
            continue
        value = valid_value(draw, Scenario, name)
        if value is not None:
            data[name] = value
    if draw(st.integers(0, 3)) > 0:
        _reconcile(data)
    has_log = data.get("reference", {}).get("kind") == "log"
    methods = []
    for index in range(draw(st.integers(1, _MOST_ITEMS))):
        method: dict[str, Any] = {"name": f"method {index}"} if draw(st.booleans()) else {}
        for name in Method.model_fields:
            wanted = draw(st.booleans()) and (has_log or name != "event") and name not in method
            value = valid_value(draw, Method, name) if wanted else None
            if value is not None:
                method[name] = value
        methods.append(method)
    data["method"] = methods
    if duration_h is not None:
        run = {"step_s": 1.0, "rate_hz": 50.0, **data.get("run", {}), "duration_h": duration_h}
        data["run"] = {**run, "step_s": max(1.0, run["step_s"]), "rate_hz": min(100.0, run["rate_hz"])}
    return data


def _reconcile(data: dict[str, Any]) -> None:
    """Make the blocks fit each other more often than chance does; what is left is for the whole to refuse."""
    if data.get("reference", {}).get("kind") != "file":
        data.setdefault("reference", {})["kind"] = "log"
    if data.get("run", {}).get("fidelity") != "strapdown":
        data.pop("alignment", None)
        for name in ("vertical", "compensation"):
            data.get("run", {}).pop(name, None)
    for name in ("begin_s", "axes"):
        data.get("imu", {}).pop(name, None)


def _tuples(args: tuple[Any, ...], info: FieldInfo | None) -> st.SearchStrategy[Any]:
    if len(args) == 2 and args[1] is Ellipsis:
        low = _rule(info, "min_length") or 0
        high = max(low, min(_rule(info, "max_length") or _MOST_ITEMS, _MOST_ITEMS))
        return st.lists(raw_values(args[0]), min_size=low, max_size=high)
    return st.tuples(*(raw_values(arg) for arg in args)).map(list)


def _floats(info: FieldInfo | None) -> st.SearchStrategy[float]:
    low, high = _bounds(info, -1000.0, 1000.0)
    above, below = _rule(info, "gt") is not None, _rule(info, "lt") is not None
    anything = st.floats(
        low, high, exclude_min=above, exclude_max=below, allow_nan=False, allow_subnormal=False
    )
    usual = st.floats(*_slider(info, low, high)).map(lambda value: float(f"{value:.3g}"))
    # squares and quotients of numbers like 1e-300 leave the range of floats: arithmetic, not the models
    large_enough = st.one_of(usual, anything).filter(lambda value: value == 0.0 or abs(value) >= _SMALLEST)
    return large_enough.filter(
        lambda value: low <= value <= high and not (above and value == low) and not (below and value == high)
    )


def _slider(info: FieldInfo | None, low: float, high: float) -> tuple[float, float]:
    extra = info.json_schema_extra if info is not None else None
    slider: Any = extra.get("slider") if isinstance(extra, dict) else None
    return (float(slider[0]), float(slider[1])) if slider else (max(low, -100.0), min(high, 100.0))


def _bounds(info: FieldInfo | None, low: float, high: float) -> tuple[float, float]:
    found_low = [v for v in (_rule(info, "ge"), _rule(info, "gt")) if v is not None]
    found_high = [v for v in (_rule(info, "le"), _rule(info, "lt")) if v is not None]
    bottom = found_low[0] if found_low else min(low, found_high[0] if found_high else low)
    top = found_high[0] if found_high else max(high, bottom)
    return bottom, top


def _rule(info: FieldInfo | None, name: str) -> Any:
    if info is None:
        return None
    return next((getattr(r, name) for r in info.metadata if getattr(r, name, None) is not None), None)
