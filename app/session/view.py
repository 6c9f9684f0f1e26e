"""Messages of a session to the open pages on it."""

from collections.abc import Set
from typing import Protocol

from navcore.foundation.errors import InputError


class View(Protocol):
    """An open page of a session. Called from the worker's thread or from that of another page."""

    def scenario_changed(self, by: object) -> None:
        """Show the session's scenario in all controls; ``by`` is who changed it."""

    def run_progressed(self, fraction: float, elapsed_s: float) -> None:
        """Show that a run is under way and the picture is an old one."""

    def run_awaits_kernels(self) -> None:
        """Say that the run begins once its kernels are compiled, and how far that is."""

    def run_ended(self) -> None:
        """Show the session's run."""

    def run_stopped(self) -> None:
        """Say that the picture is still the old one because the user stopped the run."""

    def run_refused(self, error: InputError) -> None:
        """Say why the scenario cannot run; the last good one is back."""

    def run_failed(self, error: Exception) -> None:
        """Say that something of ours went wrong; the last good picture stays."""

    def keeping_changed(self) -> None:
        """Say that the work is not kept over a restart at present, or no longer so."""

    def run_waits(self) -> None:
        """Say that the changed scenario runs only when the user asks for it."""

    def display_changed(self, by: object) -> None:
        """Draw the pictures anew as ``session.display`` says; ``by`` is who changed it."""

    def presenter_changed(self) -> None:
        """Another page drives now, or none, or the number of pages has changed."""

    def front_changed(self, front: Set[str]) -> None:
        """Bring these tabs to the front: the page that presents has them there."""

    def envelope_progressed(self) -> None:
        """Show how far the envelope is, or why there is none."""
