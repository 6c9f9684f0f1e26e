"""``python -m tools.papers [--out FOLDER] [--only WORD]``: write the reproduction report."""

import argparse
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
    given = parser.parse_args(arguments)
    faults = write_report(papers(), given.out, given.only)
    for fault in faults:
        print(fault, file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
