"""Tab "Study": a scenario over settings and seeds; what it gives is seen as it is complete, or stopped."""

from typing import Any

from navcore.design.vary import tunable_fields
from navcore.engine.run import Run
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.notation import symbol
from navcore.foundation.text import Text
from navcore.quantities import QUANTITIES
from navcore.questions.study import StudyQuestion
from navcore.study.studied import Studied
from schuler_bench.plots.plotly_data import PlotlyFigure
from schuler_bench.plots.varied import SWEPT
from schuler_bench.session.display import SWEPT as METRICS
from schuler_bench.session.shown import Shown
from schuler_bench.session.studying import (
    NOTHING,
    PRESENT,
    UPLOADED,
    chosen_task,
    left_of,
    planned,
    run_scenario,
)
from schuler_bench.shell import notices
from schuler_bench.shell.layout import CHOOSER_PX, TOOLS
from schuler_bench.shell.number_box import NumberBox
from schuler_bench.shell.plotly_view import PlotlyView
from schuler_bench.shell.searching import SearchControls, reveal, show_html
from schuler_bench.shell.view import Figures, Frame, if_user
from schuler_bench.views.study.figure import MET, series_figure, study_figure
from schuler_bench.views.study.table import OPEN_RUN, metrics_of, study_html

OF, OVER, AND_OVER, SEEDS = Text("study"), Text("over"), Text("and over"), Text("seeds")
METRIC, METHOD, SHOW = Text("of the runs"), Text("of method"), Text("show")
RUN, STOP, GO_ON = Text("Run the study"), Text("Stop the study"), Text("Go on")
SHOWS = {"pictures": Text("pictures"), "tables": Text("tables, worst runs")}
_SELF, _NOTHING = Text("this scenario"), Text("nothing else")
_MET = Text("limits met")
_EMPTY = Text(
    "Run the study: every point of the grid with each seed; then a map, what counts most, the worst runs."
)
_OLD = Text("of an earlier scenario: run it again")


