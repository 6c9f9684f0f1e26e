"""Kernels that root has compiled, used by another user: without account, home, or room to write."""

import json
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest

from navcore.foundation.kernel_cache import cache_folder, complete
from schuler_bench.bench.process import environment, free_port
from schuler_bench.bench.visitor import Visitor
from tests.attack.conftest import eventually
from tests.attack.wire import ask
from tests.users import ROOT, entering, require_users

pytestmark = [pytest.mark.slow, pytest.mark.timeout(900)]
_NOWHERE = ("/tmp", "/var/tmp", "/dev/shm")
COMMANDS = {
    "check": ["check", "zha-fast"],
    "run": ["run", "zha-fast", "--set", "run.duration_h=0.05"],
    "presets": ["presets"],
}


class Place(NamedTuple):
    """Folders of one test, under one that everybody may search."""

    top: Path
    kernels: Path
    home: Path
    scratch: Path


@pytest.fixture
def place() -> Iterator[Place]:
    """Kernels that root has compiled; a home and a temporary folder of the other user."""
    require_users()
    if not complete():
        subprocess.run([sys.executable, "-m", "navcore.warm"], env=environment(), check=True)
    top = Path(tempfile.mkdtemp(prefix="schuler-users-"))
    made = Place(top, top / "kernels", top / "home", top / "scratch")
    top.chmod(0o755)
    for folder in (made.home, made.scratch):
        folder.mkdir()
        folder.chmod(0o1777)
    made.kernels.mkdir(0o755)
    shutil.copytree(cache_folder(), made.kernels / cache_folder().name)
    yield made
    shutil.rmtree(top)


def command(
    place: Place, words: list[str], without: str = "", read_only: tuple[str, ...] = (), full: bool = False
) -> tuple[list[str], dict[str, str]]:
    """Words and environment of a command of the other user."""
    disks = (place.home, place.scratch) if full else ()
    enter, needed = entering(place.top, read_only=tuple(map(Path, read_only)), full=disks)
    folders = {"SCHULER_CACHE_DIR": place.kernels, "HOME": place.home, "TMPDIR": place.scratch}
    variables = {name: str(folder) for name, folder in folders.items()}
    given = environment() | needed | variables | {"PYTHONDONTWRITEBYTECODE": "1"}
    kept = {name: value for name, value in given.items() if name not in (*without.split(), "XDG_STATE_HOME")}
    return [*enter, sys.executable, "-m", *words], kept


SURROUNDINGS = {
    "as in the container": {},
    "no HOME": {"without": "HOME"},
    "a read-only home": {"read_only": ("HOME",)},
    "a full disk": {"full": True},
}


@pytest.mark.parametrize("where", SURROUNDINGS)
def test_every_command_works_with_the_kernels_that_root_has_compiled(place: Place, where: str) -> None:
    options = dict(SURROUNDINGS[where])
    if "read_only" in options:
        options["read_only"] = (str(place.home),)
    for name, words in COMMANDS.items():
        line, variables = command(place, ["schuler_bench", *words], **options)
        variables["NUMBA_DEBUG_CACHE"] = "1"
        done = subprocess.run(line, env=variables, cwd=place.top, capture_output=True, text=True, check=False)
        assert (done.returncode, done.stderr) == (0, ""), name
        assert "saved to" not in done.stdout, "the kernels are there already"
        if name == "run":
            assert f"data loaded from '{place.kernels}" in done.stdout, "they are used where they lie"
    assert not [*place.home.rglob("*.nbc"), *place.scratch.rglob("*.nbc")]


@pytest.mark.parametrize("name", ["check", "run"])
def test_nowhere_to_write_is_one_line(place: Place, name: str) -> None:
    line, variables = command(place, ["schuler_bench", *COMMANDS[name]], "SCHULER_CACHE_DIR HOME", _NOWHERE)
    done = subprocess.run(line, env=variables, cwd=place.top, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (2, "")
    assert "no folder for compiled kernels can be written to" in done.stderr
    assert done.stderr.count("\n") == 1


def test_without_home_and_kernels_the_temporary_folder_is_used_and_named_once(place: Place) -> None:
    words = ["schuler_bench", "run", "liu-networks", "--set", "run.duration_h=0.01"]
    line, variables = command(place, words, "SCHULER_CACHE_DIR HOME")
    said = [
        subprocess.run(line, env=variables, cwd=place.top, capture_output=True, text=True, check=True).stderr
        for _ in range(2)
    ]
    kept = place.scratch / "schuler-bench-10001"
    assert said == [f"compiled kernels are kept in {kept}: there is no home folder\n", ""]


@pytest.mark.parametrize("workers", ["1", "2"])
@pytest.mark.parametrize("kernels", [True, False], ids=["kernels", "none"])
def test_health_tells_whether_the_kernels_can_be_had(place: Place, kernels: bool, workers: str) -> None:
    """Served as the container does it: by another user than the one that compiled."""
    port = free_port()
    words = ["schuler_bench", "serve", "--port", str(port), "--workers", workers]
    line, variables = command(place, words, "" if kernels else "SCHULER_CACHE_DIR HOME")
    if not kernels:  # uploads still need a temporary folder
        (place.scratch / "schuler-bench-10001").touch()
        variables["XDG_STATE_HOME"] = str(place.home / "state")  # workers share the key of their sessions
    with (place.top / "log").open("w+") as log:
        server = subprocess.Popen(line, env=variables, cwd=place.top, stdout=log, stderr=log)
        try:
            wanted = 200 if kernels else 503
            eventually(lambda: all(_status(port) == wanted for _ in range(4)), 60.0)  # of each worker
            told = json.loads(ask(port, "/healthz").body)
            if kernels:
                assert told["status"] == "ok"
                with Visitor(port) as page:
                    page.wait_for_run(1)
                assert _status(port) == 200
            else:
                assert "no folder for compiled kernels" in told["reason"]
                with Visitor(port) as page:
                    page.wait(lambda: page.notices, "what keeps the page from a result", 60.0)
                assert "no folder for compiled kernels" in str(page.notices)
                told["page"] = page.notices
            assert str(place.top) not in str(told) and str(ROOT) not in str(told)
        finally:
            server.send_signal(signal.SIGTERM)
            server.wait(20)
        log.seek(0)
        assert "PermissionError" not in log.read()


def _status(port: int) -> int:
    try:
        return ask(port, "/healthz").status
    except OSError:
        return 0
