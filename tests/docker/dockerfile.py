"""Reads a Dockerfile and carries its steps out below a temporary folder, without a Docker engine.

Honest limits: a fresh virtual environment of the Python that runs the tests stands in for the base image;
commands that need the image's own root (`LEFT_OUT`) are not carried out but listed; nothing is isolated from
the machine below. Absolute paths in commands and variables are moved below the folder. Every stage is built
at the same place and set aside afterwards, so that what `COPY --from` brings is where it was made.
"""

from __future__ import annotations

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

KNOWN = {"CMD", "COPY", "ENV", "EXPOSE", "FROM", "HEALTHCHECK", "RUN", "USER", "VOLUME", "WORKDIR"}

# They need root and the image's user database; the folders that `install -d` makes are made all the same.
LEFT_OUT = ("useradd", "install")

# An absolute path: not the inside of a relative path, a URL, a pattern or a variable.
_ABSOLUTE = re.compile(r"(?<![\w.:/*$}-])/(?=[a-z])|(?<=:)/(?=[a-z])")


@dataclass(frozen=True)
class Instruction:
    """One instruction: its keyword, its flags (``--from=builder``), and the rest of its text."""

    keyword: str
    flags: dict[str, str]
    text: str
    line: int

    def words(self) -> list[str]:
        """Arguments of the JSON form or of the plain one."""
        return json.loads(self.text) if self.text.startswith("[") else shlex.split(self.text)


def parse(text: str) -> list[Instruction]:
    """Split a Dockerfile into instructions; an unknown keyword is an error."""
    instructions, pending, first = [], "", 0
    for number, raw in enumerate(text.splitlines(), start=1):
        if not raw.strip() or raw.lstrip().startswith("#"):
            continue
        first = first if pending else number
        pending += raw.strip()
        if pending.endswith("\\"):
            pending = pending[:-1].rstrip() + " "
            continue
        instructions.append(_instruction(pending, first))
        pending = ""
    if pending:
        raise ValueError(f"line {first}: the last instruction does not end")
    return instructions


def _instruction(text: str, line: int) -> Instruction:
    keyword, _, rest = text.partition(" ")
    if keyword.upper() not in KNOWN:
        raise ValueError(f"line {line}: {keyword} is not known here")
    flags = {}
    rest = rest.strip()
    while rest.startswith("--"):
        flag, _, rest = rest.partition(" ")
        name, _, value = flag[2:].partition("=")
        flags[name], rest = value, rest.strip()
    return Instruction(keyword.upper(), flags, rest, line)


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
            k: v for k, v in os.environ.items() if k.startswith("PIP_") or k.endswith(("_proxy", "_PROXY"))
        }
        passed |= {k: os.environ[k] for k in ("SSL_CERT_FILE", "REQUESTS_CA_BUNDLE") if k in os.environ}
        passed["PIP_CACHE_DIR"] = os.environ.get("PIP_CACHE_DIR") or _pip_cache()
        passed["PIP_DISABLE_PIP_VERSION_CHECK"] = "1"
        # "0" switches --no-compile on: byte code takes a third of the time and nothing here looks at it.
        passed["PIP_NO_COMPILE"] = "0"
        base = {
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
            raise ValueError(f"line {instruction.line}: no stand-in for the base {image}")
        self.name, self.workdir, self.variables, self.user = name or "last", "/", {}, "root"
        base, kept = self.root / "usr" / "local", self.folder / "base"
        if kept.is_dir():
            shutil.copytree(kept, base, symlinks=True, copy_function=os.link)
        else:
            subprocess.run([sys.executable, "-m", "venv", str(base)], check=True)
            shutil.copytree(base, kept, symlinks=True, copy_function=os.link)
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
            raise StepFailed(
                f"line {instruction.line}: RUN {instruction.text}: exit {done.returncode}\n{done.stdout}"
            )

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
            expanded = string.Template(below(self.root, value)).substitute(known)
            self.variables[name] = expanded

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
            raise ValueError(f"line {instruction.line}: HEALTHCHECK {keyword} is not known here")
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
