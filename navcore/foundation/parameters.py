"""Frozen, self-checking parameter models: each field carries its unit, range, slider and help.

Everything a user can set is a field of such a model. The dashboard builds its widgets, the JSON Schema its
descriptions and the error messages their allowed ranges from the same declaration.
"""

import math
from collections.abc import Sequence
from typing import Annotated, Any, get_args, get_origin

from pydantic import AfterValidator, BaseModel, ConfigDict, Field
from pydantic.fields import FieldInfo

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.notation import unit_sign
from navcore.foundation.text import Text


class Parameters(BaseModel):
    """Base of all parameter models: immutable, no unknown fields, no NaN or infinity."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False, validate_default=False)


def sharing(after: Any, before: Any) -> Any:
    """Return ``after`` made of the very objects of ``before`` wherever the two are equal, to save memory.

    Parameters
    ----------
    after, before : Parameters, tuple or a field's value
        Neither is changed.
    """
    if type(after) is not type(before):
        return after
    if after == before:
        return before
    if type(after) is tuple:
        return (*map(sharing, after, before), *after[len(before) :])
    if isinstance(after, Parameters):
        parts = {
            name: sharing(getattr(after, name), getattr(before, name)) for name in after.model_fields_set
        }
        return after.model_copy(update=parts)
    return after


def quantity(
    default: Any,
    *,
    unit: str = "",
    ge: float | None = None,
    gt: float | None = None,
    le: float | None = None,
    lt: float | None = None,
    label: str = "",
    help: str = "",
    slider: tuple[float, float] | None = None,
    log: bool = False,
    latex: str = "",
    source: str = "",
) -> Any:
    """Declare a numeric field; TOML's true or "0.7" is refused there, not quietly read as a number.

    Parameters
    ----------
    default : object
        Default value; ``...`` for none.
    unit : str
        Unit of the field as the user enters it.
    ge, gt, le, lt : float, optional
        Allowed range.
    label : str
        Name on the page; the field's own name when empty.
    help : str
        What it does, with its source.
    slider : (float, float), optional
        Range offered by a slider, within the allowed range; no slider when None.
    log : bool
        Slider moves in equal ratios.
    latex, source : str
        Equation and source for the page's explanation, of a field that ``assets/explain.toml`` does not name.

    Returns
    -------
    pydantic field declaration.
    """
    extra: dict[str, Any] = {"unit": unit}
    if label:
        extra["label"] = label
    if slider is not None:
        extra["slider"] = list(slider)
    if log:
        extra["log"] = True
    extra |= {name: text for name, text in (("latex", latex), ("source", source)) if text}
    return Field(
        default=default,
        ge=ge,
        gt=gt,
        le=le,
        lt=lt,
        strict=True,
        description=help or None,
        json_schema_extra=extra,
    )


def _file_name(text: str) -> str:
    if "\0" in text:
        raise InputError(
            Fault("", "", text, Text("must be the path of a file: no path holds a null character"))
        )
    return text


FileName = Annotated[str, AfterValidator(_file_name)]
"""Path of a file, absolute or relative to the scenario."""


def choice(default: str, *, label: str = "", help: str = "") -> Any:
    """Declare a field whose type is a Literal: one of a few words.

    Parameters
    ----------
    default : str
        Default word.
    label, help
        As of `quantity`.

    Returns
    -------
    pydantic field declaration.
    """
    return Field(
        default=default, description=help or None, json_schema_extra={"label": label} if label else None
    )


def bounded(*, unit: str = "", ge: float | None = None, le: float | None = None) -> Any:
    """Bounds of one element of a vector: ``tuple[Annotated[float, bounded(unit="m", ge=0.0)], ...]``."""
    return Field(ge=ge, le=le, strict=True, json_schema_extra={"unit": unit})


def vector_quantity(
    default: tuple[float, ...],
    *,
    unit: str = "",
    elements: tuple[str, ...] = ("x", "y", "z"),
    label: str = "",
    help: str = "",
    slider: tuple[float, float] | tuple[tuple[float, float], ...] | None = None,
    log: bool = False,
) -> Any:
    """Declare a vector field of fixed length; its elements carry their bounds (`bounded`).

    Parameters
    ----------
    default : tuple of float
        Default values.
    unit, label, help, slider, log
        As of `quantity`; the slider is that of each element, or there is one for each.
    elements : tuple of str
        Name of each element on the page.

    Returns
    -------
    pydantic field declaration.

    Raises
    ------
    ValueError
        Numbers of values and of names differ.
    """
    if len(default) != len(elements):
        raise ValueError(f"{len(default)} values but {len(elements)} names")
    extra: dict[str, Any] = {"unit": unit, "elements": list(elements)}
    if label:
        extra["label"] = label
    if slider is not None:
        extra["slider"] = list(slider)
    if log:
        extra["log"] = True
    return Field(default=default, description=help or None, json_schema_extra=extra)


def element_of(info: FieldInfo) -> FieldInfo | None:
    """Bounds and unit of a vector's elements, as a field that `allowed_range` reads; None for others."""
    for element in get_args(info.annotation)[:1]:
        if get_origin(element) is Annotated:
            return next((extra for extra in get_args(element)[1:] if isinstance(extra, FieldInfo)), None)
    return None


def allowed_range(info: FieldInfo) -> str:
    """Say a field's allowed range in words, e.g. ``must be > 0 and <= 5 (rad/s)``; empty if open."""
    signs = {"gt": ">", "ge": ">=", "lt": "<", "le": "<="}
    parts = [
        f"{sign} {getattr(rule, name):g}"
        for name, sign in signs.items()
        for rule in info.metadata
        if getattr(rule, name, None) is not None
    ]
    unit = unit_sign(extra_of(info).get("unit", ""))
    if not parts:
        return ""
    both = parts[0] if len(parts) == 1 else Text("{low} and {high}", low=parts[0], high=parts[1])
    return Text("must be {both}{unit}", both=both, unit=f" ({unit})" if unit else "")


def bounds_of(info: FieldInfo) -> tuple[float, float]:
    """Least and largest number that a field takes; -inf and inf where it is open.

    An excluded bound gives the number next to it.
    """
    least, most = -math.inf, math.inf
    for rule in info.metadata:
        gt, ge, lt, le = (getattr(rule, name, None) for name in ("gt", "ge", "lt", "le"))
        least = least if ge is None else max(least, ge)
        least = least if gt is None else max(least, math.nextafter(gt, math.inf))
        most = most if le is None else min(most, le)
        most = most if lt is None else min(most, math.nextafter(lt, -math.inf))
    return least, most


def extra_of(info: FieldInfo) -> dict[str, Any]:
    """Unit, label, slider and log flag of a field made with `quantity`; empty for other fields."""
    extra = info.json_schema_extra
    return dict(extra) if isinstance(extra, dict) else {}


def given(data: Any, names: Sequence[str]) -> list[str]:
    """Names of the fields that raw input sets to something."""
    return [name for name in names if isinstance(data, dict) and data.get(name) is not None]
