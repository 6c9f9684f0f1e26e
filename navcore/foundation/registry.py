"""Registries: what a block of a scenario can be, one class an entry, told apart by one field.

A registry is a dictionary from the name that a scenario uses to the parameter class. The type of the field
that holds any of them, the page's form, the guide, the JSON Schema and the contract test are made from it, so
that a new entry is a file with a class and a line in the registry.
"""

from importlib import import_module
from typing import Annotated, Any, ClassVar, Literal, TypeVar, Union, get_args, get_origin

from pydantic import BeforeValidator, Field

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


def registry(base: type[_Entry], discriminator: str, *places: str) -> dict[str, type[_Entry]]:
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
    dict
        Name -> class.

    Raises
    ------
    TypeError
        A place holds no subclass of ``base``, or its name is missing or used twice.
    """
    entries: dict[str, type[_Entry]] = {}
    for place in places:
        entry = loaded(place)
        if not (isinstance(entry, type) and issubclass(entry, base)):
            raise TypeError(f"{place} is no {base.__name__}")
        info = entry.model_fields[discriminator]
        if get_args(info.annotation) != (info.default,):
            raise TypeError(f"{place}: {discriminator} must be a Literal of one word, its default")
        if info.default in entries:
            raise TypeError(f'{place}: {discriminator} "{info.default}" is used twice')
        entries[info.default] = entry
    return entries


def any_of(entries: dict[str, type[_Entry]], discriminator: str) -> Any:
    """Make the type of a field that holds any entry of a registry, told apart by ``discriminator``.

    The name of an entry alone, ``"unity2"``, is the entry with its defaults, ``{ id = "unity2" }``.
    """

    def block(value: Any) -> Any:
        return {discriminator: value} if isinstance(value, str) else value

    entry = Annotated[Union[tuple(entries.values())], Field(discriminator=discriminator)]  # noqa: UP007
    named = Union[Literal[tuple(entries)], entry]  # noqa: UP007
    return Annotated[entry, BeforeValidator(block, json_schema_input_type=named)]


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
