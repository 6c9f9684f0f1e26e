"""Bad input to budget, tune and pareto: plain words with the field's name, exit code 2, nothing on stdout."""

import json
from pathlib import Path
from typing import Any

import pytest

from navcore.design.budget import budget
from navcore.design.pareto import pareto
from navcore.design.tune import tune
from navcore.foundation.errors import InputError
from navcore.foundation.units import ARCSEC
from navcore.scenario.file import to_toml
from navcore.scenario.model import Scenario
from schuler_bench.cli import main
from tests.acceptance.test_design_values import SET_A

SIGMA, XI = "method.0.network.sigma", "method.0.network.xi"
COMPASS = {"damping": "external", "network": {"id": "compass", "sigma": 0.0088, "xi": 0.7}}
RUNAWAY = {"damping": "external", "network": {"id": "custom", "num": [1.0, -0.1], "den": [1.0, 0.1]}}
QUIET_LOG = {"kind": "log"}


def ship(*methods: dict[str, Any], **blocks: Any) -> Scenario:
    """Example ship for two hours; compass unless other methods are given."""
    run = {"earth": "sphere", "duration_h": 2.0, "output_step_s": 60.0}
    return Scenario.parse({**SET_A, "run": run, "method": list(methods or (COMPASS,)), **blocks})


@pytest.fixture
def saved(tmp_path: Path) -> Any:
    """Write a scenario to a file and give its name."""

    def save(scenario: Scenario, name: str = "ship.toml") -> str:
        path = tmp_path / name
        path.write_text(to_toml(scenario), encoding="utf-8")
        return str(path)

    return save


def refused(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    """Run a command that must exit with 2; return what it says."""
    assert main(list(arguments)) == 2
    caught = capsys.readouterr()
    assert caught.out == "" and "Traceback" not in caught.err
    return caught.err


TUNE = ("--objective", "tilt_rms", "--vary", SIGMA)


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("--objective", "tilt_rms"), "--vary: is required"),
        (("--objective", "damping_ratio", "--vary", XI), "ask for it as a requirement, damping_ratio>=0.5"),
        (("--objective", "0*tilt_rms", "--vary", XI), "weights must be numbers > 0"),
        (("--objective", "tilt_rms - velocity_rms", "--vary", XI), "must be one of tilt_rms"),
        (("--objective", "tilt_rms", "--vary", "imu.gyro_tau_s"), "must not vary"),
        (("--objective", "tilt_rms", "--vary", "method.0.name"), "must not vary"),
        (("--objective", "tilt_rms", "--vary", "method.0.network.speed"), "numbers there: sigma, xi"),
        (("--objective", "tilt_rms", "--vary", "method.0.policy.limit_mps"), "numbers there: none"),
        (
            ("--objective", "tilt_rms", "--vary", "method.0.network.k1"),
            "must not be given together with sigma, xi",
        ),
        (("--objective", "tilt_rms", "--vary", f"{SIGMA}=0.1:2"), "must lie within 1e-05 and 1"),
        ((*TUNE, "--require", "tilt_rms<1"), "must have the form NAME<=VALUE"),
        ((*TUNE, "--require", "settling_s<=1km"), "unit must be one of s, min, h"),
        ((*TUNE, "--out", "/no/such/folder/best.toml"), "--out = '/no/such/folder/best.toml': cannot be"),
        ((*TUNE, "--worst-of", "no-such"), "no-such: is neither a preset nor a file"),
    ],
)
def test_words_of_tune(
    arguments: tuple[str, ...], told: str, saved: Any, capsys: pytest.CaptureFixture[str]
) -> None:
    """Each is named with its value and what would be right."""
    assert told in refused(capsys, "tune", saved(ship()), *arguments)


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("--network", "foo"), "networks = 'foo': must be one of classic2"),
        (("--network", "custom"), "networks = 'custom': must be one of classic2"),
        (("--x", "speed"), "--x = 'speed': must be one of tilt_rms"),
        (("--x", "h_slope_s"), "--x = 'h_slope_s': must be one of"),
        (("--x", "damping_ratio"), "--x = 'damping_ratio': must be one of"),
        (("--x", "velocity_rms"), "must be two different ones"),
        (("--method", "3"), "method = 3: must be 0 to 0"),
    ],
)
def test_words_of_pareto(
    arguments: tuple[str, ...], told: str, saved: Any, capsys: pytest.CaptureFixture[str]
) -> None:
    """Likewise."""
    assert told in refused(capsys, "pareto", saved(ship()), *arguments)


def test_requirements_that_nothing_meets(saved: Any, capsys: pytest.CaptureFixture[str]) -> None:
    """A line a requirement: what is in reach of it alone, in its unit, and what it costs."""
    limits = ("--require", "velocity_rms<=0.01", "--require", "settling_s<=60min")
    lines = refused(capsys, "tune", saved(ship()), *TUNE, *limits).splitlines()
    assert len(lines) == 2
    assert "'velocity_rms<=0.01'" in lines[0] and "alone velocity_rms comes to 0.1033 m/s" in lines[0]
    assert "without it tilt_rms comes to 5.176 arcsec" in lines[0]
    assert "'settling_s<=60min'" in lines[1] and "without it the others are not met either" in lines[1]


