"""A network from what a user types: ``id = "compass", sigma = 0.0088, xi = 0.7``."""

import re
from collections.abc import Mapping
from functools import cache
from typing import Any

from pydantic import TypeAdapter, ValidationError

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.faults import faults_from
from navcore.foundation.offered import when_changed
from navcore.foundation.text import Text
from navcore.foundation.written_toml import mended, read_toml_text
from navcore.networks.base import NetworkParameters
from navcore.networks.catalogue import NETWORKS, network_type
from navcore.networks.pasted import is_pasted, pasted

_EXAMPLE = Text('must be fields such as: id = "compass", sigma = 0.0088, xi = 0.7')


def parse_network(text_or_mapping: str | Mapping[str, Any], where: str = "network") -> NetworkParameters:
    """Read a network block.

    Parameters
    ----------
    text_or_mapping : str or mapping
        An id, the inside of an inline TOML table, a transfer function as `navcore.networks.pasted` reads it,
        or the fields themselves.
    where : str
        Place named in the faults.

    Raises
    ------
    InputError
        The text is not TOML, the id unknown, a field unknown, missing or out of range; one fault each.

    Examples
    --------
    >>> parse_network('id = "complementary", zeta = 0.7').damping_coefficient()
    0.7
    """
    if isinstance(text_or_mapping, str):
        data = _of_text(text_or_mapping, where)
    else:
        data = dict(text_or_mapping)
    try:
        return _adapter().validate_python(data)
    except ValidationError as error:
        raise InputError(faults_from(error, network_type(), data, where)) from None


@cache
def _adapter() -> TypeAdapter[Any]:
    return TypeAdapter(network_type())


when_changed(_adapter.cache_clear)


def _of_text(text: str, where: str) -> Any:
    """An id, a transfer function or its file, or the inside of an inline table."""
    if text in NETWORKS:
        return text
    fields = re.match(r"\s*(?:\{\s*)?\w+\s*=\s*[\"\d{]", text)
    return pasted(text, where) if is_pasted(text) and not fields else _table(text, where)


def _table(text: str, where: str) -> dict[str, Any]:
    inside = " ".join(text.split()).strip().removeprefix("{").removesuffix("}").strip().strip(",")
    try:
        document = read_toml_text(f"network = {{{mended(inside)}}}", where)
    except InputError:
        raise
    except ValueError as error:
        reason = str(error).split(" (at line")[0]
        raise InputError(
            Fault(where, "", text, Text("{example} ({reason})", example=_EXAMPLE, reason=reason))
        ) from None
    return document["network"]
