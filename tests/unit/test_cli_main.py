"""The command line as a whole: usage errors, help, exit codes, streams that take no more; presets, schema."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from navcore.scenario.file import presets
from navcore.scenario.schema_file import schema_text
from navcore.study.file import studies
from schuler_bench.cli import main
from schuler_bench.cli.parse import _COMMANDS

ROOT = Path(__file__).resolve().parents[2]


def run(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> tuple[int, str, list[str]]:
    code = main(arguments)
    captured = capsys.readouterr()
    return code, captured.out, captured.err.splitlines()


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ([], f"{{{', '.join(_COMMANDS)}}}"),
        (["simulate"], "bench}, not 'simulate'"),
        (["run"], "run needs SCENARIO"),
        (["run", "zha-fast", "--fromat", "csv"], "run does not know --fromat; perhaps --format"),
        (["run", "zha-fast", "--format", "xml"], "'xml'"),
        (["run", "zha-fast", "sun-step"], "sun-step"),
        (["run", "zha-fast", "--set"], "--set"),
        (["serve", "--port", "http"], "--port = 'http': must be a whole number"),
        (["network"], "NETWORK"),
        (["bench", "extra"], "extra"),
    ],
)
def test_a_wrong_command_line_is_one_line_and_exit_2(arguments, said, capsys):
    code, out, err = run(arguments, capsys)
    assert code == 2
    assert out == ""
    assert len(err) == 1
    assert err[0].startswith("schuler: ")
    assert said in err[0]


@pytest.mark.parametrize(
    ("override", "lines"),
    [
        (["run.duration_h=-1"], ["run.duration_h = -1: must be > 0"]),
        (["run.duration_h=nan", "site.lat_deg=95"], ["run.duration_h", "site.lat_deg = 95"]),
        (["method.1.network.id=compas"], ["method.1.network.id = 'compas'", "compass"]),
        (["method.7.name=x"], ["0 to 2"]),
        (["run.speed=3"], ["run.speed = 3"]),
        (["nonsense"], ["KEY=VALUE"]),
        (["imu.gyro_bias_dph=[1]"], ["imu.gyro_bias_dph"]),
        (["reference.kind=none"], ["method.1.damping", "reference.kind"]),
        (['motion.kind="track"', 'motion.file="no\\u0000where"'], ["motion.file"]),
        (['reference.kind="file"', 'reference.file="/no/such/log"'], ["/no/such/log"]),
    ],
)
def test_a_wrong_field_is_named_with_value_and_range(override, lines, capsys):
    sets = [word for item in override for word in ("--set", item)]
    code, out, err = run(["run", "zha-fast", *sets], capsys)
    assert code == 2
    assert out == ""
    assert "Traceback" not in "\n".join(err)
    for line in lines:
        assert any(line in said for said in err), err


@pytest.mark.parametrize("content", [b"", b"\x00\xff\xfe\x80", b"schema = 1\n[run\n", b"schema = 99\n"])
def test_a_scenario_file_with_anything_in_it(content, tmp_path, capsys):
    file = tmp_path / "scenario.toml"
    file.write_bytes(content)
    code, _, err = run(["run", str(file), "--set", "run.duration_h=0.01", "--quiet"], capsys)
    if content:
        assert code == 2
        assert len(err) == 1
        assert str(file) in err[0]
    else:
        assert code == 0  # every field has a default


def test_a_folder_is_no_scenario(tmp_path, capsys):
    code, _, err = run(["run", str(tmp_path)], capsys)
    assert code == 2
    assert len(err) == 1


def test_help_and_version(capsys):
    code, out, err = run(["--help"], capsys)
    assert (code, err) == (0, [])
    for command in ("serve", "run", "network", "presets", "check", "bench"):
        assert command in out
        code, text, err = run([command, "--help"], capsys)
        assert (code, err) == (0, [])
        assert f"usage: schuler {command}" in text
    assert run(["--version"], capsys)[1].startswith("schuler 0.")


def test_a_ctrl_c_outside_a_run_is_one_line(capsys, monkeypatch):
    from schuler_bench.cli.network import NetworkCommand

    def interrupted(_: NetworkCommand) -> int:
        raise KeyboardInterrupt

    monkeypatch.setattr(NetworkCommand, "execute", interrupted)
    assert run(["network", 'id = "classic2"'], capsys) == (3, "", ["stopped"])


def command(*arguments: str, **keywords) -> subprocess.Popen[str]:
    words = [sys.executable, "-m", "schuler_bench", *arguments]
    return subprocess.Popen(words, cwd=ROOT, text=True, stderr=subprocess.PIPE, **keywords)


_BY_NAME = """
import runpy, sys
sys.argv[1:] = ["--version"]
try:
    runpy.run_module({name!r}, run_name="__main__", alter_sys=True)
