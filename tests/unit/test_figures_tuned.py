"""The picture and rows of a table that Sun's double loop found."""

import re

from navcore.design.sun import TuningSettings, tune_table
from schuler_bench.views.method.tuned import HEIGHT, WIDTH, table_html


def test_every_row_is_a_dot_in_the_frame_and_stands_beside_suns() -> None:
    found = tune_table(settings=TuningSettings(differences_kn=(0.0, 0.5, 3.0), smallest=0.2, step=0.4))
    html = table_html(found, "#0072B2")
    dots = re.findall(r'class="sb-found" cx="([\d.]+)" cy="([\d.]+)"', html)
    assert len(dots) == 3
    assert all(0 < float(x) < WIDTH and 0 < float(y) < HEIGHT for x, y in dots)
    assert float(dots[0][0]) < float(dots[1][0]) < float(dots[2][0])
    assert html.count('<tr><td class="sb-n">') == 3
    for kn, xi, his in found.beside_sun():
        assert f'>{kn:g}</td><td class="sb-n">{xi:.3g}</td><td class="sb-n">{his:.2g}</td>' in html
    assert "velocity difference (kn)" in html
