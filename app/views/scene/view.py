"""The middle of a page: the trajectory in 3D, seen from somewhere, at a time that rests, is moved or runs.

The bar over it is made by playback.js from the element ``#sb-playback``; what is pressed comes back as
commands.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from navcore.engine.run import Run
from navcore.foundation.text import Text
from schuler_bench.plots import legend
from schuler_bench.session.display import Display
from schuler_bench.session.shown import Shown
from schuler_bench.shell.view import Frame, Tab, View
from schuler_bench.views.scene.drawer import SceneDrawer
from schuler_bench.views.scene.moment import caption_of, moment, pendulum, pendulum_svg, readout_html
from schuler_bench.views.scene.playback import SPEEDS, Playback, PlayState
from schuler_bench.views.scene.track import HALF_WIDTH, Place, error_texts, track

if TYPE_CHECKING:
    import viser


MAP, FOLLOW, TOP, SIDE = CAMERAS = (Text("map"), Text("follow"), Text("top"), Text("side"))
_TILT: dict[str, tuple[float, ...]] = {MAP: (78.0, 72.0, 66.0, 58.0, 50.0), TOP: (90.0,), SIDE: (22.0,)}
"""Elevation of the camera above the map, deg: the first at which the map's width fills the view."""
_ROOM = 1.1
"""Scene units east and west of the map for its labels, at least."""
_LATITUDE_PX = 32
"""Half the width of a label of latitude with its ground, down to arc-seconds; it is as wide from afar."""
_SOUTH, _NORTH = -HALF_WIDTH - 1.4, HALF_WIDTH + 0.5
"""How far labels and scale bar, and the arrow to the north, reach beyond the map's edges."""
_BAR_LABEL_PX = 18
"""Height of the scale bar's label, which is as high from afar."""
_UP_TO = 0.5
"""Part of the way from the view's middle to the horizon that the map may reach up."""
_LEAST_PX = 120
"""Height that the map gets in the smallest view."""
_BEHIND, _ABOVE, _AHEAD = 4.2, 2.1, 0.8
"""Of the camera behind the ship, scene units."""


@dataclass(frozen=True)
class Window:
    """The 3D view, px.

    Attributes
    ----------
    width, height : int
        Of all of it.
    above, below : int
        What instruments and bar take of its height.
    """

    width: int
    height: int
    above: int = 0
    below: int = 0

    @property
    def free(self) -> tuple[float, float]:
        """Lower and upper end of what is left for the map, from the view's middle, over half its height."""
        low = min(self.below + _BAR_LABEL_PX, self.height - self.above - _LEAST_PX)
        return 2.0 * low / self.height - 1.0, 1.0 - 2.0 * self.above / self.height


class Cameras:
    """The camera of one client.

    Parameters
    ----------
    camera : viser.CameraHandle
        Of the client.
    """

    def __init__(self, camera: viser.CameraHandle) -> None:
        self._camera = camera
        self.chosen = MAP

    def choose(self, name: str, window: Window, place: Place | None) -> None:
        """Look from one of `CAMERAS`, so that the map fills what is free of the view."""
        if name not in CAMERAS:
            return
        self.chosen = name
        if name == FOLLOW:
            if place is not None:
                self.follow(place)
            return
        half = math.tan(0.5 * self._camera.fov)
        distance = north = tilt = 0.0
        for degrees in _TILT[name]:
            tilt = math.radians(degrees)
            distance, north, wide = _fit(tilt, half, window)
            if wide:
                break
        centre = np.array([0.0, north, 0.0])
        away = distance * np.array([0.0, -math.cos(tilt), math.sin(tilt)])
        self._point(centre + away, centre, (0.0, 1.0, 0.0) if name == TOP else (0.0, 0.0, 1.0))

    def follow(self, place: Place) -> None:
        """Stay behind the ship, if that is chosen."""
        if self.chosen != FOLLOW:
            return
        w, x, y, z = place.wxyz
        ahead = np.array([2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 0.0])
        ahead /= max(float(np.linalg.norm(ahead)), 1e-9)
        ship = place.truth.astype(float)
        self._point(ship - _BEHIND * ahead + (0.0, 0.0, _ABOVE), ship + _AHEAD * ahead, (0.0, 0.0, 1.0))

    def _point(self, position: np.ndarray, look_at: np.ndarray, up: tuple[float, float, float]) -> None:
        self._camera.up_direction = up
        self._camera.position = position
        self._camera.look_at = look_at


