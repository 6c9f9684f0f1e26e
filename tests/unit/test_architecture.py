"""Rooms of the two packages: no circles between them, viser's insides in one place, every view registered."""

import ast
from collections.abc import Iterator, Mapping
from functools import lru_cache
from pathlib import Path

import pytest
import viser

import schuler_bench
from schuler_bench.views import VIEWS, load, scripts
from tools.house import imports

pytestmark = pytest.mark.contract

ROOT = Path(schuler_bench.__file__).parents[1]
PACKAGE = "schuler_bench"
ROOMS = [("navcore", 2), ("navcore", 9), (PACKAGE, 2), (f"{PACKAGE}.views", 3), (PACKAGE, 9)]
"""Packages, and how many parts of a module's name tell a room; nine: every module is one."""


def module_name(path: Path) -> str:
    """Dotted name of a file of the checkout.

    Examples
    --------
    >>> shell = ROOT / PACKAGE / "shell"
    >>> module_name(shell / "page.py"), module_name(shell / "__init__.py")
    ('schuler_bench.shell.page', 'schuler_bench.shell')
    """
    return ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")


@lru_cache(maxsize=4)
def modules(package: str) -> dict[str, ast.Module]:
    return {
        module_name(path): ast.parse(path.read_text(encoding="utf-8"))
        for path in sorted((ROOT / package).rglob("*.py"))
    }


def room(module: str, depth: int) -> str:
    """First ``depth`` parts of a module's name."""
    return ".".join(module.split(".")[:depth])


def arrows(package: str, depth: int) -> dict[str, set[str]]:
    """Rooms of a package, and which others each imports."""
    known = modules(package.split(".")[0])
    found: dict[str, set[str]] = {}
    for name, tree in known.items():
        if not name.startswith(f"{package}.") and name != package:
            continue
        here = found.setdefault(room(name, depth), set())
        here |= {room(other, depth) for other in imports(tree, known) if other.startswith(f"{package}.")}
        here.discard(room(name, depth))
    return found


def circle(graph: Mapping[str, set[str]]) -> list[str]:
    """Rooms that import each other in a circle, in order; empty when there is none.

    Examples
    --------
    >>> circle({"a": {"b"}, "b": {"c"}, "c": set()})
    []
    >>> circle({"a": {"b"}, "b": {"c"}, "c": {"b"}})
    ['b', 'c', 'b']
    """
    done: set[str] = set()

    def walk(at: str, path: list[str]) -> list[str]:
        if at in path:
            return [*path[path.index(at) :], at]
        if at in done:
            return []
        for following in sorted(graph.get(at, ())):
            found = walk(following, [*path, at])
            if found:
                return found
        done.add(at)
        return []

    return next((found for start in sorted(graph) if (found := walk(start, []))), [])


@pytest.mark.parametrize(("package", "depth"), ROOMS)
def test_rooms_import_each_other_in_no_circle(package: str, depth: int) -> None:
    graph = arrows(package, depth)
    assert len(graph) > 5
    assert circle(graph) == []


def test_a_circle_would_be_found() -> None:
    assert circle(
        arrows(PACKAGE, 2)
        | {"schuler_bench.shell": {"schuler_bench.views"}, "schuler_bench.views": {"schuler_bench.shell"}}
    )


# ---------------------------------------------------------------- viser


def test_only_the_bridge_leans_on_the_insides_of_viser() -> None:
    kept = private_names(Path(viser.__file__).parent)
    assert {"_impl", "_websock_connection", "_gui_input_handle_from_uuid"} <= kept
    leaning = {
        name: sorted(found)
        for name, tree in modules(PACKAGE).items()
        if not name.startswith("schuler_bench.bridge") and (found := set(uses_of_insides(tree, kept)))
    }
    assert leaning == {}


def private_names(folder: Path) -> set[str]:
    """Names with one leading underscore that a library gives to attributes and methods."""
    found: set[str] = set()
    for path in folder.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Attribute):
                found.add(node.attr)
            elif isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                found.add(node.name)
            elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
                found.add(node.target.id)
    return {name for name in found if name.startswith("_") and not name.startswith("__")} - {
        "_exit",
        "_fields",
    }


def uses_of_insides(tree: ast.AST, kept: set[str]) -> Iterator[str]:
    """Private modules of viser that are imported, and names that it keeps to itself, of other objects."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (
                alias.name for alias in node.names if alias.name.startswith(("viser._", "viser.infra"))
            )
        elif isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] == "viser":
            yield from (
                f"{node.module}.{alias.name}"
                for alias in node.names
                if "._" in f"{node.module}.{alias.name}" or "infra" in f"{node.module}.{alias.name}"
            )
        elif isinstance(node, ast.Attribute) and node.attr in kept:
            if not (isinstance(node.value, ast.Name) and node.value.id in ("self", "cls", "made")):
                yield ast.unparse(node)


# ---------------------------------------------------------------- views


def test_every_folder_of_views_is_registered_once() -> None:
    folders = {
        f"schuler_bench.views.{path.name}"
        for path in (ROOT / PACKAGE / "views").iterdir()
        if path.suffix == ""
    }
    folders.discard("schuler_bench.views.__pycache__")
    assert sorted(VIEWS) == sorted(folders)


def test_views_have_tabs_of_their_own() -> None:
    titles = [kind.title for kind in load() if kind.title]
    assert len(titles) == len(set(titles))
    assert all(kind.title or kind.place == "page" for kind in load())
    plots = [plot for kind in load() for plot in kind.plots]
    assert len(plots) == len(set(plots)) > 10


def test_no_callback_of_a_page_simulates() -> None:
    """A page's runs wait for their turn and can be stopped; cards and lessons are written beforehand."""
    beforehand = {"schuler_bench.views.start.cards", "schuler_bench.views.learn.own"}
    found = {
        name
        for name, tree in modules(PACKAGE).items()
        if name.startswith(("schuler_bench.views", "schuler_bench.shell"))
        and "navcore.engine.simulation" in set(imports(tree, modules("navcore")))
    }
    assert found == beforehand


def test_the_shell_knows_no_view_by_name() -> None:
    named = {
        name: found
        for name, tree in modules(PACKAGE).items()
        if name.startswith("schuler_bench.shell")
        and (
            found := [
                other for other in imports(tree, modules(PACKAGE)) if other.startswith("schuler_bench.views")
            ]
        )
    }
    assert named == {}


def test_what_is_no_view_is_not_loaded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "no_view_here").mkdir()
    (tmp_path / "no_view_here" / "__init__.py").write_text("")
    (tmp_path / "no_view_here" / "view.py").write_text("VIEW = dict\n")
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(TypeError, match="no_view_here"):
        load(["no_view_here"])
    with pytest.raises(ModuleNotFoundError):
        scripts(["nothing_of_that_name"])
