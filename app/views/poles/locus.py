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
from navcore.foundation.text import Text
from navcore.networks.base import NetworkParameters

NO_LOCUS = ""
_COUNT = 161


def locus_fields(network: NetworkParameters) -> dict[str, str]:
    """Parameters over which a locus can be drawn, those with a slider: field -> label with its unit."""
    return {
        name: form.full_label(name, info)
        for name, info in type(network).model_fields.items()
        if "slider" in (extra := extra_of(info)) and "elements" not in extra
    }


def locus_of(run: Run, index: int, field: str) -> Locus | None:
    """Locus of a method's loop over the range of a parameter's slider; None where there is none."""
    if not field or not 0 <= index < len(run.methods):
        return None
    method = run.methods[index]
    if method.method.undamped or field not in locus_fields(method.method.network):
        return None
    locus = _computed(_giving(run, index, field), field, run.scenario.omega_s)
    return locus if len(locus.values) > 1 else None


def _giving(run: Run, index: int, field: str) -> Any:
    """The network given by that parameter, at the low end of its slider: one for all its values.

    Sigma and xi become the gains when one of them is to move.
    """
    from app.editing.edits import network_values, with_value

    parameters = run.scenario.method[index].network
    value = network_values(run.scenario, index).get(field)
    if getattr(parameters, field) is None and value is not None:
        parameters = (
            with_value(run.scenario, ("method", index, "network", field), value).method[index].network
        )
    low, _ = extra_of(type(parameters).model_fields[field])["slider"]
    return parameters.model_copy(update={field: low})


@lru_cache(maxsize=32)
def _computed(parameters: Any, field: str, omega_s: float) -> Locus:
    extra = extra_of(type(parameters).model_fields[field])
    spaced = np.geomspace if extra.get("log") else np.linspace
    low, high = extra["slider"]
    return root_locus(parameters, field, spaced(low, high, _COUNT), omega_s)


def locus_traces(run: Run, index: int, field: str, suffix: str) -> list[dict[str, Any]]:
    """Branches of the locus in one panel of the pole map, with marks at both ends; empty without one."""
    locus = locus_of(run, index, field)
    if locus is None:
        return []
    method = run.methods[index]
    scaled = locus.poles / method.network.omega_s
    color, name, count = style.method_color(index), method.method.name, scaled.shape[1]
    label = locus_fields(method.method.network)[field]
    line = np.concatenate([scaled, np.full((1, count), complex(math.nan, math.nan))]).T.ravel()
    ends = np.concatenate([scaled[0], scaled[-1]])
    common: dict[str, Any] = {
        "xaxis": f"x{suffix}",
        "yaxis": f"y{suffix}",
        "showlegend": False,
        "hovertemplate": f"<b>{style.plain(name)}</b><br>{label} = %{{customdata:.4g}}<extra></extra>",
    }
    branches = style.lines(Text("{name} locus", name=name), index) | common
    branches |= {
        "x": packed(np.real(line)),
        "y": packed(np.imag(line)),
        "customdata": packed(np.tile(np.append(locus.values, math.nan), count)),
        "line": {"color": color, "width": 1.6, "dash": "dot"},
    }
    marks = (
        style.marks(Text("{name} locus ends", name=name), index, "", 7, {"width": 1.5, "color": color})
        | common
    )
    marks |= {
        "x": packed(np.real(ends)),
        "y": packed(np.imag(ends)),
        "customdata": packed(np.repeat(locus.values[[0, -1]], count)),
        "marker": marks["marker"] | {"symbol": ["circle-open"] * count + ["square-open"] * count},
    }
    return [branches, marks]


def locus_note(run: Run, index: int, field: str) -> str:
    """Say what moves along the branches, from which end to which, and where it is; empty without a locus."""
    from app.editing.edits import network_values

    locus = locus_of(run, index, field)
    if locus is None:
        return ""
    extra = extra_of(type(run.methods[index].method.network).model_fields[field])
    first, last = (number(float(value), 3) for value in locus.values[[0, -1]])
    now = network_values(run.scenario, index).get(field)
    present = "" if now is None else f", ✕ {number(float(now), 3)}"
    unit = f" {unit_sign(extra['unit'])}" if extra.get("unit") else ""
    return Text(
        "over {symbol}: ○ {first} … □ {last}{present}{unit}",
        symbol=symbol(field),
        first=first,
        last=last,
        present=present,
        unit=unit,
    )
