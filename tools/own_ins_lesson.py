"""Make the recordings of the lesson "Damping from outside": ``python -m tools.own_ins_lesson``.

The strapdown engine sails a ship for six hours; its free INS and its log along the ship's axes are
written each 10 s, a GNSS each 20 s, as a ship's logger would.
"""

import csv
import tempfile
from pathlib import Path

from navcore.foundation.assets import asset_path
from tests.own_ins import in_the_loop, recordings

LOG = {
    "kind": "log",
    "rate_hz": 0.1,
    "frame": "body",
    "bias_mps": [0.05, 0.1],
    "scale_ppm": 3000.0,
    "noise_mps": 0.05,
}
START = {
    "attitude_arcmin": [0.3, -0.2, 1.5],
    "velocity_mps": [0.4, -0.3],
    "position_arcsec": [3.0, -2.0],
}
DIGITS = {"t_s": 0, "lat_deg": 7, "lon_deg": 7, "ve_mps": 4, "vn_mps": 4}
NAMES = {"ins": "own-ins.csv", "log": "own-ins-log.csv", "truth": "own-ins-gnss.csv"}
EVERY = {"truth": 2}
"""Rows of 10 s of which one is written."""
NOT_RECORDED = ("pitch_deg", "roll_deg")


def make(folder: Path) -> None:
    """Write the three files into a folder."""
    run = in_the_loop([], reference=LOG, initial_error=START)
    with tempfile.TemporaryDirectory() as made:
        files = recordings(run, Path(made), every_s=10.0)
        for kind, name in NAMES.items():
            with Path(files[kind]).open(newline="") as source:
                rows = list(csv.DictReader(source))
            columns = [column for column in rows[0] if column not in NOT_RECORDED]
            with (folder / name).open("w", newline="") as target:
                writer = csv.writer(target, lineterminator="\n")
                writer.writerow(columns)
                writer.writerows(
                    [f"{float(row[one]):.{DIGITS.get(one, 3)}f}" for one in columns]
                    for row in rows[:: EVERY.get(kind, 1)]
                )


if __name__ == "__main__":
    make(asset_path("recordings"))
