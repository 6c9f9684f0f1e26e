"""docs/theory.md: its numbering and links, and that its formulas and reference values are navcore's."""

import re

import numpy as np
import pytest
from latex2mathml.converter import convert
from scipy.integrate import quad
from scipy.linalg import block_diag
from scipy.signal import tf2ss

from navcore.analysis import analyse, frequency_response
from navcore.analysis.whole_system import whole_system
from navcore.foundation.earth import EARTH_RATE, SPHERE
from navcore.foundation.units import DEG
from navcore.mechanization.error_model import system_matrix
from navcore.networks import parse_network
from navcore.networks.base import LinearNetwork
from navcore.networks.discrete import discretise
from tests import theory

RADIUS, GRAVITY = 6378137.0, 9.80665
OMEGA_S = SPHERE.schuler_frequency(0.0)
PAGE = theory.text()
GROWTH = theory.table("s-growth-table")
SET_A = theory.table("s-set-a")


def network_of(cell: str) -> LinearNetwork:
    """The network that the first cell of a table names, such as `unity2`, zeta 0.5."""
    name, *fields = cell.replace("`", "").split(", ")
    return parse_network({"id": name, **{f.split()[0]: float(f.split()[1]) for f in fields}}).transfer(
        OMEGA_S
    )


def test_equations_are_numbered_through_and_anchored():
    tags = [int(tag) for tag in re.findall(r"\\tag\{(\d+)\}", PAGE)]
    assert tags == list(range(1, len(tags) + 1))
    before_each = re.findall(r'<a id="eq-[a-z0-9-]+"></a>\n\n\$\$[^$]*\\tag\{\d+\}\$\$', PAGE)
    assert len(before_each) == len(tags) == PAGE.count("$$") // 2


def test_sections_are_numbered_through_and_anchored():
    found = theory.sections(PAGE)
    assert [s for s in found if "." not in s] == [str(n) for n in range(1, 23)]
    for section in found:
        anchored = rf'<a id="s-{section.replace(".", "-")}"></a>\n\n#{{2,3}} {re.escape(section)} '
        assert re.search(anchored, PAGE), section


def test_anchors_are_unique_and_links_resolve():
    known = theory.anchors(PAGE)
    assert len(known) == len(set(known))
    assert set(re.findall(r"\]\(#([^)]+)\)", PAGE)) <= set(known)


def test_equation_references_name_the_right_number():
    for number, anchor in re.findall(r"\[eq\. (\d+)\]\(#([^)]+)\)", PAGE):
        below = PAGE.split(f'<a id="{anchor}"></a>', 1)[1]
        assert re.search(r"\\tag\{(\d+)\}", below)[1] == number, anchor  # type: ignore[index]


def test_every_formula_becomes_mathml():
    """What latex2mathml does not know it writes as a word with its backslash."""
    inline = re.findall(r"(?<!\$)\$([^$\n]+)\$(?!\$)", PAGE)
    assert len(inline) > 300
    for formula in inline:
        assert "\\" not in convert(formula), formula


# ------------------------------------------------------------ 3: networks


@pytest.mark.parametrize("zeta", [0.3, 1.3])
@pytest.mark.parametrize("eta", [0.5, 0.8])
def test_complementary_polynomials_as_printed(zeta: float, eta: float):
    numerator = [1, 1 + 2 * eta + 4 * zeta * eta, 2 + 2 * zeta + 2 * eta + 4 * zeta * eta]
    numerator += [1 + 2 * eta + 2 * zeta, 1]
    denominator = [1, 1 + 2 * eta + 2 * zeta, 2 + 2 * zeta + 2 * eta + 4 * zeta * eta]
    denominator += [1 + 2 * eta + 4 * zeta, 1]
    network = network_of(f"complementary, zeta {zeta}, eta {eta}")
    np.testing.assert_allclose(network.num_p, numerator, rtol=1e-13)
    np.testing.assert_allclose(network.den_p, denominator, rtol=1e-13)


