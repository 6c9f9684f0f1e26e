"""Damping laid on the recorded output of a ship's own INS gives what damping in its loop would have given."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from navcore.engine.measures import metrics
from navcore.engine.results import timeseries, write_results
from navcore.engine.run import MethodRun, Run
from navcore.engine.simulation import simulate
from navcore.foundation.errors import InputError
from navcore.quantities import COMPONENTS
from navcore.scenario.file import load, to_toml
from navcore.scenario.model import Scenario
from tests.own_ins import damped, in_the_loop, on_ins, recordings
from tests.recordings import raw_folder

pytestmark = pytest.mark.contract

FIGURES = {
    "gyro_arw_dpsh": 0.003,
    "gyro_instability_dph": 0.003,
    "accel_vrw_ugpshz": 10.0,
    "accel_instability_ug": 10.0,
    "log_noise_mps": 0.2,
    "log_drift_mps": 0.1,
}
"""An `optimal` network is designed for these, not for sensors that stay inside the INS."""
METHODS = [
    damped("classic2", name="classic2"),
    damped("classic3", name="classic3"),
    damped({"id": "complementary"}, name="complementary"),
    damped({"id": "pole2"}, name="pole2"),
    damped({"id": "unity2"}, name="unity2"),
    damped({"id": "compass", "sigma": 0.0025, "xi": 0.7}, name="compass"),
    damped({"id": "compass", "sigma": 0.0025, "xi": 0.7, "realisation": "network"}, name="compass network"),
    damped({"id": "unity2"}, azimuth={"id": "unity2"}, name="whole"),
    damped({"id": "unity2"}, gyrocompass={"sigma": 0.002}, name="gyrocompass"),
    damped({"id": "optimal", "rho": 1e-4, **FIGURES}, name="optimal"),
]
OUTAGES = {"outage": [{"t_h": 1.5, "duration_s": 1200.0}, {"t_h": 4.0, "duration_s": 1800.0}]}
SWITCHED = [
    damped({"id": "complementary"}, switching=switching, policy=policy, name=f"{switching} {policy}")
    for switching, policy in (
        ("hard", "constant"),
        ("keep", "constant"),
        ("ramp", "threshold"),
        ("step", "yaw_rate"),
        ("bumpless", "constant"),
        ("bridge", "constant"),
        ("hard", "variation"),
    )
] + [{"name": "internal", "damping": "internal", "network": "classic2"}]
ALLOWED = 0.01
VELOCITY_FEEDBACK = 0.02


@pytest.fixture(scope="module")
def free(tmp_path_factory: pytest.TempPathFactory) -> tuple[Run, dict[str, str]]:
    """Strapdown run with the damping in the loop, and the recordings of its free INS; log in ship's axes."""
    run = in_the_loop(METHODS, reference={**LOG_IN_AXES})
    return run, recordings(run, tmp_path_factory.mktemp("ins"))


LOG_IN_AXES = {"kind": "log", "rate_hz": 1.0, "frame": "body", "scale_ppm": 4000.0, "noise_mps": 0.05}


def share(outside: MethodRun, inside: MethodRun, known: tuple[str, ...] = COMPONENTS) -> dict[str, float]:
    """Largest deviation of each error at the output rows, of the peak of the error."""
    inner = inside.rows[:: round((outside.t_s[1] - outside.t_s[0]) / (inside.t_s[1] - inside.t_s[0]))]
    found = {}
    for name in known:
        place = COMPONENTS.index(name)
        peak = float(np.max(np.abs(inside.rows[:, place])))
        found[name] = float(np.max(np.abs(outside.rows[:, place] - inner[:, place]))) / peak
    return found


def test_every_network_from_outside_is_what_it_is_in_the_loop(free: tuple[Run, dict[str, str]]) -> None:
    inside, files = free
    outside = simulate(on_ins(files, METHODS))
    assert [one.method.name for one in outside.lines] == ["as recorded", *(m["name"] for m in METHODS)]
    recorded, *methods = outside.lines
    assert max(share(recorded, inside.methods[0]).values()) < 1e-3
    for found, held in zip(methods, inside.methods[1:], strict=True):
        feedback = found.method.network.id in ("compass", "optimal")
        allowed = VELOCITY_FEEDBACK if feedback else ALLOWED
        worst = share(found, held)
        assert max(worst.values()) < allowed, (found.method.name, worst)
        assert max(np.max(np.abs(found.rows[:, k])) for k in (3, 4)) > 0.02


