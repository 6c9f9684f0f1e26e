"""Over the 3D view: play, scrub, speed, cameras, and what the ship and its pendulums do at that time.

The bar is made by playback.js from the element ``#sb-playback``; what is pressed comes back as commands.
"""

from __future__ import annotations

import json
from html import escape

from app.plots import legend
from app.session.display import Display
from app.views.scene.cameras import CAMERAS
from app.views.scene.drawer import SceneDrawer
from app.views.scene.moment import moment, readout_html
from app.views.scene.pendulum import caption_of, pendulum, pendulum_svg
from app.views.scene.playback import SPEEDS, PlayState
from navcore.engine.run import Run


def bar_html(
    count: int, state: PlayState, camera: str, run: Run, selected: int, display: Display, scene: SceneDrawer
) -> str:
    """HTML of the element from which the page makes the bar, the instruments and the key of the map.

    Parameters
    ----------
    count : int
        Number of the update, which the page reports when it has shown it.
    state : PlayState
        Time that is shown.
    camera : str
        One of `CAMERAS`.
    run, selected, display
        Run, its edited method, and units.
    scene : SceneDrawer
        Where the ships are.
    """
    swung = pendulum(run, state.time_s)
    drawn, place = scene.drawn, scene.place
    key = (
        ()
        if drawn is None or place is None
        else [
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
    )
    now = {
        "count": count,
        "time": round(state.time_s, 3),
        "span": state.span_s,
        "playing": state.playing,
        "loop": state.loop,
        "speed": state.speed,
        "speeds": SPEEDS,
        "camera": camera,
        "cameras": CAMERAS,
        "caption": "" if drawn is None else drawn.caption,
        "key": key,
    }
    return (
        f'<div id="sb-playback" hidden data-now="{escape(json.dumps(now))}">'
        f'<div data-part="pendulum">{pendulum_svg(swung)}<p>{escape(caption_of(swung))}</p></div>'
        f'<div data-part="readout">{readout_html(moment(run, state.time_s), selected, display)}</div></div>'
    )
