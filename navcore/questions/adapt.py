"""Adapt: Sun's double loop, which makes the table of the policy ``adaptive``."""

from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

from pydantic import BeforeValidator, Field, ValidationError

from navcore.foundation.answers import Answer
from navcore.foundation.errors import Fault, InputError, StoppedError
from navcore.foundation.faults import faults_from
from navcore.foundation.text import Text
from navcore.questions.base import Asked, Cancelled, Progress, Question, loaded

if TYPE_CHECKING:
    from navcore.design.sun import Tuning
    from navcore.design.sun_settings import TuningSettings


def _scenario(value: Any) -> Any:
    from navcore.design.sun import sun_scenario

    return sun_scenario() if value == "" else loaded(value)


def _settings(value: Any) -> Any:
    """Settings of texts as of ``--set``, or as they are."""
    from navcore.design.sun_settings import TuningSettings
    from navcore.scenario.file import apply_overrides

    if isinstance(value, TuningSettings):
        return value
    data: dict[str, Any] = {}
    apply_overrides(data, value)
    try:
        return TuningSettings.model_validate(data)
    except ValidationError as error:
        raise InputError(*faults_from(error, TuningSettings, data, "--loop")) from None


if TYPE_CHECKING:
    OfSun = Asked
    Loop = TuningSettings
else:
    OfSun = Annotated[Any, BeforeValidator(_scenario)]
    Loop = Annotated[Any, BeforeValidator(_settings)]


class AdaptQuestion(Question):
    """The best damping coefficient for each velocity difference."""

    title: ClassVar[str] = Text("Double loop")
    help: ClassVar[str] = Text(
        "Find the damping coefficient with the least velocity errors for each difference (Sun 8, Table 1)."
    )
    stopped: ClassVar[str] = Text("Stopped: no table was found.")
    keeps: ClassVar[bool] = False
    writes: ClassVar = "file"
    files: ClassVar = ("scenario.toml",)
    written: ClassVar[str] = Text("the scenario with a further method that follows the table")
    example: ClassVar[str] = """\
>>> from navcore import adapt
>>> found = adapt(loop=["differences_kn=[0, 3]", "step=0.33"])
>>> len(found.pairs())
2"""
    id: Literal["adapt"] = "adapt"
    scenario: OfSun = Field(
        default="",
        validate_default=True,
        description=Text("Name of a preset, or a TOML file; empty: Sun's own setting."),
        json_schema_extra={"metavar": "SCENARIO"},
    )
    loop: Loop = Field(
        default=(),
        validate_default=True,
        description=Text(
            "A setting of the double loop, e.g. step=0.05, differences_kn=[0,0.5,3], error=drift or "
            "'network={{id=\"complementary\"}}'."
        ),
        json_schema_extra={"label": Text("double loop"), "metavar": "KEY=VALUE", "many": True},
    )

    def answer(self, progress: Progress | None = None, cancelled: Cancelled | None = None) -> "Tuning":
        """Search."""
        from navcore.design.sun import tune_table

        found = tune_table(self.scenario, self.loop, progress, cancelled)
        if not found.complete:
            raise StoppedError(Fault("", "", None, Text("stopped")))
        return found

    def texts(self, answer: Answer) -> dict[str, str]:
        """Return the scenario with a method that follows the table."""
        from navcore.design.sun import Tuning, with_table
        from navcore.scenario.file import to_toml

        assert isinstance(answer, Tuning)
        return {"scenario.toml": to_toml(with_table(self.scenario, answer))}
