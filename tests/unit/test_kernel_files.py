"""Whose machine code is used, who may read and write it, and what happens where none can be kept."""

import errno
import os
import stat
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import pytest

from navcore.foundation import kernel_cache, kernel_files
from navcore.foundation.compiled import PORTABLE_SETTINGS
from navcore.foundation.errors import InputError
from schuler_bench.bench.process import environment


@pytest.mark.parametrize(
    ("settings", "refused"),
    [
        ({"NUMBA_DISABLE_JIT": "1"}, ["NUMBA_DISABLE_JIT"]),
        ({"NUMBA_OPT": "0", "NUMBA_BOUNDSCHECK": "1"}, ["NUMBA_BOUNDSCHECK", "NUMBA_OPT"]),
        ({"NUMBA_CPU_NAME": "nonsense"}, ["NUMBA_CPU_NAME"]),
        (PORTABLE_SETTINGS, []),
        ({"NUMBA_DEBUG_CACHE": "0", "NUMBA_NUM_THREADS": "1"}, []),
    ],
)
def test_settings_that_change_the_machine_code_are_refused_by_name(
    settings: dict[str, str], refused: list[str]
):
    program = [sys.executable, "-m", "schuler_bench", "run", "zha-fast", "--set", "run.duration_h=0"]
    done = subprocess.run(program, env=environment() | settings, capture_output=True, text=True, check=False)
    lines = done.stderr.splitlines()
    assert done.returncode == 2
    if refused:
        assert [line.split(" = ")[0] for line in lines] == [f"environment: {name}" for name in refused]
        assert all("must not be set" in line for line in lines)
    else:
        assert "environment" not in done.stderr and "run.duration_h" in done.stderr


SHIPPED = """
from pathlib import Path
import navcore.foundation.kernel_cache as cache
cache.SHIPPED = Path("{shipped}")
if {needed}:
    cache._NEEDED = ("a processor of tomorrow",)
from numba.core import event
from navcore.foundation.compiled import COMPILATION
"""


@pytest.mark.parametrize(
    ("needed", "compiled"), [(False, 0), (True, 1)], ids=["they fit", "a feature is missing"]
)
def test_kernels_of_the_wheel_are_used_where_they_fit(
    portable: Path, tmp_path: Path, needed: bool, compiled: int
):
    """One kernel stands for all; nothing is written, wherever it could be."""
    begin = SHIPPED.format(shipped=portable, needed=needed)
    program = begin + KERNEL.format(umask=0o022) + "print(COMPILATION.count, cache.ready())\n"
    done = run_kernel(program, tmp_path / "own")
    assert done.stdout.split() == ["computed", str(compiled), str(compiled == 0)]
    assert bool(list(tmp_path.rglob("*.nbc"))) is (compiled > 0)


