"""Light or dark page."""

from __future__ import annotations

from app.session.display import Display
from app.views.appearance import theme
from app.views.appearance.look import Look

DARK = "dark page"


class DarkPage(Look):
    """Light page, or dark page."""

    label, order = DARK, 31
    hint = "Dark: for a dim room. Light: for a projector and print. Key: D."
    command = "theme", "Dark or light page", "D"
    field, values = "theme", ("light", "dark")

    def style(self, display: Display) -> str:
        """Colours of the theme, and its name for the scripts."""
        marked = f'<div id="sb-theme" hidden data-theme="{display.theme}"></div>'
        return f"{marked}<style>{theme.css(display.theme)}</style>"
