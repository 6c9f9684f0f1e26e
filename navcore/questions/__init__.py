"""What the bench can be asked: one class a question, one line each.

Command, panel of the page, job, task of a cluster, function of a notebook and the reference page are made
from the class.
"""

from navcore.foundation.registry import registry
from navcore.questions.base import Question

QUESTIONS: dict[str, type[Question]] = registry(
    Question,
    "id",
    "navcore.questions.run:RunQuestion",
    "navcore.questions.budget:BudgetQuestion",
    "navcore.questions.tune:TuneQuestion",
    "navcore.questions.profile:ProfileQuestion",
    "navcore.questions.pareto:ParetoQuestion",
    "navcore.questions.adapt:AdaptQuestion",
    "navcore.questions.design:DesignQuestion",
    "navcore.questions.worst:WorstQuestion",
    "navcore.questions.detect:DetectQuestion",
    "navcore.questions.suffice:SufficeQuestion",
    "navcore.questions.fit:FitQuestion",
    "navcore.questions.voyage:VoyageQuestion",
    "navcore.questions.report:ReportQuestion",
    "navcore.questions.study:StudyQuestion",
    "navcore.questions.sweep:SweepQuestion",
    "navcore.questions.verify:VerifyQuestion",
    "navcore.questions.correction:CorrectionQuestion",
    "navcore.questions.why:WhyQuestion",
    "navcore.questions.damp:DampQuestion",
    "navcore.questions.export:ExportQuestion",
)
"""Questions by name, in the order in which the command and the page offer them."""
