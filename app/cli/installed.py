"""Whether the program is whole: its own physics, and the packages it needs. Imports nothing of either."""

import sys
from importlib.util import find_spec
from pathlib import Path

_OURS = ("navcore", "schuler_bench")


def foreign_navcore() -> str:
    """Say which package stands in the way of our ``navcore``, which lies beside this one; empty if none."""
    ours = Path(__file__).resolve().parents[2] / "navcore"
    if not ours.is_dir():
        return ""
    spec = find_spec("navcore")
    if spec is None or spec.origin is None:  # a folder without __init__.py stands in nobody's way
        return ""
    found = Path(spec.origin).resolve()
    if found.parent == ours:
        return ""
    return f"schuler: {found} is loaded in place of {ours}: rename it, or take its folder off PYTHONPATH"


def missing(error: ImportError) -> str:
    """Say which package cannot be loaded, and what helps."""
    package = (error.name or "").partition(".")[0]
    why = " ".join(str(error).split())
    if package and package not in _OURS:
        return (
            f"schuler: the package {package} cannot be loaded ({why}): pip install schuler-bench installs it"
        )
    return f"schuler: the program is not complete ({why}): pip install --force-reinstall schuler-bench"


def tell(complaint: str) -> None:
    """Print one line to stderr, if there is one."""
    if sys.stderr is not None:
        print(complaint.encode("ascii", "backslashreplace").decode(), file=sys.stderr)
