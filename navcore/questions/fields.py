"""Fields that several questions share."""

from typing import TYPE_CHECKING, Annotated, Any, Self

from pydantic import BeforeValidator, model_validator

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.questions.base import Question, option

ALONG = option(
    False,
    label=Text("over the run"),
    help=Text("Over the scenario's run, in place of the steady state at rest."),
)
BEYOND = option(
    False,
    label=Text("search beyond the sliders"),
    help=Text("All that the fields allow is searched, not only what the page's sliders reach."),
)


def _study(value: Any) -> Any:
    from navcore.study.file import load
    from navcore.study.model import Study

    if value is None or isinstance(value, Study):
        return value
    if isinstance(value, str):
        return load(value)
    raise InputError(Fault("", "", value, Text("must be a study, its name, or a TOML file")))


if TYPE_CHECKING:
    Over = Any
else:
    Over = Annotated[Any, BeforeValidator(_study)]
    """Type of a field that holds a study: itself, its name, or a file."""


class Varying(Question):
    """Question about parameters of one method."""

    vary: tuple[str, ...] = option(
        (),
        label=Text("what may vary"),
        metavar="FIELD[=LOW:HIGH]",
        help=Text(
            "A number of a method, e.g. method.1.network.sigma, or with a range "
            "method.1.network.sigma=1e-4:0.1."
        ),
    )
    along: bool = ALONG
    beyond_sliders: bool = BEYOND

    @model_validator(mode="after")
    def _can_vary(self) -> Self:
        from navcore.design.vary import read_varied

        read_varied(self.scenario, self.vary, self.beyond_sliders)
        return self

    @property
    def method(self) -> int:
        """Index of the method."""
        return int(self.vary[0].split(".")[1])
