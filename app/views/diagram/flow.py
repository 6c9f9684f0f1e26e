"""Flow charts of a decision and of its way back, with the method's values (Liu 9, 10; Sun 8, five states)."""

from typing import NamedTuple

from navcore.foundation.text import Text
from navcore.law.policy.adaptive import Adaptive
from navcore.law.policy.states import States
from navcore.law.policy.variation import Variation
from navcore.law.switching.ramp import Ramp
from navcore.law.switching.step import Step
from navcore.scenario.method import Method
from schuler_bench.plots import style
from schuler_bench.plots.svg_axes import word
from schuler_bench.plots.units import number
from schuler_bench.views.diagram.membership import picture

WIDTH, ROW, BOX, GAP = 780, 58, 132, 24
_HEIGHT, _TOP, _ROUND = 38, 30, 4


class Item(NamedTuple):
    """One box of a flow chart: up to two lines; a question has round ends."""

    first: str
    second: str = ""
    asks: bool = False


class Row(NamedTuple):
    """One line of a flow chart: what it is about, its boxes from the left, and what else happens."""

    title: str
    items: tuple[Item, ...]
    otherwise: str = ""


def rows(method: Method) -> tuple[Row, ...]:
    """Lines of the flow chart of a method; empty where no paper draws one.

    Parameters
    ----------
    method : Method
        As configured.
    """
    found = ()
    if isinstance(method.policy, Variation):
        found += (_decision(method.policy),)
        if isinstance(method.switching, Ramp):
            found += _ramp(method.switching)
    if isinstance(method.policy, Adaptive) and isinstance(method.switching, Step):
        found += _adaptive(method.policy, method.switching)
    if isinstance(method.policy, States):
        found += (_states(method.policy),)
    return found


def _decision(policy: Variation) -> Row:
    """Liu, figure 9."""
    return Row(
        Text("Damping switched on the variation (Liu, figure 9)"),
        (
            Item(
                Text("change s of the mean"),
                Text("n = {n} s, t₀ = {t0} s", n=number(policy.n_s), t0=number(policy.t0_s)),
            ),
            Item(Text("s ≤ {a}: damp", a=number(policy.a)), Text("s ≥ {c}: do not damp", c=number(policy.c))),
            Item(Text("wish other than"), Text("the present state?"), asks=True),
            Item(Text("count it: m + 1"), Text("m = {count}?", count=policy.count), asks=True),
            Item(Text("switch"), Text("m = 0")),
        ),
        Text("Between the limits the state is kept; a wish that agrees with it sets m = 0."),
    )


def _ramp(switching: Ramp) -> tuple[Row, ...]:
    """Liu, figure 10."""
    last = number(switching.duration_s - 1.0)
    return (
        Row(
            Text("Undamped to damped (Liu, figure 10)"),
            (
                Item(Text("clear the states"), Text("of the network")),
                Item(Text("ζ = ξ exp(m - {last})", last=last), Text("m = 0, 1, ... {last} s", last=last)),
                Item(Text("ζ = ξ")),
            ),
        ),
        Row(
            Text("Damped to undamped"),
            (
                Item(Text("shield the network")),
                Item(Text("keep the correction c"), Text("as it is")),
            ),
        ),
    )


def _adaptive(policy: Adaptive, switching: Step) -> tuple[Row, ...]:
    """Sun, figure 8."""
    laws = {
        "table": Text("table"),
        "quadratic": Text("(9), sign mended"),
        "as_printed": Text("(9) as printed"),
    }
    return (
        Row(
            Text("The damping ratio follows the difference (Sun, figure 8)"),
            (
                Item(Text("difference V_c - V_r"), Text("low-pass {tau} s", tau=number(policy.lowpass_s))),
                Item(Text("ζ wanted"), laws[policy.law]),
                Item(Text("other than"), Text("the present ζ?"), asks=True),
                Item(
                    Text("by at most {size}", size=number(switching.size)),
                    Text("every {every} s", every=number(switching.every_s)),
                ),
                Item(Text("tune the network"), Text("keep its output")),
            ),
            Text("Where it is the same, the network stays as it is."),
        ),
    )


def _states(policy: States) -> Row:
    """Sun's five states (Sun 2017, section 1); their rule is ours."""
    return Row(
        Text("Which of the five states (Sun, section 1)"),
        (
            Item(Text("mean of |a|"), Text("≤ {limit} m/s²?", limit=number(policy.limit_mps2)), asks=True),
            Item(
                "|V_r - V_c|",
                Text(
                    "≤ {limit} m/s for {returns} s?",
                    limit=number(policy.difference_mps),
                    returns=number(policy.return_s),
                ),
                asks=True,
            ),
            Item(Text("external damping")),
            Item(Text("no manoeuvre"), Text("for {settled} s?", settled=number(policy.settled_s)), asks=True),
            Item(Text("the azimuth too"), Text("whole damping")),
        ),
        Text("No at the first: undamped; at the second: internal damping; at the third: horizontal damping."),
    )


def flow_svg(method: Method) -> str:
    """Draw the flow chart of a method; empty where no paper draws one."""
    found = rows(method)
    if not found:
        return ""
    parts: list[str] = []
    y = 0.0
    for row in found:
        parts += _drawn(row, y)
        y += ROW + _TOP + (16 if row.otherwise else 0)
    return picture(WIDTH, int(y) + 6, Text("flow chart of the decision and of the way back"), parts)


def _drawn(row: Row, y: float) -> list[str]:
    """Shapes and words of one line that begins at a height."""
    parts = [word(2, y + 18, row.title)]
    top = y + _TOP
    for k, item in enumerate(row.items):
        x = 2 + k * (BOX + GAP)
        middle = x + BOX / 2
        rounding = _HEIGHT / 2 if item.asks else _ROUND
        parts.append(
            f'<rect x="{x}" y="{top}" width="{BOX}" height="{_HEIGHT}" rx="{rounding}" fill="none" '
            f'stroke="{style.REFERENCE}"/>'
        )
        if item.second:
            parts += [
                word(middle, top + 16, item.first, "middle"),
                word(middle, top + 31, item.second, "middle"),
            ]
        else:
            parts.append(word(middle, top + 23, item.first, "middle"))
        if k:
            at = top + _HEIGHT / 2
            parts.append(
                f'<path d="M{x - GAP} {at}H{x - 1}m-6 -4l6 4l-6 4" fill="none" stroke="{style.INK}"/>'
            )
            if row.items[k - 1].asks:
                parts.append(word(x - GAP / 2, at - 6, Text("yes"), "middle"))
    if row.otherwise:
        parts.append(word(2, top + _HEIGHT + 18, row.otherwise))
    return parts
