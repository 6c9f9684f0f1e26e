"""Reads a Dockerfile and carries its steps out below a temporary folder, without a Docker engine.

Honest limits: a fresh virtual environment of the Python that runs the tests stands in for the base image;
commands that need the image's own root (`LEFT_OUT`) are not carried out but listed; nothing is isolated from
the machine below. Absolute paths in commands and variables are moved below the folder. Every stage is built
at the same place and set aside afterwards, so that what `COPY --from` brings is where it was made.
"""

import fnmatch
import functools
import json
import os
import re
import shlex
import shutil
import string
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

# They need root and the image's user database; the folders that `install -d` makes are made all the same.
LEFT_OUT = ("useradd", "install")

_INSTRUCTION = re.compile(r"(\w+)\s+((?:--\S+\s+)*)(.*)")
# An absolute path: not the inside of a relative path, a URL, a pattern or a variable.
_ABSOLUTE = re.compile(r"(?<![\w.:/*$}-])/(?=[a-z])|(?<=:)/(?=[a-z])")


class Instruction(NamedTuple):
    """One instruction: its keyword, its flags (``--from=builder``), and the rest of its text."""

    keyword: str
    flags: dict[str, str]
    text: str

    def words(self) -> list[str]:
        """Arguments of the JSON form or of the plain one."""
        return json.loads(self.text) if self.text.startswith("[") else shlex.split(self.text)


def parse(text: str) -> list[Instruction]:
    """Split a Dockerfile into instructions.

    Examples
    --------
    >>> [tuple(each) for each in parse("# note\\nRUN a \\\\\\n  # in\\n && b\\nCOPY --from=x a /b\\n")]
    [('RUN', {}, 'a && b'), ('COPY', {'from': 'x'}, 'a /b')]
    """
    code = "\n".join(line.strip() for line in text.splitlines() if not line.lstrip().startswith("#"))
    lines = filter(None, re.sub(r"\s*\\\n\s*", " ", code).splitlines())
    return [
        Instruction(keyword, dict(flag[2:].split("=", 1) for flag in flags.split()), rest)
        for keyword, flags, rest in (_INSTRUCTION.fullmatch(line).groups() for line in lines)
    ]


def below(root: Path, text: str) -> str:
    """Move the absolute paths in a text below a folder."""
    return _ABSOLUTE.sub(f"{root}/", text)


def copy_context(source: Path, target: Path, ignore: str) -> None:
    """Copy what .dockerignore lets through; the last pattern that fits decides."""
    patterns = [line.strip() for line in ignore.splitlines() if line.strip() and not line.startswith("#")]

    def ignored(relative: Path) -> bool:
        outcome = False
        for pattern in patterns:
            keep, glob = pattern.startswith("!"), pattern.lstrip("!").removeprefix("**/")
            candidates = relative.parts if "**/" in pattern else relative.parts[:1]
            if any(fnmatch.fnmatch(part, glob) for part in candidates):
                outcome = not keep
        return outcome

    target.mkdir(parents=True)
    for entry in sorted(source.iterdir()):
        if ignored(Path(entry.name)):
            continue
        if entry.is_dir():
            skip = lambda folder, names: [n for n in names if ignored(Path(folder).relative_to(source) / n)]  # noqa: E731
            shutil.copytree(entry, target / entry.name, ignore=skip)
        else:
            shutil.copy2(entry, target / entry.name)


class StepFailed(RuntimeError):
    """A RUN command exited with something else than 0."""