def test_what_is_in_reach_is_told_however_large_it_is() -> None:
    """The shortest settling of a slow loop is thousands of seconds."""
    slow = [f"{SIGMA}=2e-4:4e-4"]
    with pytest.raises(InputError) as caught:
        tune(ship(), "tilt_rms", slow, ["settling_s<=60"])
    reached = float(str(caught.value).split("settling_s comes to ")[1].split(" s;")[0])
    found = tune(ship(), "settling_s", slow)
    assert reached == pytest.approx(found.objective, rel=1e-2)
    assert reached > 5000.0


@pytest.mark.slow
def test_a_requirement_that_is_met_by_chance_is_not_called_active() -> None:
    """Settling holds the optimum back here; the velocity comes near its own limit with it."""
    found = tune(
        ship(), "tilt_rms", [f"{SIGMA}=1e-3:1", f"{XI}=0.01:5"], ["velocity_rms<=0.1025", "settling_s<=3600"]
    )
    assert found.active == ("settling_s<=3600",)
    assert list(found.cost) == ["settling_s<=3600"]
    assert found.cost["settling_s<=3600"] < found.objective


@pytest.mark.parametrize(
    ("method", "field", "told"),
    [
        ({"damping": "free"}, SIGMA, 'damping = "free" uses no network'),
        ({"damping": "kalman"}, SIGMA, 'damping = "kalman" uses no network'),
        ({"damping": "averaging"}, SIGMA, 'damping = "averaging" uses no network'),
        ({"damping": "external", "network": {"id": "classic2"}}, SIGMA, "numbers there: none"),
    ],
)
def test_methods_without_a_number(method: dict[str, Any], field: str, told: str) -> None:
    """Said of the method's damping or network, for tune and for pareto."""
    found = ship(method)
    with pytest.raises(InputError, match=told):
        tune(found, "tilt_rms", [field])
    if method["damping"] != "external":
        with pytest.raises(InputError, match=told):
            pareto(found)


def test_a_further_scenario_without_the_parameter_is_named() -> None:
    """By its number among those given."""
    with pytest.raises(InputError, match=r"--worst-of = 'scenario 2': .*uses no network"):
        tune(ship(), "tilt_rms", [SIGMA], worst_of=[ship(), ship({"damping": "free"})])
    with pytest.raises(InputError, match="there is no method.1"):
        tune(
            ship(COMPASS, {**COMPASS, "name": "second"}),
            "tilt_rms",
            ["method.1.network.sigma"],
            worst_of=[ship()],
        )


def test_sensors_all_zero(saved: Any, capsys: pytest.CaptureFixture[str]) -> None:
    """No floor; nothing to tune in the steady state, nor along a run without any error."""
    silent = saved(ship(imu={}, reference=QUIET_LOG))
    for extra in ((), ("--steady",)):
        assert main(["budget", silent, "--json", *extra]) == 0
        document = json.loads(capsys.readouterr().out)
        assert document["floor"]["tilt_rad"] is None and "no random error" in document["floor"]["reason"]
        assert document["methods"][0]["times_floor"]["tilt"] is None
    assert "imu and reference have no random error" in refused(capsys, "tune", silent, *TUNE)
    assert "has no error that a setting" in refused(capsys, "tune", silent, *TUNE, "--along")
    assert "imu and reference have no random error" in refused(capsys, "pareto", silent)


