"""Times of a scenario in seconds or in hours, whichever its author counts in."""

from typing import Any

from pydantic import GetJsonSchemaHandler, model_validator

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.parameters import Parameters
from navcore.foundation.text import Text
from navcore.foundation.units import HOUR

_TWINS = {"t_h": "t_s", "t_s": "t_h", "duration_h": "duration_s", "duration_s": "duration_h"}


def in_other_unit(name: str) -> str:
    """Name of the same time in the other unit; empty for a field that is no such time.

    Examples
    --------
    >>> in_other_unit("duration_s"), in_other_unit("rate_hz")
    ('duration_h', '')
    """
    return _TWINS.get(name, "")


class EitherUnit(Parameters):
    """Block that takes its times in either unit: ``t_h`` or ``t_s``, ``duration_s`` or ``duration_h``."""

    @model_validator(mode="before")
    @classmethod
    def _in_own_unit(cls, data: Any) -> Any:
        for own in cls.model_fields:
            other = in_other_unit(own)
            if not isinstance(data, dict) or other not in data:
                continue
            value = data[other]
            if own in data:
                raise InputError(
                    Fault("", other, value, Text("give {own} or {other}, not both", own=own, other=other))
                )
            if type(value) in (int, float):
                value = value / HOUR if own.endswith("_h") else value * HOUR
            data = {key: item for key, item in data.items() if key != other} | {own: value}
        return data

    @classmethod
    def __get_pydantic_json_schema__(cls, schema: Any, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        """Properties of the fields, and of those that may stand in their place."""
        json_schema = handler(schema)
        properties = handler.resolve_ref_schema(json_schema)["properties"]
        for own in cls.model_fields:
            if other := in_other_unit(own):
                unit = "hours" if other.endswith("_h") else "seconds"
                text = f"The same as {own}, in {unit}. Not together with {own}."
                properties[other] = {"type": "number", "description": text}
        return json_schema
