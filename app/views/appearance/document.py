"""A session as one HTML page to keep, send and print: numbers, pictures, scenario; it loads nothing."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import datetime
from html import escape
from pathlib import Path
from string import Template

from app.editing.edits import files_of
from app.plots import table
from app.session.laid import titled
from app.session.pins import Pin
from app.session.shown import Shown
from app.session.uploads import with_plain_names
from app.session.window import window_of
from app.shell import notices
from app.views.compare.table import lines_of, pins_html
from app.views.metrics.table import metrics_html, system_html
from app.views.metrics.view import warnings_html
from app.views.requirements.table import requirements_html
from navcore.foundation.version import __version__
from navcore.scenario.file import load, presets, to_toml

_ABREAST = 3
"""Methods beside each other in a table, so that it fits on paper."""
_STATIC = Path(__file__).parent / "static"
_PAGE = Template((_STATIC / "document.html").read_text(encoding="utf-8"))
_CSS = table.CSS + (_STATIC / "document.css").read_text(encoding="utf-8")


@dataclass(frozen=True)
class Session:
    """What a document tells.

    Attributes
    ----------
    found : Shown
        The run, and how it is shown.
    pins : sequence of Pin
        All of the session.
    origin : str
        Where the scenario comes from.
    made : datetime
        When, with its time zone.
    """

    found: Shown
    pins: Sequence[Pin]
    origin: str
    made: datetime

    @property
    def title(self) -> str:
        """Name of the scenario."""
        return self.found.run.scenario.title or self.origin


def document(
    session: Session, pictures: Sequence[str], language: str = "en", say: Callable[[str], str] = str
) -> str:
    """HTML of the page, with ``<img data-picture="2">`` where the third picture is to stand.

    Parameters
    ----------
    session : Session
        What it tells.
    pictures : sequence of str
        Their titles.
    language : str
        Of the page, as a browser tells it.
    say : callable
        Translates HTML.
    """
    body = say(
        f"<header><h1>Schuler Bench: {escape(session.title)}</h1>{_about(session)}</header>"
        f"{_warnings(session)}{_metrics(session)}{_requirements(session)}{_pins(session)}"
        f"<section><h2>Plots</h2>{''.join(_figure(i, title) for i, title in enumerate(pictures))}</section>"
        f"{_scenario(session)}"
    )
    title = escape(session.title)
    return _PAGE.substitute(language=escape(language), title=title, style=_CSS, body=body)


def command(session: Session) -> str:
    """Command that runs the scenario again: by its name while it is a preset, else from the file."""
    scenario = session.found.run.scenario
    if session.origin in presets() and load(session.origin) == scenario:
        return f"schuler run {session.origin}"
    return "schuler run scenario.toml"


def _about(session: Session) -> str:
    scenario = session.found.run.scenario
    source = f"<p>{escape(scenario.source)}</p>" if scenario.source else ""
    lines = {
        "Scenario": escape(session.origin),
        "Duration": f"{scenario.run.duration_h:g} h",
        "Date": f"{session.made:%Y-%m-%d %H:%M %Z}",
        "Program": f"Schuler Bench {__version__}",
        "SHA-256": f"<code>{session.found.run.scenario_sha256}</code>",
        "Run it again": f'<code translate="no">{escape(command(session))}</code>',
    }
    rows = "".join(f"<dt>{name}</dt><dd>{value}</dd>" for name, value in lines.items())
    return f"{source}<dl>{rows}</dl>"


def _warnings(session: Session) -> str:
    found = session.found
    told = warnings_html(found.run, found.verified)
    heading = "<h2>Warnings about the run</h2>" if "sb-note" in told else ""
    return f"<section>{heading}{told}</section>" if heading else ""


def _parts(count: int) -> list[range]:
    """Columns of tables that are about equally wide."""
    tables = -(-count // _ABREAST)
    each = -(-count // max(tables, 1))
    return [range(first, min(first + each, count)) for first in range(0, count, max(each, 1))]


def _metrics(session: Session) -> str:
    found = session.found
    window = window_of(found.run, found.display)
    told = notices.note([window.told] if window.told else [], "info" if window.possible else "warning")
    tables = "".join(
        f'<div class="table">{metrics_html(window.run, part, display=found.display)}</div>'
        for part in _parts(len(window.run.methods))
    )
    system = system_html(found.run).replace("<details ", "<details open ", 1)
    return f'<section><h2>Metrics</h2>{told}{tables}<div class="table">{system}</div></section>'


def _requirements(session: Session) -> str:
    found = session.found
    asked = found.display.requirements
    if not asked.any:
        return "<section><h2>Requirements</h2><p>No requirement is set.</p></section>"
    run = window_of(found.run, found.display).run
    tables = "".join(
        f'<div class="table">{requirements_html(run, asked, methods=part)}</div>'
        for part in _parts(len(run.methods))
    )
    return f"<section><h2>Requirements</h2>{tables}</section>"


def _pins(session: Session) -> str:
    found = session.found
    pins = titled(session.pins, found.run.scenario)
    if not pins:
        return "<section><h2>Pins</h2><p>No run is pinned.</p></section>"
    lines = lines_of(window_of(found.run, found.display), found.selected, pins, found.display.requirements)
    baseline = None if found.baseline is None else found.baseline.id
    table = pins_html(lines, found.display.pins_by, baseline, buttons=False)
    return f'<section><h2>Pins</h2><div class="table">{table}</div></section>'


def _figure(place: int, title: str) -> str:
    return (
        f'<figure><figcaption>{escape(title)}</figcaption><img data-picture="{place}" alt="{escape(title)}">'
        "</figure>"
    )


def _scenario(session: Session) -> str:
    scenario = with_plain_names(session.found.run.scenario)
    files = ", ".join(sorted(files_of(scenario)))
    beside = f"<p>It needs these recordings beside it: {escape(files)}.</p>" if files else ""
    how = "<p>To compute the run again, save this text as scenario.toml and give the command above.</p>"
    return f"<section><h2>Scenario</h2>{how}{beside}<pre>{escape(to_toml(scenario))}</pre></section>"
