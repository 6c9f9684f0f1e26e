"""The recordings that tests run on: the raw ones where they are, else those that come with the program."""

import os
from pathlib import Path
from typing import Literal, NamedTuple

ROOT = Path(__file__).resolve().parent.parent
OWN = ROOT / "assets" / "recordings"


def raw_folder() -> Path | None:
    """Folder of the raw recordings, which is not part of the repository; None in a new clone."""
    folder = Path(os.environ.get("SCHULER_SHARED_DATA") or ROOT.parent / "shared" / "data")
    return folder if folder.is_dir() else None


class Ship(NamedTuple):
    """Files of the R/V Sikuliaq, 2018-12-06.

    Attributes
    ----------
    raw : bool
        NMEA as the ship wrote it; otherwise the same as CSV.
    log : str
        Speed log.
    track : tuple of str
        Positions and heading.
    """

    raw: bool
    log: str
    track: tuple[str, ...]


OWN_SHIP = Ship(False, str(OWN / "sikuliaq-log.csv"), (str(OWN / "sikuliaq-track.csv"),))
"""The ship's files that come with the program."""


def ship() -> Ship:
    """Find the ship's files."""
    folder = raw_folder()
    if folder is None:
        return OWN_SHIP
    names = ("gnss_cnav", "gyro_1")
    track = tuple(str(folder / "ship" / f"SKQ_{name}.txt") for name in names)
    return Ship(True, str(folder / "ship" / "SKQ_speedlog.txt"), track)


class ImuFile(NamedTuple):
    """IMU of the parked vehicle.

    Attributes
    ----------
    raw : bool
        Increments at 100 Hz; otherwise means of a second.
    path : Path
        The file.
    axes : str
        As `imu.axes` of a scenario.
    """

    raw: bool
    path: Path
    axes: Literal["rfu", "frd"]


def imu() -> ImuFile:
    """Find the IMU's file."""
    folder = raw_folder()
    if folder is None:
        return ImuFile(False, OWN / "lasergyro-1s.csv", "frd")
    return ImuFile(True, folder / "imu" / "lasergyro.imu", "rfu")
