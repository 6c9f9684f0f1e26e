"""Design: which methods meet the limits of a scenario, and with what probability."""

import json
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from navcore.foundation.answers import Answer
from navcore.foundation.parameters import quantity
from navcore.foundation.text import Text
from navcore.questions.base import Cancelled, Progress, Question, option
from navcore.questions.fields import Over

if TYPE_CHECKING:
    from navcore.design.judged import Designs
    from navcore.study.robust import Robust


class DesignQuestion(Question):
    """Methods by the share of seeds on which they meet all limits."""

    title: ClassVar[str] = Text("Design")
    help: ClassVar[str] = Text(
        "Share of seeds on which each method meets all [[requirement]] blocks of a scenario."
    )
    function: ClassVar[str] = "designs"
    stopped: ClassVar[str] = Text("Stopped: no design.")
    writes: ClassVar = "folder"
    files: ClassVar = ("design.json", "scenario.toml")
    written: ClassVar[str] = Text("design.json and scenario.toml with these methods, best first")
    example: ClassVar[str] = """\
>>> from navcore import designs, load
>>> limit = ["requirement.0.quantity=velocity_rms_mps", "requirement.0.at_most=0.5"]
>>> found = designs(load("zha-fast", ["run.duration_h=1", *limit]), seeds=4, as_set=True)
>>> found.seeds, len(found.methods)
(4, 3)"""
    apart: ClassVar[bool] = True
    id: Literal["design"] = "design"
    seeds: int | None = quantity(
        None,
        ge=1,
        le=100_000,
        label=Text("seeds"),
        help=Text("Runs of each method; where none is given 200, or 40 at each point of a study."),
    )
    as_set: bool = option(
        False,
        label=Text("methods as they stand"),
        help=Text(
            "The scenario's methods are judged as they stand, in place of every network tuned and a Kalman "
            "filter."
        ),
    )
    over: Over = option(
        None,
        label=Text("over"),
        metavar="STUDY",
        help=Text(
            "Study (a name or a file) over whose factors the methods must hold, laid over the scenario."
        ),
    )
    quantile: float = quantity(
        0.0,
        ge=0.0,
        le=1.0,
        label=Text("quantile"),
        help=Text("Of a study: which of its points counts, by the share of seeds there; 0 for the worst."),
    )

    def answer(
        self, progress: Progress | None = None, cancelled: Cancelled | None = None
    ) -> "Designs | Robust":
        """Tune, run and judge."""
        from navcore.design.designs import designs
        from navcore.study.robust import robust_designs

        given: dict[str, Any] = {"as_set": self.as_set, "progress": progress, "cancelled": cancelled}
        if self.seeds is not None:
            given["seeds"] = self.seeds
        if self.over is None:
            return designs(self.scenario, **given)
        return robust_designs(self.scenario, self.over, quantile=self.quantile, **given)

    def texts(self, answer: Answer) -> dict[str, str]:
        """Return the document, and the scenario with these methods."""
        from navcore.scenario.file import to_toml

        methods = tuple(share.method for share in vars(answer)["methods"])
        changed = self.scenario.model_copy(update={"method": methods})
        texts = json.dumps(answer.document(), indent=2) + "\n", to_toml(changed)
        return dict(zip(self.files, texts, strict=True))
