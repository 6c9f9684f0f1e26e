"""Target C: header, source, test program and vectors."""

from __future__ import annotations

import io
from string import Template

import numpy as np

from navcore.exporting.c import CPrinter
from navcore.exporting.form import ABOUT, WHOLE, Form, unit_of
from navcore.exporting.printing import wrapped
from navcore.foundation.assets import asset_path
from navcore.foundation.version import __version__
from navcore.scenario.file import scenario_hash

_IN = "    "
BOUND = 1e-12
"""Of the peak of an output: largest deviation of the exported law in double precision."""


def files(form: Form, prefix: str, single: bool, bound: float) -> dict[str, str]:
    """Return the files by name.

    Parameters
    ----------
    form : Form
        The method.
    prefix : str
        Of all names.
    single : bool
        float in place of double.
    bound : float
        Largest deviation from the vectors, of the peak of each output.
    """
    values = _values(form, prefix, CPrinter(form.program, prefix, single), bound)
    return {
        **sources(form, prefix, single),
        "test.c": _filled("test.c", values),
        "vectors.csv": vectors_csv(form),
    }


def sources(form: Form, prefix: str, single: bool) -> dict[str, str]:
    """Return header and source by name; see `files`."""
    values = _values(form, prefix, CPrinter(form.program, prefix, single), BOUND)
    return {f"{prefix}.h": _filled("law.h", values), f"{prefix}.c": _filled("law.c", values)}


def vectors_csv(form: Form) -> str:
    """Inputs and outputs of each call, with all digits."""
    import pyarrow as pa
    import pyarrow.csv

    columns = {
        name: pa.array(column.astype(np.int64) if name in WHOLE else column)
        for names, table in ((form.inputs, form.given), (form.outputs, form.expected))
        for name, column in zip(names, table.T, strict=True)
    }
    stream = io.BytesIO()
    stream.write((",".join(columns) + "\n").encode())
    pyarrow.csv.write_csv(pa.table(columns), stream, pyarrow.csv.WriteOptions(include_header=False))
    return stream.getvalue().decode()


def _filled(name: str, values: dict[str, str]) -> str:
    text = Template(asset_path(f"export/{name}").read_text("utf-8")).substitute(values)
    return "\n".join(line.rstrip() for line in text.splitlines()) + "\n"


def _values(form: Form, prefix: str, printer: CPrinter, bound: float) -> dict[str, str]:
    subject, scenario = form.subject, form.subject.scenario
    description = subject.method.kind.description(subject.method)
    real = printer.real
    return {
        "title": "Damping law of an inertial navigation system.",
        "version": __version__,
        "scenario": comment(scenario.title or "untitled"),
        "sha256": scenario_hash(scenario),
        "method": comment(subject.method.label()),
        "description": comment(str(description)),
        "prefix": prefix,
        "guard": prefix.upper(),
        "step_s": repr(subject.step_s),
        "rate_hz": f"{subject.rate_hz:.12g}",
        "hold_s": f"{form.hold_s:g}",
        "usage": _usage(form),
        "start_fields": _fields(
            ("lat_rad", "v_e_mps", "v_n_mps"), real, {"lat_rad": "latitude at the start"}
        ),
        "in_fields": _fields(form.inputs, real, form.notes),
        "out_fields": _fields(form.outputs, real, form.notes),
        "state_fields": printer.state_fields(),
        "sources": _sources(form),
        "constants": printer.constants(),
        "functions": printer.functions(),
        "initial": "\n".join(filter(None, (printer.initial_values(), f"{_IN}(void)at; /* $at */"))).replace(
            "$at", "the first call says where the law begins"
        ),
        "call": _call(form, printer),
        "hours": f"{subject.calls * subject.step_s / 3600.0:.4g}",
        "bound": f"{bound:.3g}",
        "bound_text": f"{bound:.3g} of its peak",
        "inputs": str(len(form.inputs)),
        "outputs": str(len(form.outputs)),
        "rows": str(len(form.given)),
        "line_length": str(32 * (len(form.inputs) + len(form.outputs)) + 1024),
        "names": "\n".join(f'{_IN}"{name}",' for name in form.outputs),
        "start": ", ".join(printer.number(value) for value in form.start),
        "take": "\n".join(
            f"{_IN * 2}in.{name} = {'(int)' if name in WHOLE else f'({real})'}values[{i}];"
            for i, name in enumerate(form.inputs)
        ),
        "found": "\n".join(f"{_IN * 3}(double)out.{name}," for name in form.outputs),
    }


def comment(text: str) -> str:
    """A text that ends no comment and no string, in one line."""
    return " ".join(text.replace("*/", "* /").replace('"', "'").replace("\\", "/").replace("?", "? ").split())


def _usage(form: Form) -> str:
    lines = [
        "In each call give what has just been computed; until the next call",
        "- form the transport rate with v_star: omega_E = -v_star_n/(M + h), omega_N = v_star_e/(N + h);",
        "- add feedback_e, feedback_n to the rate of the velocity, and azimuth_rate to the rate about up;",
        "- leave position and the velocity that is given out as they are computed.",
    ]
    return "\n".join(f" * {line}" for line in lines)


def _sources(form: Form) -> str:
    method = form.subject.method
    kind = type(method.kind.network(method))
    parts = [
        ("network", method.kind.network(method).id, getattr(kind, "source", "")),
        ("policy", method.policy.id, getattr(type(method.policy), "source", "")),
        ("switching", method.switching.id, getattr(type(method.switching), "source", "")),
    ]
    lines = [" *"]
    for name, id, source in parts:
        doc = (getattr(type(method), name, None) and "") or ""
        lines.append(f" * {name} {id}{f' ({source})' if source else ''}{doc}")
    return "\n".join(lines)


def _fields(names: tuple[str, ...], real: str, about: dict[str, str] | None = None) -> str:
    notes = ABOUT | (about or {})
    lines = []
    for name in names:
        kind = "int" if name in WHOLE else real
        unit = unit_of(name)
        note = ", ".join(filter(None, (notes.get(name, ""), unit)))
        lines.append(f"{_IN}{kind} {name};{f' /* {note} */' if note else ''}")
    return "\n".join(lines)


def _call(form: Form, printer: CPrinter) -> str:
    """Call of the step with the fields of in and out."""
    last = form.program.functions[-1]
    needed = printer.needs_state(last)
    given = ["s"] if needed else []
    given += [f"in->{one.name}" for one in last.params]
    lines = [] if needed else [f"{_IN}(void)s;"]
    whole = [name for name in form.outputs if name in WHOLE]
    lines += [f"{_IN}int {name};" for name in whole]
    given += [f"&{name}" if name in whole else f"&out->{name}" for name in form.outputs]
    text = f"{last.name}({', '.join(given)});"
    lines += [_IN + line if i == 0 else _IN * 2 + line for i, line in enumerate(wrapped(text, 92))]
    lines += [f"{_IN}out->{name} = {name};" for name in whole]
    return "\n".join(lines)
