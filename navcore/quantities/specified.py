"""Quantities in the words of a specification: ships' INS and gyrocompasses are bought by them.

A row that has ``over`` is a statistic over seeds; r is the horizontal position error of one seed.
"""

from navcore.foundation.text import Text
from navcore.quantities.errors import HEADING, POSITION, TILT
from navcore.quantities.quantity import Quantity

SPECIFIED = (
    Quantity(
        "position_cep50_m",
        {"seeds": Text("position CEP50")},
        "m",
        "m",
        Text("Median over the seeds of the position error at at_h, or at the end."),
        kind=POSITION,
        statistic="at",
        axes="vector",
        over="median",
    ),
    Quantity(
        "position_r95_m",
        {"seeds": Text("position R95")},
        "m",
        "m",
        Text("95th percentile over the seeds of the position error at at_h, or at the end."),
        kind=POSITION,
        statistic="at",
        axes="vector",
        over="p95",
    ),
    Quantity(
        "position_2drms_m",
        {"seeds": Text("position 2DRMS")},
        "m",
        "m",
        Text("Twice the root mean square over the seeds of the position error at at_h, or at the end."),
        kind=POSITION,
        statistic="at",
        axes="vector",
        over="2drms",
    ),
    Quantity(
        "position_trms_m",
        {"seeds": Text("position TRMS")},
        "m",
        "m",
        Text("Root mean square of the position error over time and seeds."),
        kind=POSITION,
        statistic="rms",
        axes="vector",
        over="rms",
    ),
    Quantity(
        "position_rate_cep_nmph",
        {"seeds": Text("position error rate CEP")},
        "m/s",
        "nmi/h",
        Text(
            "Median over the seeds of the slope of the least-squares line through the origin of the position "
            "error over time."
        ),
        kind=POSITION,
        statistic="rate",
        axes="vector",
        over="median",
    ),
    Quantity(
        "reset_interval_h",
        {"seeds": Text("reset interval")},
        "s",
        "h",
        Text(
            "Longest time up to which the position error stays within the limit, in the share of the seeds; "
            "it must reach at_h, or the end of the run."
        ),
        kind=POSITION,
        statistic="held",
        axes="vector",
        bounds="m",
    ),
    Quantity(
        "heading_seclat_rms_arcmin",
        {"run": Text("heading RMS, sec L, of this run")},
        "rad",
        "arcmin",
        Text("RMS of the heading error times the cosine of the latitude."),
        kind=HEADING,
        statistic="rms",
        axes="seclat",
    ),
    Quantity(
        "heading_seclat_max_arcmin",
        {"run": Text("largest heading error, sec L, of this run")},
        "rad",
        "arcmin",
        Text("Largest heading error times the cosine of the latitude."),
        kind=HEADING,
        statistic="max_abs",
        axes="seclat",
    ),
    Quantity(
        "roll_rms_arcmin",
        {"run": Text("roll RMS of this run")},
        "rad",
        "arcmin",
        Text("RMS of the error of roll: the misalignment in the ship's axes."),
        kind=TILT,
        statistic="rms",
        axes="roll",
    ),
    Quantity(
        "roll_max_arcmin",
        {"run": Text("largest roll error of this run")},
        "rad",
        "arcmin",
        Text("Largest error of roll: the misalignment in the ship's axes."),
        kind=TILT,
        statistic="max_abs",
        axes="roll",
    ),
    Quantity(
        "pitch_rms_arcmin",
        {"run": Text("pitch RMS of this run")},
        "rad",
        "arcmin",
        Text("RMS of the error of pitch: the misalignment in the ship's axes."),
        kind=TILT,
        statistic="rms",
        axes="pitch",
    ),
    Quantity(
        "pitch_max_arcmin",
        {"run": Text("largest pitch error of this run")},
        "rad",
        "arcmin",
        Text("Largest error of pitch: the misalignment in the ship's axes."),
        kind=TILT,
        statistic="max_abs",
        axes="pitch",
    ),
    Quantity(
        "heading_settled_h",
        {"run": Text("heading settled, of this run")},
        "s",
        "h",
        Text("Time of the third of the first three readings at intervals of 30 min within a band of 0.7°."),
        kind=HEADING,
        statistic="settled",
    ),
    Quantity(
        "settle_point_seclat_arcmin",
        {"run": Text("settle point error, sec L, of this run")},
        "rad",
        "arcmin",
        Text(
            "Magnitude of the mean heading error of ten readings at intervals of 20 min after settling, "
            "times the cosine of the latitude."
        ),
        kind=HEADING,
        statistic="point",
        axes="seclat",
    ),
    Quantity(
        "settle_spread_seclat_arcmin",
        {"run": Text("spread around the settle point, sec L, of this run")},
        "rad",
        "arcmin",
        Text("Root mean square of the differences of these ten readings to their mean, likewise."),
        kind=HEADING,
        statistic="spread",
        axes="seclat",
    ),
    Quantity(
        "settle_repeat_seclat_arcmin",
        {"seeds": Text("repeatability of the settle point, sec L")},
        "rad",
        "arcmin",
        Text("Largest difference of the settle points of two seeds that follow each other, likewise."),
        kind=HEADING,
        statistic="point",
        axes="seclat",
        over="repeat",
    ),
    Quantity(
        "heading_settling_s",
        {"loop": Text("heading settling")},
        "s",
        "min",
        Text(
            "Time after which the heading, 15° wrong at the start, stays within 0.7° of what it settles at; "
            "of the azimuth network's loop, or of the gyrocompass."
        ),
    ),
)
