"""The third door: uploaded files of a ship's own INS are told apart, damped by one button, and summed up."""

from pathlib import Path

import pytest

from navcore.engine.drivers.outside import prepared
from navcore.engine.simulation import simulate
from navcore.foundation.errors import InputError
from navcore.scenario.model import Scenario
from schuler_bench.session.own_ins import JUDGED, Taken, described, own_scenario, sentence, taken
from schuler_bench.session.recordings import recorded_scenario
from schuler_bench.session.uploads import Uploads
from tests.sentences import seconds
from tests.unit.test_own_ins_faults import recorded


@pytest.fixture(scope="module")
def contents(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    files = recorded(tmp_path_factory.mktemp("ins"))
    return {name: Path(path).read_bytes() for name, path in files.items()}


def uploaded(folder: Path, contents: dict[str, bytes], **names: str) -> Uploads:
    uploads = Uploads(folder / "session")
    for kind, name in names.items():
        uploads.add(name, contents[kind])
    return uploads


@pytest.mark.parametrize(
    ("ins", "truth"),
    [("ins.csv", "truth.csv"), ("b.csv", "gnss_b.csv"), ("phins.csv", "a.csv"), ("z.csv", "a.csv")],
)
def test_files_are_told_apart(contents: dict[str, bytes], tmp_path: Path, ins: str, truth: str) -> None:
    uploads = uploaded(tmp_path, contents, log="speed.csv", truth=truth, ins=ins)
    roles = taken(uploads)
    assert roles == Taken((ins,), ("speed.csv",), (truth,)) and not roles.missing
    assert roles.exchanged() == Taken((truth,), ("speed.csv",), (ins,))
    assert [names for _, names in described(uploads, roles)] == [ins, "speed.csv", truth]


def test_what_is_missing_is_named(contents: dict[str, bytes], tmp_path: Path) -> None:
    other = tmp_path / "other"
    other.mkdir()
    assert "speed log" in taken(uploaded(tmp_path, contents, ins="ins.csv")).missing
    assert "output of the INS" in taken(uploaded(other, contents, log="log.csv")).missing


def test_one_button_gives_curves_and_a_sentence(contents: dict[str, bytes], tmp_path: Path) -> None:
    uploads = uploaded(tmp_path, contents, ins="ins.csv", log="log.csv", truth="gnss.csv")
    scenario, notes = own_scenario(uploads, taken(uploads))
    assert "6.0 h" in notes[0] and scenario.site.lat_deg == pytest.approx(54.0, abs=0.01)
    assert len(scenario.method) == 4 and scenario.run.duration_h == pytest.approx(6.0, abs=0.001)
    run = simulate(scenario)
    assert [one.status for one in run.lines] == ["ok"] * 5
    said = sentence(run, "position_max_m")
    assert said.startswith("With compass the largest position error would have been") and "% less" in said
    assert all(sentence(run, key) for key in JUDGED)


def test_without_a_reference_the_sentence_claims_nothing(contents: dict[str, bytes], tmp_path: Path) -> None:
    uploads = uploaded(tmp_path, contents, ins="ins.csv", log="log.csv")
    run = simulate(own_scenario(uploads, taken(uploads))[0])
    assert sentence(run, "position_max_m").startswith("No reference was given: ")


def test_a_scenario_on_an_ins_gives_way_to_a_track(contents: dict[str, bytes], tmp_path: Path) -> None:
    uploads = uploaded(tmp_path, contents, ins="ins.csv", log="log.csv")
    scenario, _ = own_scenario(uploads, taken(uploads))
    tracked, _ = recorded_scenario(scenario, uploads)
    assert not tracked.on_ins and tracked.motion.kind == "track"
    with pytest.raises(InputError, match="motion: must be left out"):
        Scenario.parse(scenario.canonical() | {"motion": {"kind": "static"}})


def test_one_file_with_all_of_it_is_ins_and_log(tmp_path: Path) -> None:
    uploads = Uploads(tmp_path / "session")
    text = "".join(f"{line}\n" for second in seconds(600) for line in second)
    uploads.add("line.nmea", text.encode())
    roles = taken(uploads)
    assert roles == Taken(("line.nmea",), ("line.nmea",)) and not roles.missing
    run = simulate(own_scenario(uploads, roles)[0])
    assert [one.status for one in run.methods] == ["ok"] * 4
    assert run.scenario.reference.frame == "enu", "as it was given"
    prepared_scenario, env, _ = prepared(run.scenario)
    assert prepared_scenario.reference.frame == "body" and env.reference.body_frame
