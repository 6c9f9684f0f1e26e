"""Runs and networks handed over to other programs: Arrow, pandas, MATLAB, python-control."""

import importlib.util
from pathlib import Path
from typing import Any

import control
import numpy as np
import pytest
from scipy.io import loadmat

import navcore
from navcore.engine.run import Run
from navcore.foundation.errors import InputError
from tools import stable


@pytest.fixture(scope="module")
def run() -> Run:
    """Three methods of a preset."""
    return navcore.simulate(navcore.load("zha-fast", ["run.duration_h=0.1"]))


def test_arrow_and_files_hold_the_rows_of_all_methods(run: Run, tmp_path: Path) -> None:
    import pyarrow.csv
    import pyarrow.parquet

    table = run.to_arrow()
    assert table.num_rows == sum(len(one.t_s) for one in run.methods)
    run.save(tmp_path / "x.parquet")
    assert pyarrow.parquet.read_table(tmp_path / "x.parquet").equals(table)
    run.save(tmp_path / "x.csv")
    assert pyarrow.csv.read_csv(tmp_path / "x.csv").column_names == table.column_names


def test_matlab_takes_every_name_and_finds_the_rows(run: Run, tmp_path: Path) -> None:
    run.save(tmp_path / "x.mat")
    found = loadmat(tmp_path / "x.mat", simplify_cells=True)
    names = [name for name in found if not name.startswith("_")]
    assert names == ["free", "classic2", "fast_compass"]
    for name, one in zip(names, run.methods, strict=True):
        assert found[name]["name"] == one.method.name
        np.testing.assert_array_equal(found[name]["phi_e_rad"], one.rows[:, 0])
        assert all(field.isidentifier() and len(field) <= 63 for field in found[name])


def test_another_ending_is_refused(run: Run, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"must end with .mat, .parquet or .csv"):
        run.save(tmp_path / "x.xls")
    with pytest.raises(InputError, match="cannot be written"):
        run.save(tmp_path / "missing" / "x.mat")


@pytest.mark.parametrize(("package", "method"), [("pandas", "to_pandas"), ("xarray", "to_xarray")])
def test_a_package_that_is_not_installed_is_named(
    package: str, method: str, run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    if importlib.util.find_spec(package) is not None:
        found = getattr(run, method)()
        assert len(found.t_s) > 0
        return
    with pytest.raises(InputError, match=f"needs the package {package}, which is not installed"):
        getattr(run, method)()


def test_a_system_of_python_control_becomes_the_network_and_comes_back() -> None:
    system: Any = control.tf([10.0, 0.02, 1e-5], [1.0, 0.02, 1e-5])
    for given in (system, control.ss(system)):
        back: Any = navcore.from_control(given).transfer(1.24e-3).to_control()
        w = np.geomspace(1e-5, 1.0, 7) * 1j
        np.testing.assert_allclose(back(w), system(w), rtol=1e-9)


@pytest.mark.parametrize(
    ("system", "said"),
    [
        (control.tf([1.0], [1.0, 1.0], 0.1), "a continuous system"),
        (control.ss([[-1.0]], [[1.0, 1.0]], [[1.0]], [[0.0, 0.0]]), "one input and one output"),
        ("1/s", "must be a TransferFunction"),
        (control.tf([1.0], [1.0] * 10), "system"),
    ],
)
def test_a_system_that_makes_no_network_is_refused(system: object, said: str) -> None:
    with pytest.raises(InputError, match=said):
        navcore.from_control(system)


def test_dir_shows_the_public_names_alone() -> None:
    assert dir(navcore) == sorted(navcore.__all__)
    assert {"register", "simulate", "load", "Run"} <= {*dir(navcore)}


def test_nothing_in_the_stable_interface_changes_unseen() -> None:
    """After a change that is meant: ``python -m tools.stable``, and a line in the changelog."""
    assert stable.PAGE.read_text("utf-8") == stable.text()


def test_the_packages_say_that_they_are_typed(repo_root: Path) -> None:
    assert (repo_root / "navcore" / "py.typed").is_file() and (repo_root / "app" / "py.typed").is_file()
