"""From pydantic's errors to faults: the path as the user wrote it, the value, the whole allowed range."""

import difflib
import types
from collections.abc import Iterator
from dataclasses import replace
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel, ValidationError
from pydantic.fields import FieldInfo

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.parameters import allowed_range, element_of, extra_of
from navcore.foundation.text import Text
from navcore.foundation.written_toml import number_refused

_ABSENT = object()
_MOST_ERRORS = 100
"""Errors that are listed one by one: nobody reads more."""
_LONGEST_NAME = 60
_WANTED = {
    "float": Text("must be a number"),
    "int": Text("must be a whole number"),
    "bool": Text("must be true or false"),
    "string": Text("must be text"),
    "dict": Text("must be a table of fields"),
    "model": Text("must be a table of fields"),
    "finite": Text("must be a finite number"),
}
_NO_LIST = ("list_type", "tuple_type", "named_tuple_type")
_BOUNDS = {"greater_than": ">", "greater_than_equal": ">=", "less_than": "<", "less_than_equal": "<="}


def faults_from(error: ValidationError, model: Any, data: Any, where: str) -> list[Fault]:
    """Translate a pydantic error.

    Parameters
    ----------
    error : pydantic.ValidationError
        What validation raised.
    model : type or annotation
        What was validated: a model class, or an annotation such as a discriminated union.
    data : object
        The raw input, from which the offending values are taken as the user wrote them.
    where : str
        File, preset or part of the page the input came from.

    Returns
    -------
    list of Fault
        One for each wrong field; an `InputError` raised in a validator is unfolded. Paths carry no union
        tags: ``method.0.network.xi``.
    """
    faults: list[Fault] = []
    items = error.errors(include_url=False)
    for item in items[:_MOST_ERRORS]:
        faults += _unfold(item, model, data, where)
    more = len(items) - _MOST_ERRORS
    rest = [Fault(where, "", None, Text("and {more} more faults", more=more))] if more > 0 else []
    return [*_merged(faults), *rest]


def _merged(faults: list[Fault]) -> list[Fault]:
    """One fault a field: pydantic reports every member of a plain union that did not fit."""
    together: dict[tuple[str, str], Fault] = {}
    for fault in faults:
        key = (fault.where, fault.field)
        first = together.get(key)
        if first is None:
            together[key] = fault
        elif fault.allowed not in first.allowed:
            together[key] = replace(
                first,
                allowed=Text("{allowed}, or {allowed_2}", allowed=first.allowed, allowed_2=fault.allowed),
            )
    return list(together.values())


def _unfold(item: Any, model: Any, data: Any, where: str) -> list[Fault]:
    path, place, info = _walk(model, data, item["loc"])
    cause = (item.get("ctx") or {}).get("error")
    if isinstance(cause, InputError):
        return [_relocated(fault, path, data, where) for fault in cause.faults]
    kind = item["type"]
    if kind.startswith("union_tag"):
        name = (item.get("ctx") or {}).get("discriminator", "'id'").strip("'")
        value = _lookup(data, path)
        if isinstance(value, str):  # a name alone
            return [Fault(where, ".".join(path), value, _tags(place, name, value))]
        value = _lookup(data, [*path, name])
        return [Fault(where, ".".join([*path, name]), _excerpt(value, None), _tags(place, name, value))]
    if kind == "missing" and isinstance(item["loc"][-1], int):  # an element of a list that is too short
        path, place, info = _walk(model, data, item["loc"][:-1])
        kind = "tuple_type"
    value = _lookup(data, path)
    if kind == "missing":
        return [Fault(where, ".".join(path), None, _join(Text("is required"), _range(info)))]
    allowed = _allowed(item, path, place, info) if kind == item["type"] else _list(path, place, info)
    return [Fault(where, ".".join(path), _excerpt(value, item.get("input")), allowed)]


def _relocated(fault: Fault, path: list[str], data: Any, where: str) -> Fault:
    whole = [*path, *(fault.field.split(".") if fault.field else [])]
    value = _excerpt(_lookup(data, whole), fault.value)
    return Fault(fault.where or where, ".".join(whole), value, fault.allowed)


