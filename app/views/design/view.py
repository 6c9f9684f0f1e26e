"""Tab "Design": which methods meet the limits; the error budget of every method by source, over the floor."""

from typing import Any

from navcore.design.budget import Budget
from navcore.design.judged import Designs
from navcore.design.shares import Share
from navcore.design.stated import assumed_zero
from navcore.engine.run import Run
from navcore.foundation.answers import assumptions
from navcore.foundation.text import Text
from navcore.questions.budget import BudgetQuestion
from navcore.questions.design import DesignQuestion
from navcore.scenario.model import Scenario
from navcore.study.robust import Robust
from schuler_bench.editing import edits
from schuler_bench.jobs.asking import Asker
from schuler_bench.jobs.odds import Odds, without_methods
from schuler_bench.plots.budgets import steady_budget
from schuler_bench.plots.plotly_data import PlotlyFigure
from schuler_bench.session.display import Display
from schuler_bench.session.shown import Shown
from schuler_bench.shell import notices
from schuler_bench.shell.layout import TOOLS
from schuler_bench.shell.places import PlacesChooser
from schuler_bench.shell.plotly_view import PlotlyView
from schuler_bench.shell.searching import SearchControls, show_html
from schuler_bench.shell.view import Figures, Frame, if_user
from schuler_bench.views.design.figure import budget_figure
from schuler_bench.views.design.limits import TAKE_DESIGN, designs_html, limits_wanted

BUDGET_OF = Text("show")
CHOICES = {
    "limits": Text("methods that meet the limits"),
    "steady": Text("budget of the steady state, one level channel"),
    "run": Text("budget of this run, all sources"),
}
FIND, STOP = Text("Find designs for these limits"), Text("Stop finding designs")


