"""The language of the page: the chooser, and the command that changes it."""

from __future__ import annotations

from app.bridge.texts import language_of
from app.languages.wording import NAMES
from app.shell import notices
from app.shell.view import Frame, if_user

LANGUAGE = "language"
"""Label of the chooser, and name of the command; its argument is a language such as "zh-CN"."""


class PageLanguage:
    """Chooser; the page is built anew in another language, the session stays.

    Parameters
    ----------
    frame : Frame
        Of the page.
    """

    def __init__(self, frame: Frame) -> None:
        self._frame = frame
        self._now = NAMES[language_of(frame.client)]
        frame.commands.register(LANGUAGE, self._ask, watcher=True)
        for language, name in NAMES.items():
            if name != self._now:
                title = f"Language: {name}"
                frame.commands.register(
                    f"{LANGUAGE}-{language.lower()}",
                    lambda _, wanted=language: self._ask(wanted),
                    title,
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
