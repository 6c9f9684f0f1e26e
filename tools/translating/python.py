"""Texts in Python files: prose in string literals and f-strings, whatever it is used for."""

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product
from pathlib import Path

from app.languages.markup import CLOSE, OPEN, in_pieces

_PROGRAMMERS = (
    "ValueError TypeError KeyError RuntimeError AssertionError NotImplementedError ModuleNotFoundError "
    "FileNotFoundError IndexError AttributeError BadFrame RegistryError RuntimeWarning"
).split()
"""Exceptions whose text is for who reads the program."""
_QUIET = (
    "compile warning exception debug info getattr setattr hasattr TypeVar fullmatch "
    "match search sub split partition rpartition startswith endswith "
    "removeprefix removesuffix encode import_module strftime getLogger joinpath Thread"
).split()
"""Calls whose texts nobody is shown."""
_TOLD = (
    "title",
    "label",
    "help",
    "hint",
    "about",
    "says",
    "say",
    "ask",
    "why",
    "words",
    "caption",
    "name_on_page",
)
"""Keywords and class attributes whose text is shown, be it one word."""
_PROSE = re.compile(
    r"[A-Za-z][A-Za-z'’-]+[,;:]? +(?:\{\d+\} *)*[A-Za-z(<\"'{]|\} [a-z]{3,}|[a-z]{3,}[:,]? \{"
)
_NAME = re.compile(r"[A-Z][a-z]+")
_CODE = re.compile(
    r"^[#.]?[\w-]+\s*\{[^0-9]|[a-z-]+:\s*[^;{}]*;|^--|\bvar\(|^[MmLl]\d|^/|^\w+(\.\w+)+$|\d+px\b|\}px\b"
    r"|^<?tr |^sb-|^pointer-|HTTP/|^Content-|-apple-system|^<|\\[a-z]+\{|^data-"
)
_SENTENCE = re.compile(r"(?:\b[A-Za-z]+[,:;]? ){5}")
"""Six words one after the other: no style or path has them."""
_NO_TEXTS = frozenset(
    "Enter|Escape|Slider|Select|Schuler Bench|Infinity|Library|Application Support|page command|page state|"
    "page painted|pair handle|<span>{0}</span>|Hz|skip|height|alpha|{0} next|{0} open {1}|{0} list|"
    "{0}px {1}".split("|")
)
"""Strings that look like prose and are none: keys, labels and arguments for scripts."""
_CITATION = re.compile(
    r"(?:Deng|Liu|Zhao|Sun|Zha|theory\.md|eq\.|eqs\.|figs?\.|"
    r"table|tables|and|to|et al\.|[0-9.,;:() +-]|\{\d+\})+"
)
_MOST_FORMS = 8


@dataclass(frozen=True)
class Text:
    """A text that a page may show.

    Attributes
    ----------
    key : str
        English, values as ``{0}``.
    where : str
        File and line.
    prose : bool
        More than one word, or named as a text: it must have a translation. Other words may have one.
    """

    key: str
    where: str
    prose: bool


def texts_in(path: Path, name: str) -> Iterator[Text]:
    """Texts in a Python file.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    name : str
        What it is called in `Text.where`.
    """
    tree = ast.parse(path.read_text(encoding="utf-8"))
    quiet = _quiet(tree)
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and ast.unparse(node.func) in ("Text", "Text.plural"):
            forms = [str(part.value) for part in node.args if isinstance(part, ast.Constant)]
            quiet |= {id(part) for part in node.args}
            for form in forms:
                yield Text(" ".join(form.split()), f"{name}:{node.lineno}", True)
    told = _told(tree)
    for node in _walk(tree, quiet):
        for form in _forms(node):
            for piece in in_pieces(form):
                key = numbered(piece)
                if not re.search(r"[A-Za-z]{2,}", re.sub(r"\{\d+\}", "", key)):
                    continue
                for part in re.split(r"</?[a-z]+>", key) if "<" in key else ():
                    if re.search("[A-Za-z]{2,}", part):
                        yield Text(numbered(re.sub(r"\{\d+\}", OPEN + CLOSE, part)), name, False)
                yield Text(
                    key,
                    f"{name}:{getattr(node, 'lineno', 0)}",
                    is_prose(key) or (id(node) in told and key not in _NO_TEXTS),
                )


def is_prose(key: str) -> bool:
    """Whether a text is meant for a reader, as far as can be seen from it.

    Examples
    --------
    >>> [is_prose(text) for text in ("Undo", "largest tilt", "time_s", "color:red;", "Run {0}: {1} ms")]
    [True, True, False, False, True]
    >>> is_prose("Poles left of it die away: the farther left, the faster; steep ones swing.")
    True
    """
    bare = re.sub(r"<[^>]*>", "", key).strip()
    if _SENTENCE.search(bare):
        return True
    if _CODE.search(bare) or bare in _NO_TEXTS or _CITATION.fullmatch(bare):
        return False
    return _PROSE.search(bare) is not None or _NAME.fullmatch(bare.strip(" .:;,")) is not None


