"""Tune: the setting of a method that makes an objective least while requirements are kept."""

from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, Self

from pydantic import BeforeValidator, model_validator

from navcore.foundation.answers import Answer
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.quantities import OBJECTIVES, TUNED
from navcore.questions.base import Asked, Cancelled, Progress, option
from navcore.questions.fields import Over, Varying

if TYPE_CHECKING:
    from navcore.design.measures import Requirement
    from navcore.design.tuned import Tuned


def _objective(value: Any) -> Any:
    from navcore.design.measures import read_objective

    if isinstance(value, str):
        read_objective(value)
    return value


def _limit(value: Any) -> Any:
    from navcore.design.measures import Requirement, read_requirement

    if isinstance(value, str):
        return read_requirement(value)
    if not isinstance(value, Requirement):
        raise InputError(Fault("", "--require", value, Text("must have the form NAME<=VALUE or NAME>=VALUE")))
    return value


if TYPE_CHECKING:
    Limit = Requirement
else:
    Limit = Annotated[Any, BeforeValidator(_limit)]


class TuneQuestion(Varying):
    """The best setting of a method."""

    title: ClassVar[str] = Text("Tune")
    help: ClassVar[str] = Text(
        "Find the parameters of a method that make an objective least while requirements are kept."
    )
    stopped: ClassVar[str] = Text("Stopped: there is no proposal.")
    writes: ClassVar = "file"
    files: ClassVar = ("scenario.toml",)
    written: ClassVar[str] = Text("the scenario with the best setting")
    example: ClassVar[str] = """\
>>> from navcore import tune
>>> found = tune("liu-networks", "tilt_rms", ["method.2.network.zeta=0.1:2"], confirm=False)
>>> found.at_end_of_range, found.complete
((), True)"""
    id: Literal["tune"] = "tune"
    objective: Annotated[str, BeforeValidator(_objective)] = option(
        ...,
        label=Text("tune for"),
        metavar="NAME",
        help=Text(
            "What to make small: {names}, or a sum, tilt_rms + 0.5*velocity_rms.", names=", ".join(OBJECTIVES)
        ),
    )
    require: tuple[Limit, ...] = option(
        (),
        label=Text("further limits"),
        metavar="NAME<=VALUE",
        help=Text(
            "A limit, e.g. settling_s<=3600 or tilt_rms<=5arcsec, of one of {names}. The scenario's own "
            "[[requirement]] blocks count too, where none is given of their quantity.",
            names=", ".join(TUNED),
        ),
    )
    worst_of: tuple[Asked, ...] = option(
        (),
        label=Text("worst of"),
        metavar="SCENARIO",
        help=Text("A further scenario in which the same method counts too: the worst of all is made small."),
    )
    over: Over = option(
        None,
        label=Text("over"),
        metavar="STUDY",
        help=Text("Study (a name or a file) laid over the scenario: the worst of its points is made small."),
    )
    default_limits: bool = option(
        True,
        label=Text("keep settling and growth bounded"),
        help=Text(
            "A limit on settling and on growth counts where none is given: without them the search may tune "
            "the damping away."
        ),
    )
    confirm: bool = option(
        True,
        label=Text("confirm by runs"),
        help=Text("The present setting and the proposal are run on 32 seeds."),
    )

    @model_validator(mode="after")
    def _one_or_the_other(self) -> Self:
        if self.over is not None and self.worst_of:
            raise InputError(Fault("", "--over", None, Text("does not go with --worst-of")))
        return self

    def answer(self, progress: Progress | None = None, cancelled: Cancelled | None = None) -> "Tuned":
        """Search."""
        from navcore.design.tune import tune
        from navcore.study.robust_tune import tune_over

        given: dict[str, Any] = {
            "along": self.along,
            "whole": self.beyond_sliders,
            "default_limits": self.default_limits,
            "confirm": self.confirm,
            "progress": progress,
            "cancelled": cancelled,
        }
        if self.over is not None:
            return tune_over(self.scenario, self.over, self.objective, self.vary, self.require, **given)
        return tune(self.scenario, self.objective, self.vary, self.require, worst_of=self.worst_of, **given)

    def texts(self, answer: Answer) -> dict[str, str]:
        """Return the scenario with the best setting."""
        from navcore.scenario.file import to_toml

        return {"scenario.toml": to_toml(vars(answer)["scenario"])}
