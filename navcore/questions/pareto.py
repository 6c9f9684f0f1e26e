"""Pareto: what two objectives cost each other, for every network."""

from typing import TYPE_CHECKING, ClassVar, Literal

from navcore.foundation.errors import Fault, StoppedError
from navcore.foundation.parameters import quantity
from navcore.foundation.text import Text
from navcore.quantities import WEIGHED
from navcore.questions.base import Cancelled, Progress, Question, option
from navcore.questions.fields import ALONG, BEYOND

if TYPE_CHECKING:
    from navcore.design.fronts import Pareto
    from navcore.scenario.model import Scenario

if TYPE_CHECKING:
    Weighed = str
else:
    Weighed = Literal[WEIGHED]


class ParetoQuestion(Question):
    """Pareto fronts of all networks in place of a method's own."""

    title: ClassVar[str] = Text("Pareto fronts")
    help: ClassVar[str] = Text(
        "Find the Pareto fronts of two objectives for every network in place of a method's own."
    )
    stopped: ClassVar[str] = Text("Stopped: no fronts were found.")
    example: ClassVar[str] = """\
>>> from navcore import pareto
>>> found = pareto("sikuliaq-like", "tilt_rms", "velocity_rms", method=2, network=["classic2"])
>>> [*found.fronts], len(found.fronts["classic2"])
(['classic2'], 1)"""
    id: Literal["pareto"] = "pareto"
    x: Weighed = option("tilt_rms", label=Text("across"), help=Text("Objective on the horizontal axis."))
    y: Weighed = option("velocity_rms", label=Text("up"), help=Text("Objective on the vertical axis."))
    method: int = quantity(0, ge=0, label=Text("method"), help=Text("Which method of the scenario, from 0."))
    network: tuple[str, ...] = option(
        (), label=Text("networks"), metavar="ID", help=Text("Only these networks, by their ids.")
    )
    along: bool = ALONG
    beyond_sliders: bool = BEYOND

    @property
    def objectives(self) -> tuple[str, str]:
        """Both objectives."""
        return self.x, self.y

    def answer(self, progress: Progress | None = None, cancelled: Cancelled | None = None) -> "Pareto":
        """Search."""
        from navcore.design.pareto import pareto

        found = pareto(
            self.scenario,
            self.objectives,
            self.method,
            networks=self.network or None,
            along=self.along,
            whole=self.beyond_sliders,
            progress=progress,
            cancelled=cancelled,
        )
        if found.stopped and not found.fronts:
            raise StoppedError(Fault("", "", None, Text("stopped before a front was found")))
        return found

    def fits(self, scenario: "Scenario") -> bool:
        """Whether the fronts are those of a scenario: all but its method's network and name is the same."""
        if self.method >= min(len(scenario.method), len(self.scenario.method)):
            return False
        own, other = self.scenario.method[self.method], scenario.method[self.method]
        same = own.model_copy(update={"network": other.network, "name": other.name})
        return self.scenario.model_copy(update={"method": (same,)}) == scenario.model_copy(
            update={"method": (other,)}
        )
