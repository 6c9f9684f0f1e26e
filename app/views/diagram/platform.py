"""The mathematical platform of a strapdown system (Deng 2019, figures 3 and 4; Sun 2017, figure 9)."""

from collections.abc import Iterator

from navcore.foundation.text import Text
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from schuler_bench.views.diagram.parts import LOG, METHOD, SENSORS, WIDTH, Block, Line, Part, Word

_FORCE, _RATE, _LOG = 74.0, 150.0, 222.0
"""Lines of the specific force, of the rates, and of the log, from the top."""


def platform_height(method: Method) -> float:
    """Height of `platform`, px."""
    return _LOG + 30.0 if method.kind.uses_log else _RATE + 36.0


def platform(scenario: Scenario, method: Method, top: float) -> Iterator[Part]:
    """Attitude matrix C_b^n, what it turns, and the rate that turns it, below a diagram's ``top``."""
    force, rate = top + _FORCE, top + _RATE
    yield Word(8, top + 28, Text("mathematical platform"), "start", True)
    yield Block(8, force - 20, 104, 40, (Text("accelerometers"), "f^b"), SENSORS)
    yield Line(((112, force), (176, force)))
    yield Block(176, force - 20, 64, 40, ("C_b^n",))
    yield Line(((240, force), (330, force)))
    yield Word(285, force - 8, "f^n")
    yield Block(330, force - 18, 44, 36, ("1/s",))
    yield Line(((374, force), (560, force)))
    yield Word(404, force - 8, "V_c")
    yield Block(560, force - 20, 96, 40, ("1/R, 1/s", "L_c, λ_c"))
    yield Line(((656, force), (WIDTH - 12, force)))
    yield Word(WIDTH - 56, force - 8, Text("position"))
    acts = method.kind.uses_network
    yield Line(((470, force), (470, rate - 22)), own=acts)
    yield Word(478, force + 34, "V* = V_c + c" if acts else "V_c", "start")
    rates = ("ω_ie(L_c) + ω_en(V*)" if acts else "ω_ie(L_c) + ω_en(V_c)", Text("commanded rate"))
    yield Block(380, rate - 22, 176, 44, rates, METHOD if acts else "", own=acts)
    yield Line(((608, force + 20), (608, rate), (556, rate)))
    yield Line(((380, rate), (284, rate)))
    yield Word(332, rate - 8, "ω_in")
    yield Block(132, rate - 22, 152, 44, (Text("turns C_b^n by"), "ω_ib − ω_in"))
    yield Line(((208, rate - 22), (208, force + 20)))
    yield Block(8, rate - 20, 104, 40, (Text("gyros"), "ω_ib"), SENSORS)
    yield Line(((112, rate), (132, rate)))
    if method.kind.uses_log:
        yield from _log(scenario, top + _LOG)


def _log(scenario: Scenario, y: float) -> Iterator[Part]:
    """The log's velocity: turned by the computed heading where it is measured in the ship's axes."""
    told = Text("to the difference V_r − V_c above")
    if scenario.reference.frame == "body":
        yield Block(8, y - 20, 104, 40, (Text("log"), "V_r^b"), LOG)
        yield Line(((112, y), (176, y)), own=True)
        yield Block(176, y - 18, 64, 36, ("C_b^n",))
        yield Line(((240, y), (330, y)), own=True)
        yield Word(285, y - 8, "V_r^n")
    else:
        yield Block(8, y - 20, 104, 40, (Text("log"), "V_r^n"), LOG)
        yield Line(((112, y), (330, y)), own=True)
    yield Word(338, y + 4, told, "start", True)