class DesignView(PlotlyView):
    """Chooser above the table of methods, or above the bars.

    The table says at once what this run makes of the limits; the shares of seeds follow once the scenario
    stands still. The steady budget follows a slider. The budget of the run takes longer: it is computed in
    the background once the scenario stands still, and the steady one is shown until then.
    """

    title = Text("Design")
    place = "lower"
    tab = Text("Limits")
    look_for = Text(
        "Which methods meet the limits, and with what probability; which source the error comes from."
    )
    plots = (title,)
    asks = ("budget", "design")

    def __init__(self, frame: Frame) -> None:
        super().__init__(frame)
        self._budgeter = frame.session.searches.asking["budget"]
        searches = frame.session.searches
        self._judge, self._limits = searches.judge, searches.asking["design"]
        self._drawn: Budget | None = None
        self._known: object = None
        frame.commands.register(TAKE_DESIGN, self._take)

    def build_tools(self) -> None:
        """Make the chooser, the search, and the place of the table."""
        self.frame.gui.add_html(TOOLS)
        self._chooser: Any = self.frame.gui.add_dropdown(
            BUDGET_OF,
            tuple(CHOICES.values()),
            initial_value=CHOICES[self.session.display.budget],
            hint=Text(
                "Methods that meet the limits of Requirements (tab Limits), or which source each method's "
                "error is made of. Dashed: the floor, the least error that any causal linear damping can "
                "reach with these sensors and this log; it does not bound methods that do not use the log."
            ),
        )
        words = {word: key for key, word in CHOICES.items()}
        self._chooser.on_update(if_user(lambda: self.frame.show(budget=words[self._chooser.value])))
        self._over = PlacesChooser(self.frame)
        hint = Text(
            "Tunes every network for the limits, then runs each on 200 seeds, or on 40 at every point of a "
            "study: up to a minute, or several."
        )
        self._controls = SearchControls(self.frame.gui, self._limits, self._find, (FIND, STOP), hint)
        self._table = self.frame.gui.add_html("", visible=False)
        self.follow_jobs()

    def follow_display(self) -> None:
        """Show the display's choice."""
        self._chooser.value = CHOICES[self.session.display.budget]
        self.follow_jobs()
        if self.session.run is not None:
            self._ask(self.session.run.scenario)

    def draw(self, found: Shown) -> None:
        """Have the budget of the new run computed, if that is what is shown."""
        self._ask(found.run.scenario)

    def follow_scenario(self) -> None:
        """Offer the search where there are limits."""
        self.follow_jobs()

    def follow_jobs(self) -> None:
        """Show how far the search for designs is."""
        wanted = _as_table(self.session.display, self.session.scenario)
        self._controls.follow(wanted)
        self._over.follow(wanted)

    def take_new(self) -> bool:
        """Whether shares, designs or the budget of the run have just been computed."""
        run, known = self.session.run, (self._judge.known, self._limits.result, self._limits.words)
        if run is not None and _as_table(self.session.display, run.scenario):
            new = known != self._known
            self._known = known
            return new
        result = None if run is None else self._budgeter.beside(BudgetQuestion(scenario=run.scenario))
        if result is None or result is self._drawn or self.session.display.budget != "run":
            return False
        self._drawn = result
        return True

    def figure(self, both: Run, found: Shown) -> PlotlyFigure:
        """Stacked bars."""
        del both
        scenario, note = found.run.scenario, ""
        budget = (
            self._budgeter.beside(BudgetQuestion(scenario=scenario))
            if found.display.budget == "run"
            else None
        )
        if budget is None:
            budget = steady_budget(scenario)
            if found.display.budget == "run":
                note = (
                    self._budgeter.words[0] if self._budgeter.words else Text("that of the run is under way")
                )
        if budget.floor_reason:
            reason = Text("no floor: {floor_reason}", floor_reason=budget.floor_reason)
            note = Text.joined("; ", filter(None, (note, reason)))
        growth = [method.growth_per_s for method in found.run.methods]
        return budget_figure(budget, self.aspect, width_px=self.width_px, note=note, growth=growth)

    def picture(self, found: Shown) -> PlotlyFigure:
        """Make the bars; a figure without anything while the table is shown."""
        return PlotlyFigure() if _as_table(found.display, found.run.scenario) else super().picture(found)

    def figures(self, found: Shown, plot: str) -> Figures:
        """Make the bars, to be saved."""
        del plot
        return super().picture(found), []

    def show(self, picture: PlotlyFigure) -> None:
        """Send the bars, or show the table; above the bars, what a table of limits would need."""
        super().show(picture)
        run = self.session.run
        html = limits_wanted() if picture and self.session.display.budget == "limits" else ""
        if picture and run is not None:
            steady = self.session.display.budget != "run"
            said = (notices.small(text) for text in assumptions(assumed_zero(run.scenario, steady)))
            html = Text.joined("", (html, *said))
        if not picture and run is not None:
            self._judge.judge(run.scenario)
            note = notices.note((*self._judge.words, *self._limits.words), "warning")
            scenario = run.scenario
            found = designs_beside(self._limits, scenario)
            html = designs_html(run, lambda method: self._judge.odds(scenario, method), found, note)
        show_html(self._table, Text('<div class="sb-wide sb-table">{html}</div>', html=html) if html else "")

    def _find(self) -> None:
        """Tune every network for the limits."""
        session = self.session
        with notices.told(self.frame.client, Text("The designs cannot be found"), self.frame.refresh):
            with session.lock:
                scenario = session.scenario
            self._limits.begin(DesignQuestion(scenario=scenario, over=self._over.study))

    def _take(self, text: str) -> None:
        """Put the design with this place into the method that is edited."""
        session = self.session
        with session.lock:
            found = designs_beside(self._limits, session.scenario)
            if found is None or not text.isdecimal() or int(text) >= len(found.methods):
                return
            share = found.methods[int(text)]
            title = Text("The design cannot be used")
            with notices.told(self.frame.client, title, self.frame.refresh):
                changed, at = edits.with_design(session.scenario, session.selected, share.method)
                here = share if isinstance(share, Share) else share.nominal
                self._judge.learn(changed, changed.method[at], Odds(here, found.seeds))
                name = Text("{name} from Design", name=share.method.label())
                session.change(changed, None, name=name, selected=at)

    def _ask(self, scenario: Scenario) -> None:
        if self.session.display.budget == "run":
            asked = BudgetQuestion(scenario=scenario)
            if asked not in (self._budgeter.asked, self._budgeter.under_way):
                self._budgeter.begin(asked)


def designs_beside(limits: Asker, scenario: Scenario) -> Designs | Robust | None:
    """Designs for the same ship and limits; None when there are none."""
    asked = limits.asked
    same = asked is not None and without_methods(asked.scenario) == without_methods(scenario)
    return limits.result if same else None


def _as_table(display: Display, scenario: Scenario) -> bool:
    """Whether the table of limits is shown; until there are limits, the budget of the steady state is."""
    return display.budget == "limits" and bool(scenario.requirement)


VIEW = DesignView
