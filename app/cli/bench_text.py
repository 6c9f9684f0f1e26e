"""The measured numbers as a table for people."""

from collections.abc import Mapping

from navcore.foundation.answers import columns, number

_ROWS = {
    "error_model_24h_ms_per_method": ("error model, 24 h at 1 s: a method, noise included", "ms", "20"),
    "error_model_24h_cold_ms": ("the same, one method, truth and noise made anew", "ms", ""),
    "run_24h_memory_mb": ("memory of a 24 h run of 3 methods above start", "MiB", "100"),
    "strapdown_free_ns_per_sample": ("full strapdown, undamped: a sample, 200 Hz", "ns", "80"),
    "strapdown_damped_ns_per_sample": ("compass damping at 1 Hz in the loop", "ns", "90"),
    "strapdown_imu_rate_ns_per_sample": ("network of four states at the IMU's rate", "ns", "115"),
    "strapdown_batch_ns_per_sample_run": ("64 runs at once, all cores: a sample and run", "ns", "18"),
    "strapdown_seeds_ns_per_sample_run": ("the same, each run's IMU simulated too", "ns", ""),
    "imu_simulation_ns_per_sample": ("simulated IMU on a swing, all its noises: a sample", "ns", "80"),
    "yardstick_ns_per_sample": ("reference timed in the same rounds: a sample", "ns", ""),
    "strapdown_free_to_yardstick": ("undamped, to the reference", "", "1.15"),
    "strapdown_damped_to_yardstick": ("compass damping, to the reference", "", "1.29"),
    "strapdown_imu_rate_to_yardstick": ("network at the IMU's rate, to the reference", "", "1.64"),
    "strapdown_batch_to_yardstick": ("64 runs, a run, to the reference", "", ""),
    "strapdown_seeds_to_yardstick": ("the same, each run's IMU simulated too", "", ""),
    "imu_simulation_to_yardstick": ("simulated IMU, to the reference", "", "1.14"),
    "strapdown_24h_100hz_s": ("full strapdown, 24 h at 100 Hz, two methods, all noises", "s", "3"),
    "strapdown_24h_100hz_mb": ("highest memory of that process", "MiB", "400"),
    "strapdown_24h_100hz_kalman_s": ("the same day, the Kalman filter alone", "s", ""),
    "budget_steady_7_ms": ("error budget and floor of 7 methods, steady state", "ms", "30"),
    "budget_24h_3_methods_ms": ("error budget along 24 h, 3 methods, moving ship, all sources", "ms", "400"),
    "nmea_us_per_sentence": ("NMEA 0183 read: a sentence", "us", "8.33"),
    "imu_csv_ns_per_row": ("IMU read from CSV: a row", "ns", "1000"),
    "imu_parquet_ns_per_row": ("IMU read from Parquet: a row", "ns", "200"),
    "slider_to_frame_ms_p50": ("slider to last byte of the figures, 24 h, 3 methods: median", "ms", ""),
    "slider_to_frame_ms_p95": ("95th percentile", "ms", "100"),
    "slider_design_ms_p50": ("the same, budget and floor in front (Design, tab Limits): median", "ms", ""),
    "slider_design_ms_p95": ("95th percentile", "ms", "100"),
    "slider_all_views_ms_p50": ("the same, every view in front and 2 pinned runs: median", "ms", ""),
    "slider_all_views_ms_p95": ("95th percentile", "ms", "100"),
    "startup_s": ("process start to page served", "s", "1.5"),
    "rss_mb": ("memory of the server after that", "MiB", ""),
}


def bench_text(numbers: Mapping[str, float]) -> list[str]:
    """One line a number, with unit and goal."""
    rows = [["", "measured", "", "goal"]]
    for key, value in numbers.items():
        what, unit, goal = _ROWS.get(key, (key, "", ""))
        rows.append([what, number(value, 3), unit, f"<= {goal}" if goal else ""])
    return columns(rows)