def numbered(piece: str) -> str:
    """Number the values of a piece in their order; it holds each between ``OPEN`` and ``CLOSE``."""
    count = iter(range(1000))
    text = " ".join(piece.split()) if "\n" not in piece.strip() else piece.strip()
    return re.sub(f"{OPEN}[0-9]*{CLOSE}", lambda _: f"{{{next(count)}}}", text)


def _walk(node: ast.AST, quiet: set[int]) -> Iterator[ast.expr]:
    """Outermost expressions that are texts, and the texts in their values."""
    for child in ast.iter_child_nodes(node):
        if id(child) in quiet:
            continue
        if isinstance(child, ast.expr) and _is_text(child):
            yield child
            for value in _values(child):
                yield from _walk(ast.Expr(value), quiet)
        else:
            yield from _walk(child, quiet)


def _is_text(node: ast.expr) -> bool:
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
        return _is_text(node.left) or _is_text(node.right)
    return isinstance(node, ast.JoinedStr) or (isinstance(node, ast.Constant) and isinstance(node.value, str))


def _values(node: ast.expr) -> Iterator[ast.expr]:
    if isinstance(node, ast.BinOp):
        yield from _values(node.left)
        yield from _values(node.right)
    elif isinstance(node, ast.JoinedStr):
        for part in node.values:
            if isinstance(part, ast.FormattedValue) and _alternatives(part.value) is None:
                yield part.value
    elif not isinstance(node, ast.Constant):
        yield node


def _forms(node: ast.expr) -> list[str]:
    """All that a text can be, where a value in it is one of a few fixed words."""
    forms = ["".join(parts) for parts in product(*_parts(node))][:_MOST_FORMS]
    return [form for form in forms if form.replace(OPEN + CLOSE, "").strip()]


def _parts(node: ast.expr) -> list[list[str]]:
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return [[node.value]]
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
        return [*_parts(node.left), *_parts(node.right)]
    if isinstance(node, ast.JoinedStr):
        return [part for value in node.values for part in _parts(value)]
    inner = node.value if isinstance(node, ast.FormattedValue) else node
    return [_alternatives(inner) or [OPEN + CLOSE]]


def _alternatives(node: ast.expr) -> list[str] | None:
    """Fixed words between which an expression chooses: ``'s' * (n != 1)``, ``'es' if n == 1 else ''``."""
    if isinstance(node, ast.IfExp):
        words = [part.value for part in (node.body, node.orelse) if isinstance(part, ast.Constant)]
        if len(words) == 2 and all(isinstance(word, str) for word in words):
            return [str(word) for word in words]
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult):
        for side in (node.left, node.right):
            if isinstance(side, ast.Constant) and isinstance(side.value, str):
                return ["", side.value]
    return None


def _quiet(tree: ast.AST) -> set[int]:
    """Strings that nobody reads: documentation, names for the program, texts of its own errors and log."""
    return {id(part) for node in ast.walk(tree) for part in _quiet_parts(node)}


def _quiet_parts(node: ast.AST) -> list[ast.AST]:
    match node:
        case ast.Expr(value=ast.Constant()):
            return [node]
        case ast.AnnAssign(annotation=ast.AST() as kind) | ast.arg(annotation=ast.AST() as kind):
            return [kind]
        case ast.FunctionDef(returns=ast.AST() as kind) | ast.AsyncFunctionDef(returns=ast.AST() as kind):
            return [kind]
        case ast.Subscript():
            return [node.slice]
        case ast.Compare():
            return [node.left, *node.comparators]
        case ast.Assign() if any(_named(target) in ("__all__", "id", "kind") for target in node.targets):
            return [node.value]
        case ast.Call() if _named(node.func) in (*_PROGRAMMERS, *_QUIET):
            return [*node.args, *(word.value for word in node.keywords)]
        case ast.If() if "__main__" in ast.dump(node.test):
            return [*node.body]
        case _:
            return []


def _told(tree: ast.AST) -> set[int]:
    """Expressions that a name of `_TOLD` is given."""
    told: set[int] = set()
    for node in ast.walk(tree):
        match node:
            case ast.keyword(arg=str() as name, value=value):
                names = [name]
            case ast.Assign(targets=targets, value=value):
                names = [_named(target) for target in targets]
            case ast.AnnAssign(target=target, value=ast.expr() as value):
                names = [_named(target)]
            case _:
                continue
        if not set(names).isdisjoint(_TOLD):
            told.add(id(value))
    return told


def _named(node: ast.AST) -> str:
    return node.id if isinstance(node, ast.Name) else node.attr if isinstance(node, ast.Attribute) else ""
