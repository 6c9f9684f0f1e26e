"""Add a class to the program while it runs: on the page, in commands, studies and on a cluster."""

import types
from collections.abc import Callable, Iterator
from typing import Any, Literal, NamedTuple, NoReturn, TypeVar, get_args

from pydantic.fields import FieldInfo

from navcore.damping import KINDS
from navcore.damping.base import Carrying, Covering, Damping
from navcore.damping.user import damping_of
from navcore.extending.added import ADDED, COLLECTED, Added
from navcore.extending.baggage import packed
from navcore.foundation import guarded
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.offered import give_field, offer, remake
from navcore.foundation.parameters import Parameters
from navcore.foundation.records import record_type
from navcore.foundation.registry import Registry, place_of, same_class
from navcore.foundation.text import Text
from navcore.io.formats import FORMATS
from navcore.law.added_code import room_faults
from navcore.law.hosted import UserLaw
from navcore.law.policy import POLICIES, PolicyParameters
from navcore.law.switching import SWITCHINGS, SwitchingParameters
from navcore.motion import MOTIONS, MotionParameters
from navcore.networks import NETWORKS, NetworkParameters
from navcore.scenario import model as _  # its fields must be there to be changed  # noqa: F401
from navcore.scenario.method import Method
from navcore.sensors import imu_errors, log_errors
from navcore.sensors.base import Apart
from navcore.sensors.imu import Imu
from navcore.sensors.imu_errors.base import ImuTerm
from navcore.sensors.log_errors.base import LogTerm
from navcore.sensors.reference import Reference

_Thing = TypeVar("_Thing")


class _Kind(NamedTuple):
    """What can be added: what it is derived from, what is wrong with one, and how it is added."""

    what: str
    base: type
    lacks: Callable[[Any], Iterator[str]]
    add: Callable[[Any], str]


def register(thing: _Thing) -> _Thing:
    """Add a class of your own to the program.

    It is offered everywhere at once: in scenarios, on the page, by the commands, in studies and searches, and
    in every process that computes for this one. May be used as a decorator. A class that is defined anew, as
    when a notebook's cell is run again, takes the place of its earlier form.

    Parameters
    ----------
    thing : type or module
        A class derived from `NetworkParameters`, `PolicyParameters`, `SwitchingParameters`,
        `MotionParameters` (`SampledMotion`), `Damping`, `ImuTerm` or `LogTerm`; or an import format: a module
        or class with ``recognises(candidate)`` and ``read(path)``.

    Returns
    -------
    type or module
        The same.

    Raises
    ------
    InputError
        It lacks a part, or its id is in use; named with the class, its file and line. Nothing is added then.

    Examples
    --------
    >>> from typing import Literal
    >>> import navcore
    >>> from navcore.networks.base import NetworkParameters, linear_network
    >>> @navcore.register
    ... class Lead(NetworkParameters):
    ...     id: Literal["lead"] = "lead"
    ...
    ...     def transfer(self, omega_s):
    ...         return linear_network("lead", omega_s, [10.0, 7.0], [1.0, 7.0])
    >>> navcore.parse_network("lead").transfer(1.24e-3).h0
    1.0
    """
    try:
        _add(thing)
    except InputError as error:
        if (into := COLLECTED.get()) is None:
            raise
        into += error.faults
    return thing


def _add(thing: Any) -> None:
    kind = _kind_of(thing)
    if kind is None:
        known = Text.joined(", ", (each.base.__name__ for each in _KINDS))
        _refuse(thing, Text("must be derived from one of {known}, or have recognises and read", known=known))
    lacks = [*kind.lacks(thing)]
    if lacks:
        raise InputError(_fault(thing, why) for why in lacks)
    try:
        name = kind.add(thing)
    except TypeError as error:  # of a registry: the name
        _refuse(thing, str(error).partition(": ")[2] or str(error))
    ADDED[:] = [one for one in ADDED if (one.what, one.name) != (kind.what, name)]
    ADDED.append(Added(kind.what, name, thing))
    guarded.take_along(packed)


def _kind_of(thing: Any) -> _Kind | None:
    for kind in _KINDS:
        if isinstance(thing, type) and issubclass(thing, kind.base):
            return kind
    return _FORMAT if hasattr(thing, "recognises") and hasattr(thing, "read") else None


def _fault(thing: Any, why: str) -> Fault:
    return Fault(place_of(thing), getattr(thing, "__name__", type(thing).__name__), None, why)


def _refuse(thing: Any, why: str) -> NoReturn:
    raise InputError(_fault(thing, why))


# ------------------------------------------------------------ what a class may lack


def _unwritten(thing: Any) -> Iterator[str]:
    """Methods that the base leaves to the class."""
    for name in sorted(getattr(thing, "__abstractmethods__", ())):
        yield Text("must define {name}()", name=name)


def _network_lacks(thing: Any) -> Iterator[str]:
    if thing.transfer is NetworkParameters.transfer:
        yield Text("must define {name}()", name="transfer")


