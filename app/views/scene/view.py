"""The middle of a page: the trajectory in 3D, seen from somewhere, at a time that rests, is moved or runs."""

from __future__ import annotations

from app.session.shown import Shown
from app.shell.view import Frame, Tab, View, if_user
from app.views.scene.bar import PlaybackPanel
from app.views.scene.cameras import Cameras
from app.views.scene.drawer import SceneDrawer
from app.views.scene.playback import Playback, PlayState
from app.views.scene.track import track
from navcore.engine.run import Run

_FIT = "fit"
_FACTORS: tuple[str, ...] = (
    _FIT,
    "1",
    "2",
    "5",
    "10",
    "20",
    "50",
    "100",
    "200",
    "500",
    "1000",
    "2000",
    "5000",
)


class SceneView(View):
    """3D view, cameras and playback of one page.

    Attributes
    ----------
    playback : Playback
        The time that is shown; ``playback.seek(t_s)`` moves ship, pendulum, readout and the plots' lines.
    """

    def __init__(self, frame: Frame) -> None:
        super().__init__(frame)
        self._scene = SceneDrawer(frame.client.scene)
        self._cameras = Cameras(frame.client.camera)
        self._run: Run | None = None
        self._closed = False
        self.playback = Playback(self._show)

    def build(self, tab: Tab) -> None:
        """Make the chooser of the exaggeration, and what the bar over the view reads."""
        gui = self.frame.gui
        with tab:
            self._factor = gui.add_dropdown(
                "errors in 3D drawn (x)", _FACTORS, order=18,
                hint="Factor by which the 3D view enlarges the position errors; fit: chosen so that they "
                "show.",
            )  # fmt: skip
            self._panel = PlaybackPanel(gui, self.frame.commands, self.playback, self._look)
        self._factor.on_update(if_user(lambda: self.frame.show(exaggeration=_factor(self._factor.value))))

    def follow_display(self) -> None:
        """Show the chosen factor."""
        factor = self.session.display.exaggeration
        self._factor.value = _FIT if factor is None else f"{factor:g}"

    def follow_scenario(self) -> None:
        """Show the computed ship and the readout of the method that is edited now."""
        if self._run is not None and self._scene.select(self.session.selected):
            self._tell(self.playback.state)

    def draw(self, found: Shown) -> None:
        """Show a run at the time that was shown before."""
        self._run = run = found.run
        self.playback.follow(float(run.t_s[-1]) if len(run.t_s) else 0.0)
        state, selected = self.playback.state, self.session.selected
        self._scene.draw(track(run, found.display.exaggeration, found.pins), state.time_s, selected)
        self._tell(state)

    def resize(self) -> None:
        """Fit the map into the view between the columns."""
        self._cameras.choose(self._cameras.chosen, self._aspect, self._scene.place)

    def close(self) -> None:
        """End the playback."""
        self._closed = True
        self.playback.close()

    @property
    def _aspect(self) -> float:
        return self.frame.layout().view_aspect

    def _show(self, state: PlayState) -> None:
        with self.session.lock, self.frame.client.atomic():
            if self._closed or self._run is None:
                return
            self._scene.move_ship(state.time_s)
            self._tell(state)
        self.frame.client.flush()

    def _look(self, camera: str) -> None:
        with self.session.lock, self.frame.client.atomic():
            if self._closed:
                return
            self._cameras.choose(camera, self._aspect, self._scene.place)
            self._tell(self.playback.state)
        self.frame.client.flush()

    def _tell(self, state: PlayState) -> None:
        if self._scene.place is not None:
            self._cameras.follow(self._scene.place)
        if self._run is not None:
            display, selected = self.session.display, self.session.selected
            self._panel.show(state, self._run, selected, self._cameras.chosen, display)


def _factor(chosen: str) -> float | None:
    return None if chosen == _FIT else float(chosen)


VIEW = SceneView
