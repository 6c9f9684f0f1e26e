"""A ship's INS as it comes: damping carried on in pieces is that of the run on the whole recording."""

import math
import random
from collections.abc import Iterable
from pathlib import Path

import numpy as np
import pytest

from navcore.engine.damped_recording import damped_files
from navcore.engine.live.damping import LEAST_DELAY_S, LiveDamping, Piece
from navcore.engine.live.heard import Heard
from navcore.engine.live.sent import Sent
from navcore.engine.simulation import simulate
from navcore.foundation.errors import InputError
from navcore.scenario.model import Scenario
from tests.nmea import sentence
from tests.sentences import SECONDS, seconds

METHODS = [
    {"name": "unity2", "damping": "external", "network": {"id": "unity2", "zeta": 0.5}},
    {"name": "compass", "damping": "external", "network": {"id": "compass", "sigma": 0.0025, "xi": 0.7}},
]
OWN = {"damping": "external", "network": {"id": "classic2"}}


def live_scenario(
    methods: list[dict[str, object]] = METHODS, own: dict[str, object] | None = None
) -> Scenario:
    scenario = Scenario.parse({"reference": {"kind": "log"}, "method": methods})
    if own is None:
        return scenario
    damping = Scenario.parse({"reference": {"kind": "log"}, "method": [own]}).method[0]
    return scenario.model_copy(update={"ins": scenario.ins.model_copy(update={"damping": damping})})


def fed(
    live: LiveDamping,
    parts: Iterable[str],
    heard: Heard | None = None,
    sent: Sent | None = None,
    trim_s: float = math.inf,
) -> tuple[list[Piece], list[str], list[str]]:
    """Give texts one after the other; pieces, sentences sent on, and what was told."""
    heard = heard or Heard()
    pieces, lines, told = list[Piece](), list[str](), list[str]()
    for text in parts:
        reading = heard.add(text)
        if heard.ran_back:
            live.begin_anew("the times ran back")
            told.append(live.told)
        if reading is None:
            continue
        while (piece := live.advance(reading.recording)) is not None:
            pieces.append(piece)
            if sent is not None:
                lines += sent.lines(reading, piece, heard.pinned)
        if live.told and (not told or told[-1] != live.told):
            told.append(live.told)
        heard.forget_before(max(live.needed_from_s, reading.newest_s - trim_s))
    return pieces, lines, told


def in_parts(each: list[list[str]], most: int = 60) -> Iterable[str]:
    """Seconds of sentences in texts of a random length."""
    chance, k = random.Random(1), 0
    while k < len(each):
        count = chance.randint(1, most)
        yield "".join(f"{line}\n" for second in each[k : k + count] for line in second)
        k += count


def replay(
    folder: Path, each: list[list[str]], hours: float, own: dict[str, object] | None = None
) -> Scenario:
    file = folder / "line.nmea"
    file.write_text("".join(f"{line}\n" for second in each for line in second))
    ins = {"file": str(file)} | ({} if own is None else {"damping": own})
    return Scenario.parse(
        {
            "run": {"duration_h": hours, "output_step_s": 1.0},
            "ins": ins,
            "reference": {"kind": "file", "file": str(file)},
            "method": METHODS,
        }
    )


@pytest.mark.parametrize("own", [None, OWN], ids=["free", "damped itself"])
def test_live_is_the_replay(tmp_path: Path, own: dict[str, object] | None) -> None:
    each = seconds(SECONDS)
    for k in range(500, 800):  # the log is silent for five minutes
        each[k] = [line for line in each[k] if "VBW" not in line]
    pieces, lines, told = fed(LiveDamping(live_scenario(own=own)), in_parts(each), sent=Sent("unity2"))
    time_s = np.concatenate([piece.time_s for piece in pieces])
    assert told == ["the log is silent: undamped until it is heard again"]
    assert np.allclose(np.diff(time_s), 1.0) and len(time_s) >= SECONDS - LEAST_DELAY_S - 1.0
    run = simulate(replay(tmp_path, each, (len(time_s) - 1) / 3600.0, own))
    for method in run.methods:
        moved = np.concatenate([piece.moved[method.method.name] for piece in pieces])
        assert method.moved is not None and method.output is not None
        peak = np.abs(method.moved).max(axis=0)
        assert np.all(np.abs(moved[:, :7] - method.moved) <= 1e-4 * peak)
        damped = np.concatenate([piece.damped[method.method.name] for piece in pieces])
        assert np.allclose(damped[:, [0, 1, 4]], method.output[:, [0, 1, 4]], rtol=0.0, atol=1e-8)
        assert np.allclose(damped[:, 2:4], method.output[:, 2:4], rtol=0.0, atol=1e-3)
        assert np.array_equal(moved[:, 8], method.rows[:, 8]), "damped at other times"
        assert not moved[:, 8].all()
    # What is sent on are the sentences that `schuler damp` writes.
    (written,) = damped_files(run, run.methods[0]).values()
    expected = [line for line in written.split("\n") if line[:3] == "$IN"]
    assert len(lines) == len(expected) > 3000
    for line, other in zip(lines, expected, strict=True):
        ours, theirs = (one.partition("*")[0].split(",") for one in (line, other))
        for one, like in zip(ours, theirs, strict=True):
            # the last decimals are those of the smoothing's end
            assert abs(float(one) - float(like)) < 1e-3 if "." in like else one == like, (line, other)


