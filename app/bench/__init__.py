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
        Keys of interface.md; ``error_model_24h_cold_ms``, ``run_24h_memory_mb``; ``budget_steady_7_ms``,
        ``budget_24h_3_methods_ms`` (error budgets); of the full strapdown the
        law at the IMU's rate, the batch with noise at every sample, and a day (``strapdown_24h_100hz_s``,
        ``_mb``, with the Kalman filter ``_kalman_s``); the slider with the tab Design in front
        (``slider_design_ms_p50``, ``_p95``) and with every tab. With a yardstick
        (`app.bench.strapdown.YARDSTICK`) its time and the ratios to it. Medians of at least five repeats: ns,
        ms, s and MiB.

    Raises
    ------
    FileNotFoundError
        The yardstick is no file.
    RuntimeError, TimeoutError
        The dashboard does not start or does not answer.
    """
    from app.bench.dashboard import measure_dashboard
    from app.bench.design import measure_design
    from app.bench.error_model import measure_error_model
    from app.bench.memory import measure_memory
    from app.bench.strapdown import measure_strapdown
    from app.bench.strapdown_day import measure_strapdown_day

    tell("error model, 24 h")
    numbers = measure_error_model()
    tell("memory of a run")
    numbers |= measure_memory()
    tell("strapdown, a sample")
    numbers |= measure_strapdown()
    tell("strapdown, 24 h at 100 Hz")
    numbers |= measure_strapdown_day()
    tell("error budget")
    numbers |= measure_design()
    tell("dashboard")
    return numbers | measure_dashboard()