def _policy_lacks(thing: Any) -> Iterator[str]:
    if not hasattr(thing, "decide"):
        yield Text("must have {name}: a function that numba compiles", name="decide")
    yield from room_faults(thing)


def _switching_lacks(thing: Any) -> Iterator[str]:
    if not hasattr(thing, "switch"):
        yield Text("must have {name}: a function that numba compiles", name="switch")
    if thing.history != record_type():
        yield Text("history must stay empty: a class from outside the program adds nothing to the history")
    yield from room_faults(thing)


def _damping_lacks(thing: Any) -> Iterator[str]:
    for name in ("id", "help"):
        if not isinstance(getattr(thing, name, None), str):
            yield Text("must have {name}: a text", name=name)
    for name, words in (("carrying", get_args(Carrying)), ("covering", get_args(Covering))):
        if getattr(thing, name) not in words:
            yield Text("{name} must be one of {words}", name=name, words=", ".join(words))
    settings, name = thing.settings, getattr(thing, "id", "")
    if settings is not None and not (isinstance(settings, type) and issubclass(settings, Parameters)):
        yield Text("settings must be a class derived from Parameters")
    elif name in Method.model_fields and name not in KINDS:
        yield Text('id "{id}" is the name of a field of a method', id=name)


def _term_lacks(block: type[Parameters], terms: list[Any]) -> Callable[[Any], Iterator[str]]:
    def lacks(thing: Any) -> Iterator[str]:
        yield from _unwritten(thing)
        before = next(
            (one.term for one in terms if isinstance(one, Apart) and same_class(one.term, thing)), None
        )
        for name in thing.model_fields:
            if name in block.model_fields and (before is None or name not in before.model_fields):
                yield Text('field "{name}" is used twice: {block} has one', name=name, block=block.__name__)

    return lacks


def _format_lacks(thing: Any) -> Iterator[str]:
    for name in ("recognises", "read"):
        if not callable(getattr(thing, name)):
            yield Text("must define {name}()", name=name)


# ------------------------------------------------------------ how it is added


def _entry(registry: Registry[Any]) -> Callable[[Any], str]:
    def add(thing: Any) -> str:
        registry.add(thing)
        return registry.name_of(thing)

    return add


def _add_damping(thing: type[Damping]) -> str:
    before, known = tuple(KINDS), KINDS.get(thing.id)
    if known is not None and not same_class(type(known), thing):
        raise TypeError(f'{thing.__name__}: id "{thing.id}" is used twice')
    KINDS[thing.id] = thing()
    if thing.settings is not None:
        give_field(Method, thing.id, FieldInfo(annotation=thing.settings, default=thing.settings()))
        remake([Method])
    if known is None:
        info = Method.model_fields["damping"]
        about = Text("{about} {id}: {help}.", about=info.description, id=thing.id, help=thing.help)
        for model in (Method, *Method.__subclasses__()):
            model.model_fields["damping"].description = about
        offer(lambda annotation: Literal[tuple(KINDS)] if get_args(annotation) == before else None)
    return thing.id


def _term(block: type[Parameters], terms: list[Any]) -> Callable[[Any], str]:
    def add(thing: type[Parameters]) -> str:
        for name, info in thing.model_fields.items():
            give_field(block, name, info)
        remake([block])
        terms[:] = [one for one in terms if not (isinstance(one, Apart) and same_class(one.term, thing))]
        terms.append(Apart(thing))
        return ", ".join(thing.model_fields)

    return add


def _add_format(thing: Any) -> str:
    name = thing.__name__
    FORMATS[:] = [one for one in FORMATS if getattr(one, "__name__", one) != name]
    FORMATS.insert(0, thing)
    return name


def _law_lacks(thing: Any) -> Iterator[str]:
    yield from _unwritten(thing)
    yield from (
        _damping_lacks(damping_of(thing))
        if isinstance(getattr(thing, "id", None), str)
        else (Text("must have {name}: a text", name="id"),)
    )


def _add_law(thing: type[UserLaw]) -> str:
    return _add_damping(damping_of(thing))


_KINDS = (
    _Kind("network", NetworkParameters, _network_lacks, _entry(NETWORKS)),
    _Kind("policy", PolicyParameters, _policy_lacks, _entry(POLICIES)),
    _Kind("switching method", SwitchingParameters, _switching_lacks, _entry(SWITCHINGS)),
    _Kind("motion", MotionParameters, _unwritten, _entry(MOTIONS)),
    _Kind("law", UserLaw, _law_lacks, _add_law),
    _Kind("kind of damping", Damping, _damping_lacks, _add_damping),
    _Kind("sensor error", ImuTerm, _term_lacks(Imu, imu_errors.TERMS), _term(Imu, imu_errors.TERMS)),
    _Kind("log error", LogTerm, _term_lacks(Reference, log_errors.TERMS), _term(Reference, log_errors.TERMS)),
)
_FORMAT = _Kind("import format", types.ModuleType, _format_lacks, _add_format)
