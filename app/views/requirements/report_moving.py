"""The part of a report that still moves: sliders run the error model in the browser, without a server."""

import base64
import json
from html import escape
from typing import Any

from navcore.foundation.assets import asset_path
from navcore.foundation.errors import InputError
from navcore.foundation.text import Text
from navcore.quantities import HEADING, KINDS, Kind, components
from navcore.scenario.model import Scenario
from schuler_bench.views.requirements.moving import Moving, moving_of

_STYLE = (
    "#sb-moving .sb-sliders{display:grid;grid-template-columns:repeat(auto-fill,minmax(230px,1fr));"
    "gap:6px 14px}"
    "#sb-moving .sb-slider{display:block;padding-left:6px;font-size:13px}"
    "#sb-moving input{display:block;width:100%;height:28px;margin:0}"
    "#sb-moving canvas{width:100%;height:auto}"
    "#sb-moving button{margin:8px 0;padding:4px 10px;font:inherit}"
    "#sb-moving output{font-weight:600}"
    "@media print{#sb-moving{display:none}}"
)
_WAITS = Text("The sliders come where scripts may run.")


def moving_section(scenario: Scenario) -> tuple[str, str]:
    """Return the part's HTML, and its script; why there is none, and no script.

    Parameters
    ----------
    scenario : Scenario
        Of the report.
    """
    try:
        found = moving_of(scenario)
    except InputError as error:
        reason = Text.joined("; ", (fault.allowed for fault in error.faults))
        return Text("<p>No sliders: the scenario {reason:html}.</p>", reason=reason), ""
    about = Text.joined(" ", (Text("<p>{text:html}</p>", text=text) for text in _about(scenario, found)))
    program = asset_path("moving/error_model.wasm").read_bytes()
    held = {
        "header": json.dumps(found.header | {"plots": list(_plots(found.scenario))}, ensure_ascii=False),
        "numbers": base64.b64encode(found.packed()).decode(),
        "program": base64.b64encode(program).decode(),
    }
    templates = "".join(
        f'<template id="sb-moving-{name}">{escape(text, quote=False)}</template>'
        for name, text in held.items()
    )
    html = Text(
        '<style>{style}</style>{about}<div id="sb-moving"><p class="sb-waits">{waits:html}</p></div>{data}',
        style=_STYLE,
        about=about,
        waits=_WAITS,
        data=templates,
    )
    return html, asset_path("moving/report.js").read_text("utf-8")


def _about(scenario: Scenario, found: Moving) -> list[str]:
    run = found.scenario.run
    said: list[str] = [
        Text(
            "The sliders run the linear error model of {duration:.4g} h with a step of {step:g} s in this "
            "page; all else is as in the scenario.",
            duration=run.duration_h,
            step=run.step_s,
        )
    ]
    if scenario.strapdown:
        said.append(Text("The report's own runs are those of the full strapdown mechanization."))
    said += [
        Text("{name} does not move: {reason}.", name=name, reason=reason) for name, reason in found.left_out
    ]
    return said


def _plots(scenario: Scenario) -> list[dict[str, Any]]:
    """What is drawn: the kinds of errors of the report's own plots."""
    from navcore.quantities import COMPONENTS

    shown: list[Kind] = [kind for kind in KINDS if scenario.run.fidelity != "channel" or kind is not HEADING]
    return [
        {
            "title": str(kind.title),
            "unit": str(kind.unit),
            "size": kind.size,
            "columns": [COMPONENTS.index(name) for name in components(kind)],
        }
        for kind in shown
    ]
