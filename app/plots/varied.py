"""Labels of the quantities that a sweep or a study varies, and of their values."""

from collections.abc import Mapping

from navcore.foundation.notation import symbol
from navcore.foundation.text import Text
from schuler_bench.plots.units import number

SWEPT = {
    "latitude": (Text("latitude"), Text("latitude (°)")),
    "log_bias": (Text("error of the log"), Text("constant error of the log (m/s)")),
    "grade": (Text("grade of the sensors"), Text("errors of gyros and accelerometers, times their own")),
    "sea": (Text("sea state"), Text("significant wave height (m)")),
}
"""Quantity of `navcore.study.sweep.KEYS`, alone and as the label of its axis."""


def varied_label(column: str) -> str:
    """Label of the axis of a factor: of a sweep's quantity in words, of a field its parameter's symbol."""
    if column in SWEPT:
        return SWEPT[column][1]
    return symbol(column.rsplit(".", 1)[-1]) if "." in column else column


def factors_text(values: Mapping[str, float | str]) -> str:
    """Values of factors, each behind its label."""
    return Text.joined(
        ", ",
        (
            Text("{name} = {value}", name=varied_label(key), value=value_text(at))
            for key, at in values.items()
        ),
    )


def value_text(value: float | str) -> str:
    """Value of a factor: a number, also one that stands as a text in the results, in three digits."""
    try:
        return number(float(value), 3)
    except ValueError:
        return str(value)
