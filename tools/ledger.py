"""How do we know? A ledger of quantities, kinds of damping and fidelities, made from the tests.

``python -m tools.ledger`` reads the marker ``known`` of the tests. It says of which quantities a
test shows that they are right, for which kinds of damping and fidelities, and by what: an outside
``oracle`` (a published figure, a closed form, another library), an own ``twin`` (a slow program in
the tests) or a ``golden`` value (what came out before). It writes ``assets/ledger.json``, which
page and report read, and docs/ledger.md.
"""

import ast
import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from navcore.quantities import QUANTITIES
from navcore.quantities.known import FIDELITIES, METHODS, WAYS, Entry, best

ROOT = Path(__file__).parents[1]
LEDGER, PAGE = ROOT / "assets" / "ledger.json", ROOT / "docs" / "ledger.md"
_MARKS = {"oracle": "O", "twin": "T", "golden": "G", "none": "-"}
_BEGIN, _END = "<!-- ledger -->", "<!-- end of ledger -->"


@dataclass(frozen=True)
class Found:
    """One marker.

    Attributes
    ----------
    test : str
        ``path::name``.
    entry : Entry
        What it says.
    """

    test: str
    entry: Entry


def markers(folder: Path) -> Iterator[Found]:
    """Yield the markers of the tests in a folder.

    Raises
    ------
    ValueError
        A marker names what does not exist.
    """
    for path in sorted(folder.rglob("test_*.py")):
        tree = ast.parse(path.read_text("utf-8"))
        names = {
            target.id: node.value
            for node in tree.body
            if isinstance(node, ast.Assign)
            for target in node.targets
            if isinstance(target, ast.Name)
        }
        for node in ast.walk(tree):
            if not isinstance(node, ast.FunctionDef):
                continue
            for mark in node.decorator_list:
                if isinstance(mark, ast.Call) and ast.unparse(mark.func) == "pytest.mark.known":
                    where = f"{path.relative_to(ROOT)}::{node.name}"
                    yield Found(where, _entry(mark, names, where))


def _entry(mark: ast.Call, names: dict[str, ast.expr], where: str) -> Entry:
    given = [_value(one, names) for one in mark.args]
    options = {one.arg: _value(one.value, names) for one in mark.keywords if one.arg}
    way, keys = given
    entry = Entry(way, tuple(keys), tuple(options["kinds"]), tuple(options["fidelities"]), options["source"])
    for what, known in (
        (entry.quantities, QUANTITIES),
        (entry.kinds, METHODS),
        (entry.fidelities, FIDELITIES),
    ):
        if unknown := [one for one in what if one not in known]:
            raise ValueError(f"{where}: unknown {', '.join(unknown)}; known: {', '.join(known)}")
    if way not in WAYS[:-1]:
        raise ValueError(f"{where}: {way!r} is none of {', '.join(WAYS[:-1])}")
    return entry


def _value(node: ast.expr, names: dict[str, ast.expr]) -> Any:
    if isinstance(node, ast.Name):
        return _value(names[node.id], names)
    if isinstance(node, ast.List | ast.Tuple):
        items: list[Any] = []
        for one in node.elts:
            items += _value(one.value, names) if isinstance(one, ast.Starred) else [_value(one, names)]
        return items
    return ast.literal_eval(node)


def document(found: list[Found]) -> dict[str, Any]:
    """Content of ``assets/ledger.json``."""
    return {
        "entries": [
            {
                "by": one.entry.by,
                "quantities": list(one.entry.quantities),
                "kinds": list(one.entry.kinds),
                "fidelities": list(one.entry.fidelities),
                "source": one.entry.source,
                "test": one.test,
            }
            for one in found
        ]
    }


def table(found: list[Found]) -> str:
    """Table of docs/ledger.md: a row a quantity, a column a kind of damping, the marks of its fidelities."""
    entries = [one.entry for one in found]
    kinds = list(METHODS)
    lines = [
        f"| quantity | best | {' | '.join(kinds)} |",
        f"|---|---|{'---|' * len(kinds)}",
    ]
    for key in QUANTITIES:
        cells = []
        for kind in kinds:
            marks = [
                f"{fidelity} {_MARKS[way]}"
                for fidelity in FIDELITIES
                if (way := best(entries, key, kind, fidelity)) != "none"
            ]
            cells.append(", ".join(marks) or "-")
        lines.append(f"| `{key}` | {best(entries, key)} | {' | '.join(cells)} |")
    shown = [best(entries, key) for key in QUANTITIES]
    counts = ", ".join(f"{shown.count(way)} {way}" for way in WAYS)
    share = 100.0 * shown.count("oracle") / len(shown)
    lines += ["", f"Of {len(shown)} quantities: {counts}; {share:.0f} % by an outside oracle.", ""]
    lines += ["| by | quantities | kinds | fidelities | source | test |", "|---|---|---|---|---|---|"]
    for one in found:
        entry = one.entry
        keys = ", ".join(f"`{key}`" for key in entry.quantities)
        where = ", ".join(entry.fidelities)
        lines.append(
            f"| {entry.by} | {keys} | {', '.join(entry.kinds)} | {where} | {entry.source} | `{one.test}` |"
        )
    return "\n".join(lines)


def texts() -> dict[Path, str]:
    """Files that are written, and their content."""
    found = list(markers(ROOT / "tests"))
    page = PAGE.read_text("utf-8")
    head, _, rest = page.partition(_BEGIN)
    tail = rest.partition(_END)[2]
    return {
        LEDGER: json.dumps(document(found), indent=1) + "\n",
        PAGE: f"{head}{_BEGIN}\n\n{table(found)}\n\n{_END}{tail}",
    }


if __name__ == "__main__":
    for path, text in texts().items():
        path.write_text(text, "utf-8")
