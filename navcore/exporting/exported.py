"""What an export gives: the files of one method for one target."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from navcore.exporting import target_c, target_fmu, target_matlab, target_python, target_table
from navcore.exporting.form import Form
from navcore.exporting.forms import form_of
from navcore.exporting.names import require_prefix
from navcore.exporting.rounding import Rounding, rounding_of
from navcore.exporting.subject import Subject, subject_of
from navcore.foundation.answers import Answer, Column, Table
from navcore.foundation.text import Text
from navcore.scenario.model import Scenario

Target = Literal["c", "matlab", "python", "table", "fmu"]
"""Targets of an export."""


Files = Mapping[str, str | bytes]
"""Contents of files by name."""


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
    files : dict of str to (str or bytes)
        Contents by name.
    bounds : tuple of float
        Largest deviation of each output from the vectors, of its peak.
    rounding : Rounding or None
        What single precision does.
    warnings : tuple of str
        What the user should know.
    """

    form: Form
    target: str
    prefix: str
    files: Files
    bounds: tuple[float, ...]
    rounding: Rounding | None = None
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
            "bounds": dict(zip(self.form.outputs, self.bounds, strict=True)),
            "single": None if self.rounding is None else self.rounding.document(),
            "files": {name: len(_bytes(one)) for name, one in self.files.items()},
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
            '"{method}" at {rate:.6g} Hz; vectors of {hours:.4g} h, to be met within {bound:.3g} of a peak',
            method=subject.method.label(),
            rate=subject.rate_hz,
            hours=self.hours,
            bound=max(self.bounds),
        )
        if self.rounding is not None:
            yield from self.rounding.sentences()
        heads = Column(Text("file"), left=True), Column(Text("size"), "kB", 4)
        rows = [(name, len(_bytes(one)) / 1000.0) for name, one in self.files.items()]
        yield Table(heads, tuple(rows))
        yield from (Text("warning: {text}", text=text) for text in self.warnings)

    def packed(self) -> Packed:
        """Return the files as one archive, without the vectors that they were made from."""
        stream = io.BytesIO()
        with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
            for name, content in self.files.items():
                archive.writestr(zipfile.ZipInfo(name, _NO_DATE), _bytes(content), zipfile.ZIP_DEFLATED)
        return Packed(f"{self.prefix}.zip", stream.getvalue(), self.document(), tuple(self.rows()))


@dataclass(frozen=True)
class Packed(Answer):
    """The files of an export as one ZIP archive.

    Attributes
    ----------
    name : str
        Of the archive.
    archive : bytes
        Its content: the files of `Exported`, in no folder.
    found : dict
        What ``--json`` prints of the export.
    said : tuple of (Table or str)
        What is told of it.
    """

    name: str
    archive: bytes
    found: dict[str, Any]
    said: tuple[Table | str, ...]

    def document(self) -> dict[str, Any]:
        """Return what ``--json`` prints."""
        return self.found

    def rows(self) -> Iterator[Table | str]:
        """Give what was exported, the files, and the warnings."""
        yield from self.said


_NO_DATE = (1980, 1, 1, 0, 0, 0)
"""Of a file in an archive: the same export gives the same bytes."""


def _bytes(content: str | bytes) -> bytes:
    return content.encode() if isinstance(content, str) else content


def _peaks(form: Form) -> list[float]:
    return [float(peak) for peak in np.max(np.abs(form.expected), axis=0)]


_TARGETS: dict[str, Callable[[Form, str, bool, Sequence[float]], Files]] = {
    "c": target_c.files,
    "matlab": target_matlab.files,
    "python": target_python.files,
    "table": target_table.files,
    "fmu": target_fmu.files,
}
"""Files of each target."""


def exported(
    scenario: Scenario,
    method: str = "",
    *,
    target: str = "c",
    rate_hz: float | None = None,
    single: bool = False,
    outside: bool = False,
    prefix: str = "schuler_law",
) -> Exported:
    """Export the law of a method.

    Parameters
    ----------
    scenario : Scenario
        Complete and checked.
    method : str
        Name or number of the method; may be empty where there is only one.
    target : {"c", "matlab", "python", "table", "fmu"}
        What the files are.
    rate_hz : float, optional
        Calls a second; default that of the scenario's law.
    single : bool
        Numbers of single precision; what that does is measured on the vectors.
    outside : bool
        A box beside an INS in place of a law in its loop.
    prefix : str
        Of the names in the files.

    Raises
    ------
    InputError
        There is no such method, it cannot run at this rate, or the prefix is no name.
    """
    require_prefix(prefix)
    subject = subject_of(scenario, method, rate_hz)
    form = form_of(subject, outside)
    rounding = rounding_of(form) if single else None
    bounds = target_c.double_bounds(form) if rounding is None else rounding.bounds
    files = _TARGETS[target](form, prefix, single, bounds)
    return Exported(form, target, prefix, files, bounds, rounding, _warnings(subject))


def _warnings(subject: Subject) -> tuple[str, ...]:
    """Warnings of the network, and of what the method does not use."""
    return (*subject.network.warnings, *subject.method.kind.notices(subject.method))