finally:
    print(*(name for name in sys.modules if name.partition(".")[0] == "app"))
"""


@pytest.mark.parametrize(("name", "loaded"), [("schuler_bench", ""), ("app", "app")])
def test_in_a_checkout_the_folder_is_the_command_too(name: str, loaded: str):
    words = [sys.executable, "-c", _BY_NAME.format(name=name)]
    done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=True)
    version, by_the_folders_name = done.stdout.splitlines()
    assert version.startswith("schuler 0.")
    assert by_the_folders_name == loaded, "a module is imported under two names"


@pytest.mark.parametrize(("given", "wanted"), [(None, "1"), ("3", "3")])
def test_blas_has_one_thread_unless_the_user_says_otherwise(given: str | None, wanted: str) -> None:
    names = "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"
    environment = {name: value for name, value in os.environ.items() if name not in names}
    if given is not None:
        environment[names[0]] = given
    code = (
        "import os, sys; from schuler_bench.cli import main; assert 'numpy' not in sys.modules; "
        f"main(['presets']); print(os.environ['{names[0]}'], file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, env=environment, cwd=ROOT)
    assert done.stderr.decode().strip() == wanted


def test_a_reader_that_leaves_early_is_no_fault():
    reading, writing = os.pipe()
    os.close(reading)
    process = command("network", 'id = "classic2"', "--json", stdout=writing)
    os.close(writing)
    _, err = process.communicate(timeout=60)
    assert (process.returncode, err) == (0, "")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full on this system")
def test_a_full_disk_behind_stdout_is_one_line():
    with open("/dev/full", "w") as full:
        process = command("network", 'id = "classic2"', stdout=full)
        _, err = process.communicate(timeout=60)
    assert process.returncode == 2
    assert err == "standard output: cannot be written: No space left on device\n"


# ---------------------------------------------------------------- presets and the schema


def test_json_lists_every_preset_with_its_source(capsys):
    assert main(["presets", "--json"]) == 0
    captured = capsys.readouterr()
    document = json.loads(captured.out)
    assert list(document) == ["presets", "studies", "schema_file"]
    assert [s["name"] for s in document["studies"]] == sorted(studies())
    assert all(list(study) == ["name", "title"] for study in document["studies"])
    assert [p["name"] for p in document["presets"]] == sorted(presets())
    assert {"liu-networks", "liu-overshoot", "sun-step", "zha-fast"} <= set(presets())
    for preset in document["presets"]:
        assert list(preset) == ["name", "title", "source", "fidelity"]
        assert all(preset.values())
    assert Path(document["schema_file"]).is_file()


def test_people_get_a_line_a_preset(capsys):
    assert main(["presets"]) == 0
    lines = capsys.readouterr().out.splitlines()
    for name in presets():
        assert any(line.startswith(f"{name} ") for line in lines)


def test_the_schema_knows_the_fields_and_their_ranges():
    schema = json.loads(schema_text())
    assert set(schema["properties"]) >= {
        "schema",
        "run",
        "site",
        "motion",
        "imu",
        "reference",
        "method",
        "view",
    }
    duration = schema["$defs"]["RunSettings"]["properties"]["duration_h"]
    assert (duration["exclusiveMinimum"], duration["maximum"], duration["unit"]) == (0.0, 8760.0, "h")
    assert "required" not in schema  # every field has a default
