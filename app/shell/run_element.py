"""The hidden element that tells the page, and who reads it, which run is shown."""

from __future__ import annotations

import hashlib
from html import escape

from app.shell.opening import as_json
from navcore.engine.measures import metrics
from navcore.engine.run import Run


def run_element(run: Run, number: int) -> str:
    """Return HTML with the run's number, its status, a digest of its methods and its metrics as JSON."""
    digest = hashlib.blake2b(digest_size=16)
    for method in run.methods:
        digest.update(method.fingerprint)
    return (
        f'<div id="sb-run" hidden data-run="{number}" data-status="{run.status}" '
        f'data-digest="{digest.hexdigest()}">{escape(as_json(metrics(run)).decode())}</div>'
    )