def test_discrete_form_is_equation_34():
    network, step = network_of("classic3"), 1.0
    found, (A, B, C, D) = discretise(network, step), tf2ss(network.num_p, network.den_p)
    a, states = np.tan(OMEGA_S * step / 2), np.eye(3)
    inverse = np.linalg.inv(states - a * A)
    omega = np.array([0.1, 1.0, 10.0]) * OMEGA_S
    delta = np.exp(1j * omega * step) - 1.0
    d = D + a * C @ inverse @ B
    for w, z in zip(omega, delta, strict=True):
        states_per_input = np.linalg.solve(z * states - 2 * a * A @ inverse, 2 * a * inverse @ B)
        assert found.response(w) == pytest.approx((C @ inverse @ states_per_input + d).item(), rel=1e-9)


def test_compass_gains_of_section_9_2():
    ((sigma, cells),) = theory.table("s-9-2").items()
    xi, *gains = map(float, cells)
    s = float(sigma)
    by_hand = 3 * s, s**2 / OMEGA_S**2 * (2 + 1 / xi**2) - 1, s**3 / (OMEGA_S**2 * xi**2)
    np.testing.assert_allclose(by_hand, gains, rtol=3e-6)
    network = parse_network({"id": "compass", "sigma": s, "xi": xi}).transfer(OMEGA_S)
    np.testing.assert_allclose(network.num, [1 + gains[1], gains[2]], rtol=3e-6)


def test_closed_loops_of_section_9_1():
    for name, (roots, damping) in theory.table("s-9-1").items():
        network = network_of(name)
        told = []
        for part in roots.replace(" ± ", "±").split(", "):
            real, _, imaginary = part.rstrip("j").partition("±")
            told += [
                float(real) + 1j * sign * float(imaginary or 0) for sign in ((1, -1) if imaginary else (0,))
            ]
        found = np.roots(np.polyadd(np.polymul([1, 0, 0], network.den_p), network.num_p))
        np.testing.assert_allclose(np.sort_complex(found), np.sort_complex(np.array(told)), atol=7e-4)
        assert analyse(network).damping_ratio == pytest.approx(float(damping), abs=6e-4)


def test_adaptive_least_squares_and_where_the_quadratic_is_negative():
    rows = theory.table("s-4-4")
    header = re.search(r"\| \$d\$, kn \|(.*)\|", PAGE)
    assert header
    fitted = np.polyfit(theory.numbers(header[1]), theory.numbers(" ".join(rows["$\\zeta$"])), 2)
    np.testing.assert_allclose(fitted, (0.3057, -1.1383, 0.7981), atol=5e-5)
    np.testing.assert_allclose(sorted(np.roots([0.3076, -1.1452, 0.8101])), (0.95, 2.77), atol=6e-3)


# ------------------------------------------------------------ 10: the whole system


def earth_mode_growth(network: LinearNetwork, lat: float) -> float:
    """Real part (1/s) of the 24 h mode: eq. 8 and 15 with the network's states in both channels."""
    A, B, C, D = tf2ss(network.num_p, network.den_p)
    model = np.delete(np.delete(system_matrix(lat, 1.0, 1.0, EARTH_RATE / OMEGA_S), 3, 0), 3, 1)
    a = np.array(block_diag(model, A, A), dtype=float)
    n = network.order
    for dv, phi, sign, first in ((0, 4, 1.0, 6), (1, 3, -1.0, 6 + n)):
        a[first : first + n, dv] += B.ravel()
        a[phi, first : first + n] += sign * C.ravel()
        a[phi, dv] += sign * (D.item() - 1.0)
    values = np.linalg.eigvals(a)
    near = values[np.argmin(np.abs(values - 1j * EARTH_RATE / OMEGA_S))]
    return float(near.real) * OMEGA_S