def _excerpt(value: Any, fallback: Any) -> Any:
    if value is _ABSENT:
        value = fallback
    return None if isinstance(value, dict | BaseModel) else value


def _range(info: FieldInfo | None) -> str:
    return allowed_range(info) if info is not None else ""


def _join(first: str, bounds: str) -> str:
    return Text("{first}, {bounds}", first=first, bounds=bounds.removeprefix("must be ")) if bounds else first


def _allowed(item: Any, path: list[str], place: Any, info: FieldInfo | None) -> str:
    kind, context = item["type"], item.get("ctx") or {}
    if kind == "extra_forbidden":
        return _unknown_field(path[-1], place)
    if kind == "literal_error":
        return (
            Text("must be one of {expected}", expected=context["expected"])
            if " or " in context["expected"]
            else Text("must be {expected}", expected=context["expected"])
        )
    if kind in _BOUNDS:
        return _range(info) or Text(
            "must be {bounds} {next:g}", bounds=_BOUNDS[kind], next=next(iter(context.values()))
        )
    if kind in _NO_LIST or (kind == "too_long" and _length(place)):
        return _list(path, place, info)
    if kind in ("too_short", "too_long"):
        limit = context.get("min_length", context.get("max_length"))
        return (
            Text("must have at least {limit} values", limit=limit)
            if kind == "too_short"
            else Text("must have at most {limit} values", limit=limit)
        )
    wanted = _WANTED.get(kind.split("_")[0])
    if kind.startswith("model") and len(list(_members(place))) > 1:
        wanted = Text("must be a name or a table of fields")
    if wanted is not None:
        if kind.startswith(("float", "int")):
            wanted = number_refused(item["input"]) or wanted
        return _join(wanted, _range(info))
    message = str(context["error"]) if "error" in context else item["msg"]
    return _join(message.replace(Text("Input should be"), Text("must be"), 1), _range(info))


def _length(place: Any) -> int:
    """Number of values of a list that has a fixed one; 0 for others."""
    if names := getattr(place, "_fields", ()):
        return len(names)
    elements = get_args(place) if get_origin(place) is tuple else ()
    return 0 if Ellipsis in elements else len(elements)


def _list(path: list[str], place: Any, info: FieldInfo | None) -> str:
    """Say what a list must hold: of how many what, and in which range each."""
    count, elements = _length(place), get_args(place)
    members = [_unwrap(member, None)[0] for element in elements[:1] for member in _members(element)]
    names = getattr(place, "_fields", ()) or extra_of(info).get("elements", ()) if info else ()
    if any(_is_model(member) for member in members):
        block = ".".join(part for part in path if not part.isdigit())
        return Text("must be a list of blocks, [[{block}]]", block=block)
    if str in members:
        return Text("must be a list of texts")
    if rows := [member for member in members if getattr(member, "_fields", ())]:
        fields = ", ".join(rows[0]._fields)
        return Text(
            "must be a list of lists of {count} numbers ({names})", count=_length(rows[0]), names=fields
        )
    if not count:
        numbers = float in members or any(map(_length, members))
        return Text("must be a list of numbers") if numbers else Text("must be a list")
    if not names:
        return Text("must be a list of {count} numbers", count=count)
    element = element_of(info) if info else None
    if each := allowed_range(element).removeprefix("must be ") if element else "":
        return Text(
            "must be a list of {count} numbers ({names}), each {each}",
            count=count,
            names=", ".join(names),
            each=each,
        )
    return Text("must be a list of {count} numbers ({names})", count=count, names=", ".join(names))


def _unknown_field(name: str, place: Any) -> str:
    fields = place.model_fields if _is_model(place) else {}
    known = [info.alias or own for own, info in fields.items()]
    close = difflib.get_close_matches(name[:_LONGEST_NAME], known, n=1)
    hint = Text("did you mean {close}? ", close=close[0]) if close else ""
    return Text("is not a field here; {hint}known: {known}", hint=hint, known=", ".join(known) or "none")


