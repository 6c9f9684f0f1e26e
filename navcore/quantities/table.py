"""The table of quantities: name, unit, definition, of what each is judged, and how.

A row says *of what* a quantity is judged. *How* is one function of each room that judges:
`navcore.analysis.judged.loop_value` of a loop, `navcore.engine.measures.measure` of a run,
`navcore.engine.verdicts` of many seeds together, and `navcore.design.measures.measure` of an ensemble or of
the steady state.
"""

from navcore.foundation.text import Text
from navcore.foundation.units import UNITS
from navcore.quantities.errors import HEADING, POSITION, TILT, VELOCITY
from navcore.quantities.quantity import Quantity
from navcore.quantities.specified import SPECIFIED

_ROWS = (
    Quantity(
        "tilt_rms",
        {
            "steady": Text("steady tilt RMS per axis"),
            "ensemble": Text("ensemble tilt RMS per axis"),
        },
        "rad",
        "arcsec",
        Text("Root mean square of the tilt of one channel; over a run, of both."),
        kind=TILT,
        statistic="rms",
        axes="per_axis",
    ),
    Quantity(
        "velocity_rms",
        {
            "steady": Text("steady velocity RMS per axis"),
            "ensemble": Text("ensemble velocity RMS per axis"),
        },
        "m/s",
        "m/s",
        Text("Root mean square of the velocity error of one channel; over a run, of both."),
        kind=VELOCITY,
        statistic="rms",
        axes="per_axis",
    ),
    Quantity(
        "heading_rms",
        {"ensemble": Text("ensemble heading RMS")},
        "rad",
        "arcmin",
        Text("Root mean square of the heading error over the run."),
        kind=HEADING,
        statistic="rms",
    ),
    Quantity(
        "position_rms",
        {"ensemble": Text("ensemble position RMS")},
        "m",
        "m",
        Text("Root mean square of the horizontal position error over the run."),
        kind=POSITION,
        statistic="rms",
        axes="vector",
    ),
    Quantity(
        "settling_s",
        {"loop": Text("settling")},
        "s",
        "min",
        Text("Last time at which the tilt after an initial tilt exceeds 2 % of it."),
    ),
    Quantity(
        "overshoot",
        {"loop": Text("velocity after log step")},
        "m/s",
        "m/s",
        Text("Largest velocity error after a step of the log's error by 1 m/s; 0 for a method without log."),
    ),
    Quantity(
        "log_tilt",
        {"loop": Text("tilt after log step")},
        "rad",
        "arcsec",
        Text("Largest tilt after a step of the log's error by 1 m/s; 0 for a method without log."),
    ),
    Quantity(
        "worst_tilt",
        {"loop": Text("worst tilt, log ±1 m/s")},
        "rad",
        "arcsec",
        Text(
            "Largest tilt of one channel that a log can cause whose error stays within 1 m/s, however it "
            "changes; 0 for a method without log."
        ),
    ),
    Quantity(
        "worst_velocity",
        {"loop": Text("worst velocity error, log ±1 m/s")},
        "m/s",
        "m/s",
        Text(
            "Largest velocity error of one channel that a log can cause whose error stays within 1 m/s, "
            "however it changes; 0 for a method without log."
        ),
    ),
    Quantity(
        "tilt_overshoot",
        {"loop": Text("tilt overshoot")},
        "",
        "%",
        Text("Largest swing to the other side of the tilt after an initial tilt, as a part of that tilt."),
    ),
    Quantity(
        "damping_ratio",
        {"loop": Text("damping ratio")},
        "",
        "",
        Text("Smallest damping ratio -Re/|p| of the closed-loop poles."),
        sense=">=",
    ),
    Quantity(
        "h0",
        {"loop": "H(0)"},
        "",
        "",
        Text("Gain of the network for constant errors."),
        sense="",
        signed=True,
    ),
    Quantity(
        "h0_deviation",
        {"loop": "|H(0) - 1|"},
        "",
        "",
        Text(
            "How far the network's gain for constant errors is from 1: beyond it the loop is not "
            "Schuler-tuned."
        ),
    ),
    Quantity(
        "h_slope_s",
        {"loop": "H'(0)"},
        "s",
        "s",
        Text(
            "Slope of the network at s = 0. With H(0) = 1 and a slope of 0 or less the 24 h mode "
            "of the whole "
            "system does not grow; a negative slope damps it. The placement in the tab Poles keeps to it."
        ),
        signed=True,
        typical=100.0,
    ),
    Quantity(
        "earth_mode_growth_per_s",
        {"loop": Text("growth of the 24 h mode")},
        "1/s",
        "1/s",
        Text("Growth of the 24 h mode of the whole system at the site; negative when it decays."),
        signed=True,
    ),
    Quantity(
        "growth_per_s",
        {"loop": Text("growth of the whole system")},
        "1/s",
        "1/s",
        Text(
            "Fastest growth of both channels with heading and latitude along the motion, as the law is "
            "sampled and the log's difference is held; negative when all decay. Longitude is left out."
        ),
        signed=True,
    ),
    Quantity(
        "tilt_max_arcsec",
        {"run": Text("largest tilt of this run")},
        "rad",
        "arcsec",
        Text("Largest length of the tilt in this run, over what Metrics (tab Errors) measures."),
        kind=TILT,
        statistic="max_abs",
        axes="vector",
    ),
    Quantity(
        "tilt_rms_arcsec",
        {"run": Text("tilt RMS per axis of this run")},
        "rad",
        "arcsec",
        Text("RMS of the tilt per axis in this run, over what Metrics (tab Errors) measures."),
        kind=TILT,
        statistic="rms",
        axes="per_axis",
    ),
    Quantity(
        "velocity_max_mps",
        {"run": Text("largest velocity error of this run")},
        "m/s",
        "m/s",
        Text("Largest length of the velocity error in this run, over what Metrics (tab Errors) measures."),
        kind=VELOCITY,
        statistic="max_abs",
        axes="vector",
    ),
    Quantity(
        "velocity_rms_mps",
        {"run": Text("velocity RMS per axis of this run")},
        "m/s",
        "m/s",
        Text("RMS of the velocity error per axis in this run, over what Metrics (tab Errors) measures."),
        kind=VELOCITY,
        statistic="rms",
        axes="per_axis",
    ),
    Quantity(
        "heading_max_arcmin",
        {"run": Text("largest heading error of this run")},
        "rad",
        "arcmin",
        Text("Largest heading error in this run, over what Metrics (tab Errors) measures."),
        kind=HEADING,
        statistic="max_abs",
    ),
    Quantity(
        "heading_rms_arcmin",
        {"run": Text("heading RMS of this run")},
        "rad",
        "arcmin",
        Text("RMS of the heading error in this run, over what Metrics (tab Errors) measures."),
        kind=HEADING,
        statistic="rms",
    ),
    Quantity(
        "position_rms_m",
        {"run": Text("position RMS of this run")},
        "m",
        "m",
        Text("RMS of the horizontal position error of this run, over what Metrics (tab Errors) measures."),
        kind=POSITION,
        statistic="rms",
        axes="vector",
    ),
    Quantity(
        "position_max_m",
        {"run": Text("largest position error of this run")},
        "m",
        "m",
        Text("Largest horizontal position error of this run, over what Metrics (tab Errors) measures."),
        kind=POSITION,
        statistic="max_abs",
        axes="vector",
    ),
    Quantity(
        "position_final_m",
        {"run": Text("position error at the end of this run")},
        "m",
        "m",
        Text("Horizontal position error at the end of what Metrics (tab Errors) measures."),
        kind=POSITION,
        statistic="final",
        axes="vector",
    ),
    *SPECIFIED,
)
QUANTITIES = {row.key: row for row in _ROWS}
"""All rows by key."""
TUNED = tuple(row.key for row in _ROWS if row.sense and not {"run", "seeds"} & row.names.keys())
"""Quantities that a search can measure, and so keep a limit of."""
OBJECTIVES = tuple(key for key in TUNED if QUANTITIES[key].sense == "<=")
"""Quantities that a search can make small."""
WEIGHED = tuple(key for key in OBJECTIVES if not QUANTITIES[key].signed)
"""Objectives of which there are ratios: a Pareto front can have them on its axes."""
LIMITED = (
    "tilt_max_arcsec",
    "tilt_rms_arcsec",
    "velocity_max_mps",
    "velocity_rms_mps",
    "heading_max_arcmin",
    "heading_rms_arcmin",
    "position_max_m",
    "position_rms_m",
    "position_final_m",
    "settling_s",
    "growth_per_s",
    "tilt_overshoot",
    "damping_ratio",
    "h0_deviation",
    "h_slope_s",
    "log_tilt",
    "worst_tilt",
    "worst_velocity",
    *(row.key for row in SPECIFIED),
)
"""Quantities of a ``[[requirement]]``."""


