"""``python -m schuler_bench`` is the command ``schuler``; in a checkout ``python -m app`` is too."""

import sys

from schuler_bench.cli import main

if __name__ == "__main__":
    sys.exit(main())
