"""Tab "View": units, axes and bands of the plots, export of any plot, language, look and size of the page.

In presentation size the panels are enlarged by the style sheet (presentation.css), the plots in them by
`schuler_bench.plots.plotly_data`: a browser that enlarged a drawn plot would blur it, and would miss its
cursor. Of the left tabs the one that leads (`schuler_bench.shell.view.View.leads`) is shown alone.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, get_args

from navcore.foundation.notation import unit_sign
from navcore.foundation.text import Text
from schuler_bench.bridge.texts import language_of
from schuler_bench.jobs.envelopes import SEEDS
from schuler_bench.languages.wording import NAMES
from schuler_bench.session.display import Display
from schuler_bench.shell import notices
from schuler_bench.shell.view import MENU, Frame, Tab, View, if_user
from schuler_bench.views.appearance.document import FORMATS, Export, Sheet

COLORS, PRESENTATION, LANGUAGE = Text("colours of the page"), Text("presentation size"), Text("language")
"""Labels; ``language`` is also the name of the command, its argument a language such as "zh-CN"."""
_RULES = (Path(__file__).parent / "static" / "presentation.css").read_text(encoding="utf-8")
_INVERT = 0.93
"""White becomes a grey of 7 %, black one of 93 %."""
DARK_CSS = f"html{{--sb-look:invert({_INVERT}) hue-rotate(180deg);background:#fff;filter:var(--sb-look)}}"
"""The light page with its lightness turned round, and its hues turned back: the blue method is blue in both.

