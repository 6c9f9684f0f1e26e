"""What was registered here goes along with a job to another process, which registers it first."""

import pickle
import sys
from collections.abc import Callable
from importlib import import_module
from types import ModuleType
from typing import Any

import navcore
from navcore.extending.added import ADDED
from navcore.extending.law_files import law_of_file
from navcore.extending.plugins import brought, digest_of, load_plugins, load_text
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.registry import place_of
from navcore.foundation.text import Text

Baggage = tuple[tuple[str, str, str], ...]
"""Each of a kind ("file", "law" or "import"), a path or the place to import from, and the text or the id."""
_taken: set[str] = set()


def baggage() -> Baggage:
    """All that was registered in this process, to be given to `unpack` in another one.

    Raises
    ------
    InputError
        A class was defined in a notebook's cell or in the script that runs: another process cannot import it.
    """
    files = tuple(("file", path, text) for path, text in brought().items())
    others: dict[str, None] = {}
    for one in ADDED:
        if path := getattr(one.thing, "law_file", ""):
            files = (*files, ("law", path, one.name))
            continue
        whole = isinstance(one.thing, ModuleType)
        module = one.thing.__name__ if whole else one.thing.__module__
        if module == "__main__":
            why = Text("is defined in the script or notebook that runs: put it into a file of its own")
            raise InputError(Fault(place_of(one.thing), one.name, None, why))
        if getattr(sys.modules.get(module), "__file__", None) not in brought():
            others[module if whole else f"{module}:{one.thing.__qualname__}"] = None
    return (*files, *(("import", name, "") for name in others))


def packed(function: Callable[..., Any], *arguments: Any) -> tuple[Callable[..., Any], tuple[Any, ...]]:
    """Return a function and its first arguments in a form that another process can read.

    They are the same where nothing was registered; else there is one argument in the place of them.
    """
    if not ADDED:
        return function, arguments
    content = pickle.dumps((function, arguments), protocol=pickle.HIGHEST_PROTOCOL)
    return _unpacked, ((baggage(), content),)


def _unpacked(item: tuple[Baggage, bytes], *more: Any) -> Any:
    unpack(item[0])
    function, arguments = pickle.loads(item[1])
    return function(*arguments, *more)


def unpack(given: Baggage) -> None:
    """Register what another process has registered, each thing once.

    Raises
    ------
    InputError
        Something cannot be registered here, such as a package that is not installed on this machine.
    """
    load_plugins()
    here = {digest_of(path, text) for path, text in brought().items()}
    for kind, name, text in given:
        key = digest_of(name, text)
        if key in _taken or key in here:
            continue
        if kind == "file":
            if faults := load_text(name, text):
                raise InputError(faults)
        elif kind == "law":
            navcore.register(law_of_file(name, id=text))
        else:
            module, _, attribute = name.partition(":")
            try:
                found = import_module(module)
                navcore.register(getattr(found, attribute) if attribute else found)
            except (ImportError, AttributeError) as error:
                why = Text("brings methods, and cannot be imported here: {error}", error=str(error))
                raise InputError(Fault(name, "", None, why)) from error
        _taken.add(key)