def _fit(tilt: float, half: float, window: Window) -> tuple[float, float, bool]:
    """Distance of a camera at an elevation (rad), how far north it looks, and whether the width is filled.

    ``half`` is the tangent of half the camera's angle of view. What lies y north of the map's middle is seen
    (y - n) sin(tilt) / (distance + (y - n) cos(tilt)) / half above the view's middle, as a part of half its
    height, n being how far north it looks.
    """
    ends = np.minimum(np.array(window.free) * half, _UP_TO * math.tan(tilt))
    sizes = math.sin(tilt) - ends * math.cos(tilt)  # near and far things look larger and smaller
    low, high = ends / sizes
    upright = float((_NORTH - _SOUTH) / (high - low))
    # With as much room above as below n is ``middle + slope * distance``; the southern edge looks widest.
    weights = sizes**2 / np.sum(sizes**2)
    middle, slope = float(weights @ (_SOUTH, _NORTH)), -float(weights @ (low, high))
    label = HALF_WIDTH * _LATITUDE_PX / max(0.5 * window.width - _LATITUDE_PX, 1.0)
    edge = (HALF_WIDTH + max(_ROOM, label)) * window.height / (half * window.width)
    across = (edge + (HALF_WIDTH + middle) * math.cos(tilt)) / (1.0 - slope * math.cos(tilt))
    distance = max(across, upright)
    return distance, middle + slope * distance, upright <= across


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
                "error": error,
                "state": method.state,
                "said": legend.word(method.state),
                "hint": legend.hint(method.state),
            }
            for method, error in zip(drawn.methods, error_texts(drawn.methods, place.index), strict=True)
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
    return Text(
        '<div id="sb-playback" hidden data-now="{state:html}"><div data-part="pendulum">'
        '{pendulum_svg}<p>{caption_of:html}</p></div><div data-part="readout">'
        "{readout_html}</div></div>",
        state=json.dumps(now),
        pendulum_svg=pendulum_svg(swung),
        caption_of=caption_of(swung),
        readout_html=readout_html(moment(run, state.time_s), selected, display),
    )


# What stands over the view (playback.css, playback.js), px.
_PENDULUM_PX, _READOUT_PX, _LOW_PX, _TALL_PX = 195, 330, 500, 900
_BAR_PX, _BAR_TEXT_PX = {False: 88, True: 122}, 305
"""Height of the bar in two rows and in three, and width of the view from which two hold it."""
_MARGIN_PX, _CAPTION_PX, _CAPTION_TEXT_PX, _KEY_ROW_PX, _KEY_ROWS = 8, 22, 400, 22, 5
_SMALL_PX = 480
_MAP_SHARE, _LABEL_PX = 0.8, 62
"""Part of the view's width that the map's southern edge takes; width of a longitude with some room."""


