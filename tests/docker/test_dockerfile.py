"""The Dockerfile: its promises, read off its text, and its steps, carried out without a Docker engine."""

import os
import re
import shutil
import signal
import subprocess
import tempfile
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from app.bench.process import free_port
from tests.docker.dockerfile import Build, StepFailed, below, copy_context, parse

UNREACHABLE = re.compile(
    r"NewConnectionError|NameResolutionError|ConnectTimeout|Could not find a version .*none\)"
)

PREFIX = "schuler-image-"


@pytest.fixture(scope="module")
def instructions(repo_root: Path):
    """All instructions of the Dockerfile."""
    return parse((repo_root / "Dockerfile").read_text("utf-8"))


def last_stage(instructions):
    """Instructions of the stage that is shipped."""
    start = max(i for i, instruction in enumerate(instructions) if instruction.keyword == "FROM")
    return instructions[start:]


def one(instructions, keyword):
    """The only instruction of a kind."""
    [found] = [instruction for instruction in instructions if instruction.keyword == keyword]
    return found


def test_both_stages_have_the_same_pinned_base(instructions):
    bases = [i.text.partition(" AS ")[0] for i in instructions if i.keyword == "FROM"]
    assert len(bases) == 2
    [base] = set(bases)
    assert re.fullmatch(r"python:3\.11-slim-bookworm@sha256:[0-9a-f]{64}", base)


def test_everything_is_installed_from_hashes(instructions):
    from_index = [
        part
        for i in instructions
        if i.keyword == "RUN"
        for part in i.text.split("&&")
        if re.search(r"pip .*install", part) and "--no-index" not in part and "uninstall" not in part
    ]
    assert len(from_index) == 2
    assert all("--require-hashes" in part for part in from_index)


def test_the_shipped_stage_has_no_build_tools_and_no_root(instructions):
    stage = last_stage(instructions)
    assert one(stage, "USER").text == "schuler"
    assert not [i for i in stage if i.keyword == "COPY" and i.flags.get("from") != "builder"]
    assert not [i for i in stage if "apt" in i.text.split() or "gcc" in i.text]
    assert any(i.keyword == "RUN" and "uninstall --yes pip" in i.text for i in stage)


def test_one_folder_is_written_to_and_no_token_is_in_the_image(instructions):
    stage = last_stage(instructions)
    assert one(stage, "VOLUME").words() == ["/data"]
    assert {"HOME=/data", "TMPDIR=/data"} <= set(one(stage, "ENV").words())
    assert not [i for i in instructions if "TOKEN" in i.text.upper()]


@pytest.mark.parametrize(
    ("text", "moved"),
    [
        ("python -m venv /opt/x", "python -m venv /r/opt/x"),
        ("/opt/x/bin:$PATH", "/r/opt/x/bin:$PATH"),
        ("http://127.0.0.1:8080/healthz", "http://127.0.0.1:8080/healthz"),
        ("app/ ./a/b /wheels/*.whl", "app/ ./a/b /r/wheels/*.whl"),
    ],
)
def test_paths_are_moved_below_the_folder_and_addresses_are_not(text: str, moved: str):
    assert below(Path("/r"), text) == moved


def test_dockerignore_lets_only_the_program_through(repo_root: Path, tmp_path: Path):
    copy_context(repo_root, tmp_path / "context", (repo_root / ".dockerignore").read_text("utf-8"))
    names = {path.name for path in (tmp_path / "context").iterdir()}
    assert names == {
        *("app", "assets", "navcore", "requirements", "LICENSE", "README.md", "pyproject.toml"),
    }
    assert not list(tmp_path.rglob("__pycache__"))


@pytest.fixture(scope="module")
def image(repo_root: Path, instructions) -> Iterator[Build]:
    """The last stage, built; skipped where the locked packages cannot be reached."""
    place = Path(_roomy_memory() or tempfile.gettempdir()).resolve()
    _remove_leftovers(place)
    folder = Path(tempfile.mkdtemp(prefix=f"{PREFIX}{os.getpid()}-", dir=place))
    try:
        context = folder / "context"
        copy_context(repo_root, context, (repo_root / ".dockerignore").read_text("utf-8"))
        build = Build(folder, context)
        try:
            build.carry_out(instructions)
        except StepFailed as error:
            if UNREACHABLE.search(str(error)):
                pytest.skip("the locked packages cannot be reached from here, so the image cannot be built")
            raise
        yield build
    finally:
        _set_writable(folder, True)
        shutil.rmtree(folder)


def _roomy_memory() -> str | None:
    """Memory file system where there is one with room: to write and remove 30,000 files takes a disk long."""
    memory = "/dev/shm"
    if not os.path.isdir(memory) or not os.access(memory, os.W_OK):
        return None
    state = os.statvfs(memory)
    return memory if state.f_bavail * state.f_frsize > 4 * 2**30 and not state.f_flag & os.ST_NOEXEC else None


