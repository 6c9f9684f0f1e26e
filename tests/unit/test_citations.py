"""Every section of the theory that code, page, lessons and documents cite exists; no other file is cited."""

import re
import subprocess
from pathlib import Path

import pytest

from tests import theory

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = ("navcore", "app", "assets", "docs", "tests", "tools", "examples")
PAGES = ("README.md", "CHANGELOG.md", "CONTRIBUTING.md", "Makefile")
# Between "theory.md" and its section: spaces, a line's end with the next one's indent and comment sign.
_GAP = r"[\s#*\"']*"
_NUMBERS = rf"\d+(?:\.\d+)?(?:(?:,| and| to){_GAP}\d+(?:\.\d+)?)*"
_SECTION = re.compile(rf"theory\.md`?,?{_GAP}(?:sections?{_GAP})?({_NUMBERS})")
_NOT_CITING = ("theory.py", "test_theory.py", "test_pages.py", "test_lessons.py", "stage.py")
_OUTSIDE = ("physics", "design", "contract", "dashboard", "house", "speed", "serving")


def cited_from() -> list[Path]:
    """Text files that are in git, or new."""
    listed = subprocess.run(
        ["git", "ls-files", "--cached", "--others", "--exclude-standard", *FOLDERS, *PAGES],
        cwd=ROOT,
        capture_output=True,
        text=True,
    )
    if listed.returncode != 0:
        pytest.skip("not a git checkout")
    endings = {".py", ".toml", ".md", ".json", ".js", ".css", ".ipynb", ""}
    found = (ROOT / name for name in listed.stdout.splitlines())
    return [path for path in found if path.suffix in endings and path.is_file() and path != Path(__file__)]


def sections_cited(text: str) -> list[str]:
    """Numbers of the sections that a text cites."""
    return [number for found in _SECTION.findall(text) for number in re.findall(r"\d+(?:\.\d+)?", found)]


def test_every_cited_section_exists():
    known = set(theory.sections(theory.text()))
    missing, count = [], 0
    for path in cited_from():
        for number in sections_cited(path.read_text("utf-8")):
            count += 1
            if number not in known:
                missing.append(f"{path.relative_to(ROOT)}: theory.md {number}")
    assert count > 100
    assert not missing


def test_every_citation_of_the_theory_names_a_section():
    """Besides links and the name of the file by itself in the pages."""
    loose = []
    for path in cited_from():
        if path.suffix == ".md" or path.name in _NOT_CITING:
            continue
        text = path.read_text("utf-8")
        named = len(re.findall(r"theory\.md(?![\w#])", text)) - len(re.findall(r"docs/theory\.md", text))
        if named > len(_SECTION.findall(text)):
            loose.append(str(path.relative_to(ROOT)))
    assert not loose


def test_no_citation_of_a_file_outside_the_repository():
    outside = re.compile(rf"(?<![\w/])(?:{'|'.join(_OUTSIDE)})\.md|shared/spec")
    own = {f"{name}.md" for name in _OUTSIDE if (ROOT / "docs" / f"{name}.md").exists()}
    found = [
        f"{path.relative_to(ROOT)}: {hit}"
        for path in cited_from()
        for hit in outside.findall(path.read_text("utf-8"))
        if hit not in own
    ]
    assert not found


def test_documents_that_are_named_exist():
    missing = [
        f"{path.relative_to(ROOT)}: {name}.md"
        for path in cited_from()
        if path.suffix == ".py" and path.relative_to(ROOT).parts[0] in ("navcore", "app")
        for name in re.findall(r"(?<![\w*/}])(?:docs/)?([A-Za-z]+)\.md\b", path.read_text("utf-8"))
        if not (ROOT / "docs" / f"{name}.md").exists() and not (ROOT / f"{name}.md").exists()
    ]
    assert not missing


def test_citations_are_found():
    text = "theory.md 3.1, (theory.md section 4: x) theory.md\n    # sections 5 and 9.4"
    text += "; theory.md 2 (a), 3 theory.md 14 to 20"
    assert sections_cited(text) == ["3.1", "4", "5", "9.4", "2", "14", "20"]


def test_sections_of_the_explanations_exist():
    """The page shows these to the user, so that a list such as "2 (error_model), 3 (channel)" counts too."""
    known = set(theory.sections(theory.text()))
    text = (ROOT / "assets" / "explain.toml").read_text("utf-8")
    sources = re.findall(r'^source = "(.*theory\.md.*)"$', text, re.MULTILINE)
    assert len(sources) > 20
    for source in sources:
        told = re.sub(r"\([^)]*\)", "", source.split("theory.md", 1)[1].split(":")[0].split(";")[0])
        assert set(re.findall(r"\d+(?:\.\d+)?", told)) <= known, source
