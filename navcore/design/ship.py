"""Inputs that all methods share in budget, bands and tuning: sensors, motion, responses, floor."""

from dataclasses import dataclass, field
from functools import cached_property

from navcore.design.along import Along, along
from navcore.design.constants import Column, shared_columns
from navcore.design.course import MOST_INTERVALS, Course, course, motion_steps
from navcore.design.figures import Figures, Series, mean_figures
from navcore.design.filter import filter_variance
from navcore.design.floor import steady_floor
from navcore.design.modelled import Modelled, modelled
from navcore.design.scheduled import scheduled_times
from navcore.engine.environment import stretches_of
from navcore.motion.truth import Stretches
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.scenario.stochastic import StochasticModel, require_sensors, stochastic_model


@dataclass(frozen=True, eq=False)
class Ship:
    """A scenario as its methods' covariances see it; everything is made when it is first asked for.

    Attributes
    ----------
    scenario : Scenario
        Complete and checked; a strapdown scenario counts as the error model along its motion. A recorded log
        is replaced by a simulated one with the error that is fitted to it (`navcore.design.modelled`).
    along_run : bool
        Root mean squares over the scenario's run, else in the steady state at rest.
    intervals : int
        Of the run at most (`navcore.design.course.course`).
    drawn : bool
        Biases and initial errors count as they are drawn for the seeds of a design, by their standard
        deviation; else those that are given as numbers count as they are in a run.
    given : Scenario
        As it was given, with its recordings.
    """

    scenario: Scenario
    along_run: bool = True
    intervals: int = MOST_INTERVALS
    drawn: bool = False
    given: Scenario = field(init=False)

    def __post_init__(self) -> None:
        """Put the fitted log in the place of a recorded one."""
        object.__setattr__(self, "given", self.scenario)
        object.__setattr__(self, "scenario", self.recordings.scenario)

    @cached_property
    def recordings(self) -> Modelled:
        """What the recordings of the scenario count as."""
        return modelled(self.given)

    @cached_property
    def model(self) -> StochasticModel:
        """The sensors."""
        return stochastic_model(self.scenario)

    @cached_property
    def course(self) -> Course:
        """The motion; raises InputError when it cannot be carried out."""
        times = tuple(time for method in self.scenario.method for time in scheduled_times(method))
        return course(self.scenario, self.intervals, times)

    @cached_property
    def stretches(self) -> Stretches:
        """Parts of the motion, without the course; raises InputError when it cannot be carried out."""
        return stretches_of(self.scenario, *motion_steps(self.scenario))

    @cached_property
    def columns(self) -> tuple[Column, ...]:
        """Responses that all methods share."""
        return shared_columns(self.scenario, self.course, self.model, self.drawn)

    def along(self, method: Method) -> Along:
        """Variances of each source along the run, for a method whose law is known in advance."""
        require_sensors(self.scenario)
        return along(self.scenario, method, self.course, self.model, self.columns)

    @cached_property
    def floor_series(self) -> Series | None:
        """Covariance of a Kalman filter along the run; None where it is told of no error, or has no log.

        None too where a recording has no model, so that its error counts as 0.
        """
        if self.recordings.no_floor or self.model.silent or not self.model.log:
            return None
        return Series(self.course.t_s, {}, filter_variance(self.scenario, self.course, self.model))

    def floor(self, method: Method) -> Figures:
        """Least that any causal linear damping with the log can reach; empty for a method without the log."""
        if not method.reads_log or self.recordings.no_floor:
            return Figures()
        if not self.along_run:
            least = steady_floor(self.model, self.scenario.omega_s)
            return Figures(least.tilt_rad, least.velocity_mps)
        least = self.floor_series
        return Figures() if least is None else mean_figures(least.t_s, least.total)
