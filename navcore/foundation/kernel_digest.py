"""Digest that decides whether machine code is up to date: compiled functions and the constants they name.

A docstring, a comment, a help text or a moved line changes nothing; an edited constant in *another* module
does, which numba's own cache would not notice.
"""

import ast
import hashlib
import os
import platform
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import numba

PACKAGE = Path(__file__).resolve().parents[1]
_DECORATORS = {"kernel", "inlined"}


class _Module:
    """Top-level definitions of one source file."""

    def __init__(self, path: Path) -> None:
        self.functions: list[ast.FunctionDef] = []
        self.values: dict[str, ast.stmt] = {}
        self.imported: dict[str, tuple[str, str]] = {}
        for statement in ast.parse(path.read_bytes()).body:
            self._take(statement)

    def _take(self, statement: ast.stmt) -> None:
        if isinstance(statement, ast.FunctionDef):
            if _DECORATORS & {d.id for d in statement.decorator_list if isinstance(d, ast.Name)}:
                self.functions.append(statement)
            self.values[statement.name] = statement
        elif isinstance(statement, ast.ClassDef):
            self.values[statement.name] = statement
        elif isinstance(statement, ast.ImportFrom) and (statement.module or "").startswith(PACKAGE.name):
            for name in statement.names:
                self.imported[name.asname or name.name] = (str(statement.module), name.name)
        elif isinstance(statement, ast.Assign | ast.AnnAssign):
            targets = statement.targets if isinstance(statement, ast.Assign) else [statement.target]
            for node in (node for target in targets for node in ast.walk(target)):
                if isinstance(node, ast.Name):
                    self.values[node.id] = statement


@cache
def _module(name: str) -> _Module | None:
    stem = PACKAGE.parent.joinpath(*name.split("."))
    path = next((p for p in (stem.with_suffix(".py"), stem / "__init__.py") if p.is_file()), None)
    return None if path is None else _Module(path)


def _defined(module: str, name: str) -> tuple[str, ast.stmt] | None:
    """Module and statement that define a name, imports followed."""
    for _ in range(8):
        source = _module(module)
        if source is None or name in source.values:
            return None if source is None else (module, source.values[name])
        if name not in source.imported:
            return None
        module, name = source.imported[name]
    return None


def _without_text(node: ast.AST) -> str:
    """Source tree of a statement without positions, docstrings and texts of no consequence to a kernel."""
    parts = []
    for child in ast.walk(node):
        if isinstance(child, ast.Expr) and isinstance(child.value, ast.Constant):
            child.value.value = None
        if isinstance(child, ast.ClassDef):
            # Of a class, a kernel can name a plain constant of its body, a compiled function that is one of
            # its attributes, or (a NamedTuple) its fields, and nothing else.
            child.body = [s for s in child.body if isinstance(s, ast.Assign | ast.AnnAssign) and _is_plain(s)]
        parts.append(child)
    return ast.dump(node)


def _is_plain(statement: ast.Assign | ast.AnnAssign) -> bool:
    value = statement.value
    return value is None or not any(isinstance(n, ast.Call | ast.JoinedStr) for n in ast.walk(value))


def _named(module: str, statement: ast.stmt) -> Iterator[tuple[str, ast.stmt]]:
    """Yield what a statement names: by a variable, or as a registry does, by a text "package.module:Name"."""
    for node in ast.walk(statement):
        definition = None
        if isinstance(node, ast.Name):
            definition = _defined(module, node.id)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            place, _, name = node.value.partition(":")
            if name.isidentifier() and place.startswith(f"{PACKAGE.name}."):
                definition = _defined(place, name)
        if definition is not None:
            yield definition


def kernel_texts() -> Iterator[str]:
    """Yield each compiled function and each constant it names, as text without layout and wording."""
    waiting: list[tuple[str, ast.stmt]] = []
    for path in sorted(PACKAGE.rglob("*.py")):
        text = path.read_text("utf-8")
        if "@kernel" in text or "@inlined" in text:
            parts = path.relative_to(PACKAGE.parent).with_suffix("").parts
            name = ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
            module = _module(name)
            waiting += [(name, function) for function in (module.functions if module else ())]
    seen: set[int] = set()
    while waiting:
        module, statement = waiting.pop()
        if id(statement) in seen:
            continue
        seen.add(id(statement))
        yield f"{module}:{_without_text(statement)}"
        waiting += _named(module, statement)


@cache
def number_of_kernels() -> int:
    """Number of functions that are compiled with all that they inline."""
    return sum(path.read_bytes().count(b"\n@kernel\n") for path in PACKAGE.rglob("*.py"))


def source_digest() -> str:
    """Digest of the sources as they are, wording and layout included; formed in some 10 ms."""
    digest = hashlib.blake2b(_versions(), digest_size=16)
    for folder, folders, names in os.walk(PACKAGE):
        folders.sort()
        for name in sorted(names):
            if name.endswith(".py"):
                with open(os.path.join(folder, name), "rb", buffering=0) as file:
                    text = file.read()
                place = os.path.relpath(folder, PACKAGE)
                digest.update(f"{place}/{name} {len(text)}\n".encode())
                digest.update(text)
    return digest.hexdigest()


def kernel_digest() -> str:
    """Digest of all that is compiled, and for which Python, numba and kind of machine, 16 hex digits."""
    digest = hashlib.sha256(_versions())
    for text in sorted(kernel_texts()):
        digest.update(text.encode())
    return digest.hexdigest()[:16]


def _versions() -> bytes:
    # Not the build of Python: machine code depends on its bytecode and binary interface alone.
    return f"{sys.implementation.cache_tag}|{numba.__version__}|{sys.platform}|{platform.machine()}".encode()