def _remove_leftovers(place: Path) -> None:
    """Remove what a run that was killed has left: a gigabyte, in memory."""
    for left in place.glob(f"{PREFIX}*"):
        pid = left.name.removeprefix(PREFIX).partition("-")[0]
        if pid.isdigit() and left.stat().st_uid == os.getuid() and not _alive(int(pid)):
            _set_writable(left, True)
            shutil.rmtree(left)


def _alive(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        pass
    return True


def _set_writable(folder: Path, writable: bool) -> None:
    for path in [folder, *folder.rglob("*")]:
        if not path.is_symlink():
            mode = path.stat().st_mode
            path.chmod(mode | 0o200 if writable else mode & ~0o222)


@pytest.fixture(scope="module")
def read_only(image: Build) -> Iterator[list[str]]:
    """Make all but /data read-only; gives what must stand before a command so that this holds for root."""
    _set_writable(image.root, False)
    _set_writable(image.root / "data", True)
    prefix = (
        ["setpriv", "--bounding-set=-dac_override", "--inh-caps=-dac_override"] if os.geteuid() == 0 else []
    )
    if prefix and shutil.which("setpriv") is None:
        pytest.skip("root writes everywhere here, and there is no setpriv to prevent it")
    tried = image.run([*prefix, "/bin/sh", "-c", f"touch {image.root}/opt/x"])
    assert tried.returncode != 0, "the root is not read-only: this test would show nothing"
    yield prefix
    _set_writable(image.root, True)


pytestmark_slow = [pytest.mark.slow, pytest.mark.timeout(420)]


class TestBuilt:
    """The steps carried out."""

    pytestmark = pytestmark_slow

    def test_only_the_steps_of_the_user_database_were_left_out(self, image: Build):
        assert [part.split()[0] for part in image.left_out] == ["useradd", "install"]
        assert image.user == "schuler"

    def test_no_installer_is_left(self, image: Build):
        for python in ("/usr/local/bin/python", "/opt/schuler/bin/python"):
            done = image.run([below(image.root, python), "-m", "pip", "--version"])
            assert done.returncode != 0
            assert "No module named pip" in done.stdout

    def test_the_code_is_the_installed_one_with_its_assets(self, image: Build):
        code = (
            "import app; from navcore.foundation.assets import asset_path;"
            "print(app.__file__, asset_path('presets'))"
        )
        done = image.run(["python", "-c", code])
        assert done.returncode == 0, done.stdout
        for path in done.stdout.split():
            assert path.startswith(f"{image.root}/opt/schuler/lib/")

    def test_shipped_kernels_are_used_on_a_read_only_root(self, image: Build, read_only: list[str]):
        """With a data folder that nothing was ever written to, all is loaded and nothing compiled again."""
        home = image.root / "data" / "first-start"
        home.mkdir()
        told = {"HOME": str(home), "TMPDIR": str(home), "NUMBA_DEBUG_CACHE": "1"}
        first_start = replace(image, variables=image.variables | told)
        # the command itself ends at once where all is compiled: what it would do else is called here
        done = first_start.run([*read_only, "python", "-c", "from navcore.warm import warm; warm()"])
        assert done.returncode == 0, done.stdout
        assert "data loaded from" in done.stdout
        assert "data saved to" not in done.stdout

    def test_a_command_runs_on_a_read_only_root(self, image: Build, read_only: list[str]):
        done = image.run([*read_only, "schuler", "presets", "--json"])
        assert done.returncode == 0, done.stdout
        assert '"presets"' in done.stdout

    def test_beyond_loopback_it_refuses_to_start_without_a_token(self, image: Build, read_only: list[str]):
        done = image.run([*read_only, *image.command])
        assert done.returncode == 2, done.stdout
        assert "token" in done.stdout.lower()
        assert "Traceback" not in done.stdout

    def test_serves_and_is_healthy(self, image: Build, read_only: list[str]):
        """CMD and HEALTHCHECK as they stand, but on loopback and on a free port."""
        port = free_port()
        health = [part.replace("8080", str(port)) for part in image.health]
        command = [part.replace("0.0.0.0", "127.0.0.1").replace("8080", str(port)) for part in image.command]
        with_token = replace(image, variables=image.variables | {"SCHULER_TOKEN": "a-token-of-this-test"})
        assert with_token.run(health).returncode != 0
        server = subprocess.Popen(
            [*read_only, *command],
            cwd=image.root / "data",
            env=with_token.environment(),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        try:
            deadline = time.monotonic() + 60
            while (checked := with_token.run(health)).returncode != 0:
                assert server.poll() is None, server.stdout and server.stdout.read()
                assert time.monotonic() < deadline, checked.stdout
                time.sleep(0.3)
        finally:
            server.send_signal(signal.SIGTERM)
            try:
                output, _ = server.communicate(timeout=30)
            except subprocess.TimeoutExpired:
                server.kill()
                output, _ = server.communicate()
                pytest.fail(f"did not end on SIGTERM:\n{output}")
        assert "a-token-of-this-test" not in output