@pytest.fixture(scope="module")
def portable(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One kernel, compiled as those of a wheel are."""
    base = tmp_path_factory.mktemp("shipped") / "kernels"
    done = run_kernel(KERNEL.format(umask=0o022), base, PORTABLE_SETTINGS)
    assert done.stdout == "computed\n", done.stderr
    (folder,) = base.glob("kernels-*")
    (folder / "complete").touch()
    return base


KERNEL = """
import os
os.umask({umask:#o})
from navcore.sensors.imu_kernels import add_quantisation
import numpy as np
add_quantisation(np.zeros((4, 3)), np.eye(3), np.ones(3), 1.0, np.zeros((4, 3)))
print("computed")
"""


def compiled(base: Path, umask: int = 0o022) -> subprocess.CompletedProcess[str]:
    """Compile, or load, one kernel in a process of its own."""
    return run_kernel(KERNEL.format(umask=umask), base)


def run_kernel(
    program: str, base: Path, settings: dict[str, str] | None = None
) -> subprocess.CompletedProcess[str]:
    """Run a program whose kernels are kept under a folder."""
    places = {"SCHULER_CACHE_DIR": str(base), "HOME": str(base / "home"), "TMPDIR": "/tmp"}
    given = environment() | places | (settings or {})
    line = [sys.executable, "-c", program]
    return subprocess.run(line, env=given, capture_output=True, text=True, check=False)


@pytest.mark.parametrize("umask", [0o077, 0o002])
def test_everyone_may_read_the_machine_code_and_its_owner_alone_write_it(tmp_path: Path, umask: int):
    base = tmp_path / "kernels"
    done = compiled(base, umask)
    assert (done.stdout, done.stderr) == ("computed\n", "")
    modes: dict[str, set[int]] = {"folder": set(), "file": set()}
    for path in (base, *base.rglob("*")):
        modes["folder" if path.is_dir() else "file"].add(stat.S_IMODE(path.stat().st_mode))
    assert modes == {"folder": {0o755}, "file": {0o644}} and list(base.rglob("*.nbc"))


@pytest.mark.parametrize(
    ("spoil", "trusted"),
    [
        (lambda folder: None, True),
        (lambda folder: folder.chmod(0o775), False),
        (lambda folder: (folder / "code").chmod(0o664), False),
        (lambda folder: folder.parent.chmod(0o777), False),
        (lambda folder: folder.parent.chmod(0o1777), True),
        (lambda folder: folder.chmod(0o1777), False),
    ],
    ids=["ours", "group may add", "group may write", "others may rename", "like /tmp", "others may add"],
)
def test_what_others_can_write_to_is_not_used(tmp_path: Path, spoil: Callable[[Path], None], trusted: bool):
    folder = tmp_path / "base" / "kernels"
    kernel_files.make_folder(folder)
    with kernel_files.replacing(folder / "code") as file:
        file.write(b"code")
    spoil(folder)
    assert (kernel_files.untrusted(folder) == "") is trusted


@pytest.mark.skipif(os.name != "posix" or os.getuid() != 0, reason="needs root to give files away")
@pytest.mark.parametrize("part", ["", "code"])
def test_what_another_ordinary_user_owns_is_not_used(tmp_path: Path, part: str):
    folder = tmp_path / "base" / "kernels"
    kernel_files.make_folder(folder)
    (folder / "code").touch(0o644)
    os.chown(folder / part, 10001, 10001)
    assert kernel_files.untrusted(folder) == "belongs to another user"


def test_an_interrupted_write_leaves_what_was_there(tmp_path: Path):
    (tmp_path / "digest").write_bytes(b"old")
    with pytest.raises(OSError, match="full"), kernel_files.replacing(tmp_path / "digest") as file:
        file.write(b"new")
        raise OSError("full")
    assert [(path.name, path.read_bytes()) for path in tmp_path.iterdir()] == [("digest", b"old")]


def test_without_any_folder_a_program_can_be_imported_and_a_kernel_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    (tmp_path / "a-file").touch()
    monkeypatch.setattr(kernel_cache, "_bases", lambda: [tmp_path / "a-file"])
    kernel_cache.cache_folder.cache_clear()
    try:
        assert kernel_cache.any_folder() == Path(os.devnull)
        with pytest.raises(InputError) as caught:
            kernel_cache.cache_folder()
    finally:
        kernel_cache.cache_folder.cache_clear()
    assert "no folder for compiled kernels" in str(caught.value) and str(tmp_path) not in str(caught.value)


@pytest.mark.parametrize(
    ("shared", "own", "used"),
    [
        ("complete", "none", "shared"),
        ("complete", "begun", "shared"),
        ("begun", "complete", "own"),
        ("begun", "begun", "own"),
        ("spoilt", "complete", "own"),
        ("spoilt", "none", "own"),
        ("none", "none", "own"),
    ],
)
def test_a_complete_folder_is_used_where_it_lies_else_one_that_can_be_written_to(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, shared: str, own: str, used: str
):
    for base, kept in (("shared", shared), ("own", own)):
        if kept != "none":
            kernel_files.make_folder(tmp_path / base / "kernels-0")
            (tmp_path / base / "kernels-0" / "code").write_text(base)
        if kept in ("complete", "spoilt"):
            (tmp_path / base / "kernels-0" / "complete").touch(0o644)
        if kept == "spoilt":
            (tmp_path / base / "kernels-0" / "code").chmod(0o666)
    monkeypatch.setattr(kernel_cache, "kernel_hash", lambda: "0")
    monkeypatch.setattr(kernel_cache, "_bases", lambda: [tmp_path / "shared", tmp_path / "own"])
    refusal = kernel_files.refusal
    monkeypatch.setattr(
        kernel_files, "refusal", lambda at: "is read-only" if at.parent.name == "shared" else refusal(at)
    )
    before = {path: path.stat().st_mtime_ns for path in tmp_path.rglob("shared/**/*")}
    kernel_cache.cache_folder.cache_clear()
    try:
        folder = kernel_cache.cache_folder()
        assert folder.parent.name == used
        assert kernel_cache.complete() is ("complete" in (shared, own))
    finally:
        kernel_cache.cache_folder.cache_clear()
    assert {path: path.stat().st_mtime_ns for path in tmp_path.rglob("shared/**/*")} == before


def test_a_disk_without_room_is_told_before_all_kernels_are_compiled(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(kernel_cache, "cache_folder", lambda: tmp_path)
    monkeypatch.setattr(kernel_cache, "ROOM_BYTES", 1 << 62)
    with pytest.raises(InputError, match="the disk has no"), kernel_cache.compiling():
        raise AssertionError("nothing is to be compiled")


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EFBIG, errno.EACCES])
def test_what_cannot_be_kept_is_compiled_all_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture, number: int
):
    def refuse(*given: object) -> None:
        raise OSError(number, os.strerror(number), str(tmp_path))

    monkeypatch.setattr(kernel_cache.FunctionCache, "save_overload", refuse)
    monkeypatch.setattr(kernel_cache.FunctionCache, "load_overload", refuse)
    kernel_cache._say_not_kept.cache_clear()
    cache = object.__new__(kernel_cache.KernelCache)
    cache._impl = SimpleNamespace(filename_base="kernel")
    assert cache.load_overload((), None) is None
    cache.save_overload((), None)
    cache.save_overload((), None)
    assert caplog.messages == [f"compiled kernels are not kept: {os.strerror(number)}"]
