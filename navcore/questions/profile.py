"""Profile: an objective over each parameter of a method, before a search."""

from typing import TYPE_CHECKING, ClassVar, Literal

from navcore.foundation.text import Text
from navcore.quantities import OBJECTIVES
from navcore.questions.base import Cancelled, Progress, option
from navcore.questions.fields import Varying

if TYPE_CHECKING:
    from navcore.design.profile import Profiles


class ProfileQuestion(Varying):
    """An objective over each parameter, the others as they are."""

    title: ClassVar[str] = Text("Profile")
    help: ClassVar[str] = Text(
        "Measure an objective over the range of each parameter of a method, the others as they are."
    )
    spare: ClassVar[bool] = True
    still_s: ClassVar[float] = 0.3
    stopped: ClassVar[str] = ""
    example: ClassVar[str] = """\
>>> from navcore import profile
>>> found = profile("liu-networks", "settling_s", ["method.2.network.zeta"])
>>> len(found.curves), len(found.curves[0].values)
(1, 21)"""
    id: Literal["profile"] = "profile"
    objective: Literal[OBJECTIVES] = option(  # type: ignore[valid-type]
        ..., label=Text("objective"), help=Text("What is measured.")
    )

    def answer(self, progress: Progress | None = None, cancelled: Cancelled | None = None) -> "Profiles":
        """Measure it."""
        from navcore.design.profile import profiles

        return profiles(
            self.scenario,
            self.objective,
            self.vary,
            along=self.along,
            whole=self.beyond_sliders,
            progress=progress,
            cancelled=cancelled,
        )
