"""Tab "Step": responses of tilt and velocity error to steps of log, gyro and accelerometer errors."""

from navcore.engine.run import Run
from navcore.foundation.text import Text
from schuler_bench.plots.plotly_data import PlotlyFigure
from schuler_bench.session.requirements import limits_of
from schuler_bench.session.shown import Shown
from schuler_bench.shell.plotly_view import PlotlyView
from schuler_bench.views.step.figure import step


class StepView(PlotlyView):
    """The plots alone."""

    title = Text("Step")
    place = "upper"
    tab = Text("Frequency")
    look_for = Text(
        "How long a step of an error is felt: look for the settling time and the swing to the other side."
    )
    focus = "step"
    plots = (title,)
    above_px = 0

    def figure(self, both: Run, found: Shown) -> PlotlyFigure:
        """Step responses."""
        limits = limits_of(found.run.scenario.requirement)
        return step(both, self.aspect, width_px=self.width_px, limits=limits)


VIEW = StepView
