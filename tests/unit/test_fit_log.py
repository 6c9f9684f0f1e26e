"""The fit of a log's error gives back what simulated logs were made with, within its intervals."""

import json
import math
import re
from pathlib import Path

import numpy as np
import pytest

from navcore.fitting.along_track import LogAlongTrack, log_along_track
from navcore.fitting.drift import Blocks, _likelihood
from navcore.fitting.log import LogErrorFit, fit_log
from navcore.fitting.recorded import FittedLog, can_fit, fit_of, reference_of, with_fitted_log
from navcore.foundation.errors import InputError
from navcore.io.agreement import M2_S
from navcore.motion.track import TrackMotion
from navcore.motion.truth import AE, AN, COLUMNS, HEADING, VE, VN, Truth
from navcore.scenario.file import load
from navcore.sensors.recorded import recorded_window
from navcore.sensors.true_state import to_ship
from schuler_bench.cli import main
from schuler_bench.views.log.picture import log_svg

BIAS, NOISE, DRIFT, TAU_S, SCALE = (0.03, 0.08), 0.05, 0.1, 600.0, 0.004
CURRENT, SINE, COSINE = (0.3, -0.2), (0.4, 0.1), (-0.1, 0.3)


def voyage(
    seed: int,
    hours: float = 14.0,
    *,
    late_s: int = 0,
    drift: float = DRIFT,
    track_noise: float = 0.03,
    turns: bool = True,
    one_axis: bool = False,
) -> LogAlongTrack:
    """A log at 1 Hz through a current and a tide, beside a track with noise of its own.

    The ship changes course and speed each 20 to 60 min.
    """
    from scipy.ndimage import uniform_filter1d
    from scipy.signal import lfilter

    random = np.random.default_rng(seed)
    t = np.arange(0.0, hours * 3600.0)
    speed, heading, at = np.full(t.size, 6.0), np.full(t.size, 0.7), 0.0
    while at < t[-1]:
        at += random.uniform(1200.0, 3600.0)
        heading[int(at) :] += random.uniform(-1.5, 1.5) * turns
        speed[int(at) :] = random.uniform(2.0, 8.0)
    speed, heading = uniform_filter1d(speed, 60), uniform_filter1d(heading, 60)
    true = speed[:, None] * np.column_stack([np.sin(heading), np.cos(heading)])
    phase = (2.0 * np.pi * t / M2_S)[:, None]
    water = np.array(CURRENT) + np.sin(phase) * SINE + np.cos(phase) * COSINE
    rho = math.exp(-1.0 / TAU_S)
    steps = random.normal(0.0, drift * math.sqrt(1.0 - rho**2), true.shape)
    steps[0] = random.normal(0.0, drift, 2)
    own = np.array(BIAS) + lfilter([1.0], [1.0, -rho], steps, axis=0) + random.normal(0.0, NOISE, true.shape)
    reading = (1.0 + SCALE) * np.roll(to_ship(true - water, heading), late_s, axis=0) + own
    if one_axis:
        reading[:, 0] = 0.0
    seen = true + random.normal(0.0, track_noise, true.shape)
    values = np.zeros((t.size, COLUMNS))
    values[:, [VE, VN]], values[:, HEADING] = seen, heading
    values[:, [AE, AN]] = np.gradient(seen, axis=0)
    shared = slice(max(late_s, 0), t.size + min(late_s, 0))
    return LogAlongTrack(t[shared], reading[shared], Truth(1.0, values))


def planted(fit: LogErrorFit, late_s: float = 0.0) -> list[bool]:
    """Whether each interval holds what was planted."""
    assert fit.scale is not None and fit.delay_s is not None and fit.current is not None
    pairs = [
        *zip(fit.bias, BIAS, strict=True),
        (fit.noise, NOISE),
        (fit.drift, DRIFT),
        (fit.drift_tau_s, TAU_S),
        (fit.scale, SCALE),
        (fit.delay_s, late_s),
        *zip(fit.current, CURRENT, strict=True),
    ]
    for tide in fit.tides:
        pairs += [*zip(tide.sine, SINE, strict=True), *zip(tide.cosine, COSINE, strict=True)]
    return [one.low <= truth <= one.high for one, truth in pairs]


@pytest.fixture(scope="module")
def found() -> LogErrorFit:
    return fit_log(voyage(0), through_water=True)


