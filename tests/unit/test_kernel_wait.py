"""What a process does that needs a kernel which another one is compiling."""

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from navcore.foundation import kernel_cache, kernel_wait
from navcore.foundation.kernel_wait import Compiling, KernelAwaited, Need, under_way, wait_once
from schuler_bench.http.access import health
from schuler_bench.jobs import kernels

HOLDS = """
import fcntl, sys
with open(sys.argv[1], "a") as lock:
    fcntl.flock(lock, fcntl.LOCK_EX)
    print("held", flush=True)
    sys.stdin.read()
"""


@pytest.fixture
def lock(tmp_path: Path) -> Path:
    """File that whoever compiles has locked."""
    path = tmp_path / "lock"
    path.touch()
    return path


@pytest.fixture
def compiler(lock: Path) -> Iterator[subprocess.Popen[str]]:
    """Another process, which has the lock until its input ends."""
    pytest.importorskip("fcntl")
    line = [sys.executable, "-c", HOLDS, str(lock)]
    with subprocess.Popen(line, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline() == "held\n"
        yield process
        process.stdin.close()


@pytest.fixture(autouse=True)
def as_before() -> Iterator[None]:
    """Leave this process as it is: it compiles itself."""
    yield
    kernel_wait.when_missing(Need.COMPILE)
    kernel_wait.expect(False)
    kernels._state.compiling = kernels._state.process = None


def test_progress_is_read_while_the_other_process_lives(lock: Path, compiler: subprocess.Popen[str]) -> None:
    kernel_wait.note(lock, Compiling(12, 49, "navcore.mechanization.error_model._advance"))
    found = under_way(lock)
    assert found is not None
    assert (found.done, found.total, str(found)) == (12, 49, "12 of 49, mechanization.error_model._advance")
    compiler.kill()
    compiler.wait()
    assert under_way(lock) is None


def test_a_server_raises_a_helper_waits_and_a_command_compiles(
    lock: Path, compiler: subprocess.Popen[str]
) -> None:
    assert not wait_once(lock, "advance")
    kernel_wait.when_missing(Need.RAISE)
    with pytest.raises(KernelAwaited, match="advance"):
        wait_once(lock, "advance")
    kernel_wait.when_missing(Need.WAIT)
    assert wait_once(lock, "advance")
    compiler.kill()
    compiler.wait()
    for need in Need:
        kernel_wait.when_missing(need)
        assert not wait_once(lock, "advance"), "nobody compiles it any more"


def test_a_process_that_has_not_begun_is_waited_for(tmp_path: Path) -> None:
    kernel_wait.when_missing(Need.RAISE)
    kernel_wait.expect(True)
    with pytest.raises(KernelAwaited):
        wait_once(tmp_path / "lock", "advance")
    kernel_wait.expect(False)
    assert not wait_once(tmp_path / "lock", "advance")


def test_health_says_that_kernels_are_compiled_and_stays_ok() -> None:
    assert '"kernels"' not in health(kernels=kernels.words())
    kernels._state.compiling = Compiling(12, 49, "navcore.law.step")
    told = health(kernels=kernels.words())
    assert '"status": "ok"' in told and f'"{kernels.COMPILING}: 12 of 49, law.step"' in told


def test_a_server_whose_compiler_ends_early_says_so_and_goes_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(kernel_cache, "ready", lambda: False)
    monkeypatch.setattr(kernel_cache, "cache_folder", lambda: tmp_path)
    monkeypatch.setattr(kernels, "_LOOK_S", 0.01)
    kernel_wait.when_missing(Need.RAISE)
    told: list[str] = []
    with subprocess.Popen([sys.executable, "-c", "raise SystemExit(1)"]) as ended:
        ended.wait()
        kernels._state.process = ended
        kernels._follow(ended, told.append)
    assert told == [kernels.COMPILING] and "could not be compiled" in caplog.text
    assert kernels.words() == "" and not wait_once(tmp_path / "lock", "advance")
