"""``python -m tools.papers [--out FOLDER] [--only WORD] [--jobs COUNT]``: write the reproduction report."""

import argparse
import os
import sys
from pathlib import Path

from tools.papers.write import papers, write_report


def main(arguments: list[str] | None = None) -> int:
    """Write papers.md and its pictures; 1 when a claim contradicts what stands beside it."""
    parser = argparse.ArgumentParser(prog="python -m tools.papers", description=__doc__)
    parser.add_argument("--out", type=Path, default=Path("docs"), help="folder to write papers.md into")
    parser.add_argument(
        "--only", default="", help="only exhibits whose name holds this; papers.md is printed"
    )
    parser.add_argument(
        "--jobs", type=int, default=min(2, os.cpu_count() or 1), help="processes, a paper each (default: 2)"
    )
    given = parser.parse_args(arguments)
    faults = write_report(papers(), given.out, given.only, given.jobs)
    for fault in faults:
        print(fault, file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
