"""Requirements of a design: limits that the user sets, the measure of each, and who meets them."""

from dataclasses import dataclass

from pydantic import BaseModel, ConfigDict

from app.plots.limits import SIGNS
from navcore.engine.measures import measure
from navcore.engine.run import Run
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.parameters import allowed_range, extra_of, quantity
from navcore.foundation.text import Text
from navcore.quantities import ERRORS, QUANTITIES

_IN_SIGHT = 3.0


def _limit(key: str, *, le: float, ge: float = 0.0) -> float | None:
    """Declare the limit of a row of `navcore.quantities.QUANTITIES`, in the unit in which it is shown."""
    row = QUANTITIES[key]
    field = quantity(None, unit=row.shown, ge=ge, le=le, label=row.label, help=row.help)
    field.json_schema_extra["key"] = key
    return field


class Requirements(BaseModel):
    """Limits, None where there is none; each field's help defines the quantity.

    Attributes
    ----------
    settling_min, overshoot_percent, damping_ratio : float or None
    h0_deviation, h_slope_s, log_tilt_arcsec : float or None
        Of the linear loop.
    tilt_max_arcsec, velocity_rms_mps, position_rms_m : float or None
        Of the run.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    settling_min: float | None = _limit("settling_s", le=1e5)
    overshoot_percent: float | None = _limit("tilt_overshoot", le=1e3)
    damping_ratio: float | None = _limit("damping_ratio", le=1.0)
    h0_deviation: float | None = _limit("h0_deviation", le=1e3)
    h_slope_s: float | None = _limit("h_slope_s", ge=-1e6, le=1e6)
    log_tilt_arcsec: float | None = _limit("log_tilt", le=1e6)
    tilt_max_arcsec: float | None = _limit("tilt_max_arcsec", le=1e6)
    velocity_rms_mps: float | None = _limit("velocity_rms_mps", le=1e4)
    position_rms_m: float | None = _limit("position_rms_m", le=1e8)

    @property
    def limits(self) -> dict[str, float]:
        """Limits that are set, SI, by the key of the quantity."""
        asked = {row: getattr(self, name) for name, row in ROWS.items()}
        return {row.key: limit * row.size for row, limit in asked.items() if limit is not None}


ROWS = {name: QUANTITIES[extra_of(info)["key"]] for name, info in Requirements.model_fields.items()}
"""Row of `navcore.quantities.QUANTITIES` that each field limits."""


def label_of(name: str) -> str:
    """Label of a limit's box: what, sense and unit, e.g. ``settling ≤ (min)``."""
    row = ROWS[name]
    unit = Text(" ({shown})", shown=row.shown) if row.shown else ""
    return Text("{label} {signs}{unit}", label=row.label, signs=SIGNS[row.sense], unit=unit)


def read_limit(name: str, text: str) -> float | None:
    """Limit as typed; None for an empty text.

    Raises
    ------
    InputError
        Not a number, or outside what is allowed.
    """
    typed = text.strip().replace(",", ".")
    if not typed:
        return None
    allowed = Text(
        "{allowed_range}; leave it empty for no requirement",
        allowed_range=allowed_range(Requirements.model_fields[name]),
    )
    try:
        value = float(typed)
    except ValueError:
        raise InputError(
            Fault("", label_of(name), text, Text("must be a number: {allowed}", allowed=allowed))
        ) from None
    try:
        Requirements.model_validate({name: value})
    except ValueError:
        raise InputError(Fault("", label_of(name), text, allowed)) from None
    return value


@dataclass(frozen=True)
class Verdict:
    """One limit, and what the methods make of it.

    Attributes
    ----------
    name : str
        Field of `Requirements`.
    limit : float or None
        None: nothing is asked, the measured values stand alone.
    measured : tuple of float
        A value a method, in the limit's unit.
    passed : tuple of bool
        Whether each method meets it; True without a limit.
    """

    name: str
    limit: float | None
    measured: tuple[float, ...]
    passed: tuple[bool, ...]


def verdicts(run: Run, requirements: Requirements) -> tuple[Verdict, ...]:
    """Measure every method against every limit, in the order of the fields."""
    found = []
    for name, row in ROWS.items():
        limit = getattr(requirements, name)
        values = tuple(measure(method, row.key) / row.size for method in run.methods)
        passed = tuple(
            limit is None or (value <= limit if row.sense == "<=" else value >= limit) for value in values
        )
        found.append(Verdict(name, limit, values, passed))
    return tuple(found)


def error_limits(requirements: Requirements, run: Run) -> dict[str, float]:
    """Limits to draw in the error plots, SI: key of `app.views.errors.figure.error_plots` -> value.

    One that lies far above all curves is left out: it would press them flat.
    """
    asked, drawn = requirements.limits, {}
    for key in asked.keys() & {"tilt_max_arcsec", "position_rms_m"}:
        for error in ERRORS:
            largest = max(method.errors[error.name]["max_abs"] for method in run.methods)
            if error.name in QUANTITIES[key].errors and asked[key] <= _IN_SIGHT * largest:
                drawn[error.key] = asked[key]
    return drawn
