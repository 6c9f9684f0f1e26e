"""Packages and files that register methods: found, loaded once, and their faults named."""

import os
import sys
import traceback
from collections.abc import Iterator
from hashlib import blake2b
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path
from types import ModuleType

import navcore
from navcore.extending.added import ADDED, collected
from navcore.extending.law_files import LAW_FILES, law_of_file
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text

GROUP = "schuler_bench.methods"
"""Group of entry points of packages that bring methods: a class, or a module that registers some."""
VARIABLE = "SCHULER_PLUGINS"
"""Environment variable that names files, separated as in PATH. Processes that are started inherit it."""
_MODULE = "schuler_plugin_"
_loaded: set[str] = set()
_brought: dict[str, str] = {}


def load_plugins() -> tuple[Fault, ...]:
    """Load all packages and files that bring methods, each once.

    One that fails stops nothing else: what it registered before stays, and the rest is loaded.

    Returns
    -------
    tuple of Fault
        What is wrong with those that were loaded now.
    """
    faults: list[Fault] = []
    for point in entry_points(group=GROUP):
        if _first(f"entry {point.name}={point.value}"):
            faults += _load_point(point)
    for name in filter(None, os.environ.get(VARIABLE, "").split(os.pathsep)):
        if _first(f"file {Path(name).resolve()}"):
            faults += load_file(name)
    return tuple(faults)


def name_plugin(path: str) -> None:
    """Have a file loaded by `load_plugins`, here and in processes that are started from now on.

    Raises
    ------
    InputError
        There is no such file.
    """
    if not Path(path).is_file():
        raise InputError(Fault("--plugin", "", path, Text("must be a file that registers methods")))
    known = [name for name in os.environ.get(VARIABLE, "").split(os.pathsep) if name]
    os.environ[VARIABLE] = os.pathsep.join(dict.fromkeys([*known, str(Path(path).resolve())]))


def load_file(path: str | Path) -> tuple[Fault, ...]:
    """Run a file that registers methods; return what is wrong with it."""
    if Path(path).suffix in LAW_FILES:
        return _load_law(path)
    try:
        text = Path(path).read_text("utf-8")
    except (OSError, UnicodeDecodeError) as error:
        return (Fault(str(path), "", None, Text("cannot be read: {error}", error=str(error))),)
    return load_text(str(Path(path).resolve()), text)


def _load_law(path: str | Path) -> tuple[Fault, ...]:
    """Register the law in a C file or a unit, under the name of the file."""
    with collected() as faults:
        try:
            navcore.register(law_of_file(path))
        except InputError as error:
            faults += error.faults
    return tuple(faults)


def load_text(path: str, text: str) -> tuple[Fault, ...]:
    """Run the text of such a file, which need not be on this machine; return what is wrong with it."""
    before = len(ADDED)
    module = ModuleType(_MODULE + Path(path).stem)
    module.__file__ = path
    sys.modules[module.__name__] = module
    with collected() as faults:
        try:
            exec(compile(text, path, "exec", dont_inherit=True), module.__dict__)
        except Exception as error:
            faults.append(_of_error(error, path))
    _brought[path] = text
    if len(ADDED) == before and not faults:
        faults.append(
            Fault(Path(path).name, "", None, Text("registers nothing: call navcore.register(Class)"))
        )
    return tuple(faults)


def brought() -> dict[str, str]:
    """Files that were loaded, by their path, with the text that was run."""
    return dict(_brought)


def _first(key: str) -> bool:
    """Whether this is loaded for the first time; noted before, for it may ask for the program's names."""
    if key in _loaded:
        return False
    _loaded.add(key)
    return True


def _load_point(point: EntryPoint) -> Iterator[Fault]:
    with collected() as faults:
        try:
            found = point.load()
            if not isinstance(found, ModuleType) or hasattr(found, "recognises"):
                navcore.register(found)
        except Exception as error:
            faults.append(_of_error(error, ""))
    for fault in faults:
        yield Fault(f"{GROUP}: {point.name}: {fault.where}", fault.field, fault.value, fault.allowed)


def _of_error(error: Exception, path: str) -> Fault:
    """Name what a file has raised, and the line."""
    if isinstance(error, InputError):
        return error.faults[0]
    if isinstance(error, SyntaxError):
        place = f"{os.path.basename(error.filename or path)}:{error.lineno or 0}"
    else:
        frames = traceback.extract_tb(error.__traceback__)
        frame = next((one for one in reversed(frames) if one.filename == path), frames[-1])
        place = f"{os.path.basename(frame.filename)}:{frame.lineno}"
    why = Text("{kind}: {error}", kind=type(error).__name__, error=str(error))
    return Fault(place, "", None, why)


def digest_of(path: str, text: str) -> str:
    """Name of a file's text among those that another process has brought along."""
    return blake2b(f"{path}\0{text}".encode(), digest_size=16).hexdigest()
