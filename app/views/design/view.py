"""Tab "Design": the error budget of every method by source, and how many times the floor it is."""

from typing import Any

from navcore.design.budget import Budget
from navcore.engine.run import Run
from navcore.foundation.text import Text
from navcore.scenario.model import Scenario
from schuler_bench.plots.budgets import steady_budget
from schuler_bench.plots.plotly_data import PlotlyFigure
from schuler_bench.session.shown import Shown
from schuler_bench.shell.plotly_view import PlotlyView
from schuler_bench.shell.view import Frame, if_user
from schuler_bench.views.design.figure import budget_figure

BUDGET_OF = Text("budget of")
CHOICES = {"steady": Text("the steady state, one level channel"), "run": Text("this run, all sources")}


class DesignView(PlotlyView):
    """Chooser above the bars.

    The steady budget follows a slider. The budget of the run takes longer: it is computed in the background
    once the scenario stands still, and the steady one is shown until then.
    """

    title = Text("Design")
    place = "lower"
    look_for = Text("Which source the error comes from, and how far it is from the best possible.")
    plots = (title,)

    def __init__(self, frame: Frame) -> None:
        super().__init__(frame)
        self._budgeter = frame.session.searches.budgeter
        self._drawn: Budget | None = None

    def build_tools(self) -> None:
        """Make the chooser."""
        self._chooser: Any = self.frame.gui.add_dropdown(
            BUDGET_OF,
            tuple(CHOICES.values()),
            initial_value=CHOICES[self.session.display.budget],
            hint=Text(
                "Which source each method's error is made of. Dashed: the floor, the least error that any "
                "causal linear damping can reach with these sensors and this log; it does not bound methods "
                "that do not use the log."
            ),
        )
        words = {word: key for key, word in CHOICES.items()}
        self._chooser.on_update(if_user(lambda: self.frame.show(budget=words[self._chooser.value])))

    def follow_display(self) -> None:
        """Show the display's choice."""
        self._chooser.value = CHOICES[self.session.display.budget]
        if self.session.run is not None:
            self._ask(self.session.run.scenario)

    def draw(self, found: Shown) -> None:
        """Have the budget of the new run computed, if that is what is shown."""
        self._ask(found.run.scenario)

    def take_new(self) -> bool:
        """Whether the budget of the run has just been computed."""
        run = self.session.run
        result = None if run is None else self._budgeter.beside(run.scenario)
        if result is None or result is self._drawn or self.session.display.budget != "run":
            return False
        self._drawn = result
        return True

    def figure(self, both: Run, found: Shown) -> PlotlyFigure:
        """Stacked bars."""
        del both
        scenario, note = found.run.scenario, ""
        budget = self._budgeter.beside(scenario) if found.display.budget == "run" else None
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

    def _ask(self, scenario: Scenario) -> None:
        if self.session.display.budget != "run" or self._budgeter.beside(scenario) is not None:
            return
        if self._budgeter.under_way != scenario:
            self._budgeter.begin(scenario)


VIEW = DesignView
