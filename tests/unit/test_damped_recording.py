"""The damped output as a recording: read again, it errs as the method does; what is not moved stays."""

import csv
import math
from pathlib import Path

import numpy as np
import pynmea2
import pytest

from navcore.engine.damped_recording import damped_files, moved_by
from navcore.engine.run import Run
from navcore.engine.simulation import simulate
from navcore.foundation.errors import InputError
from navcore.foundation.units import DEG
from navcore.io.recording import load
from navcore.io.rewritten import Moved, written_like
from navcore.io.rewritten_nmea import checksum, rewritten_line
from navcore.questions.damp import DampQuestion
from navcore.scenario.model import Scenario
from tests.own_ins import on_ins
from tests.unit.test_own_ins_faults import recorded

METHOD = {"name": "compass", "damping": "external", "network": {"id": "compass", "sigma": 0.0025, "xi": 0.7}}


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    return recorded(tmp_path_factory.mktemp("ins"))


@pytest.fixture(scope="module")
def run(files: dict[str, str]) -> Run:
    return simulate(on_ins(files, [METHOD]))


def rows(path: str) -> list[dict[str, str]]:
    with Path(path).open(newline="") as stream:
        return list(csv.DictReader(stream))


def again(files: dict[str, str], ins: str) -> Run:
    return simulate(on_ins({**files, "ins": ins}, [{"name": "free", "damping": "free"}]))


def agree(first: Run, second: Run) -> None:
    """The output as recorded of one run errs as the method of another."""
    for name in ("dve_mps", "dvn_mps", "position_m"):
        told, expected = second.lines[0].errors[name], first.methods[0].errors[name]
        assert told["rms"] == pytest.approx(expected["rms"], rel=0.02), name
        assert told["max_abs"] < 0.5 * first.lines[0].errors[name]["max_abs"]


def test_a_damped_table_read_again_errs_as_the_method_does(
    run: Run, files: dict[str, str], tmp_path: Path
) -> None:
    ((name, text),) = damped_files(run, run.methods[0]).items()
    assert name == "ins.csv"
    (tmp_path / name).write_text(text)
    agree(run, again(files, str(tmp_path / name)))
    before, after = rows(files["ins"]), rows(str(tmp_path / name))
    assert list(before[0]) == list(after[0]) and len(before) == len(after) and before[0] == after[0]
    assert [row["t_s"] for row in before] == [row["t_s"] for row in after]
    moved = np.array([float(a["vn_mps"]) - float(b["vn_mps"]) for a, b in zip(after, before, strict=True)])
    expected = moved_by(run, run.methods[0]).at(np.arange(len(before)) * 1.0).velocity[:, 1]
    assert np.max(np.abs(moved - expected)) < 1e-9 and np.max(np.abs(moved)) > 0.5


@pytest.mark.parametrize("separator", [";", "\t", " "])
def test_the_look_of_a_table_stays(run: Run, files: dict[str, str], tmp_path: Path, separator: str) -> None:
    decimal = "," if separator == ";" else "."
    lines = [
        "# of the ship",
        separator.join(("t_s", "lat_deg", "lon_deg", "ve_kn", "vn_kn", "heading_deg", "note")),
    ]
    for row in rows(files["ins"])[::10]:
        cells = [f"{float(row['t_s']):.0f}", f"{float(row['lat_deg']):.8f}", f"{float(row['lon_deg']):.8f}"]
        cells += [f"{float(row[name]) / 0.5144444:.3f}" for name in ("ve_mps", "vn_mps")]
        cells += [f"{float(row['heading_deg']):.2f}"]
        lines.append(separator.join([cell.replace(".", decimal) for cell in cells] + ["x"]))
    path = tmp_path / "own.txt"
    path.write_text("\n".join(lines) + "\n")
    found = simulate(on_ins({**files, "ins": str(path)}, [METHOD]))
    ((_, text),) = damped_files(found, found.methods[0]).items()
    damped = text.split("\n")
    assert damped[:2] == lines[:2] and damped[-1] == "" and len(damped) == len(lines) + 1
    for old, new in zip(lines[2::200], damped[2::200], strict=True):
        before, after = old.split(separator), new.split(separator)
        assert before[0] == after[0] and before[-1] == after[-1]
        assert [len(cell.partition(decimal)[2]) for cell in before] == [
            len(cell.partition(decimal)[2]) for cell in after
        ]
    (tmp_path / "damped.txt").write_text(text)
    agree(run, again(files, str(tmp_path / "damped.txt")))


def as_nmea(path: Path, files: dict[str, str]) -> None:
    """Write the INS's output as GGA, RMC and HDT."""
    lines = []
    for row in rows(files["ins"]):
        t_s, lat, lon, ve, vn = (
            float(row[name]) for name in ("t_s", "lat_deg", "lon_deg", "ve_mps", "vn_mps")
        )
        clock = f"{int(t_s // 3600):02d}{int(t_s // 60 % 60):02d}{t_s % 60:05.2f}"
        place = f"{int(lat):02d}{lat % 1 * 60:09.6f},N,{int(lon):03d}{lon % 1 * 60:09.6f},E"
        course, speed = math.degrees(math.atan2(ve, vn)) % 360.0, math.hypot(ve, vn) / 0.514444444
        for body in (
            f"GPRMC,{clock},A,{place},{speed:.4f},{course:.4f},010524,,,A",
            f"GPGGA,{clock},{place},1,08,0.9,12.0,M,40.0,M,,",
            f"HEHDT,{float(row['heading_deg']):.2f},T",
        ):
            lines.append(f"${body}*{checksum(body)}")
    path.write_text("\n".join(lines) + "\n")


