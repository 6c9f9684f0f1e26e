"""GPX tracks, ERDDAP and SAMOS tables and RTKLIB positions, as their programs write them."""

from pathlib import Path

import numpy as np
import pytest

from navcore.foundation.errors import InputError
from navcore.foundation.units import DEG, KNOT
from navcore.io.recording import load, read_recording

START = 1714564800.0  # 2024-05-01 12:00 UTC
POINT = '<trkpt lat="{lat}" lon="-4.5"><ele>1.5</ele><time>2024-05-01T12:00:{second:02}Z</time>{more}</trkpt>'
GPX = (
    '<?xml version="1.0" encoding="UTF-8"?>\n'
    '<gpx version="1.1" creator="logger" xmlns="http://www.topografix.com/GPX/1/1">{before}<trk><trkseg>'
    "{points}</trkseg></trk></gpx>"
)


def _gpx(folder: Path, points: str, before: str = "") -> Path:
    path = folder / "track.gpx"
    path.write_text(GPX.format(points=points, before=before))
    return path


def _points(more: str = "", count: int = 10) -> str:
    return "".join(POINT.format(lat=48.0 + 1e-5 * k, second=k, more=more) for k in range(count))


def test_the_points_of_a_gpx_track_are_positions(tmp_path: Path) -> None:
    position = read_recording(_gpx(tmp_path, _points())).position
    assert position is not None and position.dated
    np.testing.assert_allclose(position.values[3], [48.00003 * DEG, -4.5 * DEG, 1.5], rtol=1e-12)
    assert position.time_s[3] == START + 3.0


def test_speed_and_course_of_a_gpx_point_are_a_velocity(tmp_path: Path) -> None:
    more = (
        "<extensions><x:TrackPointExtension xmlns:x='urn:x'><x:speed>5</x:speed><x:course>90</x:course>"
        "</x:TrackPointExtension></extensions>"
    )
    velocity = read_recording(_gpx(tmp_path, _points(more))).velocity
    assert velocity is not None
    np.testing.assert_allclose(velocity.values, [[5.0, 0.0]] * 10, atol=1e-9)
    assert read_recording(_gpx(tmp_path, _points("<speed>5</speed>"))).velocity is None


def test_points_without_a_time_are_left_out_and_counted(tmp_path: Path) -> None:
    path = _gpx(tmp_path, '<trkpt lat="1" lon="2"/>' + _points())
    record = load(path)
    assert record.position is not None and record.position.time_s.size == 10
    assert "1 point without a time left out" in record.sources[0].warnings
    route = '<rte><rtept lat="1" lon="2"/></rte>'
    for points, before in (('<trkpt lat="1" lon="2"/>', ""), ("", route)):
        with pytest.raises(InputError, match="has no track point with a time"):
            load(_gpx(tmp_path, points, before))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (GPX.format(before="", points=_points())[:400], "is no well-formed XML"),
        ('<!DOCTYPE gpx [<!ENTITY a "b">]>' + GPX.format(before="", points=_points()), "defines entities"),
        (GPX.format(before="", points=_points().replace("48.00003", "98")), "row 4: lat_deg = 98.0"),
        (GPX.format(before="", points=_points().replace("12:00:04", "12:00:02")), "runs backwards by 1 s"),
    ],
    ids=["cut off", "entities", "out of range", "time"],
)
def test_a_damaged_gpx_file_is_refused_by_name(tmp_path: Path, text: str, said: str) -> None:
    path = tmp_path / "track.gpx"
    path.write_text(text)
    with pytest.raises(InputError, match=said):
        load(path)


def test_an_erddap_table_has_its_units_below_its_names(tmp_path: Path) -> None:
    path = tmp_path / "erddap.csv"
    rows = "".join(f"2024-05-01T12:{k:02}:00Z,{48.0 + 0.001 * k},-4.5,90.0,4.5\n" for k in range(10))
    path.write_text(
        "time,latitude,longitude,platform_course,platform_speed_wrt_ground\n"
        f"UTC,degrees_north,degrees_east,degrees,meters second-1\n{rows}"
    )
    record = load(path)
    assert record.position is not None and record.velocity is not None
    np.testing.assert_allclose(record.position.values[:, 1], -4.5 * DEG)
    np.testing.assert_allclose(record.velocity.values, [[4.5, 0.0]] * 10, atol=1e-9)


def test_a_samos_table_has_speeds_in_the_unit_of_its_names(tmp_path: Path) -> None:
    path = tmp_path / "samos.csv"
    rows = "".join(f"2024-05-01T12:{k:02}:00Z,{48.0 + 0.001 * k},-4.5,90.0,270,9.0,8.5\n" for k in range(10))
    path.write_text(f"time,lat,lon,PL_HD,PL_CRS,PL_SPD (kts),PL_SOW (kts)\n{rows}")
    record = load(path)
    assert record.velocity is not None and record.water is not None and record.heading is not None
    np.testing.assert_allclose(record.velocity.values, [[-9.0 * KNOT, 0.0]] * 10, atol=1e-9)
    np.testing.assert_allclose(record.water.values[:, 1], 8.5 * KNOT)


def test_a_pos_file_of_rtklib_is_a_track_in_gps_time(tmp_path: Path) -> None:
    path = tmp_path / "rover.pos"
    rows = "".join(
        f"2024/05/01 12:00:{k:02}.000   {48.0 + 1e-5 * k:.9f}   -4.500000000    51.2   1   9\n"
        for k in range(10)
    )
    path.write_text(
        "% program   : RTKLIB ver.2.4.3\n% obs start : 2024/05/01 12:00:00.0 GPST (week2312 302400.0s)\n"
        f"%  GPST                  latitude(deg) longitude(deg)  height(m)   Q  ns\n{rows}"
    )
    position = load(path).position
    assert position is not None and position.time_s[0] == START - 18.0
    np.testing.assert_allclose(position.values[:, 2], 51.2)
