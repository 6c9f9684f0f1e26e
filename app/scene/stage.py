"""The middle of a page: the trajectory in 3D, seen from somewhere, at a time that rests, is moved or runs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from app.figures.track import track
from app.panels.playback import PlaybackPanel
from app.scene.cameras import Cameras
from app.scene.drawer import SceneDrawer
from app.scene.playback import Playback, PlayState
from app.session.session import Session
from app.session.shown import Shown
from navcore.run import Run

if TYPE_CHECKING:
    import viser

    from app.page.commands import Commands


class Stage:
    """3D view, cameras and playback of one page.

    Parameters
    ----------
    client : viser.ClientHandle
        The browser.
    session : Session
        Whose run is shown; its lock guards what is drawn.
    commands : Commands
        Of the page.

    Attributes
    ----------
    playback : Playback
        The time that is shown; ``playback.seek(t_s)`` moves ship, pendulum, readout and the plots' lines.
    """

    def __init__(self, client: viser.ClientHandle, session: Session, commands: Commands) -> None:
        self._client, self._session = client, session
        self._scene = SceneDrawer(client.scene)
        self._cameras = Cameras(client.camera)
        self._aspect = 1.0
        self._run: Run | None = None
        self._closed = False
        self.playback = Playback(self._show)
        self._panel = PlaybackPanel(client.gui, commands, self.playback, self._look)

    def draw(self, found: Shown) -> None:
        """Show a run at the time that was shown before; the caller holds the session's lock."""
        self._run = run = found.run
        self.playback.follow(float(run.t_s[-1]) if len(run.t_s) else 0.0)
        session, state = self._session, self.playback.state
        self._scene.draw(track(run, found.display.exaggeration, found.pins), state.time_s, session.selected)
        self._tell(state)

    def choose(self) -> None:
        """Show the computed ship and the readout of the method that is edited now."""
        if self._run is not None and self._scene.select(self._session.selected):
            self._tell(self.playback.state)

    def fit(self, aspect: float) -> None:
        """Fit the map into a view of this width / height."""
        self._aspect = aspect
        self._cameras.choose(self._cameras.chosen, aspect, self._scene.place)

    def close(self) -> None:
        """End the playback."""
        self._closed = True
        self.playback.close()

    def _show(self, state: PlayState) -> None:
        with self._session.lock, self._client.atomic():
            if self._closed or self._run is None:
                return
            self._scene.move_ship(state.time_s)
            self._tell(state)
        self._client.flush()

    def _look(self, camera: str) -> None:
        with self._session.lock, self._client.atomic():
            if self._closed:
                return
            self._cameras.choose(camera, self._aspect, self._scene.place)
            self._tell(self.playback.state)
        self._client.flush()

    def _tell(self, state: PlayState) -> None:
        if self._scene.place is not None:
            self._cameras.follow(self._scene.place)
        if self._run is not None:
            session = self._session
            self._panel.show(state, self._run, session.selected, self._cameras.chosen, session.display)
