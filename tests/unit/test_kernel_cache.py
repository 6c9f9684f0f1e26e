"""Where machine code is kept: what names its folder, who waits for whom, what is removed, and when."""

import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numba
import pytest

from navcore.foundation import kernel_cache
from navcore.foundation.kernel_cache import UNUSED_S, compiling, complete, prune

DIGEST = """
from navcore.foundation.kernel_cache import kernel_hash
print(kernel_hash())
"""


@pytest.fixture(scope="module")
def unedited(tmp_path_factory: pytest.TempPathFactory, repo_root: Path) -> str:
    """Digest of navcore as it is, in a tree of its own."""
    folder = tmp_path_factory.mktemp("unedited")
    shutil.copytree(repo_root / "navcore", folder / "navcore", ignore=shutil.ignore_patterns("__pycache__"))
    return run(folder, DIGEST)


@pytest.fixture
def tree(tmp_path: Path, repo_root: Path) -> Path:
    """Copy of navcore, to be edited."""
    shutil.copytree(repo_root / "navcore", tmp_path / "navcore", ignore=shutil.ignore_patterns("__pycache__"))
    return tmp_path


def run(tree: Path, text: str) -> str:
    places = {"PYTHONPATH": tree, "SCHULER_CACHE_DIR": tree / "cache", "XDG_CACHE_HOME": tree, "HOME": tree}
    environment = os.environ | {name: str(place) for name, place in places.items()}
    done = subprocess.run(
        [sys.executable, "-c", text], cwd=tree, env=environment, capture_output=True, text=True, check=True
    )
    return done.stdout.strip()


def edit(tree: Path, name: str, old: str, new: str) -> None:
    path = tree / "navcore" / name
    text = path.read_text("utf-8")
    assert text.count(old) >= 1, f"{name} does not hold {old!r}"
    path.write_text(text.replace(old, new, 1), "utf-8")


@pytest.mark.parametrize(
    ("name", "old", "new", "same"),
    [
        ("law/policy/variation.py", "Damped while s is at most this", "Damped up to this", True),
        ("law/history.py", '"""Row of the history', '"""One row of the history', True),
        ("law/network_state.py", "    y = network.D", "    # the output\n    y = network.D", True),
        ("law/policy/adaptive.py", "QUADRATIC = (0.3076,", "QUADRATIC = (0.3077,", False),
        ("foundation/units.py", "KNOT = 1852.0 / 3600.0", "KNOT = 1852.0 / 3601.0", False),
        ("law/policy/adaptive.py", "share = 1.0 if s.fresh == 1", "share = 0.5 if s.fresh == 1", False),
        ("law/step.py", "s.engaged = True", "s.engaged = False", False),
        ("mechanization/strapdown/step.py", "m_e: float\n    m_n: f", "m_n: float\n    m_e: f", False),
    ],
    ids=["help", "docstring", "comment", "constant", "constant elsewhere", "kernel", "factory", "fields"],
)  # fmt: skip
def test_only_what_is_compiled_names_the_folder(
    tree: Path, unedited: str, name: str, old: str, new: str, same: bool
):
    edit(tree, name, old, new)
    assert (run(tree, DIGEST) == unedited) is same


def test_the_order_of_a_registry_and_the_function_of_an_entry_name_the_folder(tree: Path, unedited: str):
    digests = [unedited]
    first, second = (
        f'    "navcore.law.policy.{name}",\n' for name in ("threshold:Threshold", "yaw_rate:YawRate")
    )
    edit(tree, "law/policy/__init__.py", first + second, second + first)
    digests.append(run(tree, DIGEST))
    edit(tree, "law/policy/threshold.py", "ClassVar[Any] = _decide", "ClassVar[Any] = None")
    digests.append(run(tree, DIGEST))
    assert len(set(digests)) == 3


def test_the_digest_is_formed_once_for_the_same_sources(tree: Path):
    before = run(tree, DIGEST)
    no_parser = "import ast\ndef parse(*given): raise AssertionError\nast.parse = parse\n"
    assert run(tree, no_parser + DIGEST) == before
    kept = list((tree / "cache" / "digests").iterdir())
    assert [path.read_text() for path in kept] == [before]
    kept[0].write_text("../elsewhere")
    assert run(tree, DIGEST) == before, "what is no digest is not believed"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Folder of kernels of this test alone."""
    here = tmp_path / "kernels-0123456789abcdef"
    here.mkdir()
    monkeypatch.setattr(kernel_cache, "cache_folder", lambda: here)
    return here


def test_what_nothing_has_used_for_a_month_is_removed_and_nothing_else(folder: Path):
    now = time.time()
    ages = {"kernels-old": UNUSED_S + 60.0, "kernels-recent": UNUSED_S - 3600.0, "something-else": 1e9}
    for name, age in ages.items():
        (folder.parent / name).mkdir()
        os.utime(folder.parent / name, (now - age, now - age))
    os.utime(folder, (0.0, 0.0))
    assert [path.name for path in prune(now)] == ["kernels-old"]
    assert sorted(path.name for path in folder.parent.iterdir()) == [
        folder.name, "kernels-recent", "something-else",
    ]  # fmt: skip


def test_a_use_is_noted(tmp_path: Path):
    os.utime(tmp_path, (0.0, 0.0))
    kernel_cache._used(tmp_path)
    assert time.time() - tmp_path.stat().st_mtime < 3600.0


def test_a_second_process_waits_and_then_has_nothing_to_do(folder: Path):
    import threading

    seen: list[str] = []

    def second() -> None:
        with compiling() as needed:
            seen.append(f"second {needed}")

    with compiling() as needed:
        assert needed and not complete()
        other = threading.Thread(target=second)
        other.start()
        other.join(0.3)
        seen.append("first")
    other.join(10.0)
    assert seen == ["first", "second False"] and complete()


def test_what_was_not_compiled_to_the_end_is_done_again(folder: Path):
    with pytest.raises(KeyboardInterrupt), compiling():
        raise KeyboardInterrupt
    with compiling() as needed:
        assert needed


def test_compiling_stops_the_clock_of_a_test():
    def slow_to_compile(x):
        return x + 1

    if not hasattr(signal, "setitimer"):
        pytest.skip("no interval timer on this system")
    compiled: Callable[[float], float] = numba.njit(slow_to_compile)
    before = signal.setitimer(signal.ITIMER_REAL, 50.0)[0]
    try:
        time.sleep(0.05)
        started = signal.getitimer(signal.ITIMER_REAL)[0]
        began = time.perf_counter()
        assert compiled(1.0) == 2.0
        taken, left = time.perf_counter() - began, signal.getitimer(signal.ITIMER_REAL)[0]
        assert started - left < taken, "the clock went on while numba compiled"
    finally:
        signal.setitimer(signal.ITIMER_REAL, before)
