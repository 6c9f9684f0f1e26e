"""How files take their names: all of a folder or none, with the user's rights, and never over another's."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import pytest

from navcore.foundation import out
from navcore.foundation.errors import InputError
from navcore.foundation.out import placing, require_file, require_folder, signed, write_file, written_by
from tests.folders import contents


def fill(hidden: Path, text: str) -> None:
    for name in ("a.json", "b.json"):
        (hidden / name).write_text(text)


def test_all_files_take_their_names_or_none(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    names = ("a.json", "b.json")
    with placing(tmp_path / "new" / "out", names) as hidden:
        fill(hidden, "first")
        assert not (tmp_path / "new" / "out" / "a.json").exists()
    folder = tmp_path / "new" / "out"
    replace = os.replace

    def full(source: Any, target: Any) -> None:
        if Path(target).name == "b.json" and ".schuler-" in str(source) and "earlier" not in str(source):
            raise OSError(28, "No space left on device")
        replace(source, target)

    monkeypatch.setattr(out.os, "replace", full)
    with (
        pytest.raises(InputError, match="cannot be written: No space left"),
        placing(folder, names) as hidden,
    ):
        fill(hidden, "second")
    assert contents(folder) == {"a.json": b"first", "b.json": b"first"}
    with pytest.raises(InputError, match="No space"), placing(tmp_path / "none", names) as hidden:
        raise OSError(28, "No space left on device")
    assert not (tmp_path / "none").exists()


def test_what_a_kill_has_left_is_removed_and_what_is_in_use_is_not(tmp_path: Path) -> None:
    (tmp_path / f"{out.HIDDEN}dead").mkdir()
    (tmp_path / f"{out.HIDDEN}dead" / "a.json").write_text("half")
    with placing(tmp_path, ("a.json", "b.json")) as first:
        fill(first, "first")
        with placing(tmp_path, ("a.json", "b.json")) as second:
            fill(second, "second")
        assert first.is_dir()
    assert contents(tmp_path) == {"a.json": b"first", "b.json": b"first"}
    assert [path.name for path in sorted(tmp_path.iterdir())] == ["a.json", "b.json"]


def test_what_comes_into_the_way_meanwhile_is_left(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="is a folder"), placing(tmp_path, ("a.json", "b.json")) as hidden:
        fill(hidden, "x")
        (tmp_path / "b.json").mkdir()
    assert [path.name for path in tmp_path.iterdir()] == ["b.json"]


def test_files_have_the_rights_that_the_user_gives(tmp_path: Path) -> None:
    before = os.umask(0o077)
    try:
        with placing(tmp_path / "out", ("a.json", "b.json")) as hidden:
            fill(hidden, "x")
        write_file(tmp_path / "best.toml", "x = 1\n", "tune")
    finally:
        os.umask(before)
    for path in (tmp_path / "out" / "a.json", tmp_path / "best.toml"):
        assert path.stat().st_mode & 0o777 == 0o600


def test_a_folder_that_cannot_be_written_is_refused_before_anything_is_computed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Asked of the system, which also knows of disks that are mounted for reading."""
    (tmp_path / "mine").mkdir()
    monkeypatch.setattr(out.os, "access", lambda path, mode: Path(path) != tmp_path / "mine")
    for ask in (
        lambda: require_folder(tmp_path / "mine", ["a"]),
        lambda: require_folder(tmp_path / "mine" / "x" / "y", ["a"]),
        lambda: require_file(tmp_path / "mine" / "a.toml", "tune"),
    ):
        with pytest.raises(InputError, match="cannot be written: .*mine is write-protected"):
            ask()
    require_folder(tmp_path / "other", ["a"])


def test_a_full_disk_leaves_the_earlier_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    target = tmp_path / "best.toml"
    write_file(target, "x = 1\n", "tune")
    before = target.read_bytes()

    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(out.os, "fsync", full)
    with pytest.raises(InputError, match="--out = .*: cannot be written: No space left on device"):
        write_file(target, "x = 2\n", "tune")
    assert contents(tmp_path) == {"best.toml": before}


def test_a_file_is_known_by_a_comment_of_its_own_format(tmp_path: Path) -> None:
    page = tmp_path / "report.html"
    page.write_text(f"<!DOCTYPE html>\n{signed('', 'report', '<!-- {} -->')}<p>text</p>\n")
    assert not written_by("report", page)  # the digest is of all other lines
    write_file(tmp_path / "page.html", "<p>text</p>\n", "report", comment="<!-- {} -->")
    assert written_by("report", tmp_path / "page.html")
    assert not written_by("export", tmp_path / "page.html")


def test_names_differ_by_the_file_system_alone(tmp_path: Path) -> None:
    """``Scenario.toml`` is the run's own file only where the file system does not tell letters apart."""
    (tmp_path / "Scenario.toml").write_text("x")
    same = (tmp_path / "scenario.toml").exists()
    try:
        require_folder(tmp_path, ["scenario.toml"], [tmp_path / "Scenario.toml"])
    except InputError:
        assert same
    else:
        assert not same
    require_file(tmp_path / "new.toml", "tune", ["a\0b", "x" * 5000])
