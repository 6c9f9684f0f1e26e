"""The guide to the scenario file, written from the parameter models: ``python -m navcore.scenario.guide``.

A test holds ``docs/scenario.md`` against the models, so that no field is missing from it or told wrongly.
"""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Literal, get_args, get_origin

from pydantic.fields import FieldInfo

from navcore.averaging import AlignmentMotion
from navcore.damping import KINDS
from navcore.foundation.markdown import markdown_table
from navcore.foundation.parameters import Parameters, allowed_range, element_of, extra_of
from navcore.foundation.registry import blocks_of
from navcore.law.policy import POLICIES
from navcore.law.switching import SWITCHINGS
from navcore.motion import MOTIONS
from navcore.networks import NETWORKS
from navcore.scenario.blocks import Alignment, RunSettings, SiteSettings, View
from navcore.scenario.initial_error import InitialError
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.scenario.own_ins import Ins, TruthFile
from navcore.scenario.requirement import Requirement
from navcore.sensors.imu import Imu
from navcore.sensors.log_errors.events import LogEvent
from navcore.sensors.log_errors.water import Current
from navcore.sensors.reference import Outage, Reference

INTRODUCTION = """# The scenario file

TOML, schema 1. Every field has a default; a field that is not known here is refused, as is a value out of
its range. `schuler check FILE` says what a scenario holds, `schuler run FILE --set KEY=VALUE` changes one
field of it, and [the JSON Schema](../assets/scenario.schema.json) serves an editor. This page is written from
the program by `make guide`; do not edit it.

A name alone stands for a block that has nothing else: `network = "classic2"` is
`network = { id = "classic2" }`; likewise `policy`, `policy.network`, `switching` and `motion`. A block that
has `t_h` or `duration_s` below takes `t_s` or `duration_h` as well, and the other way round, but not one time
in both units. Numbers have a decimal point.

All `[[method]]` blocks of a scenario run on the same truth, the same sensor errors and the same log.
"""


SHIPS = ("ferry", "submarine", "survey")
"""Scenarios of ``examples`` that the guide holds."""
_ABOUT_SHIPS = """## Three ships

`examples/` holds them. Legs, outages, events and currents repeat; a log fails below a speed and in its
outages; a moored ship knows its velocity; waves and changes of depth belong to the course.
"""
_ROOT = Path(__file__).resolve().parents[2]

_CITATION = re.compile(r"theory\.md (?:section )?(\d+)(?:\.(\d+))?")


def _linked(text: str) -> str:
    """Text in which each section of the theory that it cites is a link to its anchor."""
    return _CITATION.sub(
        lambda match: f"[{match[0]}](theory.md#s-{'-'.join(filter(None, match.groups()))})", text
    )


def _sections() -> Iterator[tuple[str, type[Parameters], str]]:
    yield "at the top", Scenario, "The blocks follow below."
    yield "[run]", RunSettings, ""
    yield "[site]", SiteSettings, ""
    for kind, model in MOTIONS.items():
        yield f'[motion] kind = "{kind}"', model, ""
        for block, fields in blocks_of(model).items():
            tables = (f"[[motion.{name}]]" if many else f"[motion.{name}]" for name, many in fields)
            yield ", ".join(tables), block, f'With kind = "{kind}".'
    yield "[imu]", Imu, ""
    yield "[alignment]", Alignment, ""
    yield "[[alignment.motion]]", AlignmentMotion, ""
    yield "[initial_error]", InitialError, ""
    yield "[ins]", Ins, ""
    yield "[truth]", TruthFile, ""
    yield "[reference]", Reference, ""
    yield "[[reference.event]]", LogEvent, "also `event` of a method"
    yield "[[reference.outage]]", Outage, ""
    yield "[[reference.current]]", Current, ""
    yield "[[method]]", Method, ""
    for name, kind in KINDS.items():
        if kind.settings is not None:
            yield f"{name} = {{ ... }}", kind.settings, ""
    for name, model in NETWORKS.items():
        yield f'network = {{ id = "{name}" }}', model, f"{model.title}. Source: {model.source}."
    for name, model in POLICIES.items():
        yield f'policy = {{ id = "{name}" }}', model, ""
    for name, model in SWITCHINGS.items():
        yield f'switching = {{ id = "{name}" }}', model, ""
    yield "[[requirement]]", Requirement, ""
    yield "[view]", View, ""


def _first_paragraph(model: type[Parameters]) -> str:
    return " ".join((model.__doc__ or "").split("\n\n")[0].split())


def _default(info: FieldInfo) -> str:
    value: Any = info.default
    if info.default_factory is not None or isinstance(value, Parameters):
        return ""
    if isinstance(value, tuple):
        return "" if any(isinstance(item, Parameters) for item in value) else f"`{list(value)}`"
    return "none" if value is None else f'`"{value}"`' if isinstance(value, str) else f"`{value}`"


def _allowed(info: FieldInfo) -> str:
    words = get_args(info.annotation) if get_origin(info.annotation) is Literal else ()
    if words:
        return ", ".join(f"`{word}`" for word in words)
    return allowed_range(element_of(info) or info).removeprefix("must be ")


def _row(name: str, info: FieldInfo) -> list[str]:
    text = " ".join((info.description or "").split())
    elements = extra_of(info).get("elements")
    if elements:
        text = f"{', '.join(elements)}. {text}"
    return [f"`{info.alias or name}`", _default(info), _allowed(info), text.replace("|V", "\\|V")]


def guide() -> str:
    """Return the guide as Markdown."""
    parts = [INTRODUCTION, _ABOUT_SHIPS]
    for ship in SHIPS:
        text = (_ROOT / "examples" / f"{ship}.toml").read_text(encoding="utf-8")
        parts.append(f"```toml\n{text.strip()}\n```\n")
    for heading, model, note in _sections():
        about = " ".join(text for text in (_first_paragraph(model), note) if text)
        rows = [_row(name, info) for name, info in model.model_fields.items() if info.description]
        parts.append(f"## `{heading}`\n\n{about}\n")
        if rows:
            parts.append(markdown_table(("field", "default", "allowed", "what"), rows) + "\n")
    return _linked("\n".join(parts))


def main() -> None:
    """Write ``docs/scenario.md`` of the checkout."""
    path = _ROOT / "docs" / "scenario.md"
    path.parent.mkdir(exist_ok=True)
    path.write_text(guide(), encoding="utf-8")


if __name__ == "__main__":
    main()