class StudyView(PlotlyView):
    """Choosers of the study and of what is shown, above its pictures or its tables."""

    title = Text("Study")
    place = "lower"
    tab = Text("Robustness")
    look_for = Text("How a method performs over a grid of conditions and many seeds, and where it fails.")
    plots = (title,)
    asks = ("study",)
    above_px = 3 * CHOOSER_PX

    def __init__(self, frame: Frame) -> None:
        from navcore.study.file import studies

        super().__init__(frame)
        self._studier = frame.session.searches.asking["study"]
        self._studies, self._drawn = tuple(studies()), None
        self._planned: tuple[object, str] = (None, "")
        frame.commands.register("study", lambda _: self._begin(), RUN)
        frame.commands.register(OPEN_RUN, self._open)

    # ------------------------------------------------------------ widgets

    def build_tools(self) -> None:
        """Make the choosers and the controls."""
        gui = self.frame.gui
        gui.add_html(TOOLS)
        self._study = self._chooser(OF, "study", Text(
            "This scenario over one or two of its quantities; a study of the program; or a study file (TOML) "
            "dropped on the page."
        ))  # fmt: skip
        hint = Text(
            "What is varied: the values of a sweep, or the slider of a parameter of the edited method."
        )
        self._over = self._chooser(OVER, "study_x", hint)
        self._and_over = self._chooser(AND_OVER, "study_y", hint)
        self._seeds = NumberBox(
            self.frame.client,
            SEEDS,
            self.session.display.study_seeds,
            lambda seeds: self.frame.show(study_seeds=seeds),
            whole=True,
            hint=Text("Runs at each point."),
        )
        hint = Text("Runs all methods at each point with each seed, in the background.")
        self._controls = SearchControls(gui, self._studier, self._begin, (RUN, STOP), hint)
        self._on: Any = gui.add_button(
            GO_ON, visible=False, hint=Text("Runs what is missing; nothing twice.")
        )
        self._on.on_click(if_user(self._go_on))
        self._metric = self._chooser(METRIC, "study_metric", Text("Quantity of the runs that is shown."))
        self._method = self._chooser(
            METHOD, "study_method", Text("Whose map, factors and worst runs are shown.")
        )
        self._shows = self._chooser(SHOW, "study_shows", Text("Pictures, or tables with the worst runs."))
        self._words = gui.add_html("", visible=False)
        self._table = gui.add_html("", visible=False)
        self._show_tools()

    def _chooser(self, label: str, choice: str, hint: str) -> Any:
        """Make a dropdown of a choice of the display; `_show_tools` gives it its options."""
        box: Any = self.frame.gui.add_dropdown(label, ("",), hint=hint)
        box.on_update(if_user(lambda: self.frame.show(**{choice: self._options(choice)[str(box.value)]})))
        return box

    def _options(self, choice: str) -> dict[str, str]:
        """Words -> value of a choice, in the order of the list."""
        if choice == "study":
            name = self.session.study_file[0]
            own = {_SELF: PRESENT} | {name: name for name in self._studies}
            return own | ({name: UPLOADED} if name else {})
        if choice in ("study_x", "study_y"):
            scenario, selected = self.session.scenario, self.session.selected
            fields = tunable_fields(scenario, selected)
            found: dict[str, str] = {words[0]: key for key, words in SWEPT.items()}
            found |= {symbol(field.rsplit(".", 1)[-1]): field for field in fields}
            return found | ({_NOTHING: NOTHING} if choice == "study_y" else {})
        if choice == "study_shows":
            return {words: key for key, words in SHOWS.items()}
        document = self._document
        if choice == "study_method":
            return {one["name"]: one["name"] for one in document["methods"]} if document else {}
        keys = metrics_of(document) if document else METRICS
        return {_MET if key == MET else QUANTITIES[key].label: key for key in keys}

    def _show_tools(self) -> None:
        """Show the display's choices, how far the study is, or why it ended."""
        display, found = self.session.display, self._found
        own, there = display.study == PRESENT, found is not None
        for box, choice, now in (
            (self._study, "study", display.study),
            (self._over, "study_x", display.study_x),
            (self._and_over, "study_y", display.study_y),
            (self._metric, "study_metric", self._shown_metric),
            (self._method, "study_method", self._shown_method),
            (self._shows, "study_shows", display.study_shows),
        ):
            options = self._options(choice)
            if options and (*options,) != tuple(box.options):
                box.options = (*options,)
            word = next((word for word, value in options.items() if value == now), next(iter(options), ""))
            if box.value != word:
                box.value = word
        self._seeds.show(display.study_seeds)
        running = self._controls.follow()
        reveal(
            *((box, own) for box in (self._over, self._and_over, self._seeds)),
            *((box, there) for box in (self._metric, self._method, self._shows)),
            (self._on, left_of(self._studier) is not None and not running),
        )
        words = [*self._studier.words]
        if found is not None and not found.complete and not running:
            done, whole = found.summary["runs"], found.summary["of"]
            words.append(Text("Stopped after {done} of {whole} runs.", done=done, whole=whole))
        show_html(self._words, notices.note(words, "warning"))

    def follow_scenario(self) -> None:
        """Offer the parameters of the edited method."""
        self._show_tools()

    def follow_display(self) -> None:
        """Show the display's choices."""
        self._show_tools()

    def follow_jobs(self) -> None:
        """Show how far the study is, or why it ended."""
        self._show_tools()

    # ------------------------------------------------------------ results

    @property
    def _found(self) -> Studied | None:
        return self._studier.result

    @property
    def _document(self) -> dict[str, Any]:
        """Summary of the last study; empty while there is none with a run."""
        found = self._found
        return found.summary if found is not None and found.summary["methods"] else {}

    @property
    def _shown_metric(self) -> str:
        keys, wanted = (
            metrics_of(self._document) if self._document else METRICS,
            self.session.display.study_metric,
        )
        return wanted if wanted in keys else keys[0]

    @property
    def _shown_method(self) -> str:
        names = [one["name"] for one in self._document.get("methods", ())]
        wanted = self.session.display.study_method
        return wanted if wanted in names or not names else names[-1]

    def take_new(self) -> bool:
        """Whether a study has just come to its end."""
        found = self._found
        new, self._drawn = found is not self._drawn, found
        return new

    def figure(self, both: Run, found: Shown) -> PlotlyFigure:
        """Map or curves, and what counts most; of a study that keeps errors over time, the first of them."""
        del both
        document, kept = self._document, found.display.places
        task = self._studier.asked
        old = task is not None and task.scenario not in (None, found.run.scenario)
        note = _OLD if old else ""
        series = document.get("methods", [{}])[0].get("series")
        if series and not document.get("cells"):
            return series_figure(document, next(iter(series)), self.aspect, width_px=self.width_px, kept=kept)
        metric, method = self._shown_metric, self._shown_method
        return study_figure(
            document, metric, method, self.aspect, width_px=self.width_px, kept=kept, note=note
        )

    def picture(self, found: Shown) -> PlotlyFigure:
        """Make the picture; a figure without anything while there is none, or the tables are shown."""
        if not self._document or found.display.study_shows == "tables":
            return PlotlyFigure()
        return super().picture(found)

    def figures(self, found: Shown, plot: str) -> Figures:
        """Make the picture, to be saved; raises LookupError while no study has been run."""
        if not self._document:
            raise LookupError(Text("No study has been run yet."))
        return super().figures(found, plot)

    def sheet_tables(self) -> str:
        """Make the tables for a report; empty while no study has been run."""
        return self._tables(buttons=False)

    def _tables(self, *, buttons: bool) -> str:
        if not self._document:
            return ""
        return study_html(self._document, self._shown_metric, self._shown_method, buttons=buttons)

    def show(self, picture: PlotlyFigure) -> None:
        """Send the picture, or show the tables."""
        super().show(picture)
        html = ""
        if not picture:
            html = self._tables(buttons=True) or notices.small(Text.joined(" ", (_EMPTY, self._size())))
        show_html(self._table, Text('<div class="sb-wide sb-table">{html}</div>', html=html) if html else "")

    def _size(self) -> str:
        """How large the chosen study is; found anew when that may have changed."""
        display, scenario = self.session.display, self.session.scenario
        of = (display.study, display.study_x, display.study_y, display.study_seeds, self.session.study_file)
        key = (*of, scenario.run, len(scenario.method))
        if self._planned[0] != key:
            self._planned = key, planned(self.session)
        return self._planned[1]

    # ------------------------------------------------------------ commands

    def _begin(self) -> None:
        """Run the chosen study."""
        with notices.told(self.frame.client, Text("The study cannot be run"), lambda: None):
            self._studier.begin(chosen_task(self.session))

    def _go_on(self) -> None:
        """Run what is missing of the study that was stopped."""
        left = left_of(self._studier)
        if left is not None:
            self._studier.begin(left)

    def _open(self, text: str) -> None:
        """Open the scenario of one run."""
        task: StudyQuestion | None = self._studier.asked
        if task is None:
            return
        session = self.session
        with (
            session.lock,
            notices.told(self.frame.client, Text("The run cannot be opened"), self.frame.refresh),
        ):
            if not text.isdecimal() or len(text) > 9:
                raise InputError(Fault("", "run", text[:20], Text("must be the number of a run")))
            scenario = run_scenario(task, int(text))
            name = Text("run {number} of the study", number=int(text))
            names = [method.name for method in scenario.method]
            at = names.index(self._shown_method) if self._shown_method in names else 0
            origin = None if task.scenario is not None else task.where
            session.change(scenario, None, origin=origin, selected=at, name=name)


VIEW = StudyView
