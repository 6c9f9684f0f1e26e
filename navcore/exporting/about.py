"""What all files of an export say of it: where it is from, its rate, its inputs and outputs, its use."""

from __future__ import annotations

from collections.abc import Sequence
from string import Template

from navcore.exporting.form import ABOUT, Form, unit_of
from navcore.foundation.assets import asset_path
from navcore.foundation.version import __version__
from navcore.scenario.file import scenario_hash

TITLE = "Damping law of an inertial navigation system."


def facts(form: Form, prefix: str, bounds: Sequence[float]) -> dict[str, str]:
    """Return what the templates of all targets name.

    Parameters
    ----------
    form : Form
        The method.
    prefix : str
        Of all names.
    bounds : sequence of float
        Largest deviation of each output from the vectors, of its peak.
    """
    subject, scenario = form.subject, form.subject.scenario
    return {
        "title": TITLE,
        "version": __version__,
        "scenario": plain(scenario.title or "untitled"),
        "sha256": scenario_hash(scenario),
        "method": plain(subject.method.label()),
        "description": plain(str(subject.method.kind.description(subject.method))),
        "prefix": prefix,
        "step_s": repr(subject.step_s),
        "rate_hz": f"{subject.rate_hz:.12g}",
        "hold_s": f"{form.hold_s:g}",
        "hours": f"{len(form.given) * subject.step_s / 3600.0:.4g}",
        "bounds": ", ".join(f"{bound:.3g}" for bound in bounds),
        "rows": str(len(form.given)),
    }


def plain(text: str) -> str:
    """A text that ends no comment and no string of any target, in one line."""
    for sign, other in (("*/", "* /"), ('"', "'"), ("\\", "/"), ("??", "? ?")):
        text = text.replace(sign, other)
    return " ".join(text.split())


def filled(name: str, values: dict[str, str]) -> str:
    """A template with its values."""
    text = Template(asset_path(f"export/{name}").read_text("utf-8")).substitute(values)
    return "\n".join(line.rstrip() for line in text.splitlines()) + "\n"


def note_of(form: Form, name: str) -> str:
    """What an input or output is, with its unit."""
    return ", ".join(filter(None, ((ABOUT | form.notes).get(name, ""), unit_of(name))))


def listed(form: Form, names: tuple[str, ...], pattern: str) -> str:
    """A line for each input or output: ``pattern`` with {name} and {note}."""
    return "\n".join(pattern.format(name=name, note=note_of(form, name)) for name in names)


def sources_of(form: Form) -> list[str]:
    """Network, policy and switching method, with the equations that they are from."""
    method = form.subject.method
    lines = []
    for name, part in (
        ("network", method.kind.network(method)),
        ("policy", method.policy),
        ("switching", method.switching),
    ):
        source = getattr(type(part), "source", "")
        lines.append(f"{name} {part.id}{f' ({source})' if source else ''}")
    return lines
