"""Shares of seeds beside a tick: how often a method meets a limit, and all of them."""

from navcore.engine.verdicts import Judgement
from navcore.foundation.text import Text
from schuler_bench.jobs.odds import Odds
from schuler_bench.plots.table import cell
from schuler_bench.plots.units import number


def share_text(met: float, low: float, high: float) -> str:
    """Share with its interval, in per cent.

    Examples
    --------
    >>> share_text(0.75, 0.6857, 0.8049)
    '75 % (69 to 80)'
    """
    return Text(
        "{met} % ({low} to {high})",
        met=number(100.0 * met, 3),
        low=f"{100.0 * low:.0f}",
        high=f"{100.0 * high:.0f}",
    )


def judgements(odds: Odds | None) -> tuple[Judgement, ...] | None:
    """What the seeds of a method say of each limit; None where none has been judged."""
    return None if odds is None else tuple(limit.judgement for limit in odds.share.limits)


def odds_html(odds: Odds | None, place: int | None = None) -> str:
    """Share of one limit by its place, or of all together; empty where no seed has been judged."""
    if odds is None or (place is not None and place >= len(odds.share.limits)):
        return ""
    said = odds.share if place is None else odds.share.limits[place].judgement
    hint = Text("Share of {seeds} seeds that meet it, 95 % interval", seeds=odds.seeds)
    shown = cell(share_text(said.met, said.low, said.high), "sb-share", tag="div", title=hint)
    if isinstance(said, Judgement) and said.verdict == "open":
        more = Text("no number of seeds decides")
        if said.more is not None:
            more = Text("{more} more seeds decide", more=said.more)
        shown += cell(more, "sb-share", tag="div")
    return shown
