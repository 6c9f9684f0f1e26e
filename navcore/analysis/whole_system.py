"""Stability of the whole system: both level channels, heading and latitude, coupled by the Earth's rotation.

One level channel (`navcore.analysis.loop`) says nothing about the slow modes. A horizontal damping network
moves the 24 h mode of the six-state error model, and most networks let it grow (theory.md 10). The model is
that of `navcore.analysis.whole_matrix`.
"""

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from navcore.analysis.loop import closed_loop_poles
from navcore.analysis.whole_matrix import system_matrix
from navcore.foundation.earth import EARTH_RATE, SPHERE, Earth
from navcore.foundation.text import Text
from navcore.foundation.units import DEG
from navcore.networks.azimuth_loop import AzimuthChannel, AzimuthGains
from navcore.networks.base import ComplexArray, LinearNetwork
from navcore.networks.roots import sorted_roots

EARTH_MODE, SCHULER_MODE, NETWORK_MODE = "24 h", "Schuler-Foucault", "network"
CANCELLED_MODE = "cancelled network"
"""Of a pole of the network on which one of its zeros lies: H(s) does not show it."""
_DAY = 86400.0
_SAME = 1e-6
"""Distance of a zero from a pole, relative to their size, at which they cancel."""
_STANDS = 1e-7
"""Growth over omega_s that counts as none: rounding moves a mode of two equal eigenvalues by so much."""


@dataclass(frozen=True)
class Mode:
    """One eigenvalue, or a complex pair.

    Attributes
    ----------
    name : str
        "24 h", "Schuler-Foucault", "network" or "cancelled network".
    eigenvalue : complex
        rad/s; of a pair, the one above the real axis.
    """

    name: str
    eigenvalue: complex

    @property
    def growth(self) -> float:
        """Real part, 1/s; positive: grows."""
        return self.eigenvalue.real

    @property
    def damping_ratio(self) -> float:
        """-Re/|s|; 0 for an eigenvalue at zero."""
        size = abs(self.eigenvalue)
        return -self.eigenvalue.real / size if size > 0.0 else 0.0


@dataclass(frozen=True, eq=False)
class WholeSystem:
    """Eigenvalues of the whole system at one latitude.

    Attributes
    ----------
    lat : float
        rad.
    modes : tuple of Mode
        The 24 h mode first, then the Schuler-Foucault modes, then those of the network; each by size.
    stable : bool
        No mode grows. A free system counts as stable.
    earth_growth : float
        Largest real part of the 24 h mode, 1/s; positive: it grows. 0 where rounding alone would move it.
    h_slope : float
        H'(0), s; nan where H has a pole at zero.
    warnings : tuple of str
        Names each mode that grows, with its e-folding time.
    """

    lat: float
    modes: tuple[Mode, ...]
    stable: bool
    earth_growth: float
    h_slope: float
    warnings: tuple[str, ...]

    def named(self, name: str) -> tuple[Mode, ...]:
        """Modes of one name."""
        return tuple(mode for mode in self.modes if mode.name == name)

    @property
    def slow_mode(self) -> Mode | None:
        """Least damped oscillation with 0.3 Omega < abs(s) < 3 Omega; None where there is none."""
        slow = [
            mode
            for mode in self.modes
            if mode.eigenvalue.imag > 0.0 and 0.3 < abs(mode.eigenvalue) / EARTH_RATE < 3.0
        ]
        return min(slow, key=lambda mode: mode.damping_ratio, default=None)

    @property
    def e_folding_s(self) -> float:
        """Time in which the 24 h mode grows by the factor e, s; negative: decays by it; inf: neither."""
        return 1.0 / self.earth_growth if self.earth_growth != 0.0 else math.inf


@lru_cache(maxsize=256)
def whole_system(
    network: LinearNetwork,
    lat: float,
    earth: Earth = SPHERE,
    height: float = 0.0,
    azimuth: AzimuthChannel | None = None,
) -> WholeSystem:
    """Analyse the whole system at rest.

    Parameters
    ----------
    network : LinearNetwork
        H(s) as it acts (`navcore.damping.base.Damping.acting`).
    lat : float
        rad.
    earth : Earth
        WGS-84 or the sphere.
    height : float
        m.
    azimuth : LinearNetwork or AzimuthGains, optional
        Y(s) or the gyrocompass of the azimuth channel (theory.md 3.7, 3.8).
    """
    matrix = system_matrix(network, lat, earth, height, azimuth)
    values = np.linalg.eigvals(matrix).astype(np.complex128)
    modes = tuple(_named(values, network, lat, azimuth))
    growth = max(mode.growth for mode in modes if mode.name == EARTH_MODE)
    tolerance = _STANDS * network.omega_s
    growing = [mode for mode in modes if mode.growth > tolerance]
    return WholeSystem(
        lat=lat,
        modes=modes,
        stable=not growing,
        earth_growth=growth if abs(growth) > tolerance else 0.0,
        h_slope=network.h_slope,
        warnings=tuple(_warnings(growing, network, lat)),
    )


def growth_over_latitude(
    network: LinearNetwork,
    lats: np.ndarray,
    earth: Earth = SPHERE,
    azimuth: AzimuthChannel | None = None,
) -> np.ndarray:
    """Growth rate of the 24 h mode at each latitude (rad), 1/s, shape of ``lats``."""
    lats = np.asarray(lats, dtype=float)
    rates = [
        whole_system(network, float(lat), earth, azimuth=azimuth).earth_growth for lat in lats.reshape(-1)
    ]
    return np.array(rates).reshape(lats.shape)