The root's own filter leaves fixed elements where they are; those of other elements would not.
"""
_WHERE_DARK = "(prefers-color-scheme:dark)"
_THEMES = {
    "system": f"@media {_WHERE_DARK}{{{DARK_CSS}}}",
    "opposite": f"@media not all and {_WHERE_DARK}{{{DARK_CSS}}}",
    "light": "",
    "dark": DARK_CSS,
}
"""Rules of each theme; the browser knows what the system is set to."""
_ROW = Text(
    '<div class="sb-row sb-lecture" role="toolbar" aria-label="Presentation">'
    '<button class="sb-do" data-command="size" aria-pressed="true" '
    'title="Back to the page with all its controls (L)">Normal size</button>'
    '<button class="sb-do" data-command="tab Learn" title="Lessons of five minutes">Learn</button>'
    '<button class="sb-do" data-command="tab Method" title="The selected method">Method</button></div>'
)


def dark_style(frame: Frame, display: Display) -> str:
    """Colours of the theme, and its name for the scripts."""
    del frame
    css = _THEMES[display.theme]
    return f'<div id="sb-theme" hidden data-theme="{display.theme}"></div><style>{css}</style>'


def size_style(frame: Frame, display: Display) -> str:
    """Rules and scale of the enlarged page, marked for presentation.css and playback.js."""
    if not display.enlarged:
        return ""
    scale = f"{frame.layout().scale:g}"
    marked = f'<div id="sb-size" hidden data-scale="{scale}"></div>'
    return f"{marked}<style>:root{{--sb-scale:{scale}}}{_RULES}</style>{_ROW}"


@dataclass(frozen=True)
class Look:
    """One choice of the display that a key turns over.

    Attributes
    ----------
    field : str
        Of `schuler_bench.session.display.Display`.
    others : mapping of str to str
        Value -> what the key makes of it.
    label, hint : str
        Of its control.
    words : mapping of str to str
        Value -> its words in a list; empty: a switch from the first value to the second.
    command : (str, str, str)
        Name of the command that turns it over, its title, and its key.
    style : callable
        HTML that gives a page the look.
    """

    field: str
    others: Mapping[str, str]
    label: str
    hint: str
    words: Mapping[str, str]
    command: tuple[str, str, str]
    style: Callable[[Frame, Display], str]


LOOKS = (
    Look(
        "theme",
        {"system": "opposite", "opposite": "system", "light": "dark", "dark": "light"},
        COLORS,
        Text("Dark: for a dim room. Light: for a projector and print. Key: D turns them over."),
        {
            "system": Text("as the system"),
            "opposite": Text("not as the system"),
            "light": Text("light"),
            "dark": Text("dark"),
        },
        ("theme", Text("Dark or light page"), "D"),
        dark_style,
    ),
    Look(
        "size",
        {"normal": "presentation", "presentation": "normal"},
        PRESENTATION,
        Text(
            "Large type and wide lines on the whole page, for a projector, and only the controls of the "
            "open lesson or of the selected method. Key: L."
        ),
        {},
        ("size", Text("Presentation size on or off"), "L"),
        size_style,
    ),
)


class Looks:
    """Switches, keys and styles of a page's looks.

    Parameters
    ----------
    frame : Frame
        Of the page.
    """

    def __init__(self, frame: Frame) -> None:
        self._frame, self._leading = frame, 0
        # Outside all tabs: what stands in a tab is on the page only while the tab is in front.
        self._styles = [frame.gui.add_html("", order=4) for _ in LOOKS]
        for look in LOOKS:
            name, title, key = look.command
            frame.commands.register(name, lambda _, look=look: self._turn_over(look), title, key)

    def build(self) -> None:
        """Make the controls, in the present container."""
        gui = self._frame.gui
        self._switches: list[Any] = []
        for order, look in enumerate(LOOKS, start=31):
            if look.words:
                box: Any = gui.add_dropdown(look.label, (*look.words.values(),), hint=look.hint, order=order)
                box.on_update(if_user(lambda look=look, box=box: self._choose(look, str(box.value))))
            else:
                box = gui.add_checkbox(look.label, False, hint=look.hint, order=order)
                box.on_update(if_user(lambda look=look: self._turn_over(look)))
            self._switches.append(box)

    def show(self, display: Display) -> None:
        """Give the page its looks; in presentation size bring the tab to the front that leads since."""
        for look, style, switch in zip(LOOKS, self._styles, self._switches, strict=True):
            content = look.style(self._frame, display)
            if style.content != content:
                style.content = content
            value = getattr(display, look.field)
            switch.value = look.words[value] if look.words else value == [*look.others][1]
        leading = max(self._frame.views(), key=lambda view: view.leads)
        before, self._leading = self._leading, leading.leads if display.enlarged else 0
        if self._leading > before:
            self._frame.commands.ask_page("front", leading.title)

    def _turn_over(self, look: Look) -> None:
        now = getattr(self._frame.session.display, look.field)
        self._frame.show(**{look.field: look.others[now]})

    def _choose(self, look: Look, words: str) -> None:
        self._frame.show(**{look.field: next(v for v, said in look.words.items() if said == words)})


class PageLanguage:
    """Chooser; the page is built anew in another language, the session stays.

    Parameters
    ----------
    frame : Frame
        Of the page.
    """

    def __init__(self, frame: Frame) -> None:
        self._frame, self._now = frame, NAMES[language_of(frame.client)]
        frame.commands.register(LANGUAGE, self._ask, watcher=True)
        for language, name in NAMES.items():
            if name != self._now:
                frame.commands.register(
                    f"{LANGUAGE}-{language.lower()}",
                    lambda _, language=language: self._ask(language),
                    Text("Language: {name}", name=name),
                    watcher=True,
                )

    def build(self) -> None:
        """Make the chooser, in the present container."""
        gui = self._frame.gui
        gui.add_html(notices.heading(Text("Language")), order=28)
        chooser = gui.add_dropdown(
            LANGUAGE, tuple(NAMES.values()), initial_value=self._now, order=29,
            hint=Text("Of this page alone: others on this session read their own. Your work stays as it is."),
        )  # fmt: skip
        by_name = {name: language for language, name in NAMES.items()}
        chooser.on_update(if_user(lambda: self._ask(by_name[chooser.value])))

    def _ask(self, language: str) -> None:
        if language in NAMES:
            self._frame.commands.ask_page("language", language)


_CHOICES = {
    Text("angles in"): (
        "angle",
        Text("Unit of tilts and headings in the plots over time, the spectrum and the table."),
    ),
    Text("lengths in"): ("length", Text("Unit of position errors.")),
    Text("velocities in"): ("speed", Text("Unit of velocity errors.")),
    Text("times in"): ("time", Text("Unit of the time axis, and of the spectrum's periods.")),
    Text("error axis"): (
        "scale",
        Text("log: magnitudes of the errors, on an axis of decades. Linear: with their signs."),
    ),
}
_FIT = Text("as needed")
_FACTORS: tuple[str, ...] = (_FIT, *"1 2 5 10 20 50 100 200 500 1000 2000 5000".split())
BANDS = Text("bands")
_BANDS = {
    Text("off"): "none",
    Text("±1σ by covariance"): "covariance",
    Text("{seeds} seeds, 5 to 95 %", seeds=SEEDS): "seeds",
}
EXPORT, FORMAT = Text("export plot"), Text("export as")
_PAGE_HINT = Text(
    "Numbers, verdicts, pins, warnings, all plots and the scenario on one page: it needs no server, and "
    "prints on A4."
)
_OVERVIEW_HINT = Text("All plots side by side, also those whose tabs are not in front.")
_SESSION = Text(
    '<div class="sb-export"><div class="sb-row"><button class="sb-do" '
    'data-command="save-page" title="{page_hint}">Save as one page (HTML)</button><button '
    'class="sb-do" data-command="save-overview" title="{overview_hint}">Save all plots '
    '(PNG)</button></div><div class="sb-making" role="status"></div></div>',
    page_hint=_PAGE_HINT,
    overview_hint=_OVERVIEW_HINT,
)


class AppearanceView(View):
    """How the plots are read, and what is taken from them."""

    title = Text("View")
    place = "edit"
    tab = MENU

    def __init__(self, frame: Frame) -> None:
        super().__init__(frame)
        self._export = Export(frame)
        Sheet(frame, self._export)

    def build(self, tab: Tab) -> None:
        """Make the widgets."""
        gui, export = self.frame.gui, self._export
        self._looks, language = Looks(self.frame), PageLanguage(self.frame)
        self._choosers: dict[str, Any] = {}
        with tab:
            gui.add_html(notices.heading(Text("Units and axes")), order=0)
            for order, (label, (field, hint)) in enumerate(_CHOICES.items(), start=1):
                self._choosers[field] = self._chooser(label, field, hint, order)
            self._factor: Any = gui.add_dropdown(
                Text("enlarge errors in 3D"), _FACTORS, order=9,
                hint=Text("Factor by which the 3D view enlarges the position errors; as needed: chosen so "
                "that they show."),
            )  # fmt: skip
            gui.add_html(notices.heading(Text("Bands behind the error curves")), order=10)
            self._bands: Any = gui.add_dropdown(
                BANDS,
                tuple(_BANDS),
                order=11,
                hint=Text(
                    "Covariance: one standard deviation of all modelled errors together, for "
                    "laws that do not look at the data. Seeds: runs the scenario with {seeds} "
                    "other seeds, and fills where 90 % of them lie.",
                    seeds=SEEDS,
                ),
            )
            self._progress = gui.add_progress_bar(0.0, visible=False, order=12)
            self._words = gui.add_html("", visible=False, order=13)
            gui.add_html(notices.heading(Text("Export a plot")), order=20)
            plot: Any = gui.add_dropdown(
                EXPORT,
                export.plots,
                order=21,
                hint=Text("Plot to save: as it is shown, with its units and curves."),
            )
            format: Any = gui.add_button_group(
                FORMAT,
                FORMATS,
                order=22,
                hint=Text("CSV: the plotted numbers in full. SVG, PNG: the picture."),
            )
            gui.add_html(notices.heading(Text("Export the whole session")), order=23)
            gui.add_html(_SESSION, order=24)
            gui.add_html(notices.heading(Text("Page")), order=30)
            language.build()
            self._looks.build()
        self._factor.on_update(if_user(self._enlarge))
        self._bands.on_update(if_user(lambda: self.frame.show(envelope=_BANDS[self._bands.value])))
        format.on_click(
            lambda event: export.save(plot.value, event.target.value) if event.client is not None else None
        )

    def _enlarge(self) -> None:
        factor = self._factor.value
        self.frame.show(exaggeration=None if factor == _FIT else float(factor))

    def _chooser(self, label: str, field: str, hint: str, order: int) -> Any:
        options = {unit_sign(key): key for key in get_args(Display.model_fields[field].annotation)}
        chooser: Any = self.frame.gui.add_dropdown(label, tuple(options), order=order, hint=hint)
        chooser.on_update(if_user(lambda: self.frame.show(**{field: options[chooser.value]})))
        return chooser

    def follow_display(self) -> None:
        """Show the session's choices."""
        display = self.session.display
        for field, chooser in self._choosers.items():
            chooser.value = unit_sign(getattr(display, field))
        factor = display.exaggeration
        self._factor.value = _FIT if factor is None else f"{factor:g}"
        self._bands.value = next(word for word, key in _BANDS.items() if key == display.envelope)
        self._looks.show(display)
        self.follow_jobs()

    def follow_scenario(self) -> None:
        """Let the tab that leads now stand alone in presentation size: a lesson may have been opened."""
        self._looks.show(self.session.display)

    def follow_jobs(self) -> None:
        """Show how far the bands are, or why there are none."""
        fraction, words = self.session.envelopes.fraction, self.session.envelopes.words
        self._progress.visible = fraction is not None
        self._progress.value = round(100.0 * (fraction or 0.0), 1)
        self._words.content, self._words.visible = (
            notices.note(words, "warning"),
            bool(words),
        )


VIEW = AppearanceView
