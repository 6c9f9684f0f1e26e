"""Inventory of an installation: ``python -m tools.supply sbom`` and ``audit``, from the lock."""

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
LOCK, SBOM = ROOT / "requirements/run.lock", ROOT / "build" / "sbom.json"
VULNERABLE, UNREACHABLE = 1, 3


def sbom() -> int:
    """Write the CycloneDX document; the same lock gives the same bytes."""
    SBOM.parent.mkdir(exist_ok=True)
    words = ["-m", "cyclonedx_py", "requirements", "--pyproject", str(ROOT / "pyproject.toml")]
    options = ["--output-reproducible", "--output-format", "JSON", "--output-file", str(SBOM), str(LOCK)]
    ended = subprocess.run([sys.executable, *words, *options], check=False)
    if ended.returncode == 0:
        parts = json.loads(SBOM.read_text(encoding="utf-8"))["components"]
        print(f"{SBOM.relative_to(ROOT)}: {len(parts)} components")
    return ended.returncode


def audit() -> int:
    """Look the locked packages up; say what is vulnerable, or that nothing could be looked up."""
    words = ["-m", "pip_audit", "--disable-pip", "--require-hashes", "--progress-spinner", "off"]
    options = ["--format", "json", "--requirement", str(LOCK)]
    ended = subprocess.run([sys.executable, *words, *options], capture_output=True, text=True, check=False)
    code, lines = judged(ended.stdout, ended.stderr)
    print("\n".join(lines))
    return code


def judged(report: str, complaint: str) -> tuple[int, list[str]]:
    """Exit code and lines from what pip-audit said: its JSON report, or why there is none."""
    try:
        found: list[dict[str, Any]] = json.loads(report)["dependencies"]
    except (ValueError, KeyError, TypeError):
        last = next((line for line in reversed(complaint.splitlines()) if line.strip()), "no word")
        told = "Nothing was looked up: the service of published vulnerabilities gave no answer."
        return UNREACHABLE, [told, last[:300]]
    bad = [(one, flaw) for one in found for flaw in one.get("vulns", [])]
    if not bad:
        return 0, [f"{len(found)} packages looked up, none is known to be vulnerable"]
    lines = [
        f"{one['name']} {one['version']}: {flaw['id']}, mended in {', '.join(flaw['fix_versions']) or 'none'}"
        for one, flaw in bad
    ]
    return VULNERABLE, lines


if __name__ == "__main__":
    sys.exit({"sbom": sbom, "audit": audit}[sys.argv[1]]())
