"""`schuler export`: files that compile and prove themselves, and every fault by its option with a remedy."""

import json
import subprocess
from pathlib import Path

import pytest

from schuler_bench.cli import main
from tests.exported import compiler

FLAGS = "-std=c99 -Wall -Wextra -Werror -Wconversion"
COMPASS = ["export", "zha-external", "--method", "fast (compass)", "--as", "c", "--quiet"]


@pytest.mark.skipif(not compiler(), reason="no C compiler")
def test_the_files_prove_themselves(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """24 h: exit code 0; 1 with an output that is off, 2 with a row that is missing; nothing is replaced."""
    out = tmp_path / "law"
    assert main([*COMPASS, "--name", "ship", "--json", "--out", str(out)]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["vectors"]["calls"] == 86_401
    assert sorted(told["files"]) == sorted(one.name for one in out.iterdir())
    assert {"ship.h", "ship.c", "test.c", "vectors.csv"} == set(told["files"])
    command = f"{compiler()} {FLAGS} ship.c test.c -lm -o replay"
    subprocess.run(command.split(), cwd=out, check=True)

    def replayed(lines: list[str]) -> tuple[int, str]:
        (out / "changed.csv").write_text("\n".join(lines) + "\n")
        done = subprocess.run(
            ["./replay", "changed.csv"], cwd=out, capture_output=True, text=True, check=False
        )
        return done.returncode, done.stdout

    lines = (out / "vectors.csv").read_text().splitlines()
    code, printed = replayed(lines)
    assert code == 0
    assert "v_star_e_mps" in printed
    cells = lines[500].split(",")
    cells[9] = repr(float(cells[9]) + 1e-9)
    assert replayed([*lines[:500], ",".join(cells), *lines[501:]])[0] == 1
    assert replayed(lines[:-1])[0] == 2
    assert main([*COMPASS, "--out", str(out)]) == 2
    assert "is not empty" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (
            ["--name", "2fast"],
            "--name = '2fast': must be letters, digits and _ after a letter, such as law_2fast",
        ),
        (["--name", "double"], "--name = 'double': is a word of C, MATLAB or Python: such as double_law"),
        (["--method", "slow"], "--method = 'slow': must be the name or the number of a method: 0: \"free\""),
        (["--method", "7"], "must be the name or the number of a method"),
        (["--rate", "0"], "--rate = 0.0: must be >= 0.1 and <= 200 (Hz)"),
        (["--rate", "0.15", "--set", "method.2.network.sigma=0.3"], "the loop is unstable; give at least"),
    ],
)
def test_bad_input_is_named_with_its_remedy(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], words: list[str], said: str
) -> None:
    out = tmp_path / "law"
    assert main([*COMPASS, *words, "--out", str(out)]) == 2
    assert said in capsys.readouterr().err
    assert not out.exists()
