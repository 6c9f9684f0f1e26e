"""The loop of a method as blocks and lines: what stands where, with the values in force.

The figures of the papers, in one form for all kinds of damping: Deng 1 to 4, Liu 1, 2, 6, 9 and 10, Sun 1, 2
and 5 to 9 (theory.md 3).
"""

from collections.abc import Iterator

from navcore.averaging.copies import copies_of
from navcore.foundation.earth import EARTH_RATE
from navcore.foundation.notation import symbol, with_unit
from navcore.foundation.parameters import extra_of
from navcore.foundation.text import Text
from navcore.foundation.units import HOUR, MINUTE
from navcore.networks.base import NetworkParameters
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from schuler_bench.plots.units import number
from schuler_bench.views.diagram.parts import (
    HIGH,
    LOG,
    LOW,
    METHOD,
    SENSORS,
    WIDTH,
    Block,
    Diagram,
    Line,
    Part,
    State,
    Sum,
    Switch,
    Word,
)
from schuler_bench.views.diagram.platform import platform, platform_height

_LINE, _BRANCH = 84, 166
"""Height of the main line, and of the damping below it."""
_COPIES, _COPY = 214, 82
"""Line of the first copy of a navigation, and from one to the next."""
_SHEET = 34
"""From one copy of a cascade to the next, px."""
_BELOW = 30
"""Room below the last copy."""
_LETTERS = 21
"""In a line of the network's block."""


def diagram(scenario: Scenario, index: int, state: State | None = None) -> Diagram:
    """Lay out the loop of a method.

    Parameters
    ----------
    scenario : Scenario
        Gives sensors, log and site.
    index : int
        Which method.
    state : State, optional
        What its law does at the moment that is shown.
    """
    method = scenario.method[index]
    state = state or State()
    found = Diagram(method.label(), method.kind.description(method))
    found.parts += _level(scenario, method)
    if method.kind.carrying == "filter":
        found.parts += _filter(scenario)
    elif method.kind.carrying == "copies":
        found.parts += _copies(scenario, method)
    elif method.kind.uses_network:
        found.parts += _damping(scenario, method, state)
    found.height = HIGH if found.decides or method.kind.carrying != "law" else LOW
    if method.kind.carrying == "copies":
        found.height = max(part.y + part.height for part in found.parts if isinstance(part, Block)) + _BELOW
    if method.kind.azimuth(method, scenario.omega_s) is not None:
        found.parts += _azimuth(scenario, method, found.height)
        found.height += LOW
    if scenario.run.fidelity == "strapdown":
        found.parts += platform(scenario, method, found.height)
        found.height += platform_height(method)
    return found


def _level(scenario: Scenario, method: Method) -> Iterator[Part]:
    """Accelerometer, velocity, transport rate, tilt, and the gravity that a tilt feeds back."""
    y = _LINE
    which = Text("level channels, east and north alike")
    if scenario.run.fidelity == "channel":
        which = Text("one level channel")
    elif method.gyrocompass is not None:
        which = Text("east channel; the north one turns the heading")
    yield Word(8, 20, which, "start", True)
    yield Block(8, y - 20, 104, 40, (Text("accelerometer"), "f + ∇"), SENSORS)
    yield Line(((112, y), (131, y)))
    yield Sum(140, y, ("top",))
    yield Line(((149, y), (166, y)))
    yield Block(166, y - 18, 44, 36, ("1/s",))
    if method.kind.uses_network or method.kind.carrying == "filter":
        yield Line(((210, y), (471, y)))
        yield Sum(480, y)
        yield Line(((489, y), (522, y)))
    else:
        yield Line(((210, y), (522, y)))
    yield Word(246, y - 8, "V_c")
    if method.kind.uses_network:
        yield Word(505, y - 8, "V*")
    yield Block(522, y - 18, 48, 36, ("1/R",))
    yield Line(((570, y), (595, y)))
    yield Sum(604, y)
    yield Block(556, y + 58, 96, 40, (Text("gyro"), "−ε"), SENSORS)
    yield Line(((604, y + 58), (604, y + 9)))
    yield Line(((613, y), (634, y)))
    yield Block(634, y - 18, 44, 36, ("1/s",))
    yield Line(((678, y), (WIDTH - 12, y)))
    yield Word(WIDTH - 34, y - 8, Text("tilt φ"))
    yield Line(((704, y), (704, 32), (434, 32)))
    yield Block(390, 16, 44, 32, ("g",))
    yield Line(((390, 32), (140, 32), (140, y - 9)))


