"""Where a Chromium is looked for, and what is said when there is none."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests import chromium


def stand_in(folder: Path, name: str, script: str = "exit 0") -> Path:
    """Executable of some name."""
    path = folder / name
    path.write_text(f"#!/bin/sh\n{script}\n")
    path.chmod(0o755)
    return path


@pytest.fixture
def empty_machine(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """Nothing on the PATH, nothing of playwright's, not root; the only folder of the PATH."""
    monkeypatch.delenv("SCHULER_CHROMIUM", raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr(chromium, "_playwrights_own", lambda: None)
    monkeypatch.setattr("os.geteuid", lambda: 1000)
    return tmp_path


def test_the_named_one_goes_before_the_systems(empty_machine: Path, monkeypatch: pytest.MonkeyPatch):
    system, own = stand_in(empty_machine, "chromium"), stand_in(empty_machine, "my-own")
    assert chromium.find_chromium() == system
    monkeypatch.setenv("SCHULER_CHROMIUM", str(own))
    assert chromium.find_chromium() == own
    monkeypatch.setenv("SCHULER_CHROMIUM", str(empty_machine / "missing"))
    assert chromium.find_chromium() is None


def test_one_that_is_there_is_not_installed_again(empty_machine: Path):
    path = stand_in(empty_machine, "chromium-browser")
    assert chromium.provide_chromium() == (path, "found")


def test_root_gets_it_from_the_distribution(empty_machine: Path, monkeypatch: pytest.MonkeyPatch):
    target = empty_machine / "chromium"
    bring = f"test $1 = update || /bin/cp {empty_machine}/apt-get {target}"
    stand_in(empty_machine, "apt-get", bring)
    monkeypatch.setattr("os.geteuid", lambda: 0)
    assert chromium.provide_chromium() == (target, "installed by apt-get install chromium")


def test_what_failed_is_told(empty_machine: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("sys.executable", str(stand_in(empty_machine, "python", "echo no way; exit 1")))
    path, how = chromium.provide_chromium()
    assert path is None
    assert "playwright install chromium" in how
    assert how.endswith("no way")
