"""Builds the site into ``build/docs``; a warning is an error."""

from __future__ import annotations

import os
import sys

from sphinx.cmd.build import main

from docs.site.stage import ROOT, stage


def build() -> int:
    """Stage and build; return Sphinx's exit code."""
    source, site = ROOT / "build" / "docs-source", ROOT / "build" / "docs"
    stage(ROOT, source)
    # The kernel of a notebook is a process of its own; it must see this checkout.
    os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, [str(ROOT), os.environ.get("PYTHONPATH")]))
    code = main(["--quiet", "--fail-on-warning", "--keep-going", "-b", "html", "-E", str(source), str(site)])
    if code == 0:
        print(f"The site is at {site / 'index.html'}")
    return code


if __name__ == "__main__":
    sys.exit(build())