def test_policies_and_switching_methods_from_outside(tmp_path: Path) -> None:
    inside = in_the_loop(
        SWITCHED, reference={"kind": "log", "noise_mps": 0.05, "bias_mps": [0.1, 0.0], **OUTAGES}
    )
    outside = simulate(on_ins(recordings(inside, tmp_path), SWITCHED))
    for found, held in zip(outside.methods, inside.methods[1:], strict=True):
        worst = share(found, held)
        assert max(worst.values()) < ALLOWED, (found.method.name, worst)
        assert found.law_in_force.damped_share == pytest.approx(held.law_in_force.damped_share, abs=0.01)


def test_an_ins_that_was_damped_itself(tmp_path: Path, free: tuple[Run, dict[str, str]]) -> None:
    inside, _ = free
    own = METHODS[0]
    files = recordings(inside, tmp_path, method=1)
    methods = [{"name": "free", "damping": "free"}, *METHODS[2:4]]
    outside = simulate(on_ins(files, methods, ins={"damping": own}))
    assert any("own damping" in text for text in outside.warnings)
    assert outside.lines[0].law_in_force.damped_share == 1.0
    pairs = zip(outside.methods, (inside.methods[0], *inside.methods[3:5]), strict=True)
    for found, held in pairs:
        worst = share(found, held)
        assert max(worst.values()) < ALLOWED, (found.method.name, worst)


def test_without_a_reference_errors_are_damped_minus_recorded(free: tuple[Run, dict[str, str]]) -> None:
    inside, files = free
    outside = simulate(on_ins(files, [{"damping": "free"}, METHODS[0]], truth=False))
    document = metrics(outside)
    assert document["against"] == "recorded" and [m["name"] for m in document["methods"]] == [
        "free",
        "classic2",
    ]
    assert document["methods"][0]["errors"]["dve_mps"]["max_abs"] == 0.0
    ours, free_in_loop, theirs = outside.methods[1].rows, inside.methods[0].rows, inside.methods[1].rows
    for place in range(len(COMPONENTS)):
        moved = (theirs - free_in_loop)[::10, place]
        assert np.max(np.abs(ours[:, place] - moved)) < ALLOWED * np.max(np.abs(moved))


def test_the_damped_output_is_given_out(free: tuple[Run, dict[str, str]], tmp_path: Path) -> None:
    inside, files = free
    scenario = on_ins(files, [METHODS[0]])
    run = simulate(scenario)
    table = timeseries(run).to_pydict()
    assert set(table["method"]) == {"as recorded", "classic2"}
    rows = np.array(table["method"]) == "classic2"
    navigation = inside.methods[1].navigation
    assert navigation is not None
    for name, place, bound in (
        ("lat_rad", 0, 5e-6),
        ("lon_rad", 1, 8e-6),
        ("ve_mps", 3, 0.02),
        ("vn_mps", 4, 0.02),
    ):
        assert np.max(np.abs(np.array(table[name])[rows] - navigation[::10, place])) < bound
    write_results(run, tmp_path / "out")
    document = json.loads((tmp_path / "out" / "metrics.json").read_text())
    assert document["against"] == "truth" and document["not_known"] == []
    assert load(str(tmp_path / "out" / "scenario.toml")) == scenario


def test_a_reference_without_angles_leaves_tilt_and_heading_out(
    free: tuple[Run, dict[str, str]], tmp_path: Path
) -> None:
    _, files = free
    lines = Path(files["truth"]).read_text().splitlines()
    short = tmp_path / "gnss.csv"
    short.write_text("\n".join(",".join(line.split(",")[:5]) for line in lines))
    scenario = on_ins(files | {"truth": str(short)}, [METHODS[0]])
    run = simulate(scenario)
    document = metrics(run)
    assert document["not_known"] == ["phi_e_rad", "phi_n_rad", "phi_u_rad"]
    assert set(document["methods"][0]["errors"]) == {"dve_mps", "dvn_mps", "dlat_m", "dlon_m", "position_m"}
    assert timeseries(run)["phi_u_rad"].null_count == timeseries(run).num_rows
    limited = on_ins(
        files | {"truth": str(short)},
        [METHODS[0]],
        requirement=[{"quantity": "tilt_max_arcsec", "at_most": 20.0}],
    )
    with pytest.raises(InputError, match=r"requirement\.0\.quantity.*not known"):
        simulate(limited)


