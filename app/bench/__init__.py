"""``schuler bench``: speed and memory on this machine; needs no network and no browser."""

from __future__ import annotations

from collections.abc import Callable


def bench(tell: Callable[[str], None] = lambda _: None) -> dict[str, float]:
    """Measure everything.

    Parameters
    ----------
    tell : callable
        Called with what is being measured.

    Returns
    -------
    dict
        The keys of contract.md that apply to what is built, and ``error_model_24h_cold_ms``,
        ``run_24h_memory_mb``; medians of at least five repeats, ms, s and MiB.

    Raises
    ------
    RuntimeError, TimeoutError
        The dashboard does not start or does not answer.
    """
    from app.bench.dashboard import measure_dashboard
    from app.bench.error_model import measure_error_model
    from app.bench.memory import measure_memory

    tell("error model, 24 h")
    numbers = measure_error_model()
    tell("memory of a run")
    numbers |= measure_memory()
    tell("dashboard")
    return numbers | measure_dashboard()
