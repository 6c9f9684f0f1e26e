"""Standard deviations that an INS records of its own output: kept, checked, and drawn beside it."""

import csv
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.io import netcdf_file

from navcore.checks.file import check_file
from navcore.engine.simulation import simulate
from navcore.foundation.units import DEG
from navcore.io.recording import load
from schuler_bench.plots.envelope import own_band
from schuler_bench.views.errors.figure import error_plots
from tests.nmea import START, sentence, write
from tests.own_ins import on_ins
from tests.unit.test_own_ins_faults import recorded

METHOD: dict[str, Any] = {"damping": "external", "network": "unity2"}
NAMES = {
    "pitch_deg": 0.5, "roll_deg": -0.5,
    "lat_sigma_m": 12.0, "lon_std (m)": 9.0, "std_ve_mps": 0.4, "vn_stddev_mps": 0.5,
    "heading_sigma_deg": 0.2, "pitch_sd_deg": 0.01, "sigma_roll_deg": 0.03,
}  # fmt: skip


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """Recordings of an INS that gives deviations in columns."""
    found = recorded(tmp_path_factory.mktemp("deviations"))
    own = Path(found["ins"])
    with own.open(newline="") as stream:
        rows = list(csv.reader(stream))
    with own.open("w", newline="") as stream:
        writer = csv.writer(stream)
        writer.writerow([*rows[0], *NAMES])
        writer.writerows([*row, *NAMES.values()] for row in rows[1:])
    return found


def test_columns_are_kept_and_checked(files: dict[str, str]) -> None:
    found = load(files["ins"]).deviations
    assert {name: one.values[3].tolist() for name, one in found.items()} == {
        "position": [12.0, 9.0],
        "velocity": [0.4, 0.5],
        "heading": [pytest.approx(0.2 * DEG)],
        "attitude": [pytest.approx(0.01 * DEG), pytest.approx(0.03 * DEG)],
    }
    report = check_file(files["ins"])
    said = "  standard deviation, velocity over ground (E, N) (ve_sigma+vn_sigma): median 0.4 / 0.5 m/s"
    assert said in report.text
    assert not [warning for warning in report.warnings if "not used" in warning]


def test_errors_show_a_band_of_one_sigma_beside_the_output_as_recorded(files: dict[str, str]) -> None:
    run = simulate(on_ins(files, [METHOD], run={"duration_h": 1.0}))
    assert run.against is not None and run.against.recorded is not None
    sigma = run.against.recorded.sigma
    assert sigma is not None and sigma.shape == (len(run.against.recorded.t_s), 7)
    assert np.allclose(sigma[:, 2:], [0.2 * DEG, 0.4, 0.5, 12.0, 9.0])
    assert np.allclose(np.hypot(sigma[:, 0], sigma[:, 1]), np.hypot(0.01, 0.03) * DEG)
    band = own_band(run)
    assert band is not None and band.label == "band: ±1σ by the INS itself"
    plots = error_plots(run, envelope=band)
    plot = plots["dve"]
    assert plot.curves[0].name.startswith("as recorded")
    ((upper, lower, color),) = plot.bands
    assert color.startswith(plot.curves[0].color)
    assert np.allclose(plot.curves[upper].values * plot.unit.si, 0.4)
    assert np.allclose(plot.curves[lower].values * plot.unit.si, -0.4)
    table = run.to_arrow() if hasattr(run, "to_arrow") else None
    assert table is None or "sigma_dve_mps" in table.column_names


def test_without_deviations_there_is_no_band(tmp_path: Path) -> None:
    run = simulate(on_ins(recorded(tmp_path), [METHOD], run={"duration_h": 0.5}))
    assert own_band(run) is None


def test_accuracies_of_sentences_are_kept(tmp_path: Path) -> None:
    lines: list[str] = []
    for k in range(60):
        lat = f"{48.0 + 4e-5 * k:.8f}"
        lines += [
            sentence(f"PIXSE,TIME__,1000{k:02d}.000000"),
            sentence("HEHDT,30.00,T"),
            sentence(f"PIXSE,POSITI,{lat},5.00000000,3.000"),
            sentence("PIXSE,SPEED_,1.000,4.400,0.000"),
            sentence("PIXSE,ATITUD,0.100,-0.200"),
            sentence("PIXSE,STDHRP,0.050,0.010,0.020"),
            sentence("PIXSE,STDPOS,3.00,2.00,1.00"),
            sentence("PIXSE,STDSPD,0.100,0.200,0.300"),
        ]
    found = load(write(tmp_path / "phins.txt", lines)).deviations
    assert found["position"].values[5].tolist() == [3.0, 2.0]
    assert found["velocity"].values[5].tolist() == [0.1, 0.2]
    assert found["heading"].values[5] == pytest.approx([0.05 * DEG])
    assert found["attitude"].values[5] == pytest.approx([0.02 * DEG, 0.01 * DEG])
    lines = [
        sentence(f"PASHR,1000{k:02d}.00,30.00,T,+0.10,-0.20,+0.00,0.010,0.020,0.050,1,1") for k in range(60)
    ]
    found = load(write(tmp_path / "posmv.txt", lines)).deviations
    assert found["heading"].values[5] == pytest.approx([0.05 * DEG])
    assert found["attitude"].values[5] == pytest.approx([0.02 * DEG, 0.01 * DEG])
    assert START.year == 2024


def test_deviations_of_a_netcdf_file_are_kept(tmp_path: Path) -> None:
    file = tmp_path / "ship.nc"
    with netcdf_file(file, "w") as stream:
        stream.createDimension("time", 60)
        for name, values, units in (
            ("time", np.arange(60.0), "seconds since 2024-01-01 00:00:00 UTC"),
            ("lat", 54.0 + 1e-5 * np.arange(60), "degree_north"),
            ("lon", 7.0 + 1e-5 * np.arange(60), "degree_east"),
            ("lat_std", np.full(60, 3.0), "m"),
            ("lon_std", np.full(60, 4.0), "m"),
            ("heading", np.full(60, 30.0), "degree"),
            ("heading_std", np.full(60, 0.5), "degree"),
        ):
            variable = stream.createVariable(name, "d", ("time",))
            variable[:] = values
            variable.units = units
    found = load(file).deviations
    assert found["position"].values[7].tolist() == [3.0, 4.0]
    assert found["heading"].values[7] == pytest.approx([0.5 * DEG])