def test_limits_are_judged_against_the_reference(free: tuple[Run, dict[str, str]]) -> None:
    inside, files = free
    limit = [{"quantity": "velocity_max_mps", "at_most": 0.5, "from_h": 2.0}]
    run = simulate(on_ins(files, [METHODS[0]], requirement=limit))
    first, second = (one["requirements"][0] for one in metrics(run)["methods"])
    for got, held in ((first, inside.methods[0]), (second, inside.methods[1])):
        late = held.rows[7200:, 3:5]
        assert got["value"] == pytest.approx(float(np.max(np.hypot(*late.T))), rel=0.01)


@pytest.mark.parametrize("case", ["north", "outage"])
def test_recorded_cases(case: str, tmp_path: Path) -> None:
    folder = raw_folder()
    if folder is None or not (folder / "own_ins").is_dir():
        pytest.skip("the recorded cases are not here")
    here = folder / "own_ins" / case
    expected = json.loads((here / "expected.json").read_text())["methods"]
    methods = [held["damping"] | {"name": name} for name, held in expected.items()]
    files = {name: str(here / f"{name}.csv") for name in ("ins", "log", "truth")}
    against = simulate(on_ins(files, methods, run={"duration_h": 12.0}))
    moved = simulate(on_ins(files, methods, run={"duration_h": 12.0}, truth=False))
    for k, (name, held) in enumerate(expected.items()):
        allowed = 0.02 if name == "compass" else 0.005
        for place, error in enumerate(COMPONENTS):
            for at, values in held["t"].items():
                row = round(float(at) / 10.0)
                bound = allowed * held["peak"][error]
                if error not in ("phi_e_rad", "phi_n_rad"):
                    assert abs(against.methods[k].rows[row, place] - values[error]) < bound, (name, error, at)
                change = values[error] - expected["free"]["t"][at][error]
                assert abs(moved.methods[k].rows[row, place] - change) < bound, (name, error, at)


@pytest.mark.parametrize(
    ("blocks", "said"),
    [
        ({"motion": {"kind": "static"}}, r"motion: must be left out"),
        ({"imu": {"gyro_bias_dph": [0.01, 0.0, 0.0]}}, r"imu: must be left out"),
        ({"reference": {"kind": "log"}}, r'reference.kind = .log.: must be "file"'),
        ({"run": {"fidelity": "strapdown"}}, r"run.fidelity = .strapdown."),
        ({"method": [{"damping": "kalman"}]}, r"method.0.damping = .kalman.*ins.file"),
        ({"method": [{"name": "as recorded"}]}, r"method.0.name = .as recorded."),
        ({"ins": {"damping": {"damping": "kalman"}}}, r"ins.damping.damping = .kalman."),
        (
            {"requirement": [{"quantity": "velocity_max_mps", "at_most": 1.0}]},
            r"requirement.0.quantity.*\[truth\]",
        ),
    ],
)
def test_what_does_not_go_with_an_ins(blocks: dict[str, Any], said: str) -> None:
    with pytest.raises(InputError, match=said):
        on_ins({"ins": "ins.csv", "log": "log.csv"}, [{"damping": "free"}], truth=False, **blocks)


def test_a_reference_alone_is_refused() -> None:
    with pytest.raises(InputError, match=r"truth.file.*needs ins.file"):
        Scenario.parse({"truth": {"file": "gnss.csv"}})


def test_a_scenario_on_an_ins_is_written_and_read(tmp_path: Path) -> None:
    scenario = on_ins(
        {"ins": "/a/ins.csv", "log": "/a/log.csv", "truth": "/a/truth.csv"},
        [METHODS[0]],
        ins={"damping": METHODS[2]},
    )
    text = to_toml(scenario)
    assert "[motion]" not in text and "[imu]" not in text and "[ins.damping.network]" in text
    path = tmp_path / "scenario.toml"
    path.write_text(text)
    assert load(str(path)) == scenario
