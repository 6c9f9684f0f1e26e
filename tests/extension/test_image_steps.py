"""The steps of the Dockerfile without an engine: root builds in an overlay, user 10001 serves."""

import shlex
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.extension.test_image import TOKEN, Instruction, health, stages
from tests.users import STRANGER, require_users

__all__ = ["stages"]
pytestmark = [pytest.mark.nightly, pytest.mark.timeout(1800)]
_WAITED_S = 120


@pytest.fixture
def top() -> Iterator[Path]:
    """Folder on which the layers are mounted, within the namespace of the script alone."""
    require_users()
    made = Path(tempfile.mkdtemp(prefix="schuler-image-"))
    yield made
    shutil.rmtree(made)


def script(stages: list[list[Instruction]], repo: Path, top: Path) -> str:
    """Shell script that carries out all instructions, then serves and asks for the health."""
    lines = ["set -e", f"mount -t tmpfs -o mode=755 none {top}"]
    root, variables = top, dict[str, str]()
    for number, stage in enumerate(stages):
        layer = top / str(number)
        root, place = layer / "root", "/"
        variables = {"PATH": f"{sys.base_prefix}/bin:/usr/sbin:/usr/bin:/sbin:/bin", "HOME": "/root"}
        lines += [
            f"mkdir -p {root} {layer}/upper {layer}/work",
            f"mount -t overlay -o lowerdir=/,upperdir={layer}/upper,workdir={layer}/work none {root}",
            f"mount --bind /proc {root}/proc && mount --bind /dev {root}/dev",
            f"chmod 755 {root}/root",
            f"for each in opt src data wheels; do rm -rf {root}/$each; mkdir {root}/$each; done",
        ]
        for keyword, flags, text in stage:
            match keyword:
                case "WORKDIR":
                    place = text
                    lines.append(f"mkdir -p {root}{place}")
                case "ENV":
                    for name, value in (word.split("=", 1) for word in shlex.split(text)):
                        variables[name] = value.replace("$PATH", variables["PATH"])
                case "COPY":
                    *sources, target = shlex.split(text)
                    to = f"{root}{target if target.startswith('/') else f'{place}/{target}'}"
                    origin = top / "0" / "root" if "from" in flags else repo
                    for source in sources:
                        held = f"{origin}/{source.strip('/')}"
                        tree = Path(held).is_dir() or "from" in flags
                        lines.append(f"mkdir -p {to} && cp -a {held}{'/.' if tree else ''} {to}")
                case "RUN":
                    lines.append(_inside(root, place, variables, text))
                case _:
                    pass
    served = {**variables, "SCHULER_TOKEN": TOKEN}
    command = next(instruction for instruction in stages[1] if instruction.keyword == "CMD").words
    as_user = f"setpriv --reuid={STRANGER} --regid={STRANGER} --clear-groups "
    ask = _inside(root, "/data", variables, as_user + shlex.join(health(stages[1])))
    page = (
        "import urllib.request as u; r = u.Request('http://127.0.0.1:8080/metrics', "
        f"headers={{'Authorization': 'Bearer {TOKEN}'}}); print(u.urlopen(r).read().decode())"
    )
    return "\n".join(
        [
            *lines,
            f"mount -t tmpfs -o mode=700,uid={STRANGER},gid={STRANGER} none {root}/data",
            f"mount -o remount,ro {root}",
            f"{_inside(root, '/data', served, as_user + shlex.join(command))} &",
            "server=$!",
            "trap 'kill $server' EXIT",
            f"for k in $(seq {_WAITED_S}); do {ask} 2>/dev/null && break; sleep 1; done",
            "sleep 20",
            ask,
            _inside(root, "/data", variables, as_user + shlex.join(["python", "-c", page])),
            f"! find {root}/data -name '*.nbc' | grep .",
        ]
    )


def _inside(root: Path, place: str, variables: dict[str, str], text: str) -> str:
    given = shlex.join(f"{name}={value}" for name, value in variables.items())
    return (
        f"env -i {given} chroot {root} sh -c {shlex.quote(f'cd {place} && exec sh -c {shlex.quote(text)}')}"
    )


def test_root_builds_and_another_user_serves(
    stages: list[list[Instruction]], repo_root: Path, top: Path
) -> None:
    told = subprocess.run(
        ["unshare", "--mount", "--pid", "--fork", "--kill-child", "sh", "-c", script(stages, repo_root, top)],
        capture_output=True, text=True, check=False, timeout=1700,
    )  # fmt: skip
    output = told.stdout + told.stderr
    assert told.returncode == 0, output[-5000:]
    assert "PermissionError" not in output and "failed" not in output
    assert "schuler_open_pages 0" in output and ".nbc" not in output, "the server compiled kernels"
    assert told.stderr.count("kernels: law, error model") == 1, "root compiles, once"