def duration(seconds: float) -> str:
    """A time constant in the unit that suits it, to two or three digits: "3.1 days", "53 min"."""
    seconds = abs(seconds)
    if seconds >= 0.95 * _DAY:
        days = seconds / _DAY
        return Text("{days:.2g} days", days=days) if days < 9.95 else Text("{days:.0f} days", days=days)
    if seconds >= 5400.0:
        return f"{seconds / 3600.0:.2g} h"
    return Text("{seconds:.2g} min", seconds=seconds / 60.0) if seconds >= 90.0 else f"{seconds:.2g} s"


def _named(
    values: ComplexArray, network: LinearNetwork, lat: float, azimuth: AzimuthChannel | None
) -> list[Mode]:
    """Name every eigenvalue after the mode it comes from; of a pair only the upper one is kept."""
    targets, names = _uncoupled(network, lat, azimuth)
    target_of = _nearest(values, targets)
    modes: list[Mode] = []
    for name in (EARTH_MODE, SCHULER_MODE, NETWORK_MODE, CANCELLED_MODE):
        roots = [v for v, i in zip(values, target_of, strict=True) if v.imag >= 0.0 and names[i] == name]
        modes += [Mode(name, complex(root)) for root in sorted_roots(np.array(roots)) * network.omega_s]
    return modes


def _uncoupled(
    network: LinearNetwork, lat: float, azimuth: AzimuthChannel | None
) -> tuple[ComplexArray, list[str]]:
    """Modes as they were without coupling: those of s^2 + Omega^2 Y and the poles of both channels.

    The main pair is split by Omega sin L. The last, at zero, is for a state of the law that H(s) has not.
    """
    rate = 1j * EARTH_RATE / network.omega_s
    poles = closed_loop_poles(network)
    hidden = _cancelled(poles, network)
    main = _least_damped(poles, hidden)
    own = [
        CANCELLED_MODE if gone else SCHULER_MODE if least else NETWORK_MODE
        for gone, least in zip(hidden, main, strict=True)
    ]
    if isinstance(azimuth, AzimuthGains):
        pair = np.roots([1.0, azimuth.k1 / network.omega_s, 0.5 * (azimuth.k2 + 1.0)])
        loop = np.tile(pair, 2)
        targets = np.concatenate([[0.0], loop, poles, [0.0]]).astype(np.complex128)
        return targets, [
            EARTH_MODE,
            *[NETWORK_MODE] * 4,
            *own,
            NETWORK_MODE,
        ]
    slow = np.array([rate, -rate]) if azimuth is None else abs(rate) * closed_loop_poles(azimuth)
    earth = [EARTH_MODE if least else NETWORK_MODE for least in _least_damped(slow)]
    split = np.where(main, rate * math.sin(lat), 0.0)
    targets = np.concatenate([slow, poles + split, poles - split, [0.0]])
    return targets, [*earth, *own, *own, NETWORK_MODE]


def _cancelled(poles: ComplexArray, network: LinearNetwork) -> np.ndarray:
    """Mark the closed-loop poles that are poles of the network on a zero of it, shape (n,)."""

    def on(roots: np.ndarray) -> np.ndarray:
        apart = np.abs(poles[:, None] - roots) / (np.abs(poles[:, None]) + np.abs(roots) + 1e-300)
        return np.asarray((apart < _SAME).any(axis=1))

    return np.logical_and(on(np.roots(network.den_p)), on(np.roots(network.loop_num_p)))


def _least_damped(poles: ComplexArray, hidden: np.ndarray | None = None) -> np.ndarray:
    """Mark the least damped pair, shape (n,); one that is hidden, shape (n,), is passed over."""
    size = np.abs(poles)
    damping = np.where(size > _STANDS, -poles.real / np.maximum(size, _STANDS), np.inf)
    if hidden is not None and not hidden.all():
        damping = np.where(hidden, np.inf, damping)
    least = poles[np.argmin(damping)]
    main = np.zeros(len(poles), dtype=bool)
    for pole in (least, np.conj(least)):
        main[np.argmin(np.where(main, np.inf, np.abs(poles - pole)))] = True
    return main


def _nearest(values: ComplexArray, targets: ComplexArray) -> list[int]:
    """Index of a target for each value: the closest two, relative to their size, are joined first."""
    apart = np.abs(values[:, None] - targets)
    apart /= np.abs(values[:, None]) + np.abs(targets) + 1e-300
    target_of = [-1] * len(values)
    free = set(range(len(targets)))
    for flat in np.argsort(apart, axis=None, kind="stable").tolist():
        i, j = divmod(flat, len(targets))
        if target_of[i] < 0 and j in free:
            target_of[i] = j
            free.discard(j)
    return target_of


def _warnings(growing: list[Mode], network: LinearNetwork, lat: float) -> list[str]:
    texts = []
    for mode in growing:
        reason = ""
        if mode.name == EARTH_MODE and math.isfinite(network.h_slope):
            slope = float(f"{network.h_slope:.4g}")
            reason = f" (H(0) = {network.h0:.3g}, H'(0) = {slope:+g} s)"
        elif mode.name == CANCELLED_MODE:
            reason = Text(" (a zero of H(s) lies on this pole of the network: H(s) does not show it)")
        texts.append(
            Text(
                "whole system at latitude {lat:.4g}°: the {name} mode grows, e-folding time {growth}{reason}",
                lat=lat / DEG,
                name=mode.name,
                growth=duration(1.0 / mode.growth),
                reason=reason,
            )
        )
    return texts
