"""Length of the ways through the code: ``python -m tools.house [ROOT] [--step]``.

For a checkout, it prints the arrows between the modules of each large room, the files and lines that each
recipe of CONTRIBUTING.md touches, the places that repeat the fields of a question, and how many parameters of
public functions are documented. ``--step`` adds the files and calls of one step of a slider, traced by
`schuler_bench.bench.step`.
"""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PACKAGES = ("navcore", "app")
QUESTIONS = "navcore/questions"
_SECTION = re.compile(r"^## Add an? ([^\n]+)\n(.*?)(?=^## |\Z)", re.MULTILINE | re.DOTALL)
_BLOCK = re.compile(r"<!-- (file|line): (\S+) -->\n+```\w+\n(.*?)```\n", re.DOTALL)
_NAMES = re.compile(r"^(\*{0,2}\w+(?:, *\*{0,2}\w+)*) *(?::|$)")
_SHOWN_ROOMS = 5
_SECOND_LIST = 3
"""A class or function outside a question's own file that declares so many of its fields repeats them."""


@dataclass(frozen=True)
class Parameters:
    """Parameters of public functions.

    Attributes
    ----------
    documented, of : int
        With an entry in the section ``Parameters`` of the docstring, and all.
    """

    documented: int
    of: int

    @property
    def percent(self) -> float:
        """Documented part, %."""
        return 100.0 * self.documented / max(self.of, 1)


def sources(folder: Path) -> dict[str, ast.Module]:
    """Parsed modules below a folder by their path from it."""
    return {
        path.relative_to(folder).as_posix(): ast.parse(path.read_text(encoding="utf-8"))
        for path in sorted(folder.rglob("*.py"))
    }


# ---------------------------------------------------------------- rooms


def arrows(root: Path) -> dict[str, tuple[int, int]]:
    """Modules of each room, and imports among them; a wing (a folder within a room) is a room of its own.

    Parameters
    ----------
    root : Path
        Top folder of a checkout.

    Returns
    -------
    dict
        From ``navcore/io`` to (modules, arrows), most arrows first. An import inside a function counts.
    """
    found: dict[str, tuple[int, int]] = {}
    for package in PACKAGES:
        trees = sources(root / package)
        imported_as = "schuler_bench" if package == "app" else package
        known = {
            f"{imported_as}.{name.removesuffix('.py').removesuffix('/__init__').replace('/', '.')}": name
            for name in trees
        }
        rooms: dict[str, list[str]] = {}
        for name in trees:
            rooms.setdefault(name.rpartition("/")[0], []).append(name)
        for room, members in rooms.items():
            inside = {
                (name, known[other])
                for name in members
                for other in imports(trees[name], known)
                if known[other] != name and known[other].rpartition("/")[0] == room
            }
            found[f"{package}/{room}".rstrip("/")] = (len(members), len(inside))
    return dict(sorted(found.items(), key=lambda item: -item[1][1]))