def value_unit(key: str) -> float:
    """SI value of the unit of a row of `LIMITED` in files: that in its name, else that on the page.

    Examples
    --------
    >>> value_unit("heading_max_arcmin") == UNITS["arcmin"], value_unit("velocity_max_mps")
    (True, 1.0)
    >>> value_unit("tilt_overshoot"), value_unit("reset_interval_h")
    (0.01, 3600.0)
    """
    return UNITS.get(key.rpartition("_")[2], QUANTITIES[key].size)


def limit_unit(key: str) -> float:
    """SI value of the unit of a limit that is given as a number, of a row of `LIMITED`.

    Examples
    --------
    >>> limit_unit("heading_max_arcmin") == value_unit("heading_max_arcmin")
    True
    >>> limit_unit("reset_interval_h")
    1.0
    """
    row = QUANTITIES[key]
    return UNITS[row.bounds] if row.bounds else value_unit(key)


def limit_unit_name(key: str) -> str:
    """Name of that unit, as `navcore.foundation.with_unit` reads it; empty for a plain number.

    Examples
    --------
    >>> limit_unit_name("heading_max_arcmin"), limit_unit_name("position_rate_cep_nmph")
    ('arcmin', 'kn')
    """
    row, size = QUANTITIES[key], limit_unit(key)
    suffix = key.rpartition("_")[2]
    if row.bounds or suffix not in UNITS:
        return row.bounds or {"nmi/h": "kn"}.get(row.shown, row.shown)
    return suffix if size != row.size or row.shown == suffix else row.shown


def value_unit_name(key: str) -> str:
    """Name of the unit of a row of `LIMITED` in files; empty for a plain number.

    Examples
    --------
    >>> value_unit_name("position_rate_cep_nmph"), value_unit_name("reset_interval_h")
    ('nmi/h', 'h')
    """
    suffix, row = key.rpartition("_")[2], QUANTITIES[key]
    return suffix if suffix in UNITS and row.unit != "1/s" else row.shown


def searched(key: str) -> Quantity | None:
    """Return the row that a search measures for a limit: that of the ensemble in the place of one run's."""
    own, rows = QUANTITIES[key], [QUANTITIES[name] for name in TUNED]
    how = own.kind, own.statistic, own.axes
    return next(
        (row for row in rows if row is own or (own.kind and how == (row.kind, row.statistic, row.axes))), None
    )
