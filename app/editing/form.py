"""From a model's field to what a control needs: label, unit, range, slider, choices, help. No widgets here.

Panels hold no lists of fields: they ask for the fields of a model and show what comes.
"""

from __future__ import annotations

import math
import types
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from navcore.foundation.notation import symbol, unit_sign
from navcore.foundation.offered import when_changed
from navcore.foundation.parameters import allowed_range, bounds_of, element_of, extra_of
from navcore.foundation.text import Text
from schuler_bench.editing.rounding import round_away, round_step, significant

Path = tuple[str | int, ...]
NONE = "none"
"""Choice of a field that may be left out: none of its values."""
Kind = Literal["number", "integer", "flag", "choice", "text", "roots", "numbers", "pairs"]

_AXES = {2: ("E", "N"), 3: ("x", "y", "z")}
_PLAIN: dict[Any, Kind] = {bool: "flag", int: "integer", float: "number", str: "text"}
_SLIDER_STEPS = 200
_SIGNIFICANT = 3
_OUTSIDE = 1e-6
"""Part of a slider's range by which a value may lie outside and still counts as its end: rounding."""
_LEAST, _MOST = 1e-100, 1e100
_LEFT_OUT = ("kind", "id", "file", "map")
"""Discriminators, and files: a visitor must name none of the server's."""


@dataclass(frozen=True)
class Slider:
    """A slider's range; position is the value itself, or its common logarithm.

    Attributes
    ----------
    low, high : float
        Ends, in the field's unit.
    log : bool
        Equal ratios instead of equal differences.
    whole : bool
        Whole numbers only.
    """

    low: float
    high: float
    log: bool
    whole: bool = False

    @property
    def ends(self) -> tuple[float, float]:
        """Lowest and highest position."""
        return (math.log10(self.low), math.log10(self.high)) if self.log else (self.low, self.high)

    @property
    def step(self) -> float:
        """Position change of one key press, about a two-hundredth of the range: 1, 2 or 5 times 10^n."""
        low, high = self.ends
        step = round_step((high - low) / _SLIDER_STEPS)
        return max(step, 1.0) if self.whole and not self.log else step

    def reaching(self, value: float, allowed: tuple[float, float]) -> Slider:
        """Slider whose range holds a value: this one, or a wider one that ends at 1, 2 or 5 times 10^n.

        Parameters
        ----------
        value : float
            To be shown. Nothing changes for a value that a logarithmic slider cannot show (0 and below), or
            whose size nobody means (below 1e-100, above 1e100).
        allowed : (float, float)
            Least and largest value of the field: the range does not grow beyond them.

        Examples
        --------
        >>> Slider(0.0, 1.0, False).reaching(3.4, (0.0, 100.0)).high
        5.0
        >>> Slider(1e-3, 1.0, True).reaching(4e-5, (0.0, 1.0)).low
        2e-05
        """
        ends = self.ends
        if (self.log and value <= 0.0) or (value != 0.0 and not _LEAST <= abs(value) <= _MOST):
            return self
        at, slack = (math.log10(value) if self.log else value), _OUTSIDE * (ends[1] - ends[0])
        if at > ends[1] + slack:
            return replace(self, high=max(value, min(round_away(value, up=True), allowed[1])))
        if at < ends[0] - slack:
            return replace(self, low=min(value, max(round_away(value, up=False), allowed[0])))
        return self

    def position(self, value: float) -> float:
        """Nearest position to a value; values beyond the ends stand at the end."""
        low, high = self.ends
        if not self.log:
            return min(max(float(value), low), high)
        return low if value <= 0.0 else min(max(math.log10(value), low), high)

    def value(self, position: float) -> float:
        """Value at a position, to as many digits as a slider can mean.

        Examples
        --------
        >>> Slider(1e-3, 1.0, True).value(-2.056)
        0.00879
        >>> Slider(0.0, 1.0, False).value(0.30000000000000004)
        0.3
        """
        low, high = self.ends
        if self.whole:
            return int(min(max(round(10.0**position if self.log else position), self.low), self.high))
        if self.log:
            return min(max(significant(10.0**position, _SIGNIFICANT), self.low), self.high)
        digits = max(0, 2 - math.floor(math.log10(self.step)))
        return min(max(round(position, digits), low), high)


