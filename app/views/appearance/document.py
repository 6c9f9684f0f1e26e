"""A session in one file: an HTML page to keep, send and print, or one picture of all plots."""

from collections.abc import Callable, Sequence
from copy import copy
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from functools import partial
from html import escape
from typing import Any

from navcore.engine.run import Run
from navcore.foundation.text import Text, quoted
from navcore.foundation.version import __version__
from navcore.scenario.file import load, presets, to_toml
from navcore.scenario.provenance import source_of
from schuler_bench.bridge.texts import figure_said, language_of, text_said
from schuler_bench.editing.edits import files_of
from schuler_bench.plots import table
from schuler_bench.plots.paper import paper, section
from schuler_bench.plots.plotly_data import PlotlyFigure
from schuler_bench.plots.saved import WIDTH_PX, plotly_csv, time_csv, time_figure
from schuler_bench.session.pins import Pin
from schuler_bench.session.shown import Shown, edited, shown, titled, window_of
from schuler_bench.session.uploads import with_plain_names
from schuler_bench.shell import notices
from schuler_bench.shell.layout import layout_for
from schuler_bench.shell.plotly_view import PlotlyView
from schuler_bench.shell.view import Figures, Frame, PictureView
from schuler_bench.views.compare.table import PRESENT, lines_of, pins_html
from schuler_bench.views.metrics.table import metrics_html, system_html
from schuler_bench.views.metrics.view import warnings_html, why_line
from schuler_bench.views.requirements.table import requirements_html

FORMATS = ("CSV", "SVG", "PNG")


@dataclass(frozen=True)
class Picture:
    """A picture that the page's script draws.

    Attributes
    ----------
    title : str
        What is shown.
    figure : PlotlyFigure or None
        As plotly reads it; None: the 3D view, as it is seen.
    width_px : float
        Width of the picture; its height follows from the figure.
    """

    title: str
    figure: PlotlyFigure | None
    width_px: float

    def job(self, client: Any) -> dict[str, Any]:
        """Make the script's task, in the page's language."""
        import orjson

        title = text_said(client, self.title)
        if self.figure is None:
            return {"title": title}
        return {
            "title": title,
            "view": self.figure["layout"]["meta"].get("view", ""),
            "width": round(self.width_px),
            "height": round(self.width_px * self.figure.aspect),
            "figure": orjson.Fragment(figure_said(client, self.figure.to_json())),
        }


def picture_of(title: str, figures: Figures, width_px: float) -> Picture:
    """Picture of what a view gives to be saved; a plotly figure was made for ``width_px``."""
    plotly, plots = figures
    return (
        Picture(title, time_figure(plots), WIDTH_PX) if plotly is None else Picture(title, plotly, width_px)
    )


class Export:
    """Saves the plots that the views of a page offer.

    Parameters
    ----------
    frame : Frame
        Of the page.

    Attributes
    ----------
    plots : tuple of str
        Titles of the plots that can be saved.
    """

    def __init__(self, frame: Frame) -> None:
        self._frame, self._client, self._session = frame, frame.client, frame.session
        self.plots = tuple(plot for kind in frame.kinds for plot in kind.plots)
        frame.commands.register("exported", self._exported, watcher=True)
        self._wanted = frame.gui.add_html("", order=40)
        self._count = 0

    def save(self, title: str, format: str) -> None:
        """Save a plot: its numbers from here, its picture by the page, which draws it."""
        now = shown(self._session)
        view = next((view for view in self._frame.views() if title in view.plots), None)
        if now is None or view is None:
            self.tell_no_run()
            return
        try:
            figures = view.figures(now, title)
        except LookupError as error:
            notices.tell(self._client, Text("Nothing to save"), [str(error)], "warning")
            return
        name = title.split(": ")[-1].split(" (")[0].replace(" ", "-").lower()
        if format == "CSV":
            numbers = _numbers(figures, now, title)
            self._client.send_file_download(f"{name}.csv", numbers, save_immediately=True)
            self._client.flush()
            return
        layout = self._frame.layout()
        picture = picture_of(title, figures, layout.plot_px * layout.scale)
        self.draw(format.lower(), f"{name}.{format.lower()}", [picture])

    def draw(
        self, format: str, name: str, pictures: Sequence[Picture], page: str = "", title: str = ""
    ) -> None:
        """Let the page draw pictures and save them as one file (export.js).

        Parameters
        ----------
        format : {"svg", "png", "html", "overview"}
            Of the file; "html": a page of ours with the pictures in it; "overview": PNG of all pictures.
        name : str
            Of the file.
        pictures : sequence of Picture
            One of them for a single plot.
        page : str
            HTML in which ``<img data-picture="2">`` stands for the third picture.
        title : str
            Above the overview.
        """
        import orjson

        self._count += 1
        drawn = [picture.job(self._client) for picture in pictures]
        job = {"format": format, "name": name, "pictures": drawn, "page": page, "title": title}
        text = escape(orjson.dumps(job).decode())
        self._wanted.content = (
            f'<div id="sb-export" hidden data-count="{self._count}" data-job="{text}"></div>'
        )
        self._client.flush()

    def tell_no_run(self) -> None:
        """There is nothing to save yet."""
        notices.tell(self._client, Text("Nothing to save"), [Text("there is no run yet")], "warning")

    def _exported(self, fault: str) -> None:
        """The page has saved its file, or says why not."""
        self._wanted.content = ""
        if fault:
            notices.tell(self._client, Text("Not saved"), [fault[:200]], "warning")
        self._client.flush()