class SceneView(View):
    """3D view, cameras and playback of one page.

    Attributes
    ----------
    playback : Playback
        The time that is shown; ``playback.seek(t_s)`` moves ship, pendulum, readout and the plots' lines.
    """

    alone = CAMERAS

    def __init__(self, frame: Frame) -> None:
        super().__init__(frame)
        self._scene = SceneDrawer(frame.client.scene)
        self._cameras = Cameras(frame.client.camera)
        self._run: Run | None = None
        self._count, self._closed, self._large = 0, False, "plots"
        self.playback = Playback(self._show)

    def build(self, tab: Tab) -> None:
        """Make what the bar over the view reads."""
        gui = self.frame.gui
        with tab:
            self._bar = gui.add_html("", order=3)
        add, playback = self.frame.commands.register, self.playback
        add("shown", _number(lambda count: playback.heard(self._count - int(count))), watcher=True)
        add("play", lambda _: playback.toggle(), Text("Play or pause"), Text("Space"), watcher=True)
        add("seek", _number(playback.seek), watcher=True)
        add("speed", _number(playback.set_speed), watcher=True)
        add("loop", lambda text: playback.set_loop(text == "on"), watcher=True)
        for camera in CAMERAS:
            title = Text("3D view: {camera}", camera=camera)
            add(f"camera-{camera}", lambda _, camera=camera: self._look(camera), title, watcher=True)

    def follow_scenario(self) -> None:
        """Show the computed ship and the readout of the method that is edited now."""
        if self._run is not None and self._scene.select(self.session.selected):
            self._tell(self.playback.state)

    def follow_display(self) -> None:
        """Let 3D view and plots change places where the session has come to want it (playback.js)."""
        before, self._large = self._large, self.session.display.large
        if before != self._large:
            self.frame.commands.ask_page("large", self._large)

    def draw(self, found: Shown) -> None:
        """Show a run at the time that was shown before."""
        self._run = run = found.run
        self.playback.follow(float(run.t_s[-1]) if len(run.t_s) else 0.0)
        state, selected = self.playback.state, self.session.selected
        display, layout = found.display, self.frame.layout()
        beside = max(2, int(_MAP_SHARE * layout.view_px[0] / (_LABEL_PX * layout.letter)))
        drawn = track(run, display.exaggeration, found.pins, display.state_of, beside)
        self._scene.enlarge(layout.scale)
        self._scene.draw(drawn, state.time_s, selected)
        self._tell(state)

    def resize(self) -> None:
        """Fit the map into the view between the columns."""
        self._cameras.choose(self._cameras.chosen, self._window, self._scene.place)

    def close(self) -> None:
        """End the playback."""
        self._closed = True
        self.playback.close()

    @property
    def _window(self) -> Window:
        """The view, and what of its height the instruments above and the key below the map take."""
        layout = self.frame.layout()
        width, height = layout.view_px
        above = 0 if height < _LOW_PX else _PENDULUM_PX if height < _TALL_PX else _READOUT_PX
        text_px = width / layout.letter
        bar = _MARGIN_PX if layout.alone else _BAR_PX[text_px < _BAR_TEXT_PX]
        caption = _CAPTION_PX * math.ceil(_CAPTION_TEXT_PX / text_px)
        methods = 0 if self._run is None else len(self._run.methods)
        abreast = 1 if width < _SMALL_PX else 2
        below = bar + caption + _KEY_ROW_PX * min(-(-methods // abreast), _KEY_ROWS)
        return Window(width, height, above, below)

    def _show(self, state: PlayState) -> None:
        self._change(lambda: self._scene.move_ship(state.time_s), state)

    def _look(self, camera: str) -> None:
        place = self._scene.place
        self._change(lambda: self._cameras.choose(camera, self._window, place), self.playback.state)

    def _change(self, act: Callable[[], None], state: PlayState) -> None:
        """Change the 3D view at once, and the bar with it."""
        with self.session.lock, self.frame.client.atomic():
            if self._closed:
                return
            act()
            self._tell(state)
        self.frame.client.flush()

    def _tell(self, state: PlayState) -> None:
        if self._scene.place is not None:
            self._cameras.follow(self._scene.place)
        if self._run is not None:
            display, selected = self.session.display, self.session.selected
            self._count += 1
            for view in self.frame.views():
                view.follow_time(state.time_s)
            self._bar.content = bar_html(
                self._count, state, self._cameras.chosen, self._run, selected, display, self._scene
            )


def _number(use: Callable[[float], None]) -> Callable[[str], None]:
    """Command that takes a number; hostile or torn arguments ask for nothing."""

    def take(text: str) -> None:
        with suppress(ValueError, OverflowError):
            use(float(text))

    return take


VIEW = SceneView
