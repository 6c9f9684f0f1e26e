"""Motion `waves`: the seaway has the spectrum asked for, the ship answers it, the truth is consistent."""

import math
from typing import Any

import numpy as np
import pytest
from pydantic import ValidationError

from navcore.foundation.earth import WGS84
from navcore.foundation.errors import InputError
from navcore.foundation.units import DEG
from navcore.motion import LegsMotion, WavesMotion
from navcore.motion.sea import Answer, Seaway, energy_below, make_seaway
from navcore.motion.truth import (
    AE,
    AU,
    HEADING,
    HEADING_RATE,
    HEIGHT,
    LAT,
    PITCH,
    PITCH_RATE,
    ROLL,
    ROLL_RATE,
    VE,
    VN,
    VU,
    Site,
)
from tests.motions import SEA

SITE = Site(32.06 * DEG, 118.8 * DEG, 7.0)
STIFF: dict[str, Any] = {
    f"{name}_{field}": value
    for name in ("pitch", "roll", "heading", "heave")
    for field, value in (("gain", 1.0), ("period_s", 0.5), ("damping", 0.7))
}
"""A raft that follows the surface: far above the waves' frequencies."""


def rows(motion: WavesMotion, until: float, step: float) -> np.ndarray:
    return motion.rows(round(until / step) + 1, step, SITE, WGS84)


def sea_of(motion: WavesMotion, count: int | None = None) -> Seaway:
    towards, spread = (motion.direction_deg + 180.0) * DEG, motion.spread_deg * DEG
    rng = np.random.default_rng(motion.seed)
    return make_seaway(
        motion.height_m, motion.modal_period_s, towards, spread, count or motion.components, rng
    )


@pytest.mark.parametrize("count", [8, 32, 200])
def test_significant_height_is_exact(count: int) -> None:
    sea = sea_of(SEA, count)
    assert 4.0 * math.sqrt((sea.amplitude**2).sum() / 2.0) == pytest.approx(SEA.height_m, rel=1e-12)


def test_energy_is_spread_as_the_bretschneider_spectrum() -> None:
    """Against a numerical integral of S(w) = 5/16 Hs^2 wp^4/w^5 exp(-5/4 (wp/w)^4)."""
    sea, peak = sea_of(SEA, 200), 2.0 * math.pi / SEA.peak_period_s
    w = np.linspace(0.5 * peak, 3.0 * peak, 100_001)
    density = 5.0 / 16.0 * SEA.height_m**2 * peak**4 / w**5 * np.exp(-1.25 * (peak / w) ** 4)
    total = np.trapezoid(density, w)
    assert total == pytest.approx(SEA.height_m**2 / 16.0, rel=0.02)
    for part in (0.8, 1.0, 1.3, 2.0):
        wanted = np.trapezoid(density[w <= part * peak], w[w <= part * peak]) / total
        got = (sea.amplitude[sea.frequency <= part * peak] ** 2).sum() / (sea.amplitude**2).sum()
        assert got == pytest.approx(wanted, abs=0.02)
        assert (energy_below(part) - energy_below(0.5)) / 0.9845 == pytest.approx(wanted, abs=1e-3)


def test_variance_and_spectrum_of_a_day_of_heave() -> None:
    from scipy.signal import welch

    motion = WavesMotion.model_validate(STIFF | {"speed_mps": 0.0, "components": 200})
    heave = rows(motion, 86400.0, 1.0)[:, HEIGHT] - SITE.height
    assert 4.0 * heave.std() == pytest.approx(motion.height_m, rel=0.02)
    frequency, density = welch(heave, fs=1.0, nperseg=2048)
    part = frequency * motion.peak_period_s
    for low, high in ((0.5, 0.9), (0.9, 1.2), (1.2, 3.0)):
        energy = density[(part >= low) & (part < high)].sum() * frequency[1]
        wanted = (energy_below(high) - energy_below(low)) / 0.9845 * motion.height_m**2 / 16.0
        assert energy == pytest.approx(wanted, rel=0.12)


def test_a_fully_developed_sea_has_the_peak_of_pierson_and_moskowitz() -> None:
    motion = WavesMotion(spectrum="pierson_moskowitz", height_m=4.0, peak_period_s=3.0)
    assert motion.modal_period_s == pytest.approx(2.0 * math.pi / (0.4 * math.sqrt(9.80665 / 4.0)))
    assert motion.modal_period_s == pytest.approx(5.0 * math.sqrt(4.0), rel=0.01)
    assert WavesMotion(height_m=4.0, peak_period_s=9.0).modal_period_s == 9.0


