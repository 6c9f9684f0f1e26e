"""The container image: what the Dockerfile promises, and the image itself where a Docker engine answers."""

import json
import re
import shlex
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest

from schuler_bench.bench.process import environment, free_port

pytestmark = pytest.mark.timeout(1800)
TOKEN = "a-token-of-this-test"
_UNREACHABLE = re.compile(
    r"NewConnectionError|NameResolutionError|ConnectTimeout|Could not find a version .*none\)"
)


class Instruction(NamedTuple):
    """Keyword, flags (``--from=builder``) and arguments of one instruction."""

    keyword: str
    flags: dict[str, str]
    text: str

    @property
    def words(self) -> list[str]:
        """Arguments of the JSON form or of the plain one."""
        return json.loads(self.text) if self.text.startswith("[") else shlex.split(self.text)


@pytest.fixture(scope="module")
def stages(repo_root: Path) -> list[list[Instruction]]:
    """Instructions of the builder and of the stage that is shipped."""
    lines = [line.strip() for line in (repo_root / "Dockerfile").read_text("utf-8").splitlines()]
    code = re.sub(r"\s*\\\n\s*", " ", "\n".join(line for line in lines if not line.startswith("#")))
    found: list[list[Instruction]] = []
    for line in filter(None, code.splitlines()):
        keyword, flags, text = re.fullmatch(r"(\w+)\s+((?:--\S+\s+)*)(.*)", line).groups()
        found += [[]] if keyword == "FROM" else []
        found[-1].append(Instruction(keyword, dict(flag[2:].split("=", 1) for flag in flags.split()), text))
    return found


def of(stage: list[Instruction], keyword: str) -> list[Instruction]:
    """Instructions of a kind, in order."""
    return [instruction for instruction in stage if instruction.keyword == keyword]


def steps(stage: list[Instruction]) -> list[str]:
    """Commands of a stage, in order."""
    return [step.strip() for run in of(stage, "RUN") for step in run.text.split("&&")]


def health(shipped: list[Instruction]) -> list[str]:
    """Command of the health check."""
    return json.loads(of(shipped, "HEALTHCHECK")[0].text.removeprefix("CMD "))


def test_both_stages_have_the_same_pinned_base(stages: list[list[Instruction]]) -> None:
    builder, shipped = (stage[0].text for stage in stages)
    assert builder == f"{shipped} AS builder"
    assert re.fullmatch(r"python:3\.11-slim-bookworm@sha256:[0-9a-f]{64}", shipped)


def test_packages_come_by_hash_and_the_program_without_an_index(stages: list[list[Instruction]]) -> None:
    installs = [step for step in steps(stages[0]) if re.search(r"pip .*(install|wheel) ", step)]
    locked = [step for step in installs if "--require-hashes --only-binary :all:" in step]
    assert [step.rpartition(" -r ")[2] for step in locked] == [
        "requirements/run.lock",
        "requirements/build.lock",
    ]
    assert len(installs) == 4 and all("--no-index" in step for step in installs if step not in locked)
    assert "schuler/bin/python" in installs[-1] and installs[-1].endswith("/wheels/*.whl")


def test_what_is_copied_exists_and_nothing_else_reaches_the_builder(
    repo_root: Path, stages: list[list[Instruction]]
) -> None:
    sources = {source.rstrip("/") for copy in of(stages[0], "COPY") for source in copy.words[:-1]}
    assert [source for source in sources if not (repo_root / source).exists()] == []
    ignored, *let_through, last = (repo_root / ".dockerignore").read_text("utf-8").split()
    assert (ignored, last) == ("*", "**/__pycache__")
    assert set(let_through) == {f"!{source}" for source in sources}


def test_the_shipped_stage_has_no_build_tools_no_installer_and_no_root(
    stages: list[list[Instruction]],
) -> None:
    builder, shipped = stages
    assert [user.text for user in of(shipped, "USER")] == ["schuler"]
    assert any(re.match(r"useradd .*--uid 10001 .*nologin schuler", step) for step in steps(shipped))
    assert not [step for step in steps(shipped) if {"apt", "apt-get", "gcc"} & set(step.split())]
    assert "python -m pip uninstall --yes pip setuptools wheel" in steps(shipped)
    assert "python -m venv --without-pip /opt/schuler" in steps(builder)


def test_the_wheel_that_is_shipped_holds_the_kernels(stages: list[list[Instruction]]) -> None:
    builder, shipped = stages
    made = steps(builder)
    warmed = made.index("/opt/schuler/bin/python -m navcore.warm portable")
    built = next(number for number, step in enumerate(made) if " pip wheel " in step)
    assert warmed < built and of(builder, "WORKDIR")[-1].text == "/src"
    assert [(copy.flags, copy.words) for copy in of(shipped, "COPY")] == [
        ({"from": "builder"}, ["/opt/schuler", "/opt/schuler"])
    ]
    assert of(shipped, "ENV")[0].words[0] == "PATH=/opt/schuler/bin:$PATH"
    assert not [words for stage in stages for words in of(stage, "ENV") if "SCHULER_CACHE_DIR" in words.text]