def _numbers(figures: Figures, now: Shown, title: str) -> bytes:
    about = (Text("Schuler Bench: {title}", title=title), f"scenario_sha256 {now.run.scenario_sha256}")
    plotly, plots = figures
    return time_csv(plots, about) if plotly is None else plotly_csv(plotly, about)


PAGE, OVERVIEW = "session.html", "overview.png"
_WINDOW = (1600, 940)
"""Window for which plots are laid out: on A4 their type is legible, and three stand on a page."""
_ABREAST = 3
"""Methods beside each other in a table, so that it fits on paper."""


@dataclass(frozen=True)
class Session:
    """Session that a document describes.

    Attributes
    ----------
    now : Shown
        The run, and how it is shown.
    pins : sequence of Pin
        All of the session.
    origin : str
        Where the scenario comes from.
    date : datetime
        When, with its time zone.
    tables : sequence of (str, str)
        Title and HTML of what views add (`schuler_bench.shell.view.View.sheet_tables`).
    """

    now: Shown
    pins: Sequence[Pin]
    origin: str
    date: datetime
    tables: Sequence[tuple[str, str]] = ()

    @property
    def title(self) -> str:
        """Name of the scenario."""
        return self.now.run.scenario.title or self.origin


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
    figures = (
        Text(
            '<figure><figcaption>{title:html}</figcaption><img data-picture="{place}" '
            'alt="{title:html}"></figure>',
            title=title,
            place=place,
        )
        for place, title in enumerate(pictures)
    )
    plots = section(Text("Plots"), *figures)
    body = say(
        Text(
            "<header><h1>Schuler Bench: {title:html}</h1>{about}</header>"
            "{warnings}{metrics}{requirements}{pins}{tables}{plots}{scenario}",
            title=session.title,
            about=_about(session),
            warnings=_warnings(session),
            metrics=_metrics(session),
            requirements=_requirements(session),
            pins=_pins(session),
            tables=Text.joined("", (section(title, html) for title, html in session.tables)),
            plots=plots,
            scenario=_scenario(session),
        )
    )
    title = quoted(session.title)
    return paper(language, title, body)


def command(session: Session) -> str:
    """Command that runs the scenario again: by its name while it is a preset, else from the file."""
    if session.origin in presets() and load(session.origin) == session.now.run.scenario:
        return Text("schuler run {origin}", origin=session.origin)
    return Text("schuler run scenario.toml")


def _about(session: Session) -> str:
    scenario = session.now.run.scenario
    source = Text("<p>{source:html}</p>", source=source_of(scenario)) if scenario.source else ""
    lines = {
        Text("Scenario"): quoted(session.origin),
        Text("Duration"): f"{scenario.run.duration_h:g} h",
        Text("Date"): f"{session.date:%Y-%m-%d %H:%M %Z}",
        Text("Program"): Text("Schuler Bench {version}", version=__version__),
        "SHA-256": Text("<code>{scenario_sha256}</code>", scenario_sha256=session.now.run.scenario_sha256),
        Text("Run it again"): Text('<code translate="no">{command:html}</code>', command=command(session)),
    }
    rows = Text.joined(
        "", (Text("<dt>{name}</dt><dd>{value}</dd>", name=name, value=value) for name, value in lines.items())
    )
    return Text("{source}<dl>{rows}</dl>", source=source, rows=rows)


def _tables(count: int, make: Callable[[range], str]) -> str:
    """Tables that are about equally wide; ``make`` gives one of some of the methods."""
    return Text.joined(
        "",
        (Text('<div class="table">{table}</div>', table=make(part)) for part in table.parts(count, _ABREAST)),
    )