def _damping(scenario: Scenario, method: Method, state: State) -> Iterator[Part]:
    """Difference to the log, network, switch, and who decides."""
    y, main = _BRANCH, _LINE
    yield Line(((228, main), (228, y - 9)), own=True)
    log = _log(scenario, y) if method.kind.uses_log else None
    yield from _compared(y, log, "V_r")
    network = method.kind.network(method)
    acting = method.kind.acting(network.transfer(scenario.omega_s))
    values = _values(network, scenario.omega_s, state.coefficient)
    lines = ("1 − H(s)", network.id, *values)
    if acting.realisation != "network":
        fed_back = ("G(s)",)  # the second output of a network
        if acting.feedback_p is None:
            gains = network.values(scenario.omega_s)
            k1, *others = (_value(network, name, gains.get(name)) for name in ("k1", "k2", "k3"))
            lines = ("−(K₂ + K₃/s)", network.id, *values, *_pairs(others))
            fed_back = tuple(k1.split(" ")[:2])
        yield Line(((246, y), (246, y - 36), (214, y - 36)), own=True)
        yield Block(154, y - 53, 60, 34, fed_back, METHOD, own=True)
        yield Line(((154, y - 36), (140, y - 36), (140, main + 9)), own=True)
    height = 22.0 + 15.0 * (len(lines) - 1)
    yield Block(264, y - 18, 136, height, lines, METHOD, own=True)
    yield from _through_switch(y, main)
    if method.policy.id != "constant" or (scenario.reference.interrupted and method.kind.referenced):
        yield from _decision(method, y)


def _compared(y: float, log: Block | None, name: str, *above: Line) -> Iterator[Part]:
    """Difference to the log, if there is one, from the signal that comes from above."""
    if log is not None:
        yield log
        yield Line(((112, y), (219, y)), own=True)
        yield Word(166, y - 7, name)
    yield from above
    yield Sum(228, y, ("top",))
    yield Line(((237, y), (264, y)), own=True)


def _through_switch(y: float, main: float) -> Iterator[Part]:
    """From a network through the switch up into a line."""
    yield Line(((400, y), (418, y)), own=True, arrow=False)
    yield Switch(418, y)
    yield Line(((454, y), (480, y), (480, main + 9)), own=True)


def _decision(method: Method, y: float) -> Iterator[Part]:
    """Who decides, and how the passage is made."""
    low = y + 66
    yield Block(418, low - 15, 118, 46, (Text("switching"), method.switching.id), METHOD, own=True)
    yield Line(((436, low - 15), (436, y + 8)), dashed=True)
    yield Block(
        110, low - 15, 130, 46, (Text("policy"), method.policy.id.replace("_", " ")), METHOD, own=True
    )
    if method.policy.id != "constant":
        yield Line(((228, y + 9), (228, low - 15)), dashed=True)
    yield Line(((240, low + 20), (418, low + 20)), dashed=True)


def _filter(scenario: Scenario) -> Iterator[Part]:
    """A Kalman filter in the place of network and switch."""
    y = _BRANCH
    yield Line(((228, _LINE), (228, y - 9)), own=True)
    yield from _compared(y, _log(scenario, y), "V_r")
    yield Block(264, y - 22, 136, 44, (Text("Kalman filter"), Text("K of its covariance")), METHOD, own=True)
    yield Line(((400, y), (480, y), (480, _LINE + 9)), own=True)
    yield Word(440, y - 7, "δV, φ, ε")
    yield Line(((440, y), (440, y + 56), (716, y + 56), (716, _LINE + 4)), own=True)
    yield Word(580, y + 50, Text("corrections of velocity, attitude and drifts"), muted=True)


