"""Models that change while the program runs: a registry has a new entry, a block has a new field.

Pydantic compiles a model when its class is made. Where an entry is added later, the fields that may hold it
are given their new type, and the models that hold these models are compiled anew, the innermost first.
"""

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import reduce
from operator import or_
from types import UnionType
from typing import Annotated, Any, Union, get_args, get_origin

from pydantic import BaseModel, BeforeValidator
from pydantic.fields import FieldInfo

from navcore.foundation.parameters import Parameters

Change = Callable[[Any], Any]
"""Gives the new type in the place of a type; None where it stays."""
_CHANGED: list[Callable[[], object]] = []


def when_changed(forget: Callable[[], object]) -> None:
    """Have a function called whenever models change: what is remembered of their fields is out of date."""
    _CHANGED.append(forget)


def offer(change: Change) -> None:
    """Give fields of all models a new type.

    Parameters
    ----------
    change : callable
        Asked of each type within each field.
    """
    touched = [model for model in _models() if sum(_changed(info, change) for info in _infos(model))]
    remake(touched)


def give_field(model: type[BaseModel], name: str, info: FieldInfo) -> None:
    """Give a model and those derived from it a field; to be followed by `remake`."""
    for each in (model, *_below(model)):
        each.__pydantic_fields__[name] = info
        each.__annotations__[name] = info.annotation


def remake(touched: list[type[BaseModel]]) -> None:
    """Compile models anew, and all that hold them."""
    models, waiting = [*_models()], set(touched)
    for model in _in_order(models):
        held = {one for info in _infos(model) for one in _held(info.annotation)}
        if model in waiting or held & waiting:
            waiting.add(model)
            for info in _infos(model):
                if type(info.default) in waiting:
                    info.default = _anew(info.default)
            model.model_rebuild(force=True)
    for forget in _CHANGED:
        forget()


def _anew(default: Any) -> Any:
    """Make a default that was made before its model has changed."""
    given = {name: getattr(default, name) for name in default.model_fields_set}
    return type(default)(**given)


def _infos(model: type[BaseModel]) -> Iterator[FieldInfo]:
    yield from model.__pydantic_fields__.values()


def _models() -> Iterator[type[BaseModel]]:
    yield from dict.fromkeys(_below(Parameters))


def _below(model: type[BaseModel]) -> Iterator[type[BaseModel]]:
    for each in model.__subclasses__():
        yield each
        yield from _below(each)


def _in_order(models: list[type[BaseModel]]) -> Iterator[type[BaseModel]]:
    """Models after those that they hold."""
    done: set[type[BaseModel]] = set()

    def visit(model: type[BaseModel]) -> Iterator[type[BaseModel]]:
        if model in done:
            return
        done.add(model)
        for info in _infos(model):
            for one in _held(info.annotation):
                yield from visit(one)
        yield model

    for model in models:
        yield from visit(model)


def _held(annotation: Any) -> Iterator[type[BaseModel]]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for part in get_args(annotation):
        yield from _held(part)


def _changed(info: FieldInfo, change: Change) -> bool:
    """Change the type of a field, and the type that its validators say they take."""
    after = _within(info.annotation, change)
    if after is info.annotation:
        return False
    info.annotation = after
    info.metadata = [
        replace(one, json_schema_input_type=_within(one.json_schema_input_type, change))
        if isinstance(one, BeforeValidator)
        else one
        for one in info.metadata
    ]
    return True


def _within(annotation: Any, change: Change) -> Any:
    """Type with its parts changed; the very same where nothing is."""
    if (after := change(annotation)) is not None:
        return after
    parts = get_args(annotation)
    changed = tuple(_within(part, change) for part in parts)
    if all(one is other for one, other in zip(parts, changed, strict=True)):
        return annotation
    origin = get_origin(annotation)
    if origin is Annotated:
        return Annotated[changed]
    if origin in (Union, UnionType):
        return reduce(or_, changed) if origin is UnionType else Union[changed]  # noqa: UP007
    return origin[changed]
