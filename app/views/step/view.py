"""Tab "Step": responses of tilt and velocity error to steps of log, gyro and accelerometer errors."""

from app.plots.plotly_data import PlotlyFigure
from app.session.requirements import limits_of
from app.session.shown import Shown
from app.shell.plotly_view import PlotlyView
from app.views.step.figure import step
from navcore.engine.run import Run
from navcore.foundation.text import Text


class StepView(PlotlyView):
    """The plots alone."""

    title = Text("Step")
    place = "upper"
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
