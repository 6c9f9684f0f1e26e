"""A law of a user's own as a unit (FMU): what is refused, by name and with the remedy."""

import sys
import zipfile
from pathlib import Path

import pytest

from navcore.exporting import target_c, target_fmu
from navcore.exporting.law_form import law_form
from navcore.extending.fmu_law import fmu_law
from navcore.foundation.errors import InputError
from navcore.law.called import Given
from navcore.law.hosted import Start
from tests.exported import busy_inputs, compiler
from tests.unit.test_export_laws import FEW, subject

pytestmark = pytest.mark.skipif(not compiler(), reason="no C compiler")
START = Start(0.7, 0.0, 0.0, 1.0)


@pytest.fixture(scope="module")
def unit(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An exported law, called once a second."""
    form = law_form(subject(FEW[1]), busy_inputs(20))
    made = target_fmu.files(form, "law", False, target_c.double_bounds(form))["law.fmu"]
    path = tmp_path_factory.mktemp("unit") / "law.fmu"
    path.write_bytes(made if isinstance(made, bytes) else b"")
    return path


def changed(unit: Path, folder: Path, old: str, new: str, left_out: str = "") -> Path:
    """The unit with another text in its description, or without some files."""
    path = folder / "other.fmu"
    with zipfile.ZipFile(unit) as given, zipfile.ZipFile(path, "w") as made:
        for name in given.namelist():
            content = given.read(name)
            if name == "modelDescription.xml":
                content = content.replace(old.encode(), new.encode())
            if not (left_out and name.startswith(left_out)):
                made.writestr(name, content)
    return path


def test_each_run_has_an_instance_of_its_own(unit: Path) -> None:
    """Two side by side: what one is given moves nothing in the other."""
    law = fmu_law(unit, id="ours")
    assert (law.id, law.help) == ("ours", "the unit in law.fmu")
    calm = Given(5.0, 1.0, 0.7, 5.0, 1.0, 1, 0.2, 0.0, 0.0)
    first, second = law().start(START), law().start(START)
    answers = [(first(calm._replace(log_e_mps=6.0)), second(calm)) for _ in range(20)]
    answer = answers[-1][1]
    assert answer.damped is True
    assert (answer.v_star_e_mps, answer.v_star_n_mps) == pytest.approx((5.0, 1.0), abs=1e-12)
    assert abs(first(calm._replace(log_e_mps=6.0)).v_star_e_mps - 5.0) > 0.1


def test_another_rate_is_refused_with_the_remedy(unit: Path) -> None:
    said = r"runs at a step of 1 s and is called every 0.5 s: set run.step_s, or export it for 2 Hz"
    with pytest.raises(InputError, match=said):
        fmu_law(unit)().host(START._replace(step_s=0.5))


@pytest.mark.parametrize(
    ("old", "new", "left_out", "said"),
    [
        ('"v_star_n_mps"', '"north"', "", "must have the output v_star_n_mps"),
        ("", "", "binaries/", "has no binary for this machine"),
        ("<ModelVariables>", "<Model>", "", "is no unit that can be read"),
    ],
)
def test_a_unit_that_is_no_law_is_refused(
    unit: Path, tmp_path: Path, old: str, new: str, left_out: str, said: str
) -> None:
    with pytest.raises(InputError, match=said):
        fmu_law(changed(unit, tmp_path, old, new, left_out))


def test_what_is_no_unit_or_not_there_is_refused(tmp_path: Path) -> None:
    (tmp_path / "text.fmu").write_text("no ZIP")
    for name in ("text.fmu", "none.fmu"):
        with pytest.raises(InputError, match=f"{name}: is no unit that can be read"):
            fmu_law(tmp_path / name)


def test_without_fmpy_it_says_what_to_install(unit: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "fmpy", None)
    with pytest.raises(InputError, match="needs FMPy, which is not installed: pip install fmpy"):
        fmu_law(unit)