def test_what_is_wrong_on_the_line_is_counted_and_passed_over() -> None:
    each = seconds(400)
    heard = Heard()
    each[50] += ["$INHDT,12.0,T*00", "no sentence", "$INRMC,2330"]
    each[200][0] = each[200][0].replace(",N,", ",S,")  # its checksum is wrong
    body = each[210][0][1:].partition("*")[0].split(",")
    body[3] = f"{float(body[3]) + 3.0:012.7f}"  # 3' off, with a right one
    each[210][0] = sentence(",".join(body))
    live = LiveDamping(live_scenario())
    pieces, _, told = fed(live, in_parts(each, 20), heard)
    assert heard.counts.malformed == 4 and heard.counts.sentences == 4 * 400 - 1, heard.counts
    assert not told and not live.restarts and live.left_out == 1
    assert sum(len(piece.time_s) for piece in pieces) >= 375
    moved = np.concatenate([piece.moved["unity2"] for piece in pieces])
    assert np.abs(moved[:, 3:5]).max() < 1.0


def test_a_second_receiver_does_not_take_the_place_of_the_first() -> None:
    each = seconds(300)
    other = [line.replace("$INRMC", "$GPRMC").replace("54", "55") for second in each for line in second[:1]]
    for k, line in enumerate(other):
        each[k].insert(2, sentence(line[1:].partition("*")[0]))
    for k in range(100, 130):  # the INS is silent, the other is not
        each[k] = [line for line in each[k] if "$GP" in line or "VBW" in line]
    heard, live = Heard(), LiveDamping(live_scenario())
    pieces, _, told = fed(live, in_parts(each, 20), heard)
    assert heard.pinned["position"] == "IN"
    lat = np.degrees(np.concatenate([piece.recorded[:, 0] for piece in pieces]))
    assert lat.max() < 54.5 and live.restarts == 1 and "silent for 31 s" in told[-1]


def test_a_fix_given_to_the_ins_begins_damping_anew() -> None:
    each = seconds(400)
    for k in range(200, 400):
        body = each[k][0][1:].partition("*")[0].split(",")
        body[3] = f"{float(body[3]) + 0.5:012.7f}"
        each[k][0] = sentence(",".join(body))
    live = LiveDamping(live_scenario())
    pieces, _, told = fed(live, in_parts(each, 20))
    assert live.restarts == 1 and len(told) >= 1 and "jumped (9" in told[0]
    again = next(piece for piece in pieces if piece.time_s[0] >= pieces[0].time_s[0] + 199.0)
    assert np.abs(again.moved["unity2"][0, :7]).max() == 0.0


def test_a_heading_that_falls_silent_is_waited_for() -> None:
    each = seconds(600)
    for k in range(200, 450):
        each[k] = [line for line in each[k] if "HDT" not in line]
    live = LiveDamping(live_scenario())
    pieces, _, told = fed(live, in_parts(each, 20), trim_s=180.0)
    time_s = np.concatenate([piece.time_s for piece in pieces])
    assert told == [
        "the INS's heading is silent: damping begins anew",
        "waiting for the heading of the INS: HDT or THS sentences",
    ]
    assert live.restarts == 1 and time_s[-1] - time_s[0] > 580.0
    assert np.count_nonzero(np.diff(time_s) > 1.5) == 1 and np.diff(time_s).max() > 200.0


def test_what_is_no_longer_at_hand_begins_damping_anew() -> None:
    each = seconds(300)
    live, heard = LiveDamping(live_scenario()), Heard()
    fed(live, in_parts(each[:150], 20), heard)
    heard.begin_anew()
    _, _, told = fed(live, in_parts(each[200:], 20), heard)
    assert told == ["what was heard meanwhile is no longer at hand: damping begins anew"]


def test_a_stream_that_begins_again_is_taken_up() -> None:
    each = seconds(300)
    live, heard = LiveDamping(live_scenario()), Heard()
    _, _, told = fed(live, [*in_parts(each, 20), *in_parts(each, 20)], heard)
    assert live.restarts == 1 and "ran back" in told[0]
    assert heard.counts.sentences == 2 * 4 * 300


def test_times_without_a_date_go_on_over_midnight() -> None:
    each = [[_gll(line) if "RMC" in line else line for line in second] for second in seconds(900)[500:]]
    pieces, _, told = fed(LiveDamping(live_scenario()), in_parts(each, 10))
    time_s = np.concatenate([piece.time_s for piece in pieces])
    assert not told and np.allclose(np.diff(time_s), 1.0) and time_s[-1] > 86400.0 > time_s[0]


def _gll(line: str) -> str:
    fields = line.partition("*")[0].split(",")
    return sentence(",".join(["INGLL", *fields[3:7], fields[1], "A"]))


def test_what_is_missing_is_named_and_bounds_the_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("navcore.engine.live.heard.MOST_CHARACTERS", 9000)
    each = [second[:3] for second in seconds(300)]
    heard, live = Heard(), LiveDamping(live_scenario())
    _, _, told = fed(live, in_parts(each, 20), heard)
    assert told == ["waiting for the log: VBW or VHW sentences"]
    assert 8000 < heard.size <= 9000


@pytest.mark.parametrize("damping", ["averaging", "kalman"])
def test_what_no_law_carries_out_is_refused(damping: str) -> None:
    scenario = Scenario.parse({"reference": {"kind": "log"}, "method": [{"damping": damping}]})
    with pytest.raises(InputError, match="method.0.damping = .* must be free, or damping by a network"):
        LiveDamping(scenario)