def imports(tree: ast.AST, known: Mapping[str, object]) -> Iterator[str]:
    """Modules among ``known`` that are imported anywhere, inside functions and for types only too."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name in known)
        elif isinstance(node, ast.ImportFrom) and node.module:
            for alias in node.names:
                full = f"{node.module}.{alias.name}"
                if full in known or node.module in known:
                    yield full if full in known else node.module


# ---------------------------------------------------------------- recipes


def recipes(guide: str) -> dict[str, tuple[int, int]]:
    r"""Files that each recipe touches, and lines that it adds.

    Examples
    --------
    >>> block = "<!-- {}: {}.py -->\n```python\nx = 1\ny = 2\n```\n"
    >>> recipes("## Add a network\n" + block.format("file", "a") + block.format("line", "b") + "## Other\n")
    {'network': (2, 3)}
    """
    return {
        title: (
            len({path for _, path, _ in blocks}),
            sum(1 if kind == "line" else len(text.splitlines()) for kind, _, text in blocks),
        )
        for title, section in _SECTION.findall(guide)
        if (blocks := _BLOCK.findall(section))
    }


# ---------------------------------------------------------------- second lists


def question_fields(root: Path) -> dict[str, set[str]]:
    """Fields of each question by the file of its class; empty where a checkout has no room of questions."""
    folder = root / QUESTIONS
    found: dict[str, set[str]] = {}
    for name, tree in sources(folder).items() if folder.is_dir() else ():
        for node in tree.body:
            if isinstance(node, ast.ClassDef) and any(
                isinstance(base, ast.Name) and base.id.endswith("Question") for base in node.bases
            ):
                fields = {
                    item.target.id
                    for item in node.body
                    if isinstance(item, ast.AnnAssign)
                    and isinstance(item.target, ast.Name)
                    and not ast.unparse(item.annotation).startswith("ClassVar")
                }
                found[f"{QUESTIONS}/{name}"] = fields - {"scenario"}
    return found


def second_lists(root: Path) -> dict[str, list[str]]:
    """Classes and functions outside a question's file that declare at least three of its fields again.

    Returns
    -------
    dict
        From the file of a question to the places, ``app/cli/tune.py:TuneCommand``.
    """
    places = {
        f"{package}/{name}": list(_declared(tree))
        for package in PACKAGES
        for name, tree in sources(root / package).items()
    }
    return {
        own: [
            f"{file}:{name}"
            for file, declared in places.items()
            if file != own and not file.startswith("navcore/design")
            for name, names in declared
            if len(fields & names) >= min(_SECOND_LIST, len(fields)) > 1
        ]
        for own, fields in question_fields(root).items()
    }


def _declared(tree: ast.Module) -> Iterator[tuple[str, set[str]]]:
    """Fields of each class, parameters of each function."""
    for node in ast.walk(tree):
        if isinstance(node, ast.ClassDef):
            yield (
                node.name,
                {
                    item.target.id
                    for item in node.body
                    if isinstance(item, ast.AnnAssign) and isinstance(item.target, ast.Name)
                },
            )
        elif isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            yield node.name, {argument.arg for argument in _arguments(node)}


# ---------------------------------------------------------------- documented parameters


def documented(folder: Path, only: set[str] | None = None) -> Parameters:
    """Count the documented parameters of public functions, methods and classes below a folder.

    Parameters
    ----------
    folder : Path
        Of a package.
    only : set of str, optional
        Names of functions and classes to count; by default all public ones.
    """
    with_entry = total = 0
    for name, tree in sources(folder).items():
        if any(part.startswith("_") and part != "__init__.py" for part in name.split("/")):
            continue
        for own, node in _public(tree):
            if only is not None and own not in only:
                continue
            names = {argument.arg for argument in _arguments(node)} - {"self", "cls"}
            described = _described(ast.get_docstring(node) or "")
            with_entry += len(names & described)
            total += len(names)
    return Parameters(with_entry, total)


def _public(tree: ast.Module) -> Iterator[tuple[str, ast.FunctionDef]]:
    for node in tree.body:
        if isinstance(node, ast.FunctionDef) and not node.name.startswith("_"):
            yield node.name, node
        elif isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
            for item in node.body:
                if isinstance(item, ast.FunctionDef) and not item.name.startswith("_"):
                    yield node.name, item


def _arguments(node: ast.FunctionDef | ast.AsyncFunctionDef) -> list[ast.arg]:
    own = node.args
    return [*own.posonlyargs, *own.args, *own.kwonlyargs]


def _described(docstring: str) -> set[str]:
    r"""Names in the section ``Parameters`` of a numpydoc docstring.

    Examples
    --------
    >>> parameters = "Parameters\n----------\na, b : float\n    Of x, m.\n"
    >>> sorted(_described(parameters + "\nReturns\n-------\nc : int"))
    ['a', 'b']
    """
    _, found, rest = docstring.partition("Parameters\n----------\n")
    if not found:
        return set()
    section = re.split(r"\n\w[\w ]*\n-{3,}\n", rest)[0]
    names = (_NAMES.match(line) for line in section.splitlines() if not line.startswith((" ", "\t")))
    return {name.strip(" *") for match in names if match for name in match[1].split(",")}


def shown_names(root: Path) -> set[str]:
    """Names that ``import navcore`` shows, from the list of its ``__init__``."""
    tree = ast.parse((root / "navcore/__init__.py").read_text(encoding="utf-8"))
    return {
        node.value
        for node in ast.walk(tree)
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and node.value.isidentifier()
    }


# ---------------------------------------------------------------- all


def lines(root: Path) -> Iterator[str]:
    """Give the report, line by line."""
    yield "arrows inside the largest rooms (modules, arrows):"
    for room, (modules, inside) in list(arrows(root).items())[:_SHOWN_ROOMS]:
        yield f"  {room:<28} {modules:4d} {inside:4d}"
    yield "recipes (files, lines):"
    for title, (files, added) in recipes((root / "CONTRIBUTING.md").read_text(encoding="utf-8")).items():
        yield f"  {title:<28} {files:4d} {added:4d}"
    yield "places that repeat the fields of a question:"
    lists = second_lists(root)
    for own, places in lists.items():
        yield f"  {own:<34} {len(places):3d}  {', '.join(places)}".rstrip()
    if not lists:
        yield "  there is no room of questions"
    yield "documented parameters:"
    for package in PACKAGES:
        count = documented(root / package)
        yield f"  {package:<28} {count.documented:5d} of {count.of:5d}, {count.percent:.0f} %"
    count = documented(root / "navcore", shown_names(root))
    yield f"  {'shown by import navcore':<28} {count.documented:5d} of {count.of:5d}, {count.percent:.0f} %"


def main(arguments: list[str]) -> None:
    """Print the report of a checkout, by default of this one."""
    roots = [Path(argument) for argument in arguments if not argument.startswith("--")]
    root = roots[0] if roots else ROOT
    print("\n".join(lines(root)))
    if "--step" in arguments:
        print("a step of a slider:", flush=True)
        subprocess.run([sys.executable, "-m", "schuler_bench.bench.step"], cwd=root, check=True)


if __name__ == "__main__":
    main(sys.argv[1:])
