"""A run with fewer output rows: for those that are kept beside the present one."""

from dataclasses import replace

import numpy as np

from navcore.engine.run import MethodRun, Run

MOST_ROWS = 2000
"""Output rows that a kept run needs: what a picture can show."""


def few_rows(run: Run, most: int = MOST_ROWS) -> Run:
    """The same run with at most about ``most`` output rows, first and last among them; curves stay whole."""
    step = -(-len(run.t_s) // most)
    if step <= 1:
        return run
    last = len(run.t_s) - 1
    chosen = np.unique(np.append(np.arange(0, last + 1, step), last))
    methods = tuple(_few_rows(method, chosen) for method in run.methods)
    against = run.against
    if against is not None:
        recorded = None if against.recorded is None else _few_rows(against.recorded, chosen)
        against = replace(against, recorded=recorded, to_log=against.to_log[chosen])
    return replace(run, methods=methods, t_s=run.t_s[chosen], truth=run.truth[chosen], against=against)


def _few_rows(method: MethodRun, chosen: np.ndarray) -> MethodRun:
    mine = chosen[chosen < len(method.t_s)]
    return replace(
        method,
        t_s=method.t_s[mine],
        rows=method.rows[mine],
        law_series=method.law_series[mine],
        navigation=None if method.navigation is None else method.navigation[mine],
        output=None if method.output is None else method.output[mine],
        moved=None if method.moved is None else method.moved[mine],
    )