def test_what_was_planted_comes_back(found: LogErrorFit) -> None:
    assert sum(planted(found)) >= 12 and len(planted(found)) == 13
    assert found.noise.value == pytest.approx(NOISE, rel=0.01) and found.rate_hz == 1.0
    assert found.drift.value == pytest.approx(DRIFT, rel=0.15)
    assert found.drift_tau_s.value == pytest.approx(TAU_S, rel=0.3)
    assert found.current is not None and found.delay_s is not None and found.scale is not None
    assert [one.value for one in found.current] == pytest.approx(CURRENT, abs=0.03)
    assert [one.value for one in found.tides[0].sine] == pytest.approx(SINE, abs=0.03)
    assert [one.value for one in found.tides[0].cosine] == pytest.approx(COSINE, abs=0.03)
    # The intervals say something: they are no wider than a manoeuvre each half hour allows.
    assert found.delay_s.deviation < 0.3 and found.scale.deviation < 0.008
    assert found.drift.deviation < 0.02 and found.bias[0].deviation < 0.03


@pytest.mark.slow
def test_the_intervals_hold_the_truth_as_often_as_they_say() -> None:
    held = np.array([planted(fit_log(voyage(seed, 8.0), through_water=True)) for seed in range(50)])
    assert 0.90 <= held.mean() <= 0.99
    assert held.mean(axis=0).min() >= 0.84


@pytest.mark.parametrize("late_s", [-120, -12, 12, 282])
def test_a_clock_of_either_sign_is_found(late_s: int) -> None:
    fit = fit_log(voyage(1, 6.0, late_s=late_s), through_water=True)
    assert fit.delay_s is not None and abs(fit.delay_s.value - late_s) < 3.0 * fit.delay_s.deviation < 2.5
    assert fit.noise.value == pytest.approx(NOISE, rel=0.01)
    assert reference_of(fit).delay_s == max(round(fit.late_s, 3), 0.0) or late_s > 0


def test_the_noise_of_the_track_is_none_of_the_log() -> None:
    fit = fit_log(voyage(2, 6.0, track_noise=0.2), through_water=True)
    assert fit.scale is not None and abs(fit.scale.value - SCALE) < 3.0 * fit.scale.deviation < 0.06
    assert fit.noise.value == pytest.approx(NOISE, rel=0.1)


def test_a_log_that_measures_forward_alone_says_nothing_of_starboard() -> None:
    fit = fit_log(voyage(3, 6.0, one_axis=True), through_water=True)
    assert fit.one_axis and fit.bias[0].low == -math.inf and fit.bias[0].high == math.inf
    assert fit.noise.value == pytest.approx(NOISE, rel=0.02)
    assert fit.current is not None
    assert [one.value for one in fit.current] == pytest.approx(CURRENT, abs=0.25)
    assert (reference_of(fit).bias_std_mps or 1.0) < 0.3


def test_on_one_heading_the_current_is_part_of_the_bias() -> None:
    fit = fit_log(voyage(4, 6.0, turns=False), through_water=True)
    assert fit.current is None and not fit.tides
    assert any(
        "a current cannot be told" in str(row) for row in FittedLog(fit, voyage(4, 1.0), "water").rows()
    )


def test_white_noise_alone_has_no_drift() -> None:
    fit = fit_log(voyage(5, 6.0, drift=0.0), through_water=True)
    assert fit.drift.value == 0.0 and fit.drift.low == 0.0 and fit.drift.high < 0.02


def test_a_perfect_log_at_rest_fits_to_nothing() -> None:
    rest = Truth(0.5, np.zeros((1, COLUMNS)))
    fit = fit_log(LogAlongTrack(np.arange(300.0), np.zeros((300, 2)), rest), through_water=True)
    assert fit.delay_s is None and fit.scale is None and fit.current is None
    assert fit.noise.value == fit.drift.value == 0.0
    assert reference_of(fit).drift_mps == 0.0


def test_stamps_that_jitter_do_not_change_the_rate_of_the_fit() -> None:
    even = np.arange(2000.0)
    late = 0.05 * (even % 20)  # the logger's loop takes 5 % too long, and catches up
    noise = np.random.default_rng(1).normal(0.0, 0.05, (2000, 2))
    fit = fit_log(LogAlongTrack(even + late, noise, Truth(0.5, np.zeros((1, COLUMNS)))), through_water=False)
    assert fit.rate_hz == pytest.approx(1.0, rel=0.001)
    assert fit.noise.value == pytest.approx(0.05, rel=0.05)


