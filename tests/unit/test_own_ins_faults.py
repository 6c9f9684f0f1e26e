"""Recordings of a ship's own INS that cannot serve, or are to be doubted: each is named with what to do."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from navcore.engine.drivers.outside import prepared
from navcore.engine.simulation import simulate
from navcore.foundation.errors import InputError
from navcore.foundation.units import DEG
from tests.own_ins import on_ins, table

RADIUS = 6.37e6
SECONDS = 6 * 3600
COURSES = (40.0, 130.0, 250.0)
METHOD = [{"damping": "external", "network": "classic2"}]


def recorded(folder: Path, swing: float = 0.8, every: int = 1, **changed: Any) -> dict[str, str]:
    """Files of an INS whose velocity swings by some m/s about that of a ship on three courses.

    ``changed`` holds, by the name of a file, a function that is given its columns and changes them.
    """
    t = np.arange(SECONDS + 1.0)
    heading = np.interp(t, np.linspace(0.0, SECONDS, 6), np.repeat(COURSES, 2)) * DEG
    ve, vn = 8.0 * np.sin(heading), 8.0 * np.cos(heading)
    phase = 2.0 * math.pi * t / 5064.0
    own_e, own_n = ve + swing * np.sin(phase), vn + swing * np.cos(phase) - swing

    def moved(east: np.ndarray, north: np.ndarray) -> dict[str, np.ndarray]:
        lat = 54.0 * DEG + np.concatenate([[0.0], np.cumsum(0.5 * (north[1:] + north[:-1]))]) / RADIUS
        lon = 7.0 * DEG + np.concatenate(
            [[0.0], np.cumsum(0.5 * (east[1:] + east[:-1]))]
        ) / RADIUS / math.cos(54.0 * DEG)
        return {"lat_deg": lat / DEG, "lon_deg": lon / DEG, "ve_mps": east, "vn_mps": north}

    random = np.random.default_rng(1)
    columns = {
        "ins": {"t_s": t, **moved(own_e, own_n), "heading_deg": heading / DEG},
        "log": {"t_s": t, "speed_mps": np.full(t.size, 8.0) + random.normal(0.0, 0.05, t.size)},
        "truth": {"t_s": t, **moved(ve, vn), "heading_deg": heading / DEG},
    }
    for name, change in changed.items():
        change(columns[name])
    for name, held in columns.items():
        thin = every if name == "ins" else 10 if name == "truth" else 1
        table(folder / f"{name}.csv", **{key: column[::thin] for key, column in held.items()})
    return {name: str(folder / f"{name}.csv") for name in columns}


def without(*names: str) -> Any:
    def change(columns: dict[str, np.ndarray]) -> None:
        for name in names:
            columns.pop(name)

    return change


def stepped(columns: dict[str, np.ndarray]) -> None:
    """A fix at 3 h moves the position by about 2 km."""
    columns["lat_deg"] = columns["lat_deg"] + np.where(columns["t_s"] >= 10800.0, 0.018, 0.0)


def kicked(columns: dict[str, np.ndarray]) -> None:
    """The fix resets the velocity too."""
    stepped(columns)
    columns["ve_mps"] = columns["ve_mps"] + np.where(columns["t_s"] >= 10800.0, 2.0, 0.0)


def later(columns: dict[str, np.ndarray]) -> None:
    columns["t_s"] = columns["t_s"] + 604800.0


def in_knots(columns: dict[str, np.ndarray]) -> None:
    columns["speed_mps"] = columns["speed_mps"] * 1.943844


@pytest.mark.parametrize(
    ("files", "blocks", "said"),
    [
        ({"log": later}, {}, r"(?s)reference\.file.*share no time"),
        ({"log": in_knots}, {}, r"reference\.factor = 1\.0: .*1\.[89]\d times.*knots taken for m/s.*0\.51"),
        (
            {"ins": stepped},
            {},
            r'ins\.file.*jumps \(200\d m at 1970-01-01T03:00:00.*ins\.jumps = "skip".*"split"',
        ),
        (
            {"ins": kicked},
            {"ins": {"jumps": "skip"}},
            r'ins\.jumps = .skip.: must be "split".*velocity steps',
        ),
        ({"ins": without("heading_deg")}, {}, r"reference\.file.*ship's axes.*heading_deg or HDT"),
        ({"ins": without("lat_deg", "lon_deg")}, {}, r"ins\.file.*holds no position"),
        ({"truth": stepped}, {}, r"truth\.file.*the reference jumps \(200\d m at"),
        ({"truth": later}, {}, r"(?s)truth\.file.*share no time"),
        ({"log": without("speed_mps")}, {}, r"reference\.file"),
        ({}, {"run": {"duration_h": 7.0}}, r"run\.duration_h must be <= 6\.0"),
    ],
)
def test_recordings_that_cannot_serve(
    files: dict[str, Any], blocks: dict[str, Any], said: str, tmp_path: Path
) -> None:
    held = recorded(tmp_path, **files)
    with pytest.raises(InputError, match=said):
        prepared(on_ins(held, METHOD, **blocks))


def test_an_output_that_is_too_slow(tmp_path: Path) -> None:
    with pytest.raises(
        InputError, match=r"ins\.file.*every 100 s \(0\.01 Hz\) is too slow.*At least 0\.05 Hz"
    ):
        prepared(on_ins(recorded(tmp_path, every=100), METHOD))
    assert prepared(on_ins(recorded(tmp_path, every=10), METHOD))[0].steps == SECONDS


def test_a_free_ins_is_not_doubted(tmp_path: Path) -> None:
    _, env, _ = prepared(on_ins(recorded(tmp_path), METHOD))
    assert not any("damped" in text for text in env.warnings)


def test_an_ins_that_is_already_damped_is_told(tmp_path: Path) -> None:
    _, env, _ = prepared(on_ins(recorded(tmp_path, swing=0.0), METHOD))
    assert any("no oscillation at 84 min" in text and "[ins.damping]" in text for text in env.warnings)


def test_positions_alone_are_told(tmp_path: Path) -> None:
    _, env, _ = prepared(on_ins(recorded(tmp_path, ins=without("ve_mps", "vn_mps")), METHOD))
    assert any("positions only: its velocity is their rate of change" in text for text in env.warnings)


def test_without_a_heading_a_log_of_east_and_north_serves(tmp_path: Path) -> None:
    def as_east_and_north(columns: dict[str, np.ndarray]) -> None:
        speed = columns.pop("speed_mps")
        columns["ve_mps"], columns["vn_mps"] = speed, 0.0 * speed

    files = recorded(tmp_path, ins=without("heading_deg"), log=as_east_and_north)
    run = simulate(on_ins(files, METHOD, run={"duration_h": 1.0}))
    assert any("no heading" in text for text in run.warnings)
    output = run.methods[0].output
    assert output is not None and np.isnan(output[:, 4]).all() and np.isfinite(output[:, :4]).all()


def test_fixes_are_left_out_or_the_longest_piece_is_taken(tmp_path: Path) -> None:
    plain, jumping = tmp_path / "plain", tmp_path / "jumping"
    plain.mkdir()
    jumping.mkdir()
    whole = simulate(on_ins(recorded(plain), METHOD))
    files = recorded(jumping, ins=stepped)
    skipped = simulate(on_ins(files, METHOD, ins={"jumps": "skip"}))
    assert any("left out of the INS's positions: 200" in text for text in skipped.warnings)
    assert np.allclose(skipped.methods[0].rows[:, :7], whole.methods[0].rows[:, :7], atol=2.0, equal_nan=True)
    split = on_ins(files, METHOD, ins={"jumps": "split"}, run={"duration_h": 2.9})
    run = simulate(split)
    assert any("longest piece" in text for text in run.warnings)
    with pytest.raises(InputError, match=r"run\.duration_h must be <= (2\.9|3\.0)"):
        simulate(on_ins(files, METHOD, ins={"jumps": "split"}))