@pytest.mark.known(
    "oracle",
    ["h_slope_s", "earth_mode_growth_per_s"],
    kinds=["external"],
    fidelities=["loop"],
    source="table of theory.md 10, of an independent program",
)
@pytest.mark.parametrize("name", GROWTH)
def test_growth_of_the_24_h_mode(name: str):
    slope, days = (theory.numbers(cell) for cell in GROWTH[name])
    network = network_of(name)
    n, d = network.num_p, network.den_p
    h_slope = (n[-2] - n[-1] / d[-1] * d[-2]) / d[-1] / OMEGA_S
    assert h_slope == pytest.approx(slope[0], abs=0.1)
    assert network.h_slope == pytest.approx(h_slope, rel=1e-9)
    for lat_deg, told in zip((0, 32, 45, 60, 75), days, strict=True):
        growth = earth_mode_growth(network, lat_deg * DEG)
        assert 1.0 / growth / 86400.0 == pytest.approx(told, abs=0.006)
        assert whole_system(network, lat_deg * DEG).earth_growth == pytest.approx(growth, rel=1e-6)
        by_formula = 0.5 * EARTH_RATE**2 * (1 + np.sin(lat_deg * DEG) ** 2) * h_slope
        assert by_formula == pytest.approx(growth, rel=0.04 if abs(h_slope) < 1000 else 0.053)


# ------------------------------------------------------------ 20: the budget's reference values

ARCSEC = np.pi / 180 / 3600
UG, HOUR = 1e-6 * GRAVITY, 3600.0


def rms(network: LinearNetwork, source: str, output: str, density: object) -> float:
    """Steady RMS by the integral of eq. 51; the density is a function of omega (rad/s)."""

    def integrand(log_omega: float) -> float:
        omega = float(np.exp(log_omega))
        gain = abs(frequency_response(network, source, output, np.array([omega]))[0])  # type: ignore[arg-type]
        return gain**2 * density(omega) * omega / np.pi  # type: ignore[operator]

    edges = np.log(OMEGA_S * np.array([1e-5, 0.1, 0.9, 1.1, 10.0, 1e4]))
    parts = [
        quad(integrand, *pair, limit=200, epsrel=1e-7)[0] for pair in zip(edges, edges[1:], strict=False)
    ]
    return float(np.sqrt(sum(parts)))


def white(value: float):
    return lambda omega: value


def drift(sigma: float, tau: float):
    return lambda omega: 2 * sigma**2 / tau / (omega**2 + tau**-2)


SOURCES = [
    ("eps", white((0.003 * DEG / 60.0) ** 2)),
    ("eps", drift(0.003 * DEG / HOUR, HOUR)),
    ("nabla", white((10 * UG) ** 2)),
    ("nabla", drift(10 * UG, HOUR)),
    ("dv_r", white(0.2**2)),
    ("dv_r", drift(0.1, 600.0)),
]


@pytest.mark.parametrize("name", SET_A)
def test_budget_of_set_a(name: str):
    *by_source, tilt, velocity = (float(cell) for cell in SET_A[name])
    network = network_of(name)
    found = [rms(network, source, "phi", density) / ARCSEC for source, density in SOURCES]
    np.testing.assert_allclose(found, by_source, rtol=1e-3)
    assert np.sqrt(np.sum(np.square(found))) == pytest.approx(tilt, rel=1e-3)
    total = np.sqrt(sum(rms(network, source, "dv", density) ** 2 for source, density in SOURCES))
    assert total == pytest.approx(velocity, rel=1e-3)


def test_optimal_network_of_section_20():
    """The cost of the tilt only, on the sensors of set A: the tilt nears the floor, the velocity does not."""
    header = re.search(r"\| \$\\rho\$ \|(.*)\|", PAGE)
    assert header
    weights = [float(text.strip(" $").replace("10^{", "1e").rstrip("}")) for text in header[1].split("|")]
    assert weights == [1.0, 0.1, 0.01, 1e-3, 1e-4]
    rows = theory.table("s-set-a", 1)
    tilts, velocities = (
        theory.numbers(" ".join(rows[name])) for name in ("$\\varphi$, ″", "$\\delta V$, m/s")
    )
    for rho, tilt, velocity in zip(weights, tilts, velocities, strict=True):
        network = parse_network({"id": "optimal", "rho": rho, "q": 0.0}).transfer(OMEGA_S)
        total = {
            output: np.sqrt(sum(rms(network, source, output, density) ** 2 for source, density in SOURCES))
            for output in ("phi", "dv")
        }
        assert total["phi"] / ARCSEC == pytest.approx(tilt, rel=2e-3)
        assert total["dv"] == pytest.approx(velocity, rel=4e-3)