def test_too_short_records_are_refused() -> None:
    with pytest.raises(InputError, match="a fit needs 50"):
        fit_log(
            LogAlongTrack(np.arange(49.0), np.zeros((49, 2)), Truth(0.5, np.zeros((1, COLUMNS)))),
            through_water=True,
        )


def test_the_likelihood_is_that_of_the_whole_covariance() -> None:
    """A slow twin: the covariance of all blocks at once, with the drift's mean over each block."""
    random = np.random.default_rng(2)
    count = np.array([4, 4, 0, 3, 4, 4, 1, 4, 0, 4, 4, 4])
    k, length_s = count.size, 5.0
    values, design = random.normal(size=(k, 1)), random.normal(size=(k, 1, 2))
    values[count == 0], design[count == 0] = 0.0, 0.0
    blocks = Blocks(values, design, count, length_s, np.array([1e6, 1e6]))

    def whole(tau_s: float, ratio: float) -> float:
        fine = (np.arange(40 * k) + 0.5) * length_s / 40
        covariance = ratio * np.exp(-np.abs(fine[:, None] - fine) / tau_s)
        kept = count > 0
        means = covariance.reshape(k, 40, k, 40).mean(axis=(1, 3))[np.ix_(kept, kept)]
        total = means + np.diag(1.0 / count[kept])
        x, y = design[kept, 0], values[kept, 0]
        inverse = np.linalg.inv(total)
        normal = x.T @ inverse @ x
        left = y @ inverse @ y - (x.T @ inverse @ y) @ np.linalg.solve(normal, x.T @ inverse @ y)
        terms = np.linalg.slogdet(total)[1], np.linalg.slogdet(normal)[1], (len(y) - 2) * math.log(left)
        return -0.5 * sum(terms)

    points = np.array([8.0, 20.0, 60.0]), np.array([0.5, 3.0, 20.0])
    ours = _likelihood(blocks, *points).log
    twin = np.array([whole(*point) for point in zip(*points, strict=True)])
    np.testing.assert_allclose(np.diff(ours), np.diff(twin), atol=2e-3)


# ---------------------------------------------------------------- recordings, page, command


def test_the_block_holds_the_numbers_of_the_document(found: LogErrorFit) -> None:
    document = FittedLog(found, voyage(0, 1.0), "water").document()["log"]
    block = reference_of(found)
    assert [one["value"] for one in document["bias_mps"]] == [*block.bias_mps]
    assert document["noise_mps"]["value"] == block.noise_mps
    assert document["drift_mps"]["value"] == block.drift_mps
    assert document["drift_tau_s"]["value"] == block.drift_tau_s
    assert document["scale_ppm"]["value"] == block.scale_ppm
    assert [one["value"] for one in document["current_mps"]] == [*block.current_mps]


def test_what_the_fit_leaves_open_is_part_of_the_deviation_of_the_bias(found: LogErrorFit) -> None:
    """By it the shares of a design count the uncertainty of the fit."""
    expected = np.mean([one.value**2 + one.deviation**2 for one in found.bias])
    assert reference_of(found).deviation == pytest.approx([math.sqrt(expected)] * 2, rel=1e-4)


def test_the_tide_of_the_block_is_the_straight_stream_nearest_to_the_fitted_one(found: LogErrorFit) -> None:
    block, t = reference_of(found), np.linspace(0.0, M2_S, 400)
    angle = 2.0 * np.pi * t / (block.tide_period_h * 3600.0) + math.radians(block.tide_phase_deg)
    straight = np.sin(angle)[:, None] * block.tide_mps
    phase = (2.0 * np.pi * t / M2_S)[:, None]
    (tide,) = found.tides
    whole = np.sin(phase) * [e.value for e in tide.sine] + np.cos(phase) * [e.value for e in tide.cosine]
    assert np.std(whole - straight) < 0.75 * np.std(whole)
    # no other phase comes nearer
    for turn in (-0.2, 0.2):
        other = np.sin(angle + turn)[:, None]
        best = other * (other * whole).mean(axis=0) / np.mean(other**2)
        assert np.std(whole - straight) <= np.std(whole - best) + 1e-4


