"""Target MATLAB, for Octave too: a function, a script that replays the vectors, the network as objects."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from navcore.exporting.about import facts, filled, listed
from navcore.exporting.form import Form
from navcore.exporting.matlab import MatlabPrinter
from navcore.exporting.printing import INDENT
from navcore.exporting.target_c import vectors_csv
from navcore.networks.base import LinearNetwork
from navcore.networks.discrete import discretise


def files(form: Form, prefix: str, single: bool, bounds: Sequence[float]) -> dict[str, str]:
    """Return the files by name; parameters as of `navcore.exporting.target_c.files`."""
    printer = MatlabPrinter(form.program, single)
    values = facts(form, prefix, bounds) | {
        "usage": "\n".join(f"% {line}" for line in form.usage),
        "constants": printer.constants(),
        "functions": printer.functions(),
        "initial": printer.initial_values(),
        "in_fields": listed(form, form.inputs, "%   {name}: {note}"),
        "out_fields": listed(form, form.outputs, "%   {name}: {note}"),
        "call": _call(form, printer),
        "input_names": ", ".join(f"'{name}'" for name in form.inputs),
        "output_names": ", ".join(f"'{name}'" for name in form.outputs),
        "typed": "single" if single else "double",
    }
    made = {
        f"{prefix}.m": filled("law.m", values),
        "replay.m": filled("replay.m", values),
        "vectors.csv": vectors_csv(form),
    }
    if form.subject.method.kind.uses_network:
        numbers = network_lines(form.subject.network, form.subject.step_s)
        made[f"{prefix}_objects.m"] = filled("objects.m", values | {"numbers": numbers})
    return made


def _call(form: Form, printer: MatlabPrinter) -> str:
    """The call of the step with the fields of in, and its results as fields of out."""
    last = form.program.functions[-1]
    needs, changes = printer.touches(last)
    given = [*(["s"] if needs else []), *(f"in.{one.name}" for one in last.params)]
    results = [*(["s"] if changes else []), *(f"out.{name}" for name in form.outputs)]
    lines = ["out = struct();", f"[{', '.join(results)}] = {last.name}({', '.join(given)});"]
    return "\n".join(INDENT + line for line in lines)


def network_lines(network: LinearNetwork, step_s: float) -> str:
    """Statements with H(s), Q(s) = 1 - H(s) and its discrete form at a step in s, with all digits."""
    discrete = discretise(network, step_s)
    difference = np.polysub(network.den, network.num)
    rows = {
        "Ts": step_s,
        "num": network.num,
        "den": network.den,
        "qnum": np.concatenate([np.zeros(len(network.den) - len(difference)), difference]),
        "dA": discrete.dA,
        "B": discrete.B[:, None],
        "C": -discrete.C[None, :],
        "D": 1.0 - discrete.D,
    }
    return "\n".join(f"{INDENT}{name} = {_matrix(value)};" for name, value in rows.items())


def _matrix(value: Any) -> str:
    if isinstance(value, float):
        return repr(value)
    if value.size == 0:
        return f"zeros({value.shape[0]}, {value.shape[1]})"
    return "[" + "; ".join(", ".join(map(repr, row)) for row in np.atleast_2d(value).tolist()) + "]"
