"""Views: what the page asks of them, and what it gives them."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Generic, Literal, TypeVar

from pydantic import ValidationError

from navcore.engine.run import Run
from navcore.foundation.errors import InputError
from navcore.foundation.faults import faults_from
from navcore.foundation.text import Text
from schuler_bench.editing import edits
from schuler_bench.editing.form import NONE, FieldSpec
from schuler_bench.plots import style, table
from schuler_bench.plots.plotly_data import PlotlyFigure
from schuler_bench.plots.uplot import UplotFigure
from schuler_bench.session.display import Display
from schuler_bench.session.session import Session
from schuler_bench.session.shown import Shown
from schuler_bench.shell import notices
from schuler_bench.shell.commands import Commands
from schuler_bench.shell.control import Control, Section
from schuler_bench.shell.editor import Editor
from schuler_bench.shell.layout import BAR_PX, STRIP_PX, Layout
from schuler_bench.shell.opening import Opening

if TYPE_CHECKING:
    import viser

    from navcore.scenario.model import Scenario

Place = Literal["edit", "upper", "lower", "page"]
"""Left tabs with controls; tabs of the upper and of the lower right panel; anywhere, without a tab."""
MENU = "menu"
"""`View.tab` of a view that the menu opens: it has a tab only while it is in front."""
Tab = AbstractContextManager[Any]
"""Widgets that are made inside it stand in the tab."""
Figures = tuple[PlotlyFigure | None, list[UplotFigure]]
"""Content of a plot that can be saved: the plotly figure, or the plots over time."""
P = TypeVar("P")
NOT_GIVEN = Text("not set (which is not 0)")
"""Below the box of a number that the scenario leaves out."""


@dataclass(frozen=True)
class Frame:
    """Access of a view to its page.

    Attributes
    ----------
    client : viser.ClientHandle
        The browser.
    bar : Tab
        The top bar: widgets that are made inside it stand there, in the order of their numbers.
    session : Session
        Whose work is shown.
    commands : Commands
        Of the page.
    editor : Editor
        Turns a moved control into a new scenario.
    opening : Opening
        Scenarios and files.
    kinds : sequence of type
        The registered views, in the order of their tabs.
    layout : callable
        Gives the present sizes.
    views : callable
        Gives all views of the page.
    redraw : callable
        Makes the pictures in front anew, from the run there is.
    refresh : callable
        Lets all views show the session's scenario again.
    """

    client: viser.ClientHandle
    bar: Tab
    session: Session
    commands: Commands
    editor: Editor
    opening: Opening
    kinds: Sequence[type[View]]
    layout: Callable[[], Layout]
    views: Callable[[], Sequence[View]]
    redraw: Callable[[], None]
    refresh: Callable[[], None]

    @property
    def gui(self) -> viser.GuiApi:
        """Where widgets are made."""
        return self.client.gui

    def controls(self) -> list[Control]:
        """All controls of fields on the page."""
        return [control for view in self.views() for control in view.controls]

    def show(self, **choices: object) -> None:
        """Change how the pictures are shown; a choice out of its range is refused by name."""
        try:
            self.session.show(None, **choices)
        except ValidationError as error:
            refused = InputError(faults_from(error, Display, choices, ""))
            notices.tell(self.client, Text("Not changed"), notices.fault_lines(refused))
            for view in self.views():
                view.follow_display()


class View:
    """A tab, or another part of a page. What the page tells it does nothing unless a view wants it.

    The page calls everything but `build` and `to_front` with the session's lock held.

    Parameters
    ----------
    frame : Frame
        Of the page.

    Attributes
    ----------
    title : str
        Of the view, by which everything opens it; "" for a view without a tab.
    place : Place
        Where it stands.
    tab : str
        Title of the tab that it shares with others, or `MENU`; "": it has a tab of its own title.
    mode : str
        Its name among the modes, or the folds, of that tab (`schuler_bench.shell.tabs`); "": its title.
    look_for : str
        What to look for in it, in one line at the top of a tab of the right column.
    focus : str
        Name in a scenario's block ``view`` that brings its tab to the front.
    alone : tuple of str
        Of a view without a tab that may fill a window: names for ``?view=``, one for each way to see it.
    plots : tuple of str
        Titles of the plots that can be saved from it.
    asks : tuple of str
        Questions that it asks: the tab "Ask" offers the others.
    always : bool
        The tab is always there; else while a `PictureView` has something to show.
    """

    title: ClassVar[str] = ""
    place: ClassVar[Place] = "page"
    tab: ClassVar[str] = ""
    mode: ClassVar[str] = ""
    look_for: ClassVar[str] = ""
    focus: ClassVar[str] = ""
    alone: ClassVar[tuple[str, ...]] = ()
    plots: ClassVar[tuple[str, ...]] = ()
    asks: ClassVar[tuple[str, ...]] = ()
    always: ClassVar[bool] = True

    def __init__(self, frame: Frame) -> None:
        self.frame, self.session = frame, frame.session

    def build(self, tab: Tab) -> None:
        """Make the widgets; again when a new layout has removed them."""

    @property
    def leads(self) -> int:
        """Rank among the left tabs in presentation size, where the highest one stands alone."""
        return 0

    @property
    def controls(self) -> Sequence[Control]:
        """Its controls of fields."""
        return ()

    def fields(self) -> Sequence[FieldSpec]:
        """Fields that it can show of the session's scenario, which the palette finds."""
        return [control.spec for control in self.controls] if self.title else ()

    @property
    def in_use(self) -> bool:
        """Whether the session's scenario sets one of `fields`: then its fold is open."""
        scenario = self.session.scenario
        unset = (NONE, None)
        return any(
            (value := edits.value_at(scenario, spec.path)) != spec.default and value not in unset
            for spec in self.fields()
        )

    def reveal(self, spec: FieldSpec) -> None:
        """Show the control of one of `fields`, which it may leave out until it is asked for."""

    def follow_scenario(self) -> None:
        """Show the session's scenario; the control in use (``frame.editor.moved``) stays as it is."""

    def follow_display(self) -> None:
        """Show what the session's display says."""

    def follow_jobs(self) -> None:
        """Show how far the work beside the page is, or what it gave."""

    def take_new(self) -> bool:
        """Whether work beside the page has given something that the pictures do not show yet; asked once."""
        return False

    def draw(self, found: Shown) -> None:
        """Show what the pictures are of from now on; large pictures belong to `PictureView`."""

    def follow_time(self, t_s: float) -> None:
        """The time that the 3D view shows is another, s."""

    def resize(self) -> None:
        """The window has another size."""

    def to_front(self) -> None:
        """The tab is in front."""

    def figures(self, found: Shown, plot: str) -> Figures:
        """Figures of one of `plots`, to be saved; raises LookupError, in words, where there are none."""
        raise NotImplementedError(plot)

    def sheet(self, found: Shown) -> Sequence[tuple[str, Figures]]:
        """Content for a report of the whole session: title and figures of each picture."""
        pictures: list[tuple[str, Figures]] = []
        for plot in self.plots:
            with suppress(LookupError):  # there is nothing to show
                pictures.append((plot, self.figures(found, plot)))
        return pictures

    def sheet_tables(self) -> str:
        """HTML of tables for a report of the whole session, below its title; empty where there are none."""
        return ""

    def close(self) -> None:
        """The browser has gone."""


