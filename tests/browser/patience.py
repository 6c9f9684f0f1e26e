"""How long a test waits for a page, and which of its complaints say nothing."""

import os

THROTTLE_MS = 80
"""More than the 30 ms in which the page sends at most one value of a control."""

PATIENCE_MS = 90_000
"""So long a page may take for one thing, on a machine that does much else."""

SLOW = float(os.environ.get("SCHULER_BROWSER_SLOW", "1"))
"""The page's processor is so many times slower: a test must not depend on its speed."""

GONE = ("Tried to update non-existent component", "_redrawFromAutoMarginCount")
"""What viser and plotly say of a plot that goes while it is drawn; nothing is lost.

viser's page removes at once what is removed, but changes what is changed at the end of a frame: a plot that
was changed and then removed within one frame, when the page is behind, is reported so. And plotly goes on
laying out a plot in several steps, whether or not it is still there.
"""
