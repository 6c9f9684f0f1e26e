"""Target Python: one class on numpy, which replays the vectors."""

from collections.abc import Sequence

from navcore.exporting.about import facts, filled, note_of
from navcore.exporting.form import WHOLE, Form
from navcore.exporting.printing import INDENT
from navcore.exporting.python import PythonPrinter
from navcore.exporting.target_c import vectors_csv


def files(form: Form, prefix: str, single: bool, bounds: Sequence[float]) -> dict[str, str]:
    """Return the files by name; parameters as of `navcore.exporting.target_c.files`."""
    printer = PythonPrinter(form.program, single)
    last = form.program.functions[-1]
    typed = {name: "np.float32(given.{})" for name in form.inputs if single and name not in WHOLE}
    values = facts(form, prefix, bounds) | {
        "class_name": "".join(part.capitalize() for part in prefix.split("_")),
        "usage": "\n".join(form.usage),
        "constants": printer.constants(),
        "functions": printer.functions(),
        "initial": printer.initial_values(),
        "in_fields": _fields(form, form.inputs),
        "out_fields": _fields(form, form.outputs),
        "step": last.name,
        "arguments": ", ".join(typed.get(one.name, "given.{}").format(one.name) for one in last.params),
        "row": _row(form),
    }
    return {f"{prefix}.py": filled("law.py.txt", values), "vectors.csv": vectors_csv(form)}


def _fields(form: Form, names: tuple[str, ...]) -> str:
    lines = []
    for name in names:
        kind = {"log_valid": "int", "damped": "bool"}.get(name, "float")
        lines.append(f"{INDENT}{name}: {kind}  # {note_of(form, name)}".rstrip(" #"))
    return "\n".join(lines)


def _row(form: Form) -> str:
    """Inputs of a row of the vectors."""
    place = form.inputs.index("log_valid")
    return f"row[:{place}], int(row[{place}]), *row[{place + 1}:count]"
