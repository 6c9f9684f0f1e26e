"""The right column: the views of a run in one or two panels, and which of them are out of date."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence, Set
from typing import TYPE_CHECKING, Any

from navcore.foundation.text import Text, quoted
from schuler_bench.bridge.controls import rail_style
from schuler_bench.session.shown import Shown
from schuler_bench.shell.layout import RAIL_PX, Layout
from schuler_bench.shell.view import PictureView, View
from schuler_bench.shell.view_faults import ViewFaults

if TYPE_CHECKING:
    import viser


class Column:
    """Tabs of the upper and of the lower right panel.

    Parameters
    ----------
    gui : viser.GuiApi
        Of the client.
    views : sequence of View
        Those of the page that stand there, in the order of their tabs.
    faults : ViewFaults
        Calls their methods.
    """

    def __init__(self, gui: viser.GuiApi, views: Sequence[View], faults: ViewFaults) -> None:
        self._gui, self._views, self._faults = gui, views, faults
        self._pictured = {view.title: view for view in views if isinstance(view, PictureView)}
        self._panels: list[viser.PanelHandle] = []
        self._rail = gui.add_html("", order=3)
        self._tabs: dict[str, viser.GuiTabHandle] = {}
        self._stale = set(self._pictured)

    def build(self, layout: Layout) -> None:
        """Place the panels and the tabs that are always there, in place of earlier ones."""
        for panel in self._panels:
            panel.remove()
        upper = self._gui.add_panel()
        upper.dock_right()
        self._panels, self._tabs = [upper], {}
        if layout.two:
            lower = self._gui.add_panel()
            lower.dock_below(upper)
            self._panels.append(lower)
        upper.set_width(round(layout.right_px * layout.scale))
        folded = layout.view_px[0] == RAIL_PX
        self._rail.content = rail_style(layout.left_px, layout.right_px) if folded else ""
        self._stale = set(self._pictured)
        for view in self._views:
            if view.always:
                self._add(view)

    def _add(self, view: View) -> None:
        panel = self._panels[0 if view.place == "upper" else -1]
        tab = self._tabs[view.title] = panel.add_tab(view.title)
        with tab:
            self._faults.place(view)
            if view.look_for:
                words = quoted(view.look_for)
                self._gui.add_html(
                    Text('<div class="sb-look" title="{told}">{told}</div>', told=words), order=-1
                )
        self._faults.call(view.build, tab)

    @property
    def foremost(self) -> frozenset[str]:
        """Titles of the first tab of each panel: those in front until the page says otherwise."""
        first: dict[str, str] = {}
        for view in self._views:
            if view.title in self._tabs:
                first.setdefault(view.place if len(self._panels) > 1 else "", view.title)
        return frozenset(first.values())

    # ------------------------------------------------------------ what is out of date

    def mark_stale(self, titles: Iterable[str] | None = None) -> None:
        """Note that some pictures, or all, are of another run or another choice."""
        self._stale |= set(self._pictured if titles is None else titles)

    @property
    def of_selected(self) -> set[str]:
        """Titles of the pictures that depend on which method the controls edit."""
        return {title for title, view in self._pictured.items() if view.of_selected}

    def wanted(self, front: Set[str]) -> set[str]:
        """Titles of the pictures among the tabs in front; all of them where none is."""
        return (self._pictured.keys() & front) or set(self._pictured)

    def take_rooms(self, rooms: Mapping[str, int]) -> None:
        """Make the pictures in front anew whose plots are far from as high as they were made: title -> px."""
        self.mark_stale(
            title
            for title, px in rooms.items()
            if px and title in self._pictured and self._faults.call(self._pictured[title].take_room, px)
        )

    def stale(self, front: Set[str]) -> set[str]:
        """Titles of the pictures in front that are out of date; ``front`` is empty while it is unknown."""
        return self._stale & (front or self._pictured.keys())

    # ------------------------------------------------------------ pictures

    def make(self, sources: Shown, wanted: Iterable[str]) -> dict[str, Any]:
        """Make the wanted pictures: title -> picture; nothing is sent yet."""
        views = [self._pictured[title] for title in wanted]
        pictures = {
            view.title: self._faults.call(view.picture, sources)
            for view in views
            if self._faults.call(view.stands, sources.run)
        }
        return {title: picture for title, picture in pictures.items() if picture is not None}

    def show(self, sources: Shown, pictures: dict[str, Any], wanted: set[str]) -> None:
        """Send pictures that `make` gave for ``wanted``; they are up to date from now on."""
        self._stale -= wanted
        for view in self._pictured.values():
            if not view.always:
                self._place(view, bool(self._faults.call(view.stands, sources.run)))
        for title, picture in pictures.items():
            self._faults.call(self._pictured[title].show, picture)

    def _place(self, view: PictureView[Any], stands: bool) -> None:
        """Let a tab be there exactly while its view has something to show."""
        if stands and view.title not in self._tabs:
            self._add(view)
        elif not stands and view.title in self._tabs:
            self._tabs.pop(view.title).remove()
            self._faults.forget(view)

    def behind(self, front: Set[str]) -> set[str]:
        """Titles of the tabs behind those in front; none while ``front`` is unknown, and so empty."""
        return {view.title for view in self._views} - front if front else set()

    def tell_front(self, front: Set[str]) -> None:
        """Let the views in front know that they are."""
        for view in self._views:
            if view.title in front:
                self._faults.call(view.to_front)
