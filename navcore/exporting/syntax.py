"""What the reader asks of the syntax of a function."""

import ast
import inspect
import textwrap
from typing import Any

from navcore.exporting.values import NotWrittenError


def tree_of(function: Any) -> ast.FunctionDef:
    """Syntax of a function."""
    tree = ast.parse(textwrap.dedent(inspect.getsource(function))).body[0]
    assert isinstance(tree, ast.FunctionDef)
    return tree


def first_lines(doc: str) -> str:
    """First paragraph of a docstring, in one line."""
    return " ".join(doc.partition("\n\n")[0].split())


def as_read(target: ast.expr) -> ast.expr:
    """The target of an assignment, to be read."""
    return ast.parse(ast.unparse(target), mode="eval").body


def assigned(nodes: list[ast.stmt]) -> set[str]:
    """Names that statements assign."""
    return {
        one.id
        for node in nodes
        for one in ast.walk(node)
        if isinstance(one, ast.Name) and isinstance(one.ctx, ast.Store)
    }


def read_outside(tree: ast.FunctionDef, nodes: list[ast.stmt], name: str) -> bool:
    """Whether a function reads a name outside of some of its statements."""
    inside = {id(one) for node in nodes for one in ast.walk(node)}
    return any(
        isinstance(one, ast.Name)
        and one.id == name
        and isinstance(one.ctx, ast.Load)
        and id(one) not in inside
        for one in ast.walk(tree)
    )


def bounds_of(node: ast.expr) -> list[ast.expr]:
    """Arguments of a range."""
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "range":
        return node.args
    raise NotWrittenError(ast.unparse(node))
