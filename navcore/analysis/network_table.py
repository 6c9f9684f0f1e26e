"""docs/networks.md: every network with H(0), H'(0) and what it does to the 24 h mode (theory.md 10).

``python -m navcore.analysis.network_table`` writes the page; a test holds it to what the analysis says now.
"""

from pathlib import Path

from navcore.analysis.loop import analyse
from navcore.analysis.whole_system import duration, whole_system
from navcore.foundation.earth import SPHERE
from navcore.foundation.markdown import markdown_table
from navcore.foundation.units import DEG
from navcore.networks import NETWORKS, parse_network

PAGE = Path(__file__).resolve().parents[2] / "docs" / "networks.md"
LATITUDES = (30.0, 45.0, 60.0)
VARIANTS: dict[str, tuple[str, ...]] = {
    "compass": ("sigma = 0.0088, xi = 0.7", 'sigma = 0.0015, xi = 0.7, realisation = "network"'),
    "complementary": ("zeta = 0.5, eta = 0.5", "zeta = 1.3, eta = 0.5"),
    "pole2": ('xi = 0.5, variant = "exact"', 'xi = 0.5, variant = "as_printed"'),
    "unity2": ("zeta = 0.5, r = 1.2", "zeta = 0.5, r = 0.8, zeta2 = 0.29"),
    "optimal": ("rho = 0.01, q = 0", "rho = 0.01, q = 1", 'rho = 0.01, q = 1, realisation = "feedback"'),
}
"""Parameters beside or in place of a network's defaults."""
LEFT_OUT = ("custom",)

_HEAD = """# Networks and the 24 h mode

<!-- Written by `make guide`: do not edit. -->

One level channel decides how fast tilt and velocity settle. Whether the *whole system* is stable depends on
the slope H'(0) too: with the Earth's rotation a network with H(0) = 1 moves the 24 h mode by

    growth = (1/2) Omega^2 (1 + sin^2 L) H'(0)        (eigenvalues: within 4 % for |H'(0)| <= 1000 s)

With H'(0) > 0 the mode grows: a heading error of an arc-minute becomes hundreds of kilometres of latitude
within weeks, however good the log. With H'(0) < 0 it decays, at the price that slow errors of the log come in
(|1 - H(j Omega)| is about |H'(0)| Omega).

The table holds every network of the catalogue with its defaults, or with the parameters named, under external
damping on the sphere. The last three columns say what the eigenvalues of the whole system give: both
channels, heading and latitude. `schuler network 'id = "..."' --lat DEG` prints them for any network and
latitude.

"""

_FOOT = """
Velocity feedback (`compass` with `realisation = "feedback"`) is a case of its own: it pulls the
velocity onto the log's. Without an azimuth loop the latitude then stays where it is, and the 24 h mode
neither grows nor decays.

To have both, choose `complementary`, or `unity2` with r < 1. Of those, `complementary` keeps all closed-loop
pairs as well damped as asked; `unity2` with r < 1 has a second pair that is the less damped the nearer r is
to 1. `optimal` is designed on one channel, which knows nothing of this mode: with q = 0 it grows within
hours. With q = 1 it decays; [what that costs](design.md#the-optimal-network) is a tenth of the tilt, and with
velocity feedback nothing.
"""


def page() -> str:
    """Text of the page."""
    head = ["network", "parameters", "H(0)", "H'(0), s", "damping ratio"]
    head += [f"24 h mode at {lat:g}°" for lat in LATITUDES]
    rows = []
    for name in NETWORKS:
        if name not in LEFT_OUT:
            rows += [_row(name, parameters) for parameters in VARIANTS.get(name, ("",))]
    return f"{_HEAD}{markdown_table(head, rows)}\n{_FOOT}"


def _row(name: str, parameters: str) -> list[str]:
    text = f'id = "{name}"' + (f", {parameters}" if parameters else "")
    network = parse_network(text).transfer(SPHERE.schuler_frequency(0.0))
    cell = f"`{parameters}`" if parameters else ""
    cells = [f"`{name}`", cell, f"{network.h0:.4g}", f"{network.h_slope:+.1f}"]
    cells.append(f"{analyse(network).damping_ratio:.3f}")
    for lat in LATITUDES:
        whole = whole_system(network, lat * DEG)
        growth = whole.earth_growth
        if growth == 0.0:
            cells.append("stands")
        else:
            cells.append(f"{'grows' if growth > 0.0 else 'decays'}, {duration(1.0 / growth)}")
    return cells


def main() -> None:
    """Write the page."""
    PAGE.write_text(page(), "utf-8")


if __name__ == "__main__":
    main()