def _copies(scenario: Scenario, method: Method) -> Iterator[Part]:
    """Averaged copies of a free navigation: Zhao's B, C and D, or a cascade."""
    site = scenario.site.site()
    copies = copies_of(method.settings, scenario.omega_s, site.lat, site.height, scenario.earth)
    if copies.level == copies.slow:
        if len(copies.ahead_s) == 2:
            lines = (Text("copy C, begun {ahead} ahead", ahead=ahead_words(copies.ahead_s[1])), "e^(sT_s/2)")
            yield from _copy(_COPIES, lines, ("½ (B + C)",), WIDTH - 88.0, WIDTH - 48.0)
            return
        yield from _cascade(tuple(ahead_words(ahead) for ahead in copies.ahead_s[1:]))
        return
    _, half, day = (ahead_words(ahead) for ahead in copies.ahead_s)
    lines = (Text("copy C, begun {ahead} ahead", ahead=half), "e^(sT_s/2)")
    yield from _copy(_COPIES, lines, ("½ (B + C)", Text("velocity, tilt")), 626.0, 716.0)
    lines = (Text("copy D, begun {ahead} ahead", ahead=day), "e^(sT_e/2)")
    yield from _copy(_COPIES + _COPY, lines, ("½ (B + D)", Text("position, heading")), 642.0, WIDTH - 20.0)


def _cascade(ahead: tuple[str, ...]) -> Iterator[Part]:
    """Each copy of a cascade, and the mean of all with the main navigation."""
    bus, left = 560.0, WIDTH - 88.0
    lowest = _COPIES + _SHEET * (len(ahead) - 1)
    for place, lead in enumerate(ahead):
        y = _COPIES + _SHEET * place
        words = Text("copy {letter}, begun {ahead} ahead", letter=chr(ord("C") + place), ahead=lead)
        yield Block(264, y - 13, 236, 26, (words,), METHOD, own=True)
        yield Line(((500, y), (bus, y)), own=True)
    if len(ahead) > 1:
        yield Line(((bus, lowest), (bus, _COPIES)), own=True)
    yield Line(((bus, _COPIES), (left, _COPIES)), own=True)
    yield Word(382, lowest + 31, Text("the same navigation on forecast sensors"), muted=True)
    yield Block(left, _COPIES - 24, 80, 48, (Text("mean"), f"1/{len(ahead) + 1} Σ"), METHOD, own=True)
    yield Line(((WIDTH - 48.0, _LINE), (WIDTH - 48.0, _COPIES - 24)), own=True)


def _copy(
    y: float, lines: tuple[str, ...], mean: tuple[str, ...], left: float, down: float
) -> Iterator[Part]:
    """One copy, and the mean with the main navigation: its left edge, and where that comes down (px)."""
    width = 80.0 if left > 660.0 else 120.0
    yield Block(264, y - 24, 236, 48, lines, METHOD, own=True)
    yield Line(((500, y), (left, y)), own=True)
    yield Word(382, y + 42, Text("the same navigation on forecast sensors"), muted=True)
    yield Block(left, y - 24, width, 48, mean, METHOD, own=True)
    yield Line(((down, _LINE), (down, y - 24)), own=True)


def ahead_words(seconds: float) -> str:
    """How far a copy is ahead, in minutes or hours."""
    if seconds < HOUR * 2.0:
        return with_unit(f"{seconds / MINUTE:.1f}", "min")
    return with_unit(f"{seconds / HOUR:.2f}", "h")