@dataclass(frozen=True)
class FieldSpec:
    """Specification of a control for one field, or for one element of a vector field.

    Attributes
    ----------
    path : tuple
        Where the value lies in the canonical scenario.
    label : str
        Name with unit, unique on the page.
    hint : str
        What it does, allowed range and source, for the tooltip.
    kind : str
        "number", "integer", "flag" (yes or no), "choice", "text", "roots" (zeros or poles as text), "numbers"
        (coefficients) or "pairs" (rows of a table).
    default : object
        The model's default; None when a value may be left out.
    choices : tuple of str
        Allowed values of a "choice".
    slider : Slider or None
        Range of the slider, which grows when a value lies outside it.
    allowed : (float, float)
        Least and largest value of a number.
    """

    path: Path
    label: str
    hint: str
    kind: Kind
    default: Any
    choices: tuple[str, ...] = ()
    slider: Slider | None = None
    allowed: tuple[float, float] = (-math.inf, math.inf)

    @cached_property
    def name(self) -> str:
        """Dotted path of the field, as in ``--set``."""
        return ".".join(map(str, self.path))


def fields(model: type[BaseModel], path: Path, prefix: str = "") -> list[FieldSpec]:
    """Everything in a model that a control can show, in the model's order.

    Nested models, lists of blocks and file names are left out: they have panels of their own.

    Parameters
    ----------
    model : type
        A parameter model.
    path : tuple
        Where the model's block lies in the scenario.
    prefix : str
        Put before each label, so that labels stay unique on the page.
    """
    return list(_fields(model, path, prefix))


@lru_cache(maxsize=256)
def _fields(model: type[BaseModel], path: Path, prefix: str) -> tuple[FieldSpec, ...]:
    return tuple(
        spec
        for name, info in model.model_fields.items()
        if name not in _LEFT_OUT
        for spec in _field(name, info, (*path, name), prefix)
    )


when_changed(_fields.cache_clear)


def choice(model: type[BaseModel], name: str, path: Path, label: str = "") -> FieldSpec:
    """The control of one field that offers choices, discriminators (``kind``, ``id``) included."""
    info = model.model_fields[name]
    offered = choices_of(info)
    return FieldSpec(
        (*path, name), label or full_label(name, info), _hint(info, ""), "choice", info.default, offered
    )


def flag(model: type[BaseModel], name: str, path: Path) -> FieldSpec:
    """Control of a block that is there or not."""
    info = model.model_fields[name]
    return FieldSpec((*path, name), full_label(name, info), _hint(info, ""), "flag", False)


def choices_of(info: FieldInfo) -> tuple[str, ...]:
    """Values that a field offers; none where it takes others."""
    annotation = _without_none(info.annotation)
    return tuple(str(v) for v in get_args(annotation)) if get_origin(annotation) is Literal else ()


def _field(name: str, info: FieldInfo, path: Path, prefix: str) -> list[FieldSpec]:
    annotation = _without_none(info.annotation)
    offered = choices_of(info)
    if offered and info.default is None:
        offered = (NONE, *offered)
    kind: Kind | None = "choice" if offered else _PLAIN.get(annotation)
    if kind is None and get_origin(annotation) is tuple:
        items = [_bare(item) for item in get_args(annotation)]
        if Ellipsis not in items:
            return _vector(name, info, path, prefix) if items and set(items) == {float} else []
        kind = _kind_of_list(items[0])
    if kind is None:
        return []
    hint = _hint(info, allowed_range(info) if kind in ("integer", "number") else "")
    if kind == "pairs":
        columns = ": ".join(_bare(get_args(annotation)[0])._fields)
        hint = Text("{hint} Written as {columns}, ...", hint=hint, columns=columns)
    label = full_label(name, info, prefix)
    return [FieldSpec(path, label, hint, kind, info.default, offered, _slider(info), bounds_of(info))]


def _kind_of_list(item: Any) -> Kind | None:
    """Kind of a field that is a list of such items: roots, rows with two columns, or numbers."""
    if get_origin(item) is tuple:
        return "roots"
    if isinstance(item, type) and len(getattr(item, "_fields", ())) == 2:
        return "pairs"
    return "numbers" if item is float else None


def _vector(name: str, info: FieldInfo, path: Path, prefix: str) -> list[FieldSpec]:
    """One control for each element of a vector."""
    element, size = element_of(info), len(info.default)
    names = extra_of(info).get("elements") or _AXES.get(size, tuple(map(str, range(size))))
    ends = allowed_range(element) if element is not None else ""
    allowed = (-math.inf, math.inf) if element is None else bounds_of(element)
    return [
        FieldSpec(
            (*path, i), full_label(name, info, prefix, part), _hint(info, _with_unit(ends, part)), "number",
            info.default[i], (), _slider(info, i), allowed,
        )
        for i, part in enumerate(names)
    ]  # fmt: skip