def _warnings(session: Session) -> str:
    warnings = warnings_html(session.now.run, session.now.verified)
    return section(Text("Warnings about the run"), warnings) if "sb-note" in warnings else ""


def _metrics(session: Session) -> str:
    run, display = session.now.run, session.now.display
    window = window_of(run, display)
    note = notices.note([window.told] if window.told else [], "info" if window.possible else "warning")
    whole = window.run.with_recorded
    tables = _tables(len(whole.methods), lambda part: metrics_html(whole, part, display=display))
    system = system_html(run, folded=False)
    return section(Text("Metrics"), note, tables, Text('<div class="table">{system}</div>', system=system))


def _requirements(session: Session) -> str:
    run = session.now.run
    if not run.scenario.requirement:
        return section(Text("Requirements"), Text("<p>No requirement is set.</p>"))
    tables = _tables(len(run.methods), lambda part: requirements_html(run, methods=part))
    return section(Text("Requirements"), tables)


def _pins(session: Session) -> str:
    run, display, baseline = session.now.run, session.now.display, session.now.baseline
    pins = titled(session.pins, run.scenario)
    if not pins:
        return section(Text("Pins"), Text("<p>No run is pinned.</p>"))
    lines = lines_of(window_of(run, display), run, session.now.selected, pins)
    by = None if baseline is None else baseline.id
    table = pins_html(lines, display.pins_by, by, buttons=False)
    reasons = [_reasons(run, session.now.selected, lines[0].color, PRESENT)]
    reasons += [_reasons(pin.run, edited(pin), pin.hex, pin.name) for pin in pins if pin.run is not None]
    return section(
        Text("Pins"),
        Text('<div class="table">{table}</div><h3>Why</h3>', table=table),
        *reasons,
    )


def _reasons(run: Run, place: int, color: str, name: str) -> str:
    """Sources that dominate the errors of the method that is or was edited: a tenth of a second each."""
    from navcore.design.dominance import why

    result = why(replace(run, methods=run.methods[: place + 1][-1:]))
    ((_, causes),) = result.methods
    return why_line(result, causes, name, color)


def _scenario(session: Session) -> str:
    scenario = with_plain_names(session.now.run.scenario)
    files = Text.joined(", ", sorted(files_of(scenario)))
    beside = Text("<p>It needs these recordings beside it: {files:html}.</p>", files=files) if files else ""
    how = Text("<p>To compute the run again, save this text as scenario.toml and give the command above.</p>")
    return section(
        Text("Scenario"), how, beside, Text("<pre>{to_toml:html}</pre>", to_toml=to_toml(scenario))
    )


class Sheet:
    """Gathers what the session shows, and lets the page draw and save it.

    Parameters
    ----------
    frame : Frame
        Of the page.
    export : Export
        Draws the plots.
    """

    def __init__(self, frame: Frame, export: Export) -> None:
        self._frame, self._export = frame, export
        add = frame.commands.register
        add("save-page", lambda _: self.save(PAGE), Text("Save the session as one page (HTML)"), watcher=True)
        overview = Text("Save all plots in one picture (PNG)")
        add("save-overview", lambda _: self.save(OVERVIEW), overview, watcher=True)

    def save(self, name: str) -> None:
        """Save `PAGE` or `OVERVIEW`."""
        frame, client = self._frame, self._frame.client
        now = shown(frame.session)
        if now is None:
            self._export.tell_no_run()
            return
        tables = [(view.title, html) for view in frame.views() if (html := view.sheet_tables())]
        pins, origin = frame.session.pins.all, frame.session.origin
        session = Session(now, pins, origin, datetime.now(UTC), tables)
        pictures, say = pictures_of(frame, now), partial(text_said, client)
        if name == OVERVIEW:
            self._export.draw(
                "overview", name, pictures, title=say(Text("Schuler Bench: {title}", title=session.title))
            )
            return
        page = document(session, [picture.title for picture in pictures], language_of(client), say)
        self._export.draw("html", name, pictures, page=page)


def pictures_of(frame: Frame, now: Shown) -> list[Picture]:
    """3D view and plots of all views, in the order of their tabs, laid out alike whatever the window is."""
    layout = layout_for(*_WINDOW)
    pictures = [Picture(Text("Trajectory in 3D"), None, 0.0)]
    for view in frame.views():
        if isinstance(view, PictureView) and not view.stands(now.run):
            continue
        if isinstance(view, PlotlyView):  # the same one, its plot for another place
            view = copy(view)
            view.frame = replace(frame, layout=lambda: layout)
        pictures += [picture_of(title, figures, layout.plot_px) for title, figures in view.sheet(now)]
    return pictures
