"""The changes that a mutation run makes: one node of a file's syntax tree at a time.

An expression is turned round; a statement that keeps a value (``a.b = ...``, ``a[i] = ...``, ``a += ...``) is
dropped; a branch that refuses, returns or goes on early is never taken. Left out by rule, as no number of a
run depends on it: type annotations, docstrings, texts, and what of a parameter only the page shows (slider,
label, help, unit).
"""

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

_OPERATORS: dict[type[ast.AST], type[ast.AST]] = {
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult,
    ast.FloorDiv: ast.Mult, ast.Mod: ast.Mult, ast.MatMult: ast.Mult,
    ast.Lt: ast.GtE, ast.LtE: ast.Gt, ast.Gt: ast.LtE, ast.GtE: ast.Lt, ast.Eq: ast.NotEq, ast.NotEq: ast.Eq,
    ast.And: ast.Or, ast.Or: ast.And,
}  # fmt: skip
_CALLS = {
    "min": "max", "max": "min", "minimum": "maximum", "maximum": "minimum", "sin": "cos", "cos": "sin",
    "any": "all", "all": "any",
}  # fmt: skip
_SHOWN_ONLY = {"slider", "label", "help", "unit", "description", "title", "json_schema_extra", "elements"}


@dataclass(frozen=True)
class Mutant:
    """One change: the ``place``-th node of a file that can be changed."""

    file: str
    place: int
    line: int
    what: str

    @property
    def name(self) -> str:
        """Name that stays as long as the file does."""
        return f"{self.file}#{self.place}"

    def applied(self, source: str) -> str:
        """Text of the file with the change."""
        return changed(source, self.place)


def mutants_of(path: Path, root: Path) -> list[Mutant]:
    """Every change of a file.

    Parameters
    ----------
    path : Path
        The source file.
    root : Path
        Folder that the name of the file is told from.
    """
    name = str(path.relative_to(root))
    nodes = _changeable(ast.parse(path.read_text("utf-8")))
    return [Mutant(name, i, node.lineno, _words(node)) for i, node in enumerate(nodes)]


def changed(source: str, place: int) -> str:
    """Source text with the ``place``-th changeable node changed."""
    tree = ast.parse(source)
    node = _changeable(tree)[place]
    if isinstance(node, ast.Assign | ast.AugAssign):
        _Dropped(node).visit(tree)
    else:
        _change(node)
    return ast.unparse(tree)


class _Dropped(ast.NodeTransformer):
    """Puts ``pass`` in the place of a statement."""

    def __init__(self, statement: ast.stmt) -> None:
        self._statement = statement

    def visit(self, node: ast.AST) -> ast.AST:
        return ast.Pass() if node is self._statement else self.generic_visit(node)


def _change(node: ast.expr | ast.stmt) -> None:
    match node:
        case ast.If():
            node.test = ast.Constant(False)
        case ast.UnaryOp(op=ast.Not()):
            node.operand = ast.UnaryOp(ast.Not(), node.operand)
        case ast.BinOp() | ast.BoolOp():
            node.op = _OPERATORS[type(node.op)]()  # pyright: ignore[reportAttributeAccessIssue]
        case ast.Compare():
            node.ops[0] = _OPERATORS[type(node.ops[0])]()  # pyright: ignore[reportArgumentType, reportCallIssue]
        case ast.UnaryOp():
            node.op = ast.UAdd()
        case ast.Call(func=ast.Name() as called):
            called.id = _CALLS[called.id]
        case ast.Call(func=ast.Attribute() as called):
            called.attr = _CALLS[called.attr]
        case ast.Constant(value=bool() as value):
            node.value = not value
        case ast.Constant(value=int() as value):
            node.value = value + 1
        case ast.Constant(value=float() as value):
            node.value = 1.1 * value or 0.1


def _changeable(tree: ast.AST) -> list[ast.expr | ast.stmt]:
    return [node for node in _code(tree) if _can_change(node)]


def _code(node: ast.AST, parent: ast.AST | None = None) -> Iterator[ast.expr | ast.stmt]:
    """Yield every statement, and every expression whose value decides what the code does, parents first."""
    if isinstance(node, ast.JoinedStr | ast.arg):
        return
    if isinstance(node, ast.keyword) and node.arg in _SHOWN_ONLY:
        return
    if isinstance(node, ast.expr) and not (isinstance(node, ast.Constant) and not _counts(node, parent)):
        yield node
    elif isinstance(node, ast.stmt):
        yield node
    for name, value in ast.iter_fields(node):
        if name in ("annotation", "returns", "decorator_list"):
            continue
        for child in value if isinstance(value, list) else [value]:
            if isinstance(child, ast.AST):
                yield from _code(child, node)


def _counts(node: ast.Constant, parent: ast.AST | None) -> bool:
    """Whether a constant is a number of the computation: not an index, not an axis, not a text."""
    if isinstance(node.value, float):
        return True
    return type(node.value) is int and isinstance(parent, ast.BinOp | ast.Compare)


def _can_change(node: ast.expr | ast.stmt) -> bool:
    match node:
        case ast.Assign():
            return any(isinstance(one, ast.Subscript | ast.Attribute) for one in node.targets)
        case ast.AugAssign():
            return not _is_text(node.value)
        case ast.If():
            return isinstance(node.body[-1], ast.Raise | ast.Return | ast.Continue | ast.Break)
        case ast.BinOp():
            return type(node.op) in _OPERATORS and not (_is_text(node.left) or _is_text(node.right))
        case ast.Compare():
            return type(node.ops[0]) in _OPERATORS
        case ast.UnaryOp():
            return isinstance(node.op, ast.USub | ast.Not)
        case ast.Call():
            return getattr(node.func, "id", getattr(node.func, "attr", "")) in _CALLS
        case _:
            return isinstance(node, ast.BoolOp | ast.Constant)


def _is_text(node: ast.expr) -> bool:
    return isinstance(node, ast.JoinedStr) or (isinstance(node, ast.Constant) and isinstance(node.value, str))


def _words(node: ast.expr | ast.stmt) -> str:
    text = ast.unparse(node.test if isinstance(node, ast.If) else node)
    text = text if len(text) <= 70 else text[:67] + "..."
    if isinstance(node, ast.Assign | ast.AugAssign):
        return f"dropped: {text}"
    if isinstance(node, ast.If):
        return f"never taken: if {text}"
    if isinstance(node, ast.Constant):
        return f"{text} + 1" if isinstance(node.value, int) else f"{text} x 1.1"
    if isinstance(node, ast.UnaryOp):
        return f"{'not' if isinstance(node.op, ast.Not) else 'minus'} dropped in {text}"
    if isinstance(node, ast.Call):
        return f"min/max, sin/cos or any/all exchanged in {text}"
    op = node.ops[0] if isinstance(node, ast.Compare) else node.op  # pyright: ignore[reportAttributeAccessIssue]
    return f"{type(op).__name__} -> {_OPERATORS[type(op)].__name__} in {text}"
