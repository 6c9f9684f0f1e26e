"""Claims of the reproduction report as tests: the linear half, with fewer seeds."""

from __future__ import annotations

from dataclasses import replace

from tests.papers.claim import Exhibit, Verdict
from tests.papers.markdown import check
from tests.papers.runs import Runs


def verdicts(exhibit: Exhibit, runs: Runs) -> list[Verdict]:
    """Verdict of each claim without the strapdown half; `check` refuses one that its reason contradicts."""
    return [check(replace(claim, strapdown=False), runs).verdict for claim in exhibit.claims]
