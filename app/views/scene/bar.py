"""Over the 3D view: play, scrub, speed, cameras, and what the ship and its pendulums do at that time.

The bar is made by playback.js; what it shows comes from the element ``#sb-playback``, and what is
pressed comes back as commands.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from html import escape
from typing import TYPE_CHECKING

from app.plots import legend
from app.session.display import Display
from app.views.scene.cameras import CAMERAS
from app.views.scene.moment import moment, readout_html
from app.views.scene.pendulum import caption_of, pendulum, pendulum_svg
from app.views.scene.playback import SPEEDS, Playback, PlayState
from navcore.engine.run import Run

if TYPE_CHECKING:
    import viser

    from app.shell.commands import Commands
    from app.views.scene.drawer import SceneDrawer


def map_key(drawer: SceneDrawer) -> list[dict[str, str]]:
    """Entries below the map: each method's key, colour, how it is shown, and the error that its ship has."""
    drawn, place = drawer.drawn, drawer.place
    if drawn is None or place is None:
        return []
    return [
        {
            "key": method.name,
            "color": "#{:02x}{:02x}{:02x}".format(*method.color),
            "error": method.error_text(place.index),
            "state": method.state,
            "said": legend.word(method.state),
            "hint": legend.hint(method.state),
        }
        for method in drawn.methods
    ]


class PlaybackPanel:
    """The bar, the readout and the pendulum of one page.

    Parameters
    ----------
    gui : viser.GuiApi
        Of the client.
    commands : Commands
        Of the page.
    playback : Playback
        Of the page.
    look : callable
        ``look(camera)``: see the scene from another of `CAMERAS`.
    """

    def __init__(
        self, gui: viser.GuiApi, commands: Commands, playback: Playback, look: Callable[[str], None]
    ) -> None:
        self._now = gui.add_html("", order=3)
        self._count = 0

        def number(text: str, use: Callable[[float], None]) -> None:
            try:
                use(float(text))
            except (ValueError, OverflowError):
                return

        def heard(count: float) -> None:
            playback.heard(self._count - int(count))

        # Hostile or torn arguments ask for nothing.
        commands.register("shown", lambda text: number(text, heard), watcher=True)
        commands.register("play", lambda _: playback.toggle(), "Play or pause", "Space", watcher=True)
        commands.register("seek", lambda text: number(text, playback.seek), watcher=True)
        commands.register("speed", lambda text: number(text, playback.set_speed), watcher=True)
        commands.register("loop", lambda text: playback.set_loop(text == "on"), watcher=True)
        for camera in CAMERAS:
            commands.register(
                f"camera-{camera}", lambda _, camera=camera: look(camera), f"3D view: {camera}", watcher=True
            )

    def show(
        self,
        state: PlayState,
        run: Run,
        selected: int,
        camera: str,
        display: Display,
        drawer: SceneDrawer,
    ) -> None:
        """Show a time of a run, and below the map its key."""
        swung = pendulum(run, state.time_s)
        readout = readout_html(moment(run, state.time_s), selected, display)
        self._count += 1
        now = {
            "count": self._count,
            "time": round(state.time_s, 3),
            "span": state.span_s,
            "playing": state.playing,
            "loop": state.loop,
            "speed": state.speed,
            "speeds": SPEEDS,
            "camera": camera,
            "cameras": CAMERAS,
            "caption": "" if drawer.drawn is None else drawer.drawn.caption,
            "key": map_key(drawer),
        }
        self._now.content = (
            f'<div id="sb-playback" hidden data-now="{escape(json.dumps(now))}">'
            f'<div data-part="pendulum">{pendulum_svg(swung)}<p>{escape(caption_of(swung))}</p></div>'
            f'<div data-part="readout">{readout}</div></div>'
        )