def test_only_the_log_errs(saved: Any, capsys: pytest.CaptureFixture[str]) -> None:
    """The floor is 0, and the output says why nothing is a multiple of it."""
    quiet = saved(ship(imu={}))
    assert main(["budget", quiet, "--steady"]) == 0
    assert "could remove all of it: the floor is 0" in capsys.readouterr().out
    assert main(["budget", quiet, "--steady", "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["floor"]["tilt_rad"] == 0.0 and "floor is 0" in document["floor"]["reason"]
    assert document["methods"][0]["times_floor"] == {"tilt": None, "velocity": None}


def test_a_log_without_error_has_a_floor_below_every_setting() -> None:
    """The velocity is known exactly then, the tilt is not; a fast compass loop comes near its floor."""
    often = {"earth": "sphere", "step_s": 0.005, "duration_h": 1.0}
    fast = {"damping": "external", "network": {"id": "compass", "sigma": 1.0, "xi": 10.0}}
    found = budget(ship(fast, reference={**QUIET_LOG, "rate_hz": 200.0}, run=often), steady=True)
    least, own = found.floor.rms, found.methods[0].total.rms
    assert least.velocity_mps == 0.0 and own.velocity_mps == pytest.approx(4e-5, rel=0.1)
    assert least.tilt_rad and own.tilt_rad
    assert 1.0 < own.tilt_rad / least.tilt_rad < 1.2
    assert least.tilt_rad / ARCSEC == pytest.approx(2.140, rel=1e-3)


def test_sources_without_a_steady_state(saved: Any, capsys: pytest.CaptureFixture[str]) -> None:
    """Named, with how they grow; along the run they are there."""
    assert main(["budget", saved(ship({"damping": "free"})), "--steady", "--json"]) == 0
    method = json.loads(capsys.readouterr().out)["methods"][0]
    assert method["tilt_rad"] is None and method["sources"]["gyro_white"]["tilt_rad"] is None
    assert method["sources"]["gyro_white"]["growth_in_1h"]["tilt_rad"] > 0.0
    assert "gyro_white" in method["warnings"][0] and "drive a mode without decay" in method["warnings"][0]


def test_a_method_that_diverges_leaves_the_others_their_budget(
    saved: Any, capsys: pytest.CaptureFixture[str]
) -> None:
    """Exit code 3, its figures null, marked; also where it is shown by seeds."""
    seen = {**RUNAWAY, "policy": {"id": "yaw_rate"}}
    long = {"earth": "sphere", "duration_h": 400.0, "step_s": 10.0, "output_step_s": 3600.0}
    scenario = ship(COMPASS, {**RUNAWAY, "name": "runs away"}, seen, run=long)
    assert main(["budget", saved(scenario), "--json"]) == 3
    methods = json.loads(capsys.readouterr().out)["methods"]
    assert [method["status"] for method in methods] == ["ok", "diverged", "diverged"]
    assert methods[0]["tilt_rad"] > 0.0 and methods[1]["tilt_rad"] is None
    assert "the loop is unstable as it is sampled" in methods[1]["warnings"][0]


@pytest.mark.slow
def test_an_unstable_start_is_no_hindrance(saved: Any, capsys: pytest.CaptureFixture[str]) -> None:
    """The present setting has no figures; the search comes to the optimum that a stable start finds."""
    gains = {"id": "compass", "k1": 1e-5, "k2": 0.5, "k3": 1e-3}
    unstable = ship({"damping": "external", "network": gains})
    assert budget(unstable, steady=True).methods[0].total.rms.tilt_rad is None
    vary = ["method.0.network.k1=1e-5:0.1", "method.0.network.k3=1e-7:0.01"]
    found = tune(unstable, "tilt_rms", vary)
    good = tune(ship({"damping": "external", "network": gains | {"k1": 1e-2, "k3": 1e-5}}), "tilt_rms", vary)
    assert found.before is None and good.before is not None
    assert found.objective == pytest.approx(good.objective, rel=1e-3)
    call = [
        "tune",
        saved(unstable),
        "--objective",
        "settling_s",
        *(f"--vary={one}" for one in vary),
        "--json",
    ]
    assert main(call) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["before"] is None and 0.0 < document["objective"] < 1e4


def test_an_optimum_at_the_end_of_a_range_is_told_on_the_command_line(
    saved: Any, capsys: pytest.CaptureFixture[str]
) -> None:
    """The value is the end itself."""
    call = ["tune", saved(ship()), "--objective", "tilt_rms", "--vary", f"{SIGMA}=0.005:0.1"]
    assert main(call) == 0
    assert "at the end of its range" in capsys.readouterr().out
    assert main([*call, "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["best"] == {SIGMA: 0.005} and document["at_end_of_range"] == [SIGMA]


def test_the_kalman_filter_is_its_own_floor() -> None:
    """Steady with its sources, and along the run; an error that it is not told of adds its response."""
    kalman = {"damping": "kalman"}
    steady = budget(ship(kalman), steady=True)
    method = steady.methods[0]
    assert method.shown == "steady" and steady.times_floor(method) == {"tilt": 1.0, "velocity": 1.0}
    for name in ("tilt_rad", "velocity_mps"):
        parts = sum(getattr(entry.rms, name) ** 2 for entry in method.sources.values())
        assert parts == pytest.approx(getattr(steady.floor.rms, name) ** 2, rel=1e-6)
    assert 0.01 < (method.sources["log_white"].rms.tilt_rad or 0.0) / ARCSEC < 4.7
    along = budget(ship(kalman))
    assert along.methods[0].shown == "covariance"
    assert along.times_floor(along.methods[0])["position"] == 1.0
    misled = ship(kalman, reference={**SET_A["reference"], "current_mps": [0.3, 0.0]})
    untold = budget(misled).methods[0]
    assert untold.shown == "covariance" and "current" in str(untold.warnings)


def test_limits_that_contradict_each_other_are_refused_before_a_search(
    saved: Any, capsys: pytest.CaptureFixture[str]
) -> None:
    """One line that names both."""
    limits = ["--require", "settling_s<=1h", "--require", "settling_s>=2h"]
    assert main(["tune", saved(ship()), "--objective", "tilt_rms", "--vary", SIGMA, *limits]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "settling_s>=2h" in line and "contradicts settling_s<=1h" in line


def test_biases_alone_can_be_tuned_for() -> None:
    """The steady objective is the sum of noise and constants."""
    damped = {"damping": "external", "network": {"id": "complementary"}}
    biased = ship(damped, imu={"gyro_bias_std_dph": 0.01}, reference=QUIET_LOG)
    assert tune(biased, "velocity_rms", ["method.0.network.zeta"], default_limits=False).before
