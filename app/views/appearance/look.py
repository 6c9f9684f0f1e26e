"""Looks of the whole page that are on or off: dark page, presentation size; and the page's language.

In presentation size the panels are enlarged by the style sheet (presentation.css), the plots in them by
`app.plots.enlarged`: a browser that enlarged a drawn plot would blur it, and would miss its cursor. Of the
left tabs the one that leads (`app.shell.view.View.leads`) is shown alone.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from app.bridge.texts import language_of
from app.languages.wording import NAMES
from app.session.display import Display
from app.shell import notices
from app.shell.view import Frame, if_user
from navcore.foundation.text import Text

DARK, PRESENTATION, LANGUAGE = "dark page", "presentation size", "language"
"""Labels; ``language`` is also the name of the command, its argument a language such as "zh-CN"."""
_RULES = (Path(__file__).parent / "static" / "presentation.css").read_text(encoding="utf-8")
_INVERT = 0.93
"""White becomes a grey of 7 %, black one of 93 %."""
DARK_CSS = f"html{{background:#fff;filter:invert({_INVERT}) hue-rotate(180deg)}}"
"""The light page with its lightness turned round, and its hues turned back: the blue method is blue in both.

The root's own filter leaves fixed elements where they are; those of other elements would not.
"""
_ROW = (
    '<div class="sb-row sb-lecture" role="toolbar" aria-label="Presentation">'
    '<button class="sb-do" data-command="size" aria-pressed="true" '
    'title="Back to the page with all its controls (L)">Normal size</button>'
    '<button class="sb-do" data-command="tab Learn" title="Lessons of five minutes">Learn</button>'
    '<button class="sb-do" data-command="tab Method" title="The selected method">Method</button></div>'
)


def dark_style(frame: Frame, display: Display) -> str:
    """Colours of the theme, and its name for the scripts."""
    del frame
    css = DARK_CSS if display.theme == "dark" else ""
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
    """One choice of the display with two values.

    Attributes
    ----------
    field : str
        Of `app.session.display.Display`.
    values : (str, str)
        Off, on.
    label, hint : str
        Of its switch.
    command : (str, str, str)
        Name of the command that turns it over, its title, and its key.
    style : callable
        HTML that gives a page the look.
    """

    field: str
    values: tuple[str, str]
    label: str
    hint: str
    command: tuple[str, str, str]
    style: Callable[[Frame, Display], str]


LOOKS = (
    Look(
        "theme",
        ("light", "dark"),
        DARK,
        "Dark: for a dim room. Light: for a projector and print. Key: D.",
        ("theme", "Dark or light page", "D"),
        dark_style,
    ),
    Look(
        "size",
        ("normal", "presentation"),
        PRESENTATION,
        "Large type and wide lines on the whole page, for a projector, and only the controls of the "
        "open lesson or of the selected method. Key: L.",
        ("size", "Presentation size on or off", "L"),
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
        """Make the switches, in the present container."""
        self._switches: list[Any] = []
        for order, look in enumerate(LOOKS, start=31):
            switch = self._frame.gui.add_checkbox(look.label, False, hint=look.hint, order=order)
            switch.on_update(if_user(lambda look=look: self._turn_over(look)))
            self._switches.append(switch)

    def show(self, display: Display) -> None:
        """Give the page its looks; in presentation size bring the tab to the front that leads since."""
        for look, style, switch in zip(LOOKS, self._styles, self._switches, strict=True):
            content = look.style(self._frame, display)
            if style.content != content:
                style.content = content
            switch.value = getattr(display, look.field) == look.values[1]
        leading = max(self._frame.views(), key=lambda view: view.leads)
        before, self._leading = self._leading, leading.leads if display.enlarged else 0
        if self._leading > before:
            self._frame.commands.ask_page("front", leading.title)

    def _turn_over(self, look: Look) -> None:
        on = getattr(self._frame.session.display, look.field) == look.values[1]
        self._frame.show(**{look.field: look.values[not on]})


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
        gui.add_html(notices.heading("Language"), order=28)
        chooser = gui.add_dropdown(
            LANGUAGE, tuple(NAMES.values()), initial_value=self._now, order=29,
            hint="Of this page alone: others on this session read their own. Your work stays as it is.",
        )  # fmt: skip
        by_name = {name: language for language, name in NAMES.items()}
        chooser.on_update(if_user(lambda: self._ask(by_name[chooser.value])))

    def _ask(self, language: str) -> None:
        if language in NAMES:
            self._frame.commands.ask_page("language", language)
