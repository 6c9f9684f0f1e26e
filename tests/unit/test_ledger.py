"""The ledger of how numbers are known is that of the tests, and most numbers have an outside oracle."""

import pytest

from navcore.damping import KINDS
from navcore.quantities import LIMITED, QUANTITIES
from navcore.quantities.known import METHODS, WAYS, Entry, best, known, ledger
from navcore.scenario.file import load
from schuler_bench.plots.known import known_mark
from tools import ledger as made


def test_the_ledger_is_that_of_the_tests() -> None:
    """`python -m tools.ledger` writes it; every test that it names is there."""
    for path, text in made.texts().items():
        assert path.read_text("utf-8") == text, f"python -m tools.ledger makes {path.name} anew"
    assert {*KINDS} <= {*METHODS}
    assert [one.entry for one in made.markers(made.ROOT / "tests")] == [*ledger()]


def test_most_quantities_are_known_by_an_outside_oracle() -> None:
    by_oracle = [key for key in QUANTITIES if known(key) == "oracle"]
    assert len(by_oracle) >= 0.6 * len(QUANTITIES)
    assert [key for key in LIMITED if known(key) == "none"] == []


def test_the_best_way_counts_and_another_method_or_fidelity_does_not() -> None:
    entries = [
        Entry("twin", ("settling_s",), ("free", "external"), ("loop",), "a"),
        Entry("oracle", ("settling_s",), ("external",), ("loop",), "b"),
    ]
    assert best(entries, "settling_s", "external", "loop") == "oracle"
    assert best(entries, "settling_s", "free") == "twin" and best(entries, "settling_s", "kalman") == "none"
    assert best(entries, "h0") == "none" == WAYS[-1]


def test_a_marker_of_what_does_not_exist_is_refused(tmp_path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(made, "ROOT", tmp_path)
    for said in ('"oracle", ["no_such"]', '"guess", ["settling_s"]'):
        (tmp_path / "test_it.py").write_text(
            f'@pytest.mark.known({said}, kinds=["free"], fidelities=["loop"], source="x")\n'
            "def test_it() -> None:\n    pass\n"
        )
        with pytest.raises(ValueError, match=r"test_it\.py::test_it"):
            list(made.markers(tmp_path))


def test_a_number_has_a_mark_of_its_own_method() -> None:
    """In words and with the oracle beneath the pointer."""
    free, *_ = load("zha-fast").method
    marked = known_mark("position_max_m", free, "error_model")
    assert "●" in marked and "outside oracle" in marked and "matrix exponential" in marked
    compass = next(one for one in load("sea-gyrocompass").method if one.gyrocompass)
    assert "●" not in known_mark("roll_rms_arcmin", compass, "strapdown")
    assert "of another method or fidelity" in known_mark("roll_rms_arcmin", compass, "strapdown")
