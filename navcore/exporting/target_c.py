"""Target C: header, source, test program and vectors."""

from __future__ import annotations

import io
from collections.abc import Sequence

import numpy as np

from navcore.exporting.about import facts, filled, note_of, sources_of
from navcore.exporting.c import CPrinter
from navcore.exporting.form import WHOLE, Form
from navcore.exporting.printing import INDENT, wrapped

_LATER = "/* the first call says where the law begins */"
BOUND = 1e-12
"""Of the peak of an output: largest deviation of the exported law in double precision."""


def double_bounds(form: Form) -> tuple[float, ...]:
    """Bounds of the outputs in double precision."""
    return (BOUND,) * len(form.outputs)


def files(form: Form, prefix: str, single: bool, bounds: Sequence[float]) -> dict[str, str]:
    """Return the files by name.

    Parameters
    ----------
    form : Form
        The method.
    prefix : str
        Of all names.
    single : bool
        float in place of double.
    bounds : sequence of float
        Largest deviation of each output from the vectors, of its peak.
    """
    values = _values(form, prefix, CPrinter(form.program, prefix, single), bounds)
    return {
        **sources(form, prefix, single),
        "test.c": filled("test.c", values),
        "vectors.csv": vectors_csv(form),
    }


def sources(form: Form, prefix: str, single: bool) -> dict[str, str]:
    """Return header and source by name; see `files`."""
    values = _values(form, prefix, CPrinter(form.program, prefix, single), double_bounds(form))
    return {f"{prefix}.h": filled("law.h", values), f"{prefix}.c": filled("law.c", values)}


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


def _values(form: Form, prefix: str, printer: CPrinter, bounds: Sequence[float]) -> dict[str, str]:
    real = printer.real
    start = "\n".join(filter(None, (printer.initial_values(), f"{INDENT}(void)at; {_LATER}")))
    columns = len(form.inputs) + len(form.outputs)
    return facts(form, prefix, bounds) | {
        "guard": prefix.upper(),
        "usage": "\n".join(f" * {line}" for line in form.usage),
        "start_fields": _fields(form, ("lat_rad", "v_e_mps", "v_n_mps"), real),
        "in_fields": _fields(form, form.inputs, real),
        "out_fields": _fields(form, form.outputs, real),
        "state_fields": printer.state_fields(),
        "sources": "\n".join([" *", *(f" * {line}" for line in sources_of(form))]),
        "constants": printer.constants(),
        "functions": printer.functions(),
        "initial": start,
        "call": _call(form, printer),
        "inputs": str(len(form.inputs)),
        "outputs": str(len(form.outputs)),
        "line_length": str(32 * columns + 1024),
        "names": "\n".join(f'{INDENT}"{name}",' for name in form.outputs),
        "start": ", ".join(printer.number(value) for value in form.start),
        "take": "\n".join(
            f"{INDENT * 2}in.{name} = {'(int)' if name in WHOLE else f'({real})'}values[{i}];"
            for i, name in enumerate(form.inputs)
        ),
        "found": "\n".join(f"{INDENT * 3}(double)out.{name}," for name in form.outputs),
    }


def _fields(form: Form, names: tuple[str, ...], real: str) -> str:
    lines = []
    for name in names:
        note = note_of(form, name)
        kind = "int" if name in WHOLE else real
        lines.append(f"{INDENT}{kind} {name};{f' /* {note} */' if note else ''}")
    return "\n".join(lines)


def _call(form: Form, printer: CPrinter) -> str:
    """Call of the step with the fields of in and out."""
    last = form.program.functions[-1]
    needed = printer.needs_state(last)
    given = ["s"] if needed else []
    given += [f"in->{one.name}" for one in last.params]
    lines = [] if needed else [f"{INDENT}(void)s;"]
    whole = [name for name in form.outputs if name in WHOLE]
    lines += [f"{INDENT}int {name};" for name in whole]
    given += [f"&{name}" if name in whole else f"&out->{name}" for name in form.outputs]
    text = f"{last.name}({', '.join(given)});"
    lines += [INDENT + line if i == 0 else INDENT * 2 + line for i, line in enumerate(wrapped(text, 92))]
    lines += [f"{INDENT}out->{name} = {name};" for name in whole]
    return "\n".join(lines)
