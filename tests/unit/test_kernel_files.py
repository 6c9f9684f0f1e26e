"""Whose machine code is used, who may read and write it, and what happens where none can be kept."""

import errno
import os
import stat
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from navcore.foundation import kernel_cache, kernel_files
from navcore.foundation.errors import InputError
from schuler_bench.bench.process import environment

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
    places = {"SCHULER_CACHE_DIR": str(base), "HOME": str(base / "home"), "TMPDIR": "/tmp"}
    program = [sys.executable, "-c", KERNEL.format(umask=umask)]
    return subprocess.run(program, env=environment() | places, capture_output=True, text=True, check=False)


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
def test_what_others_can_write_to_is_neither_used_nor_copied(
    tmp_path: Path, spoil: Callable[[Path], None], trusted: bool
):
    folder = tmp_path / "base" / "kernels"
    kernel_files.make_folder(folder)
    with kernel_files.replacing(folder / "code") as file:
        file.write(b"code")
    spoil(folder)
    assert (kernel_files.untrusted(folder) == "") is trusted
    assert kernel_files.copy(folder, tmp_path / "copies" / "kernels") is trusted
    assert (tmp_path / "copies" / "kernels" / "code").exists() is trusted


@pytest.mark.skipif(os.name != "posix" or os.getuid() != 0, reason="needs root to give files away")
@pytest.mark.parametrize("part", ["", "code"])
def test_what_another_ordinary_user_owns_is_not_used(tmp_path: Path, part: str):
    folder = tmp_path / "base" / "kernels"
    kernel_files.make_folder(folder)
    (folder / "code").touch(0o644)
    os.chown(folder / part, 10001, 10001)
    assert kernel_files.untrusted(folder) == "belongs to another user"
    assert not kernel_files.copy(folder, tmp_path / "copies" / "kernels")


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
    ("own", "room", "used", "code"),
    [
        ("none", True, "own", "shared"),
        ("begun", True, "own", "shared"),
        ("complete", True, "own", "own"),
        ("none", False, "shared", "shared"),
        ("begun", False, "shared", "shared"),
    ],
)
def test_a_begun_folder_of_ones_own_does_not_hide_a_complete_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, own: str, room: bool, used: str, code: str
):
    def refuse(*given: object, **options: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    for base, kept in (("shared", "complete"), ("own", own)):
        if kept != "none":
            kernel_files.make_folder(tmp_path / base / "kernels-0")
            (tmp_path / base / "kernels-0" / "code").write_text(base)
        if kept == "complete":
            (tmp_path / base / "kernels-0" / "complete").touch()
    monkeypatch.setattr(kernel_cache, "kernel_hash", lambda: "0")
    monkeypatch.setattr(kernel_cache, "_bases", lambda: [tmp_path / "shared", tmp_path / "own"])
    refusal = kernel_files.refusal
    monkeypatch.setattr(
        kernel_files, "refusal", lambda at: "is root's" if at.parent.name == "shared" else refusal(at)
    )
    if not room:
        monkeypatch.setattr(kernel_files.shutil, "copytree", refuse)
    kernel_cache.cache_folder.cache_clear()
    try:
        folder = kernel_cache.cache_folder()
        assert (folder.parent.name, kernel_cache.complete()) == (used, True)
    finally:
        kernel_cache.cache_folder.cache_clear()
    assert (folder / "code").read_text() == code
    assert not list(tmp_path.glob("own/tmp*")), "an unfinished copy is left"


def test_of_two_processes_that_copy_the_first_is_left_alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    source, target = tmp_path / "shared" / "kernels", tmp_path / "own" / "kernels"
    for folder in (source, target):
        kernel_files.make_folder(folder)
    copytree = kernel_files.shutil.copytree

    def slowly(*given: Path, **options: Callable[[str, list[str]], set[str]]) -> None:
        monkeypatch.undo()  # the other process begins later, and ends before this one
        assert kernel_files.copy(source, target)
        (target / "compiled since").touch()
        copytree(*given, **options)

    monkeypatch.setattr(kernel_files.shutil, "copytree", slowly)
    assert kernel_files.copy(source, target)
    assert (target / "compiled since").exists()


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
    assert cache.load_overload((), None) is None
    cache.save_overload((), None)
    cache.save_overload((), None)
    assert caplog.messages == [f"compiled kernels are not kept: {os.strerror(number)}"]
