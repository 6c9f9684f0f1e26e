"""Tab "Tune": the best setting of the selected method, or the Pareto fronts of all networks in its place."""

from typing import Any

from navcore.design.fronts import Pareto
from navcore.design.pareto import measured
from navcore.design.profile import Profiles
from navcore.engine.run import Run
from navcore.foundation.text import Text
from schuler_bench.plots.plotly_data import PlotlyFigure
from schuler_bench.session.shown import Shown
from schuler_bench.shell.layout import CHOOSER_PX, TOOLS
from schuler_bench.shell.plotly_view import PlotlyView
from schuler_bench.shell.view import Figures, Frame, if_user
from schuler_bench.views.tune.finder import FrontsPanel
from schuler_bench.views.tune.fronts import fronts_figure
from schuler_bench.views.tune.profiles import profiles_figure
from schuler_bench.views.tune.setting import SettingPanel

SEARCH_FOR = Text("search for")
SEARCHES = {Text("the best setting"): "setting", Text("Pareto fronts"): "fronts"}
_NOTE_PX = 26


class TuneView(PlotlyView):
    """Chooser of what is searched for; below it the controls of that search, and its proposal or picture."""

    title = Text("Tune")
    place = "lower"
    tab = Text("Search")
    look_for = Text("Let the program search the best setting; accept or discard what it proposes.")
    plots = (title,)
    asks = ("tune", "profile", "pareto")
    above_px = 2 * CHOOSER_PX + _NOTE_PX

    def __init__(self, frame: Frame) -> None:
        super().__init__(frame)
        self._setting, self._finder = SettingPanel(frame), FrontsPanel(frame)
        self._profiles = frame.session.searches.asking["profile"]
        self._drawn: Pareto | None = None
        self._drawn_profiles: object = None
        self._idle = True
        frame.commands.register("tune", lambda _: self._setting.begin(), Text("Tune the selected method"))

    def build_tools(self) -> None:
        """Make the controls of both searches."""
        gui = self.frame.gui
        gui.add_html(TOOLS)
        self._search: Any = gui.add_dropdown(
            SEARCH_FOR, tuple(SEARCHES),
            hint=Text("The best setting: of the selected method, for one objective. Pareto fronts: what two "
            "objectives cost each other, with every network in place of that method's own."),
        )  # fmt: skip
        self._search.on_update(if_user(lambda: self.frame.show(search=SEARCHES[self._search.value])))
        self._setting.build()
        self._finder.build()
        self._show()

    @property
    def _of_fronts(self) -> bool:
        return self.session.display.search == "fronts"

    @property
    def of_selected(self) -> bool:
        """The star, or the curves, are of the selected method."""
        return True

    def follow_scenario(self) -> None:
        """Offer the fields of the selected method."""
        self._show()

    def follow_display(self) -> None:
        """Show the display's choices."""
        self._show()

    def follow_jobs(self) -> None:
        """Show how far the searches are, or what they gave."""
        self._show()

    def take_new(self) -> bool:
        """Whether fronts or curves have just been found, or a proposal takes the place of the curves."""
        before = self._drawn, self._drawn_profiles, self._idle
        if self._of_fronts:
            self._drawn = self._finder.found
        else:
            self._drawn_profiles, self._idle = self._profiles.result, self._setting.idle
        now = self._drawn, self._drawn_profiles, self._idle
        return any(one is not other for one, other in zip(before, now, strict=True))

    def _show(self) -> None:
        chosen = next(label for label, name in SEARCHES.items() if name == self.session.display.search)
        if self._search.value != chosen:
            self._search.value = chosen
        self._setting.show(chosen=not self._of_fronts)
        self._finder.show(chosen=self._of_fronts)

    def figure(self, both: Run, found: Shown) -> PlotlyFigure:
        """Pareto fronts, with the present design; or the objective over each parameter."""
        del both
        scenario = found.run.scenario
        if found.display.search != "fronts":
            known, index = self._curves(found), found.selected
            if known is None:
                return PlotlyFigure()
            color = found.run.methods[index].place
            return profiles_figure(known.curves, known.of, scenario.method[index], color, self.aspect)
        index, objectives = self._finder.method, self._finder.objectives
        return fronts_figure(
            self._finder.found,
            objectives,
            measured(scenario, objectives, index) if index < len(scenario.method) else None,
            scenario.method[min(index, len(scenario.method) - 1)].name,
            self.aspect,
            width_px=self.width_px,
            note=self._finder.note,
            growth=found.run.methods[min(index, len(found.run.methods) - 1)].growth_per_s,
        )

    def _curves(self, found: Shown) -> Profiles | None:
        """Objective over each parameter of the selected method; None while a proposal takes their place."""
        asked, of = self._setting.profile(found.run.scenario), self._profiles.asked
        if asked is None or of is None or asked.method != found.selected or not self._setting.idle:
            return None
        fits = (of.objective, of.vary) == (asked.objective, asked.vary)
        known: Profiles | None = self._profiles.result
        return known if fits and known is not None and known.curves else None

    def picture(self, found: Shown) -> PlotlyFigure:
        """Make the picture; a figure without anything while there are no curves, or a proposal."""
        empty = found.display.search != "fronts" and self._curves(found) is None
        return PlotlyFigure() if empty else super().picture(found)

    def show(self, picture: PlotlyFigure) -> None:
        """Send the picture, and have the curves measured."""
        super().show(picture)
        run = self.session.run
        if run is not None and not self._of_fronts and self._setting.idle:
            asked = self._setting.profile(run.scenario)
            if asked is not None:
                self._profiles.follow(asked)

    def figures(self, found: Shown, plot: str) -> Figures:
        """Make the fronts, to be saved; raises LookupError while none have been found."""
        if found.display.search != "fronts" or self._finder.found is None:
            raise LookupError(Text("No Pareto fronts have been found yet."))
        return super().figures(found, plot)


VIEW = TuneView