def _with_unit(ends: str, part: str) -> str:
    """Range of an element, in the unit that stands behind its own name: ``K₁ (1/s)``."""
    unit = part.rpartition(" (")[2] if part.endswith(")") else ""
    return Text("{ends} ({unit}", ends=ends, unit=unit) if ends and unit else ends


def full_label(name: str, info: FieldInfo, prefix: str = "", part: str = "") -> str:
    """Label of a control: a prefix, the field's name, the element's name and the unit.

    A name that begins with the prefix or its singular stands without it: "wave height" in a block "waves".
    """
    extra, label = extra_of(info), plain_label(name, info)
    words = [prefix if label.split()[0].rstrip("s") != prefix.rstrip("s") else "", label, part]
    sign = unit_sign(extra.get("unit", ""))
    unit = Text("({sign})", sign=sign) if sign else ""
    return Text.joined(" ", (word for word in (*words, unit) if word))


_OF_BLOCKS = {"reference": Text("log"), "initial_error": Text("initial")}
"""What the labels of a block's fields leave out, since the page shows them in a tab of that name."""


def field_words(model: BaseModel, path: str) -> tuple[str, str]:
    """Name of a field in words, or its symbol, and its unit as the model names it.

    Parameters
    ----------
    model : BaseModel
        Parameter model, such as a scenario or a method.
    path : str
        Dotted path in it.
    """
    *blocks, name = path.split(".")
    at: Any = model
    for step in blocks:
        if step.isdigit() and isinstance(at, tuple):
            at = at[int(step)] if int(step) < len(at) else None  # of a list that is longer elsewhere
        else:
            at = getattr(at, step, None)
    info = type(at).model_fields.get(name) if isinstance(at, BaseModel) else None
    if info is None or symbol(name) != name.replace("_", " "):
        return symbol(name), ""
    extra, label = extra_of(info), plain_label(name, info)
    if (of := _OF_BLOCKS.get(blocks[0] if blocks else "")) and of not in label:
        label = Text("{of} {label}", of=of, label=label)
    unit = extra.get("unit", "")
    return label, "" if unit == "1" else unit


def label_alone(spec: FieldSpec) -> str:
    """Label of a control where no tab stands around it: with the word that the tab's name gives.

    Examples
    --------
    >>> label_alone(FieldSpec(("reference", "noise_mps"), "noise (m/s)", "", "number", 0.0))
    'log noise (m/s)'
    """
    of = _OF_BLOCKS.get(str(spec.path[0]))
    return spec.label if of is None or of in spec.label else Text("{of} {label}", of=of, label=spec.label)


def plain_label(name: str, info: FieldInfo) -> str:
    """Label of a field without unit and element: its own, else its name."""
    extra = extra_of(info)
    return extra.get("label") or name.removesuffix(f"_{extra.get('unit')}").replace("_", " ")


def _hint(info: FieldInfo, allowed: str) -> str:
    text = (info.description or "").strip()
    # The elements of a vector may have units of their own, in their names.
    if allowed and not allowed.endswith(")") and extra_of(info).get("unit") in (None, "", "1"):
        allowed = Text("{allowed} (no unit)", allowed=allowed)
    bounds = Text("{allowed:sentence}", allowed=allowed) if allowed else ""
    return Text.joined(" ", (part for part in (text, bounds) if part))


def _slider(info: FieldInfo, element: int = 0) -> Slider | None:
    extra = extra_of(info)
    ends = extra.get("slider")
    if not ends:
        return None
    if not isinstance(ends[0], int | float):
        ends = ends[element]
    whole = _without_none(info.annotation) is int
    return Slider(float(ends[0]), float(ends[1]), bool(extra.get("log")), whole)


def _bare(annotation: Any) -> Any:
    while get_origin(annotation) is Annotated:
        annotation = get_args(annotation)[0]
    return annotation


def _without_none(annotation: Any) -> Any:
    annotation = _bare(annotation)
    if get_origin(annotation) in (Union, types.UnionType):
        rest = [a for a in get_args(annotation) if a is not type(None)]
        return _bare(rest[0]) if len(rest) == 1 else annotation
    return annotation