class PictureView(View, Generic[P]):
    """A view of a run in the right column: it is drawn only while it is in front."""

    def stands(self, run: Run) -> bool:
        """Whether there is something to show of a run."""
        del run
        return True

    @property
    def of_selected(self) -> bool:
        """Whether the picture depends on which method the controls edit."""
        return False

    def take_room(self, px: int) -> bool:
        """Note how high the page shows the plot; return whether its picture is to be made anew."""
        del px
        return False

    def picture(self, found: Shown) -> P:
        """Make the picture; changes nothing, and is called without the session's lock."""
        raise NotImplementedError

    def show(self, picture: P) -> None:
        """Show a picture."""
        raise NotImplementedError


class FieldsView(View):
    """Makes a section at each of `places`, and shows fields in them.

    Attributes
    ----------
    places : dict
        Name of a section -> place of its first control in the tab.
    """

    places: ClassVar[dict[str, float]] = {}

    def build(self, tab: Tab) -> None:
        """Make the sections."""
        self._opened: Scenario | None = None
        self._given: set[tuple[str | int, ...]] = set()
        gui, edit = self.frame.gui, self.frame.editor.edit
        self.sections = {name: Section(gui, tab, edit, order) for name, order in self.places.items()}

    @property
    def controls(self) -> list[Control]:
        """Controls of the fields."""
        return [control for section in self.sections.values() for control in section.controls.values()]

    def given(self, specs: Sequence[FieldSpec]) -> list[FieldSpec]:
        """Fields that the scenario sets, and those that it has set since it was opened.

        A control stays while its value passes the default: "0" is the beginning of "0.8".
        """
        scenario, opened = self.session.scenario, self.session.opened
        if opened is not self._opened:
            self._opened, self._given = opened, set()
        self._given |= {s.path for s in specs if edits.value_at(scenario, s.path) != s.default}
        return [spec for spec in specs if spec.path in self._given]

    def show_fields(self, fields: Mapping[str, list[FieldSpec]]) -> None:
        """Show fields of the session's scenario in the sections with these names."""
        scenario, moved = self.session.scenario, self.frame.editor.moved
        for name, specs in fields.items():
            values = edits.values_at(scenario, [spec.path for spec in specs])
            unset = {
                spec.path: NOT_GIVEN
                for spec in specs
                if spec.kind == "number" and spec.default is None and values[spec.path] is None
            }
            self.sections[name].show(specs, values, moved, unset)


def page_styles(kinds: Sequence[type[View]], state_id: str, command_id: str) -> str:
    """CSS of a page: of the shell, of its views, each folder once, and of the plots over time.

    Parameters
    ----------
    kinds : sequence of type
        The registered views.
    state_id, command_id : str
        Ids of the controls through which the page reports and asks.
    """
    folders = dict.fromkeys(Path(inspect.getfile(kind)).parent for kind in kinds)
    of_shell = [Path(__file__).parent / "static" / f"{name}.css" for name in ("page", "commands", "touch")]
    of_views = [path for folder in folders for path in sorted(folder.glob("*.css"))]
    first, last = (
        "".join(path.read_text(encoding="utf-8") for path in paths) for paths in (of_shell, of_views)
    )
    first = first.replace("PAGE_STATE", state_id).replace("PAGE_COMMAND", command_id)
    first = first.replace("PAGE_FONT", style.FONT_FAMILY)
    first = first.replace("BAR_PX", f"{BAR_PX}").replace("STRIP_PX", f"{STRIP_PX}")
    return first + table.CSS + last + style.UPLOT_CSS


def if_user(act: Callable[[], None]) -> Callable[[Any], None]:
    """Call-back of a widget that acts only on what a user does, not on values that we set."""
    return lambda event: act() if event.client is not None else None