@dataclass
class Build:
    """The stage being built: `folder` holds `root` (the stage at work), finished stages and the context."""

    folder: Path
    context: Path
    variables: dict[str, str] = field(default_factory=dict)
    workdir: str = "/"
    name: str = ""
    user: str = "root"
    command: list[str] = field(default_factory=list)
    health: list[str] = field(default_factory=list)
    left_out: list[str] = field(default_factory=list)

    @property
    def root(self) -> Path:
        """Where the stage's absolute paths begin."""
        return self.folder / "root"

    def carry_out(self, instructions: list[Instruction]) -> None:
        """Carry out all instructions; the last stage stays at `root`."""
        for instruction in instructions:
            getattr(self, f"_{instruction.keyword.lower()}")(instruction)

    def environment(self) -> dict[str, str]:
        """Variables a command sees: those of the image, and what pip needs to reach its index here."""
        passed = {
            name: value
            for name, value in os.environ.items()
            if name.startswith("PIP_")
            or name.endswith(("_proxy", "_PROXY"))
            or name in ("SSL_CERT_FILE", "REQUESTS_CA_BUNDLE")
        }
        base = {
            "PIP_CACHE_DIR": os.environ.get("PIP_CACHE_DIR") or _pip_cache(),
            "PIP_DISABLE_PIP_VERSION_CHECK": "1",
            # "0" switches --no-compile on: byte code takes a third of the time and nothing here looks at it.
            "PIP_NO_COMPILE": "0",
            "PATH": f"{self.root}/usr/local/bin:/usr/bin:/bin",
            "HOME": f"{self.root}/root",
            "LANG": "C.UTF-8",
        }
        return passed | base | self.variables

    def place(self, path: str) -> Path:
        """Where a path of the stage lies; one that is not absolute starts at the stage's WORKDIR."""
        return self.root / (path if path.startswith("/") else f"{self.workdir}/{path}").lstrip("/")

    def run(self, command: list[str]) -> subprocess.CompletedProcess[str]:
        """Run a command in the stage."""
        return subprocess.run(
            command,
            cwd=self.place(self.workdir),
            env=self.environment(),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=600,
        )

    def _from(self, instruction: Instruction) -> None:
        if self.name:
            self.root.rename(self.folder / f"stage-{self.name}")
        image, _, name = instruction.text.partition(" AS ")
        if not image.startswith("python:"):
            raise ValueError(f"no stand-in for the base {image}")
        self.name, self.workdir, self.variables, self.user = name or "last", "/", {}, "root"
        base = self.folder / "base"
        if not base.is_dir():
            subprocess.run([sys.executable, "-m", "venv", str(self.root / "usr" / "local")], check=True)
            shutil.copytree(self.root / "usr" / "local", base, symlinks=True, copy_function=os.link)
        else:
            shutil.copytree(base, self.root / "usr" / "local", symlinks=True, copy_function=os.link)
        (self.root / "root").mkdir()

    def _run(self, instruction: Instruction) -> None:
        parts = []
        for part in instruction.text.split(" && "):
            words = part.split()
            if words[0] in LEFT_OUT:
                self.left_out.append(part)
                parts += [f"mkdir -p {words[-1]}"] if words[:2] == ["install", "-d"] else []
            else:
                parts.append(part.strip())
        done = self.run(["/bin/sh", "-e", "-c", below(self.root, " && ".join(parts) or "true")])
        if done.returncode != 0:
            raise StepFailed(f"RUN {instruction.text}: exit {done.returncode}\n{done.stdout}")

    def _copy(self, instruction: Instruction) -> None:
        *sources, target = instruction.words()
        stage = instruction.flags.get("from")
        origin = self.folder / f"stage-{stage}" if stage else self.context
        into = self.place(target)
        for source in sources:
            path = origin / source.lstrip("/")
            if path.is_dir():
                # Links instead of copies between stages: nearly a gigabyte less to write.
                how = os.link if stage else shutil.copy2
                shutil.copytree(path, into, symlinks=True, copy_function=how, dirs_exist_ok=True)
            else:
                goal = into / path.name if target.endswith("/") else into
                goal.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(path, goal)

    def _env(self, instruction: Instruction) -> None:
        known = self.environment()
        for word in instruction.words():
            name, _, value = word.partition("=")
            # What a variable holds is already moved below the folder: move, then expand.
            self.variables[name] = string.Template(below(self.root, value)).substitute(known)

    def _workdir(self, instruction: Instruction) -> None:
        self.workdir = instruction.text
        self.place(self.workdir).mkdir(parents=True, exist_ok=True)

    def _user(self, instruction: Instruction) -> None:
        self.user = instruction.text

    def _cmd(self, instruction: Instruction) -> None:
        self.command = instruction.words()

    def _healthcheck(self, instruction: Instruction) -> None:
        keyword, _, rest = instruction.text.partition(" ")
        if keyword != "CMD":
            raise ValueError(f"HEALTHCHECK {keyword} is not known here")
        self.health = json.loads(rest)

    def _volume(self, instruction: Instruction) -> None:
        for folder in instruction.words():
            self.place(folder).mkdir(parents=True, exist_ok=True)

    def _expose(self, instruction: Instruction) -> None:
        int(instruction.text)


@functools.cache
def _pip_cache() -> str:
    asked = subprocess.run([sys.executable, "-m", "pip", "cache", "dir"], capture_output=True, text=True)
    return asked.stdout.strip() or os.devnull