def test_damped_sentences_read_again_err_as_the_method_does(files: dict[str, str], tmp_path: Path) -> None:
    path = tmp_path / "ins.nmea"
    as_nmea(path, files)
    dated = {name: str(tmp_path / f"{name}.csv") for name in ("log", "truth")}
    for name, target in dated.items():
        first, *others = Path(files[name]).read_text().splitlines()
        moved = [f"{1714521600.0 + float(one.split(',')[0]):.0f},{one.split(',', 1)[1]}" for one in others]
        Path(target).write_text("\n".join([first.replace("t_s", "unix_time"), *moved]) + "\n")
    found = simulate(on_ins({**dated, "ins": str(path)}, [METHOD]))
    ((name, text),) = damped_files(found, found.methods[0]).items()
    for line in text.splitlines()[::997]:
        pynmea2.parse(line, check=True)
    before, after = path.read_text().splitlines(), text.splitlines()
    assert [one.split(",")[0] for one in before] == [one.split(",")[0] for one in after]
    assert [one.count(",") for one in before] == [one.count(",") for one in after]
    assert load(str(path)).sources[0].lines == len(after)
    (tmp_path / name).write_text(text)
    second = simulate(on_ins({**dated, "ins": str(tmp_path / name)}, [{"name": "free", "damping": "free"}]))
    agree(found, second)


ONE = Moved(
    np.array([0.0]),
    np.array([[0.01 * DEG, -0.02 * DEG]]),
    np.array([[0.5, -0.25]]),
    np.array([[0.3, -0.4, 0.5]]) * DEG,
    np.array([math.pi / 2.0]),
)
"""Of a ship that heads east: pitch changes by phi_N, roll by -phi_E."""


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("GPGLL,5959.700,N,00000.600,E,120000,A,A", "GPGLL,6000.300,N,00000.600,W,120000,A,A"),
        ("HEHDT,359.70,T", "HEHDT,0.20,T"),
        ("GPVTG,90.0,T,92.0,M,10.00,N,18.52,K,A", "GPVTG,92.5,T,94.5,M,10.98,N,20.34,K,A"),
        ("GPVTG,,T,,M,0.00,N,0.00,K,A", "GPVTG,,T,,M,1.09,N,2.01,K,A"),
        ("PIXSE,POSITI,54.30000000,359.99000000,12.0", "PIXSE,POSITI,54.31000000,359.97000000,12.0"),
        ("PIXSE,SPEED_,4.516,-0.100,0.01", "PIXSE,SPEED_,5.016,-0.350,0.01"),
        ("PIXSE,ATITUD,1.000,2.000", "PIXSE,ATITUD,0.700,2.400"),
        (
            "PASHR,120000.00,90.00,T,+1.00,-2.00,0.1,0.1,0.1,0.1,1,1",
            "PASHR,120000.00,90.50,T,+0.70,-2.40,0.1,0.1,0.1,0.1,1,1",
        ),
        ("PSXN,23,1.00,2.00,90.00,0.1", "PSXN,23,0.70,1.60,90.50,0.1"),
        ("PRDID,+2.00,+1.00,090.00", "PRDID,+1.60,+0.70,090.50"),
        ("GPZDA,120000,01,05,2024,,", "GPZDA,120000,01,05,2024,,"),
        ("GPGGA,120000,,,,,0,00,,,M,,M,,", "GPGGA,120000,,,,,0,00,,,M,,M,,"),
    ],
)
def test_each_kind_of_sentence(before: str, after: str) -> None:
    line = f"2024-05-01T12:00:00Z ${before}*{checksum(before)}"
    assert rewritten_line(line, ONE) == f"2024-05-01T12:00:00Z ${after}*{checksum(after)}"
    assert rewritten_line(f"${before}", ONE) == f"${after}"


def test_numbers_keep_their_look() -> None:
    assert written_like("-0.0012", 0.0011) == "0.0011" and written_like("007", 8.4) == "008"
    assert written_like("1.50", -0.001) == "0.00"


def test_the_question_writes_the_files_and_leaves_the_own_ones(files: dict[str, str], tmp_path: Path) -> None:
    scenario = on_ins(files, [METHOD, {"name": "free", "damping": "free"}])
    with pytest.raises(InputError, match="--method.*must be one of compass, free"):
        DampQuestion.ask({"scenario": scenario}).answer()
    question = DampQuestion.ask({"scenario": scenario, "method": "compass"})
    answer = question.answer()
    question.require_free(tmp_path)
    question.write(answer, tmp_path)
    assert (tmp_path / "ins.csv").read_text() == answer.files["ins.csv"]
    assert answer.document()["largest_change"]["position_m"] > 1e4
    with pytest.raises(InputError):
        question.require_free(Path(files["ins"]).parent)


def test_what_cannot_be_written_anew_is_refused(files: dict[str, str], tmp_path: Path) -> None:
    path = tmp_path / "ins.csv"
    lines = Path(files["ins"]).read_text().splitlines()
    named = [line.split(",") for line in lines]
    for row in named[1:]:
        row[1] = f"{float(row[1]):.6f} N"
    path.write_text("\n".join(",".join(row) for row in named) + "\n")
    found = simulate(on_ins({**files, "ins": str(path)}, [METHOD]))
    with pytest.raises(InputError, match="lat_deg = .*cannot be written anew"):
        damped_files(found, found.methods[0])
    plain = simulate(Scenario.parse({"run": {"duration_h": 0.1}, "method": [{"name": "free"}]}))
    with pytest.raises(InputError, match="own INS"):
        damped_files(plain, plain.methods[0])
