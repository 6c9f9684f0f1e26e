"""Why: which error source and which natural period dominate each method's errors."""

from typing import TYPE_CHECKING, Any, ClassVar, Literal, Self

from pydantic import PrivateAttr

from navcore.foundation.text import Text
from navcore.questions.base import Cancelled, Progress, Question, unless_stopped

if TYPE_CHECKING:
    from navcore.design.dominance import Why
    from navcore.engine.run import Run


class WhyQuestion(Question):
    """What dominates a run."""

    title: ClassVar[str] = Text("Why")
    help: ClassVar[str] = Text(
        "Say which error source dominates each error of each method, and in which natural period it moves."
    )
    keeps: ClassVar[bool] = False
    spare: ClassVar[bool] = True
    still_s: ClassVar[float] = 1.0
    stopped: ClassVar[str] = ""
    example: ClassVar[str] = """\
>>> from navcore import load, why
>>> found = why(load("zha-fast", ["run.duration_h=2"]))
>>> found.methods[0][0], found.methods[0][1][0].source
('free', 'gyro bias')"""
    id: Literal["why"] = "why"
    _run: Any = PrivateAttr(default=None)

    @classmethod
    def of(cls, run: "Run") -> Self:
        """Ask it of a run that is there; else the scenario is run first."""
        asked = cls.model_construct(scenario=run.scenario)
        asked._run = run
        return asked

    def __eq__(self, other: object) -> bool:
        """Whether both are of the same run; of the same scenario, where neither has been run."""
        if not isinstance(other, WhyQuestion) or self._run is not other._run:
            return False
        return self._run is not None or self.scenario == other.scenario

    __hash__ = None  # type: ignore[assignment]

    def answer(self, progress: Progress | None = None, cancelled: Cancelled | None = None) -> "Why":
        """Take the sources apart."""
        from navcore.design.dominance import why
        from navcore.engine.simulation import simulate

        run = self._run
        if run is None:
            run = simulate(self.scenario, None, cancelled)
            unless_stopped(cancelled)
        return why(run, progress or (lambda _: None), cancelled or (lambda: False))