def test_the_recorded_ships_log_errs_as_the_preset_that_was_fitted_to_it() -> None:
    recorded = load("sikuliaq-recorded")
    assert can_fit(recorded)
    found = fit_of(recorded)
    fit, like = found.fit, load("sikuliaq-like").reference
    assert found.speed == "ground" and fit.delay_s is not None
    assert fit.delay_s.value == pytest.approx(like.delay_s, abs=0.8)
    assert fit.bias[0].value == pytest.approx(like.bias_mps[0], abs=0.005)
    assert fit.bias[1].low < like.bias_mps[1] < fit.bias[1].high
    made = with_fitted_log(recorded, fit)
    assert made.reference.kind == "log" and made.reference.bias_mps == reference_of(fit).bias_mps
    assert made.motion == recorded.motion and not can_fit(made)


def test_both_speeds_of_the_log_are_fitted() -> None:
    recorded = load("sikuliaq-recorded")
    through = recorded.reference.model_copy(update={"speed": "water"})
    found = fit_of(recorded.model_copy(update={"reference": through}))
    assert found.other is not None and found.other_speed == "ground"
    assert found.other.drift.value == pytest.approx(0.021, abs=0.003)
    told = "\n".join(found.lines())
    assert 'its drift is 0.021 m/s; choose it by speed = "ground"' in told


def test_the_picture_shows_log_and_ship_and_what_lies_between_them() -> None:
    found = fit_of(load("sikuliaq-recorded"))
    svg = log_svg(found.log, found.fit.late_s)
    ship, log, difference = (
        np.array([point.split(",") for point in points.split()], float)
        for points in re.findall(r'polyline points="([^"]+)"', svg)
    )
    assert ship.shape == log.shape == difference.shape and len(ship) == 240
    assert np.all(np.diff(ship[:, 0]) > 0.0)
    # in pixels of one scale, the two curves lie as far apart as the fit says
    assert np.corrcoef(log[:, 1] - ship[:, 1], difference[:, 1])[0, 1] > 0.999
    late = re.findall(r'polyline points="([^"]+)"', log_svg(found.log, 0.0))[2]
    assert np.ptp([float(point.split(",")[1]) for point in late.split()]) > 0.0


def test_the_true_motion_ends_with_the_time_that_log_and_track_share() -> None:
    scenario = load("sikuliaq-recorded")
    assert isinstance(scenario.motion, TrackMotion)
    window = recorded_window(scenario.motion, scenario.reference)
    assert window is not None
    log = log_along_track(scenario.reference, scenario.motion)
    assert window.span_s - log.truth.step_s < log.end_s <= window.span_s
    assert 0.0 <= log.time_s[0] < log.time_s[-1] <= log.end_s


def test_without_recordings_there_is_nothing_to_fit() -> None:
    scenario = load("sikuliaq-like")
    assert not can_fit(scenario)
    with pytest.raises(InputError, match="recorded track"):
        fit_of(scenario)


RECORDINGS = Path("assets/recordings")


def test_the_command_prints_the_fit_and_writes_its_block(
    repo_root: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    log, track = (str(repo_root / RECORDINGS / f"sikuliaq-{name}.csv") for name in ("log", "track"))
    block = tmp_path / "log.toml"
    code = main(["fit", log, "--track", track, "--speed", "ground", "--scenario", str(block), "--json"])
    assert code == 0
    document = json.loads(capsys.readouterr().out)
    assert document["speed"] == "ground" and document["log"].keys() >= {
        "bias_mps", "noise_mps", "drift_mps", "drift_tau_s", "scale_ppm", "delay_s",
    }  # fmt: skip
    assert document["log"]["delay_s"].keys() == {"value", "low", "high"}
    written = load(str(block))
    assert written.reference.kind == "log" and "sikuliaq-log.csv" in written.source
    assert written.reference.noise_mps == document["log"]["noise_mps"]["value"]


def test_a_log_without_a_track_and_a_file_that_is_missing_are_refused(
    repo_root: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    log = str(repo_root / RECORDINGS / "sikuliaq-log.csv")
    assert main(["fit", log]) == 2
    assert "--track: must name the positions and the heading" in capsys.readouterr().err
    assert main(["fit", "nowhere.csv", "--track", log]) == 2
    assert "nowhere.csv" in capsys.readouterr().err
