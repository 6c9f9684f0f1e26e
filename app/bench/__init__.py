"""``schuler bench``: speed and memory on this machine; needs no network and no browser."""

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
        ``budget_24h_3_methods_ms`` (error budgets); ``nmea_us_per_sentence``, ``imu_csv_ns_per_row``,
        ``imu_parquet_ns_per_row`` (recordings read); of the full strapdown the law at the IMU's rate, the
        batch with the simulation of each run's IMU (``strapdown_seeds_ns_per_sample_run``), and a day
        (``strapdown_24h_100hz_s``, ``_mb``, with the Kalman filter ``_kalman_s``); the slider with the tab
        Design in front (``slider_design_ms_p50``, ``_p95``) and with every tab. With a yardstick
        (`schuler_bench.bench.strapdown.YARDSTICK`) its time and the ratios to it. Medians of at least five
        repeats: ns, ms, s and MiB.

    Raises
    ------
    FileNotFoundError
        The yardstick is no file.
    RuntimeError, TimeoutError
        The dashboard does not start or does not answer.
    """
    from schuler_bench.bench import runs
    from schuler_bench.bench.dashboard import measure_dashboard
    from schuler_bench.bench.reading import measure_reading
    from schuler_bench.bench.strapdown import measure_strapdown

    numbers: dict[str, float] = {}
    for what, measure in (
        ("error model, 24 h", runs.measure_error_model),
        ("memory of a run", runs.measure_memory),
        ("strapdown, a sample", measure_strapdown),
        ("strapdown, 24 h at 100 Hz", runs.measure_strapdown_day),
        ("error budget", runs.measure_budgets),
        ("recordings", measure_reading),
        ("dashboard", measure_dashboard),
    ):
        tell(what)
        numbers |= measure()
    return numbers
