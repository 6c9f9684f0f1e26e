"""Registries: what a block of a scenario can be, one class an entry, told apart by one field.

A registry is a dictionary from the name that a scenario uses to the parameter class. The type of the field
that holds any of them, the page's form, the guide, the JSON Schema and the contract test are made from it, so
that a new entry is a file with a class and a line in the registry.
"""

import inspect
import os
from collections.abc import Iterable, Mapping
from importlib import import_module
from typing import Annotated, Any, ClassVar, Literal, TypeVar, Union, get_args, get_origin

from pydantic import BeforeValidator, Field

from navcore.foundation.offered import offer
from navcore.foundation.parameters import Parameters


class Entry(Parameters):
    """Base of the classes in a registry.

    Attributes
    ----------
    source : str
        Where it is from, for the explanation of its fields: paper and equation.
    """

    source: ClassVar[str] = ""


def loaded(place: str) -> Any:
    """Import what stands at ``"package.module:Name"``."""
    module, _, name = place.partition(":")
    return getattr(import_module(module), name)


_Entry = TypeVar("_Entry", bound=Parameters)


class Registry(dict[str, type[_Entry]]):
    """Classes by name, in the order in which the page offers them; more can be added while the program runs.

    Attributes
    ----------
    base : type
        What every entry is a subclass of.
    discriminator : str
        The field that names an entry: a Literal of one word, which is its default.
    own : dict
        The entries that came with the program.
    """

    def __init__(self, base: type[_Entry], discriminator: str, entries: Iterable[type[_Entry]]) -> None:
        super().__init__()
        self.base, self.discriminator = base, discriminator
        for entry in entries:
            name = self.name_of(entry)
            if name in self:
                raise TypeError(
                    f'{entry.__module__}:{entry.__name__}: {discriminator} "{name}" is used twice'
                )
            self[name] = entry
        self.own: dict[str, type[_Entry]] = dict(self)

    def name_of(self, entry: type[_Entry]) -> str:
        """Name of a class that may be an entry.

        Raises
        ------
        TypeError
            It is no subclass of the base, or its name is missing or used by another class.
        """
        place = f"{getattr(entry, '__module__', '')}:{getattr(entry, '__name__', entry)}"
        if not (isinstance(entry, type) and issubclass(entry, self.base)):
            raise TypeError(f"{place} is no {self.base.__name__}")
        info = entry.model_fields.get(self.discriminator)
        if info is None or get_args(info.annotation) != (info.default,):
            raise TypeError(f"{place}: {self.discriminator} must be a Literal of one word, its default")
        if info.default in self and not same_class(self[info.default], entry):
            raise TypeError(f'{place}: {self.discriminator} "{info.default}" is used twice')
        return info.default

    def add(self, entry: type[_Entry]) -> None:
        """Add an entry, or put a class in the place of an earlier form of itself; all models offer it then.

        Raises
        ------
        TypeError
            As of `name_of`.
        """
        name, before, names = self.name_of(entry), tuple(self.values()), tuple(self)
        self[name] = entry

        def change(annotation: Any) -> Any:
            if get_args(annotation) == before:
                return _union(self.values())
            return Literal[tuple(self)] if get_args(annotation) == names else None

        offer(change)

    @property
    def field_type(self) -> Any:
        """Type of a field that holds any entry, as of now."""
        return any_of(self, self.discriminator)


def same_class(one: type, other: type) -> bool:
    """Whether a class is another one defined anew, as when a notebook's cell or a file is run again."""
    return (one.__module__, one.__qualname__) == (other.__module__, other.__qualname__)


def place_of(thing: Any) -> str:
    """File and line where a class or function is defined, for faults; its module where that is not known."""
    try:
        file = inspect.getsourcefile(thing) or ""
        line = inspect.getsourcelines(thing)[1]
    except (OSError, TypeError):
        return str(getattr(thing, "__module__", ""))
    return f"{os.path.basename(file)}:{line}"


def registry(base: type[_Entry], discriminator: str, *places: str) -> Registry[_Entry]:
    """Load the classes of a registry.

    Parameters
    ----------
    base : type
        What every entry is a subclass of.
    discriminator : str
        The field that names an entry: a Literal of one word, which is its default.
    *places : str
        Where the classes are, ``"package.module:Class"``, in the order in which the page offers them.

    Returns
    -------
    Registry
        Name -> class.

    Raises
    ------
    TypeError
        A place holds no subclass of ``base``, or its name is missing or used twice.
    """
    return Registry(base, discriminator, map(loaded, places))


def _union(entries: Iterable[type[Parameters]]) -> Any:
    return Union[tuple(entries)]  # noqa: UP007


def any_of(entries: Mapping[str, type[_Entry]], discriminator: str) -> Any:
    """Make the type of a field that holds any entry of a registry, told apart by ``discriminator``.

    The name of an entry alone, ``"unity2"``, is the entry with its defaults, ``{ id = "unity2" }``.
    """

    def block(value: Any) -> Any:
        return {discriminator: value} if isinstance(value, str) else value

    entry = Annotated[_union(entries.values()), Field(discriminator=discriminator)]
    return Annotated[entry, BeforeValidator(block, json_schema_input_type=_named(entries, discriminator))]


def _named(entries: Mapping[str, type[Parameters]], discriminator: str) -> Any:
    """What such a field takes: a name, or a block."""
    entry = Annotated[_union(entries.values()), Field(discriminator=discriminator)]
    return Union[Literal[tuple(entries)], entry]  # noqa: UP007


def blocks_of(model: type[Parameters]) -> dict[type[Parameters], list[tuple[str, bool]]]:
    """Find the fields of a model that are blocks of their own.

    Returns
    -------
    dict
        Class of a block -> the fields that hold one of it, each with whether it holds a list of them.
    """
    blocks: dict[type[Parameters], list[tuple[str, bool]]] = {}
    for name, info in model.model_fields.items():
        many = get_origin(info.annotation) is tuple
        block = get_args(info.annotation)[0] if many else info.annotation
        if isinstance(block, type) and issubclass(block, Parameters):
            blocks.setdefault(block, []).append((name, many))
    return blocks
