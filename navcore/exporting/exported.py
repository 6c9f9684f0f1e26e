"""What an export gives: the files of one method for one target."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from navcore.exporting import target_c
from navcore.exporting.form import Form
from navcore.exporting.forms import form_of
from navcore.exporting.names import require_prefix
from navcore.exporting.subject import Subject, subject_of
from navcore.foundation.answers import Answer, Column, Table
from navcore.foundation.text import Text
from navcore.scenario.model import Scenario

Target = Literal["c"]
"""Targets of an export."""


@dataclass(frozen=True)
class Exported(Answer):
    """The law of a method as files.

    Attributes
    ----------
    form : Form
        The method, its program and its vectors.
    target : str
        What it was exported as.
    prefix : str
        Of the names in the files.
    files : dict of str to str
        Texts by name.
    bound : float
        Largest deviation from the vectors, of the peak of each output.
    warnings : tuple of str
        What the user should know.
    """

    form: Form
    target: str
    prefix: str
    files: dict[str, str]
    bound: float
    warnings: tuple[str, ...] = ()

    def document(self) -> dict[str, Any]:
        """Return what ``--json`` prints."""
        subject = self.form.subject
        peaks = dict(zip(self.form.outputs, _peaks(self.form), strict=True))
        return {
            "method": subject.method.label(),
            "target": self.target,
            "name": self.prefix,
            "rate_hz": subject.rate_hz,
            "step_s": subject.step_s,
            "vectors": {"calls": len(self.form.given), "hours": self.hours, "peaks": peaks},
            "bound": self.bound,
            "files": {name: len(text.encode()) for name, text in self.files.items()},
            "warnings": list(self.warnings),
        }

    @property
    def hours(self) -> float:
        """Time that the vectors replay, h."""
        return len(self.form.given) * self.form.subject.step_s / 3600.0

    def rows(self) -> Iterator[Table | str]:
        """Give what was exported, the files, and the warnings."""
        subject = self.form.subject
        yield Text(
            '"{method}" at {rate:.6g} Hz; vectors of {hours:.4g} h, bound {bound:.3g} of the peaks',
            method=subject.method.label(),
            rate=subject.rate_hz,
            hours=self.hours,
            bound=self.bound,
        )
        heads = Column(Text("file"), left=True), Column(Text("size"), "kB", 4)
        rows = [(name, len(text.encode()) / 1000.0) for name, text in self.files.items()]
        yield Table(heads, tuple(rows))
        yield from (Text("warning: {text}", text=text) for text in self.warnings)


def _peaks(form: Form) -> list[float]:
    return [float(peak) for peak in np.max(np.abs(form.expected), axis=0)]


_TARGETS: dict[str, Callable[[Form, str, bool, float], dict[str, str]]] = {"c": target_c.files}
"""Files of each target."""


def exported(
    scenario: Scenario,
    method: str = "",
    *,
    target: str = "c",
    rate_hz: float | None = None,
    prefix: str = "schuler_law",
) -> Exported:
    """Export the law of a method.

    Parameters
    ----------
    scenario : Scenario
        Complete and checked.
    method : str
        Name or number of the method; may be empty where there is only one.
    target : {"c"}
        What the files are.
    rate_hz : float, optional
        Calls a second; default that of the scenario's law.
    prefix : str
        Of the names in the files.

    Raises
    ------
    InputError
        There is no such method, it cannot run at this rate, or the prefix is no name.
    """
    require_prefix(prefix)
    subject = subject_of(scenario, method, rate_hz)
    form = form_of(subject)
    bound = target_c.BOUND
    files = _TARGETS[target](form, prefix, False, bound)
    return Exported(form, target, prefix, files, bound, _warnings(subject))


def _warnings(subject: Subject) -> tuple[str, ...]:
    """Warnings of the network, and of what the method does not use."""
    return (*subject.network.warnings, *subject.method.kind.notices(subject.method))