def _tags(place: Any, name: str, value: Any) -> str:
    known = [tag for member in _members(place) for tag in _tags_of(member, name)]
    close = difflib.get_close_matches(_tag_text(value), known, n=1)
    hint = Text(" (did you mean {close}?)", close=close[0]) if close and value is not _ABSENT else ""
    return (
        Text("is required: one of {known}{hint}", known=", ".join(known), hint=hint)
        if value is _ABSENT
        else Text("must be one of {known}{hint}", known=", ".join(known), hint=hint)
    )


def _tag_text(value: Any) -> str:
    return value[:_LONGEST_NAME] if isinstance(value, str) else ""


def _lookup(data: Any, path: list[str]) -> Any:
    for key in path:
        if isinstance(data, dict) and key in data:
            data = data[key]
        elif isinstance(data, list | tuple) and key.isdigit() and int(key) < len(data):
            data = data[int(key)]
        else:
            return _ABSENT
    return data


def _walk(model: Any, data: Any, loc: tuple[int | str, ...]) -> tuple[list[str], Any, FieldInfo | None]:
    """Follow pydantic's location; return the path without tags, the annotation there and its field."""
    path: list[str] = []
    place, info = _unwrap(model, None)
    holder = place
    for step in loc:
        members = list(_members(place))
        if isinstance(step, str) and len(members) > 1:
            chosen = next((m for m in members if step in _names(m)), None)
            if chosen is not None:
                place, info = _unwrap(chosen, info)
            if chosen is not None or not any(_is_model(m) and _field(m, step) for m in members):
                continue
        if isinstance(step, str) and step.startswith(("function-", "constrained-", "lax-or-strict", "[key]")):
            continue
        path.append(str(step))
        holder = place
        place, info = _descend(members, step, info)
    return path, (holder if place is None else place), info


def _descend(members: list[Any], step: int | str, info: FieldInfo | None) -> tuple[Any, FieldInfo | None]:
    for member in members:
        if _is_model(member):
            field = _field(member, step)
            if field is not None:
                return _unwrap(field.annotation, field)
        elif isinstance(step, int) and get_origin(member) in (list, tuple, set, frozenset):
            arguments = [a for a in get_args(member) if a is not Ellipsis]
            if arguments:
                return _unwrap(arguments[min(step, len(arguments) - 1)], info)
        elif get_origin(member) is dict:
            return _unwrap(get_args(member)[1], info)
    return None, None


def _field(model: type[BaseModel], step: int | str) -> FieldInfo | None:
    return next(
        (f for name, f in model.model_fields.items() if step in (name, f.alias, f.validation_alias)), None
    )


def _unwrap(annotation: Any, info: FieldInfo | None) -> tuple[Any, FieldInfo | None]:
    """Strip Annotated and Optional; an Annotated[..., Field(...)] with bounds replaces the field's own."""
    while True:
        if get_origin(annotation) is Annotated:
            inner, *extras = get_args(annotation)
            own = next((e for e in extras if isinstance(e, FieldInfo) and allowed_range(e)), None)
            annotation, info = inner, own or info
        elif len(members := list(_members(annotation))) == 1 and members[0] is not annotation:
            annotation = members[0]
        else:
            return annotation, info


def _members(annotation: Any) -> Iterator[Any]:
    """Members of a union without None; the annotation itself when it is no union."""
    if get_origin(annotation) is Annotated:
        yield from _members(get_args(annotation)[0])
    elif get_origin(annotation) in (Union, types.UnionType):
        for member in get_args(annotation):
            if member is not type(None):
                yield from _members(member)
    else:
        yield annotation


def _is_model(annotation: Any) -> bool:
    return isinstance(annotation, type) and issubclass(annotation, BaseModel)


def _tags_of(member: Any, name: str) -> list[str]:
    field = member.model_fields.get(name) if _is_model(member) else None
    annotation = None if field is None else field.annotation
    return [str(value) for value in get_args(annotation)] if get_origin(annotation) is Literal else []


def _names(member: Any) -> list[str]:
    """Names that pydantic may give a member of a union: class name, type text or discriminator tag."""
    names = [str(member), getattr(member, "__name__", "")]
    if _is_model(member):
        names += [tag for name in member.model_fields for tag in _tags_of(member, name)]
    return names
