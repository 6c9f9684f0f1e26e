"""How fast recordings are read: NMEA 0183, and an IMU from CSV and from Parquet."""

import tempfile
from collections.abc import Iterator
from functools import partial, reduce
from operator import xor
from pathlib import Path

import numpy as np

from navcore.io.recording import read_recording
from navcore.sensors.recorded_imu import read_imu
from schuler_bench.bench.rounds import median_s

REPEATS = 5
SECONDS = 10_000
"""Of a ship's log: four sentences each."""
SAMPLES = 300_000
_IMU = ("t_s", "gx_rad_s", "gy_rad_s", "gz_rad_s", "fx_mps2", "fy_mps2", "fz_mps2")


def measure_reading() -> dict[str, float]:
    """Median time of a sentence, us, and of a row of an IMU, ns."""
    import pyarrow
    from pyarrow import csv, parquet

    normal = np.random.default_rng(1).normal
    values = np.column_stack([normal(0.0, 1e-3, (SAMPLES, 3)), normal([0.0, 0.0, 9.8], 0.1, (SAMPLES, 3))])
    columns = np.column_stack([0.01 * np.arange(1, SAMPLES + 1), values]).round(9)
    table = pyarrow.table(dict(zip(_IMU, columns.T, strict=True)))
    with tempfile.TemporaryDirectory(prefix="schuler-bench-") as name:
        folder = Path(name)
        (folder / "log.txt").write_text("\n".join(_ship()))
        csv.write_csv(table, folder / "imu.csv")
        parquet.write_table(table, folder / "imu.parquet")
        times = [
            median_s([partial(read, folder / file)] * REPEATS)
            for read, file in ((read_recording, "log.txt"), (read_imu, "imu.csv"), (read_imu, "imu.parquet"))
        ]
    return {
        "nmea_us_per_sentence": 1e6 * times[0] / (4 * SECONDS),
        "imu_csv_ns_per_row": 1e9 * times[1] / SAMPLES,
        "imu_parquet_ns_per_row": 1e9 * times[2] / SAMPLES,
    }


def _ship() -> Iterator[str]:
    """Lines of a logger: position twice, heading and log, each second, with a time before each sentence."""
    for k in range(SECONDS):
        clock = np.datetime64("2024-05-13") + np.timedelta64(k, "s")
        time, place = str(clock)[11:].replace(":", ""), f"{4500 + 1e-4 * k:.5f},N,{1200 + 2e-4 * k:010.5f},E"
        speed, heading = 10.0 + np.sin(0.01 * k), 90.0 + 30.0 * np.sin(0.02 * k)
        for body in (
            f"GPRMC,{time}.00,A,{place},{speed:.2f},{heading:.1f},130524,,,A",
            f"GPGGA,{time}.00,{place},1,08,1.0,{20.0 + 0.01 * (k % 90):.2f},M,-20.00,M,,",
            f"HEHDT,{heading:.2f},T",
            f"VDVBW,{speed:.2f},0.10,A,{speed:.2f},0.10,A,,V,,V",
        ):
            yield f"{clock}.0000Z ${body}*{reduce(xor, body.encode()):02X}"