@pytest.mark.parametrize("heading", [0.0, 100.0, 200.0, 300.0])
def test_a_raft_follows_the_surface_it_moves_over(heading: float) -> None:
    """Height, pitch and roll against the surface itself, differentiated at the place of the moving ship."""
    motion = WavesMotion.model_validate(STIFF | {"speed_mps": 3.0, "heading_deg": heading})
    stiff = {name: value / 100.0 for name, value in STIFF.items() if name.endswith("period_s")}
    motion = motion.model_copy(update=stiff)
    sea, psi = sea_of(motion), heading * DEG

    def surface(t: float, east: float, north: float) -> float:
        along = east * np.sin(sea.towards) + north * np.cos(sea.towards)
        return float(sea.amplitude @ np.cos(sea.frequency * t - sea.wave_number * along + sea.phase))

    ahead, starboard = np.array([np.sin(psi), np.cos(psi)]), np.array([np.cos(psi), -np.sin(psi)])
    states, h = rows(motion, 300.0, 1.0), 0.01
    for t in (0, 17, 133, 300):
        place = 3.0 * t * ahead
        rise = [
            (surface(t, *(place + h * side)) - surface(t, *(place - h * side))) / (2.0 * h)
            for side in (ahead, starboard)
        ]
        assert states[t, HEIGHT] - SITE.height == pytest.approx(surface(t, *place), abs=0.02)
        assert states[t, PITCH] == pytest.approx(rise[0], abs=0.002)
        assert states[t, ROLL] == pytest.approx(-rise[1], abs=0.002)


def test_second_order_answer() -> None:
    answer = Answer(gain=0.8, period_s=10.0, damping=0.1)
    assert answer.transfer(np.array(0.0)) == pytest.approx(0.8)
    w = 2.0 * math.pi / 10.0
    assert answer.transfer(np.array(w)) == pytest.approx(0.8 / 0.2j)
    assert abs(answer.transfer(np.array(100.0 * w))) == pytest.approx(0.8e-4, rel=0.01)


def test_long_crested_seas_from_ahead_and_abeam() -> None:
    ahead = rows(WavesMotion(direction_deg=0.0, spread_deg=0.0), 600.0, 0.5)
    abeam = rows(WavesMotion(direction_deg=90.0, spread_deg=0.0), 600.0, 0.5)
    assert np.abs(ahead[:, [ROLL, HEADING]]).max() < 1e-12 < np.abs(ahead[:, PITCH]).max()
    assert np.abs(abeam[:, [PITCH, HEADING]]).max() < 1e-12 < np.abs(abeam[:, ROLL]).max()


def test_rates_are_derivatives() -> None:
    h = 1e-3
    states = rows(SEA, 60.0, h)
    for column, rate in (
        (PITCH, PITCH_RATE),
        (ROLL, ROLL_RATE),
        (HEADING, HEADING_RATE),
        (HEIGHT, VU),
        (VU, AU),
    ):
        numeric = (states[2:, column] - states[:-2, column]) / (2.0 * h)
        assert np.abs(numeric - states[1:-1, rate]).max() < 2e-6 * max(1.0, np.abs(states[:, rate]).max())
        assert np.abs(states[:, rate]).max() > 1e-3


def test_the_mean_course_is_that_of_legs() -> None:
    motion = SEA.model_copy(update={"heading_deg": 70.0})
    straight = LegsMotion.model_validate({"heading_deg": 70.0, "leg": [{"speed_mps": 6.0}]})
    states, mean = rows(motion, 7200.0, 10.0), straight.rows(721, 10.0, SITE, WGS84)
    np.testing.assert_allclose(states[:, [LAT, LAT + 1, VE, VN]], mean[:, [LAT, LAT + 1, VE, VN]], atol=1e-14)
    assert not states[:, AE].any()
    assert states[:, HEADING].mean() == pytest.approx(70.0 * DEG, abs=0.05 * DEG)


def test_the_seed_alone_decides_the_sea() -> None:
    again = WavesMotion(speed_mps=6.0)
    np.testing.assert_array_equal(rows(SEA, 100.0, 1.0), rows(again, 100.0, 1.0))
    other = rows(SEA.model_copy(update={"seed": 2}), 100.0, 1.0)
    assert np.corrcoef(other[:, HEIGHT], rows(SEA, 100.0, 1.0)[:, HEIGHT])[0, 1] < 0.9


def test_a_higher_sea_is_the_same_sea_scaled() -> None:
    doubled = rows(SEA.model_copy(update={"height_m": 5.0}), 100.0, 1.0)
    np.testing.assert_allclose(doubled[:, ROLL], 2.0 * rows(SEA, 100.0, 1.0)[:, ROLL], atol=1e-12)


def test_too_long_a_step_is_refused_with_the_mean_period() -> None:
    short = WavesMotion(peak_period_s=3.0)
    with pytest.raises(InputError, match=r"mean period of \w+ .* must be >= 4 s") as caught:
        short.truth(11, 0.5, SITE, WGS84)
    assert caught.value.faults[0].field == "peak_period_s"
    short.truth(11, 0.1, SITE, WGS84)
    WavesMotion().truth(11, 0.5, SITE, WGS84)


def test_a_sea_that_pitches_over_is_refused() -> None:
    with pytest.raises(ValidationError, match="height_m = .*pitch could reach"):
        WavesMotion(height_m=20.0, peak_period_s=5.0, pitch_deg=40.0, pitch_damping=0.05)
