"""``schuler check`` of scenarios and logs."""

import json
import subprocess
import sys
import tempfile

import pytest
from numba.core import event

from navcore.checks.report import FileReport
from navcore.foundation import guarded
from navcore.foundation.visible import visible
from navcore.scenario.file import load, scenario_hash
from navcore.warm import compile_once
from schuler_bench.bench.process import environment
from schuler_bench.cli import main
from schuler_bench.cli.check import check, guarded_check
from tests.recordings import ship


def test_a_scenario_is_described(tmp_path, capsys):
    file = tmp_path / "my.toml"
    file.write_text(
        'schema = 1\ntitle = "mine"\n[reference]\nkind = "log"\n[[method]]\ndamping = "external"\n'
        'network = { id = "compass" }\n'
    )
    assert main(["check", str(file), "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["ok"] is True
    assert document["title"] == "mine"
    assert document["scenario_sha256"] == scenario_hash(load(str(file)))
    assert document["methods"][0]["network"] == "compass"
    assert any("H(0)" in warning for warning in document["warnings"])
    assert main(["check", str(file)]) == 0
    out = capsys.readouterr().out
    assert "mine" in out and "external, network compass" in out and "warning: " in out


def test_a_preset_is_checked_by_its_name(capsys):
    assert main(["check", "liu-overshoot"]) == 0
    assert "5: sine for 1000 s" in capsys.readouterr().out


@pytest.mark.parametrize("json_wanted", [False, True])
def test_a_wrong_scenario_gives_a_line_per_fault(json_wanted, tmp_path, capsys):
    file = tmp_path / "wrong.toml"
    file.write_text('schema = 1\n[run]\nduration_h = -1\nearth = "flat"\n')
    assert main(["check", str(file), *(["--json"] if json_wanted else [])]) == 2
    captured = capsys.readouterr()
    lines = captured.err.splitlines()
    assert len(lines) == 2
    assert all(line.startswith(f"{file}: run.") for line in lines)
    if json_wanted:
        document = json.loads(captured.out)
        assert document["ok"] is False
        assert [fault["field"] for fault in document["faults"]] == ["run.duration_h", "run.earth"]
    else:
        assert captured.out == ""


def test_a_motion_that_cannot_be_carried_out_is_found(tmp_path, capsys):
    file = tmp_path / "track.toml"
    file.write_text('schema = 1\n[motion]\nkind = "track"\nfile = "missing.csv"\n')
    assert main(["check", str(file)]) == 2
    err = capsys.readouterr().err
    assert "motion.file" in err and err.count("\n") == 1


@pytest.mark.parametrize("content", [None, b"", b"\x00\x01\x02\xff" * 100])
def test_a_log_that_is_none(content, tmp_path, capsys):
    file = tmp_path / "log.txt"
    if content is not None:
        file.write_bytes(content)
    assert main(["check", str(file)]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert str(file.name) in captured.err
    assert "Traceback" not in captured.err


@pytest.mark.parametrize("name", ["a" * 3000, "a" * 300 + ".toml", "a\0b"])
def test_a_name_that_no_file_can_have_is_refused(name, capsys):
    assert main(["check", name]) == 2
    assert visible(name)[:2] in capsys.readouterr().err


def test_the_ships_log_is_described(capsys):
    files = ship()
    assert main(["check", files.log, "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert ("VDVBW" if files.raw else "rows") in document["sentences"]
    assert document["checksum_faults"] == 0
    assert document["quantities"]["ground"]["span_s"] == pytest.approx(46 * 60, rel=0.05)


# ---------------------------------------------------------------- a recorded IMU


HEADER = "t_s,gx_rad_s,gy_rad_s,gz_rad_s,fx_mps2,fy_mps2,fz_mps2"
PSINS = """% PSINS-format SIMU log file.
0 0 -90.6 0 0 0
34.0 108.0 380.0 0.0 10.0 9.780327
0.1 0.1 0.1 125 125 125
{rows}
"""


def _csv(tmp_path, times, force="0.1,0.2,9.8"):
    path = tmp_path / "imu.csv"
    path.write_text("\n".join([HEADER, *(f"{t},1e-5,2e-5,3e-5,{force}" for t in times)]) + "\n")
    return str(path)


def _check(path, capsys):
    code = main(["check", path, "--json"])
    return code, json.loads(capsys.readouterr().out)


def test_a_csv_is_described(tmp_path, capsys):
    code, told = _check(_csv(tmp_path, [k / 50 for k in range(1, 101)]), capsys)
    assert (code, told["kind"], told["warnings"]) == (0, "recorded IMU, CSV", [])
    assert (told["samples"], told["rate_hz"], told["span_s"], told["gaps"]) == (100, 50.0, 2.0, 0)
    assert told["up_axis"] == "+z" and told["mean_force_mps2"] == [0.1, 0.2, 9.8]
    assert told["mean_turn_dph"][0] == pytest.approx(2.0626, abs=1e-3)


def test_psins_gives_its_place(tmp_path, capsys):
    path = tmp_path / "a.imu"
    path.write_text(PSINS.format(rows="1 -2 3 4 -5 80\n" * 50))
    code, told = _check(str(path), capsys)
    assert (code, told["kind"]) == (0, "recorded IMU, PSINS")
    assert told["place"] == {"lat_deg": 34.0, "lon_deg": 108.0, "height_m": 380.0}


@pytest.mark.parametrize(
    ("force", "warning"),
    [
        ("0.1,0.2,-9.8", 'the -z axis looks like up: forward, right, down? Then give imu.axes = "frd"'),
        ("9.8,0.1,0.2", "the +x axis looks like up"),
        ("0,0,1.0", "is 1 m/s², far from gravity"),
    ],
)
def test_wrong_axes_and_scales_are_warned_of(force, warning, tmp_path, capsys):
    code, told = _check(_csv(tmp_path, [k / 50 for k in range(1, 101)], force), capsys)
    assert code == 0 and len(told["warnings"]) == 1 and warning in told["warnings"][0]


@pytest.mark.parametrize(
    ("times", "force", "fault"),
    [
        ([1, 2, 3, 7, 8], "0,0,9.8", "1 gaps, the first at t = 3 s, the longest 4 s"),
        ([1, 2, 2, 3], "0,0,9.8", "time stands still or runs backwards at t = 2 s"),
        ([1, 2, 3, 4], "0,nan,9.8", "4 samples are NaN or infinite, the first at sample 1"),
    ],
)
def test_gaps_and_nan_are_faults(times, force, fault, tmp_path, capsys):
    code, told = _check(_csv(tmp_path, times, force), capsys)
    assert code == 2 and not told["ok"] and fault in told["faults"][0]["allowed"]


def test_people_get_the_same_in_words(tmp_path, capsys):
    assert main(["check", _csv(tmp_path, range(1, 20))]) == 0
    out = capsys.readouterr().out
    for word in (
        "19 samples at 1 Hz",
        "the +z axis looks like up",
        "the Earth: 15.041",
        "warning: 1 Hz is slow",
    ):
        assert word in out


def test_no_kernel_is_compiled_for_a_scenario_that_check_understands(tmp_path):
    """Each error alone and with another: the child can keep no kernels, so all must be there before."""
    errors = ("gyro_bias_dph=[0.005,0.0,0.0]", "gyro_arw_dpsh=0.001", "gyro_lsb=[1e-7,1e-7,1e-7]")
    motions = {
        "static": 'kind = "static"',
        "legs": 'kind = "legs"\nleg = [{duration_s = 600.0}, {duration_s = 120.0, heading_deg = 90.0}]',
    }
    compile_once()
    with Uncached() as compiled:
        for imu in (*errors, f"{errors[1]}\n{errors[2]}"):
            for name, motion in motions.items():
                file = tmp_path / f"{name}.toml"
                file.write_text(f"schema = 1\n[motion]\n{motion}\n[imu]\n{imu}\n[[method]]\n")
                assert check(str(file)).ok
    assert compiled.names == []


class Uncached(event.Listener):
    """Names of the kernels that are compiled, and not loaded, within its block."""

    def __enter__(self):
        self.names = []
        event.register("numba:compile", self)
        return self

    def __exit__(self, *_):
        event.unregister("numba:compile", self)

    def on_start(self, event):
        self.names.append(event.data["dispatcher"].py_func.__qualname__)

    def on_end(self, event):
        del event


def twice_after_an_installation(file, folder):
    """``schuler check`` with an empty cache, as after ``pip install``, and once more."""
    places = dict.fromkeys(("HOME", "XDG_CACHE_HOME"), str(folder))
    variables = {name: value for name, value in environment().items() if name != "SCHULER_CACHE_DIR"} | places
    words = [sys.executable, "-m", "schuler_bench", "check", file]
    # A socket's path holds about 100 letters: the folder of a test may lie too deep for that of the readers.
    with tempfile.TemporaryDirectory(dir="/tmp") as temporary:
        variables |= {"TMPDIR": temporary}
        return [
            subprocess.run(words, env=variables, capture_output=True, text=True, check=False)
            for _ in range(2)
        ]


def test_a_preset_is_understood_right_after_an_installation(tmp_path):
    first, second = twice_after_an_installation("zha-fast", tmp_path)
    assert (first.returncode, first.stderr, second.stderr) == (0, "", "")
    assert "zha-fast" in first.stdout and first.stdout == second.stdout


@pytest.mark.nightly
@pytest.mark.timeout(900)
def test_a_file_is_understood_right_after_an_installation(tmp_path):
    """The kernels are compiled before it is read; the second time without a word about them."""
    file = tmp_path / "ship.toml"
    file.write_text("schema = 1\n[[method]]\n")
    first, second = twice_after_an_installation(str(file), tmp_path)
    assert (first.returncode, second.returncode, second.stderr) == (0, 0, "")
    assert first.stderr.startswith("kernels: ") and first.stdout == second.stdout


def test_kernels_are_compiled_before_a_file_is_read_in_a_child(tmp_path, monkeypatch, capsys):
    file = tmp_path / "ship.toml"
    file.write_text("schema = 1\n[[method]]\n")
    children = []
    monkeypatch.setattr("navcore.foundation.kernel_cache.complete", lambda: False)
    monkeypatch.setattr(
        "navcore.warm.compile_for_checks", lambda progress: progress(f"{len(children)} children")
    )
    monkeypatch.setattr(guarded, "start", lambda *given: children.append(given))
    monkeypatch.setattr(guarded, "call", lambda file, *given: FileReport(file, ""))
    assert guarded_check(str(file)).ok
    assert capsys.readouterr().err == "kernels: 0 children\n" and len(children) == 1


def test_a_temporary_folder_with_a_long_path_is_named(tmp_path):
    deep = tmp_path / ("a" * 80)
    deep.mkdir()
    file = tmp_path / "ship.toml"
    file.write_text("schema = 1\n[[method]]\n")
    words = [sys.executable, "-m", "schuler_bench", "check", str(file)]
    variables = environment() | {"TMPDIR": str(deep)}
    done = subprocess.run(words, env=variables, capture_output=True, text=True, check=False)
    assert done.returncode != 0
    said = f"the path of the temporary folder has {len(str(deep))} letters"
    assert said in done.stderr and "at most 70; set TMPDIR to a shorter one" in done.stderr