def _azimuth(scenario: Scenario, method: Method, top: float) -> Iterator[Part]:
    """The azimuth channel below the level ones: Y(s), or a gyrocompass."""
    y, low = top + _LINE, top + _BRANCH
    yield Word(8, top + 30, Text("azimuth channel: error of the heading"), "start", True)
    yield Block(8, y - 22, 202, 44, ("ω_U", "Ω sin L_c + V_E tan L_c/R"))
    yield Line(((210, y), (471, y)))
    yield Sum(480, y)
    yield Line(((489, y), (595, y)))
    yield Word(540, y - 8, "ω_U + c_U")
    yield Sum(604, y)
    yield Block(556, y + 58, 96, 40, (Text("gyro"), "−ε_U"), SENSORS)
    yield Line(((604, y + 58), (604, y + 9)))
    yield Line(((613, y), (634, y)))
    yield Block(634, y - 18, 44, 36, ("1/s",))
    yield Line(((678, y), (WIDTH - 12, y)))
    yield Word(WIDTH - 34, y - 8, "φ_U")
    own = method.gyrocompass
    if own is not None:
        yield Block(8, low - 20, 204, 40, (Text("north difference to the log"), "V_cN − V_rN"), LOG)
        lines = (
            "K_U3/(Ω cos L (s + K_U4))",
            Text("gyrocompass"),
            f"σ {number(own.sigma, 3)} 1/s, ζ {number(own.xi, 3)}",
            *_pairs(
                [
                    f"K_U{k} {number(gain, 3)}"
                    for k in range(1, 5)
                    if (gain := getattr(own, f"k{k}")) is not None
                ]
            ),
        )
        yield Line(((212, low), (264, low)), own=True)
        yield Block(264, low - 20, 178, 26.0 + 15.0 * (len(lines) - 1), lines, METHOD, own=True)
        yield Line(((442, low), (480, low), (480, y + 9)), own=True)
        yield Word(500, low - 26, "w", "start")
        return
    network = method.azimuth
    log = Block(8, low - 22, 104, 44, (Text("log"), "L_r, V_r"), LOG) if method.kind.uses_log else None
    yield from _compared(low, log, "ω_Ur", Line(((228, y), (228, low - 9)), own=True))
    lines = ("1 − Y(s)", network.id, *_values(network, EARTH_RATE, None))
    yield Block(264, low - 18, 136, 22.0 + 15.0 * (len(lines) - 1), lines, METHOD, own=True)
    yield from _through_switch(low, y)


def _log(scenario: Scenario, y: float) -> Block:
    return Block(8, y - 20, 104, 40, (Text("log"), _log_words(scenario)), LOG)


def _log_words(scenario: Scenario) -> str:
    reference = scenario.reference
    if reference.kind == "log":
        return with_unit(f"{reference.rate_hz:g}", "Hz")
    return Text("recorded") if reference.kind == "file" else Text("no error")


def _values(network: NetworkParameters, omega_s: float, coefficient: float | None) -> Iterator[str]:
    """Values that were given, two in a line; where a policy sets the coefficient, that one in force."""
    if coefficient is not None:
        yield Text("ζ {value} now", value=number(coefficient, 3))
        return
    values = network.values(omega_s)
    given = [name for name in type(network).model_fields if getattr(network, name, None) is not None]
    words = [_value(network, name, values.get(name)) for name in given]
    yield from _pairs([word for word in words if word])


def _value(network: NetworkParameters, name: str, value: object) -> str:
    """A number with its symbol and unit; empty for anything else."""
    info = type(network).model_fields[name]
    if isinstance(value, bool) or not isinstance(value, int | float):
        return ""
    unit = str(extra_of(info).get("unit", ""))
    return with_unit(f"{symbol(name)} {number(float(value), 3)}", "" if unit == "1" else unit)


def _pairs(words: list[str]) -> Iterator[str]:
    """Two words in a line where they fit, four lines at most."""
    lines: list[str] = []
    for word in words:
        if lines and "," not in lines[-1] and len(lines[-1]) + 2 + len(word) <= _LETTERS:
            lines[-1] = f"{lines[-1]}, {word}"
        else:
            lines.append(word)
    yield from lines[:4]