def test_one_folder_is_written_to_and_no_token_is_in_the_image(stages: list[list[Instruction]]) -> None:
    builder, shipped = stages
    assert [volume.words for volume in of(shipped, "VOLUME")] == [["/data"]]
    assert "install -d -o schuler -g schuler /data" in steps(shipped)
    assert {"HOME=/data", "TMPDIR=/data"} <= set(of(shipped, "ENV")[0].words)
    assert not [instruction for instruction in builder + shipped if "TOKEN" in instruction.text.upper()]


def test_command_and_health_check_do_what_they_say(stages: list[list[Instruction]], tmp_path: Path) -> None:
    """Carried out by this Python; served on loopback, at a free port."""
    shipped, port = stages[1], free_port()
    program, *words = of(shipped, "CMD")[0].words
    assert (program, of(shipped, "EXPOSE")[0].text) == ("schuler", words[-1])
    start = [sys.executable, "-m", "schuler_bench", *words]
    variables = environment() | {"XDG_STATE_HOME": str(tmp_path)}
    refused = subprocess.run(start, env=variables, capture_output=True, text=True, timeout=60)
    assert (refused.returncode, "Traceback" in refused.stderr) == (2, False)
    assert "token" in refused.stderr
    here = [word.replace("0.0.0.0", "127.0.0.1").replace("8080", str(port)) for word in start]
    check = [sys.executable, *(word.replace("8080", str(port)) for word in health(shipped)[1:])]
    assert subprocess.run(check, capture_output=True).returncode != 0
    server = subprocess.Popen(
        here,
        env=variables | {"SCHULER_TOKEN": TOKEN},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    try:
        wait_until_healthy(check)
        server.send_signal(signal.SIGTERM)
        output, _ = server.communicate(timeout=30)
    finally:
        server.kill()
        server.wait()
    assert server.returncode == 0 and TOKEN not in output


def wait_until_healthy(check: list[str]) -> None:
    """Repeat the health check until it passes."""
    until = time.monotonic() + 60.0
    while (checked := subprocess.run(check, capture_output=True, text=True)).returncode != 0:
        assert time.monotonic() < until, checked.stdout + checked.stderr
        time.sleep(0.3)


# ---------------------------------------------------------------- the image


def docker(*words: str) -> subprocess.CompletedProcess[str]:
    """Run a command of Docker."""
    return subprocess.run(["docker", *words], capture_output=True, text=True, timeout=1500)


@pytest.fixture(scope="module")
def image(repo_root: Path) -> Iterator[str]:
    """Identifier of the image, built from this tree."""
    if shutil.which("docker") is None or docker("info").returncode != 0:
        pytest.skip("no Docker engine answers here (`docker info`)")
    built = docker("build", "--quiet", str(repo_root))
    if _UNREACHABLE.search(built.stderr):
        pytest.skip("the locked packages cannot be reached from a container here")
    assert built.returncode == 0, built.stderr
    name = built.stdout.strip()
    yield name
    docker("image", "rm", "--force", name)


_WHERE = (
    "import schuler_bench; from navcore.foundation.assets import asset_path as p;"
    "print(schuler_bench.__file__, p('presets'))"
)
_WARM = "from navcore.warm import warm; warm()"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("words", "code", "said", "unsaid"),
    [
        (["/usr/local/bin/python", "-m", "pip"], 1, "No module named pip", "Usage"),
        (["python", "-m", "pip"], 1, "No module named pip", "Usage"),
        (["python", "-c", _WHERE], 0, "/opt/schuler/lib/", "/src"),
        (["python", "-c", _WARM], 0, "data loaded from", "data saved to"),
        (["schuler", "presets", "--json"], 0, '"presets"', "Traceback"),
        ([], 2, "token", "Traceback"),
    ],
    ids=["base", "program", "code and assets", "kernels", "command", "without a token"],
)
def test_a_container_with_a_read_only_root(
    image: str, words: list[str], code: int, said: str, unsaid: str
) -> None:
    options = ["--rm", "--init", "--read-only", "--env", "NUMBA_DEBUG_CACHE=1"]
    ended = docker("run", *options, image, *words)
    output = ended.stdout + ended.stderr
    assert ended.returncode == code, output
    assert said in output and unsaid not in output


@pytest.mark.slow
def test_a_container_serves_and_ends(image: str, stages: list[list[Instruction]]) -> None:
    options = ["--detach", "--init", "--read-only", "--env", f"SCHULER_TOKEN={TOKEN}"]
    name = docker("run", *options, image).stdout.strip()
    try:
        wait_until_healthy(["docker", "exec", name, *health(stages[1])])
        docker("stop", "--time", "10", name)
        state = json.loads(docker("inspect", name).stdout)[0]["State"]
        logs = docker("logs", name)
    finally:
        docker("rm", "--force", "--volumes", name)
    assert state["ExitCode"] == 0 and TOKEN not in logs.stdout + logs.stderr
