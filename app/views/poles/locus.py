"""Root locus over one parameter of a method's network, drawn through the pole map."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import numpy as np

from app.editing import form
from app.plots import style
from app.plots.plotly_data import packed
from app.plots.units import number
from navcore.analysis.locus import Locus, root_locus
from navcore.engine.run import Run
from navcore.foundation.notation import symbol, unit_sign
from navcore.foundation.parameters import extra_of
from navcore.networks.base import NetworkParameters

NO_LOCUS = ""
_COUNT = 161
_START, _END = "circle", "square"


def locus_fields(network: NetworkParameters) -> dict[str, str]:
    """Parameters over which a locus can be drawn, those with a slider: field -> label with its unit."""
    found: dict[str, str] = {}
    for name, info in type(network).model_fields.items():
        extra = extra_of(info)
        if "slider" in extra and "elements" not in extra:
            found[name] = form.full_label(name, info)
    return found


def locus_of(run: Run, index: int, field: str) -> Locus | None:
    """Locus of a method's loop over the range of a parameter's slider; None where there is none."""
    if not field or not 0 <= index < len(run.methods):
        return None
    method = run.methods[index]
    if method.method.undamped or field not in locus_fields(method.method.network):
        return None
    parameters = _giving(run, index, field)
    found = _computed(_Key(parameters, field, run.scenario.omega_s))
    return found if len(found.values) > 1 else None


def _giving(run: Run, index: int, field: str) -> NetworkParameters:
    """The network given by that parameter: sigma and xi become the gains when one of them is to move."""
    from app.editing.edits import network_values, with_value

    path = ("method", index, "network", field)
    parameters = run.scenario.method[index].network
    if getattr(parameters, field) is not None:
        return parameters
    value = network_values(run.scenario, index).get(field)
    return with_value(run.scenario, path, value).method[index].network if value is not None else parameters


class _Key:
    """A network apart from the value of one parameter: a slider of that parameter asks the same again."""

    def __init__(self, parameters: NetworkParameters, field: str, omega_s: float) -> None:
        self.parameters, self.field, self.omega_s = parameters, field, omega_s
        others = sorted((k, repr(v)) for k, v in parameters if k != field)
        self._same = type(parameters).__name__, field, omega_s, tuple(others)

    def __hash__(self) -> int:
        return hash(self._same)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Key) and self._same == other._same


@lru_cache(maxsize=32)
def _computed(key: _Key) -> Locus:
    extra = extra_of(type(key.parameters).model_fields[key.field])
    low, high = extra["slider"]
    spaced = np.geomspace if extra.get("log") else np.linspace
    return root_locus(key.parameters, key.field, spaced(low, high, _COUNT), key.omega_s)


def locus_traces(run: Run, index: int, field: str, suffix: str) -> list[dict[str, Any]]:
    """Branches of the locus in one panel of the pole map, with marks at both ends; empty without one."""
    found = locus_of(run, index, field)
    if found is None:
        return []
    method = run.methods[index]
    scaled = found.poles / method.network.omega_s
    color, name = style.method_color(index), style.plain(method.method.name)
    label = locus_fields(method.method.network)[field]
    gap = np.full((1, scaled.shape[1]), complex(math.nan, math.nan))
    line = np.concatenate([scaled, gap]).T.ravel()
    values = np.tile(np.append(found.values, math.nan), scaled.shape[1])
    common: dict[str, Any] = {
        "type": "scatter",
        "xaxis": f"x{suffix}",
        "yaxis": f"y{suffix}",
        "legendgroup": str(index),
        "showlegend": False,
        "hovertemplate": f"<b>{name}</b><br>{label} = %{{customdata:.4g}}<extra></extra>",
    }
    ends = np.concatenate([scaled[0], scaled[-1]])
    count = scaled.shape[1]
    return [
        common
        | {
            "mode": "lines",
            "name": f"{name} locus",
            "x": packed(np.real(line)),
            "y": packed(np.imag(line)),
            "customdata": packed(values),
            "line": {"color": color, "width": 1.6, "dash": "dot"},
        },
        common
        | {
            "mode": "markers",
            "name": f"{name} locus ends",
            "x": packed(np.real(ends)),
            "y": packed(np.imag(ends)),
            "customdata": packed(np.repeat(found.values[[0, -1]], count)),
            "marker": {
                "symbol": [f"{_START}-open"] * count + [f"{_END}-open"] * count,
                "size": 7,
                "color": color,
                "line": {"width": 1.5, "color": color},
            },
        },
    ]


def locus_note(run: Run, index: int, field: str) -> str:
    """Say what moves along the branches, from which end to which, and where it is; empty without a locus."""
    from app.editing.edits import network_values

    found = locus_of(run, index, field)
    if found is None:
        return ""
    extra = extra_of(type(run.methods[index].method.network).model_fields[field])
    first, last = (number(float(value), 3) for value in found.values[[0, -1]])
    now = network_values(run.scenario, index).get(field)
    present = "" if now is None else f", ✕ {number(float(now), 3)}"
    unit = f" {unit_sign(extra['unit'])}" if extra.get("unit") else ""
    return f"over {symbol(field)}: ○ {first} … □ {last}{present}{unit}"
