"""What single precision does to an exported law: measured on its vectors, and told before it is used."""

from __future__ import annotations

import ctypes
import math
import shutil
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from navcore.exporting import target_c, target_python
from navcore.exporting.c import CPrinter
from navcore.exporting.form import WHOLE, Form
from navcore.foundation.earth import SEMI_MAJOR_AXIS
from navcore.foundation.text import Text
from navcore.foundation.units import ARCSEC
from navcore.networks.discrete import DiscreteNetwork, discretise
from navcore.quantities import TILT, VELOCITY

_MARGIN, _LEAST = 4.0, 1e-6
"""The bound is so many times what was measured, and at least so much of the peak."""
_MATTERS_ARCSEC, _MATTERS_MPS = 0.1, 0.001
"""Tilt and velocity from which rounding is worth a warning."""


@dataclass(frozen=True)
class Rounding:
    """Single against double precision over the vectors.

    Attributes
    ----------
    deviations : tuple of float
        Largest deviation of each output.
    bounds : tuple of float
        Bound of each output, of its peak, that the files state.
    tilt_rad, velocity_mps : float
        Largest error that rounding makes in a level channel of the closed loop; nan without a network.
    pole_shift : float
        Largest relative shift of a pole of the network, as it runs, by rounding its coefficients.
    direct_radius : float
        Largest pole of the difference equation with rounded coefficients; beyond 1 it is unstable.
    other_decisions : int
        Calls in which the law decides otherwise than in double precision.
    """

    deviations: tuple[float, ...]
    bounds: tuple[float, ...]
    tilt_rad: float
    velocity_mps: float
    pole_shift: float
    direct_radius: float
    other_decisions: int

    def document(self) -> dict[str, float | int | None]:
        """Return what ``--json`` prints."""

        def finite(value: float) -> float | None:
            return value if math.isfinite(value) else None

        return {
            TILT.figure: finite(self.tilt_rad),
            VELOCITY.figure: finite(self.velocity_mps),
            "pole_shift": finite(self.pole_shift),
            "direct_form_largest_pole": finite(self.direct_radius),
            "other_decisions": self.other_decisions,
        }

    def sentences(self) -> tuple[str, ...]:
        """Say what rounding does, and which form stands it."""
        found = []
        if math.isfinite(self.tilt_rad):
            text = Text(
                "single precision: rounding makes at most {tilt:.2g}″ of tilt and {velocity:.2g} m/s in the "
                "loop; the poles of the network move by {shift:.1g} of their size",
                tilt=self.tilt_rad / ARCSEC,
                velocity=self.velocity_mps,
                shift=self.pole_shift,
            )
            found.append(text)
        if self.direct_radius >= 1.0:
            found.append(
                Text(
                    "the difference equation would be unstable in single precision (pole at {radius:.9f}): "
                    "the files hold the state space with the transition matrix less the identity, which "
                    "stands it",
                    radius=self.direct_radius,
                )
            )
        if self.other_decisions:
            found.append(
                Text(
                    "single precision decides otherwise in {count} calls: the policy's measure lies at "
                    "its limit",
                    count=self.other_decisions,
                )
            )
        return tuple(found)

    @property
    def matters(self) -> bool:
        """Whether the user should think again."""
        large = self.tilt_rad > _MATTERS_ARCSEC * ARCSEC or self.velocity_mps > _MATTERS_MPS
        return large or self.other_decisions > 0


def rounding_of(form: Form) -> Rounding:
    """Run a form in single precision, by the C compiler where there is one, else in numpy."""
    found = _compiled(form) if shutil.which("cc") else _interpreted(form)
    off = np.abs(found - form.expected)
    peak = np.max(np.abs(form.expected), axis=0)
    deviations = np.max(off, axis=0)
    shares = np.where(peak > 0.0, deviations / np.where(peak > 0.0, peak, 1.0), 0.0)
    bounds = tuple(_rounded_up(max(_MARGIN * share, _LEAST)) for share in shares.tolist())
    tilt, velocity, shift, direct = math.nan, math.nan, math.nan, math.nan
    method = form.subject.method
    if method.kind.uses_network:
        discrete = discretise(form.subject.network, form.subject.step_s)
        shift, direct = pole_shift(discrete), direct_radius(discrete)
        if method.kind.uses_log:
            tilt, velocity = _in_the_loop(form, discrete, found[:, :2] - form.expected[:, :2])
    decisions = int(
        np.sum(found[:, form.outputs.index("damped")] != form.expected[:, form.outputs.index("damped")])
    )
    return Rounding(tuple(deviations.tolist()), bounds, tilt, velocity, shift, direct, decisions)


def _rounded_up(value: float) -> float:
    """A bound with one digit."""
    size = 10.0 ** math.floor(math.log10(value))
    return math.ceil(value / size) * size


def _compiled(form: Form) -> np.ndarray:
    """Outputs of the C code in single precision."""
    prefix, printer = "law", CPrinter(form.program, "law", single=True)
    take = "".join(
        f" in.{name} = ({'int' if name in WHOLE else printer.real})given[{i}];"
        for i, name in enumerate(form.inputs)
    )
    give = "".join(f" found[{i}] = (double)out.{name};" for i, name in enumerate(form.outputs))
    driver = (
        f'#include "law.h"\nvoid run(const double *given, double *found, long n)\n{{\n    law_state s;\n'
        f"    const law_start at = {{0, 0, 0}};\n    law_init(&s, &at);\n"
        f"    for (long k = 0; k < n; k++) {{\n"
        f"        law_in in; law_out out;{take}\n        law_step(&s, &in, &out);{give}\n"
        f"        given += {len(form.inputs)}; found += {len(form.outputs)};\n    }}\n}}\n"
    )
    with tempfile.TemporaryDirectory() as folder:
        for name, text in (*target_c.sources(form, prefix, True).items(), ("run.c", driver)):
            Path(folder, name).write_text(text)
        command = ["cc", "-std=c99", "-O1", "-shared", "-fPIC", "law.c", "run.c", "-lm", "-o", "law.so"]
        subprocess.run(command, cwd=folder, check=True, capture_output=True)
        run = ctypes.CDLL(str(Path(folder, "law.so"))).run
        given, found = np.ascontiguousarray(form.given), np.empty(form.expected.shape)
        pointer = ctypes.POINTER(ctypes.c_double)
        run(given.ctypes.data_as(pointer), found.ctypes.data_as(pointer), ctypes.c_long(len(given)))
    return found


def _interpreted(form: Form) -> np.ndarray:
    """Outputs of the Python code in single precision."""
    names: dict[str, object] = {"__name__": "law"}
    exec(target_python.files(form, "law", True, target_c.double_bounds(form))["law.py"], names)  # noqa: S102  our own text
    law, given = names["Law"](), names["Given"]  # pyright: ignore[reportCallIssue]
    place = form.inputs.index("log_valid")
    rows = (given(*row[:place], int(row[place]), *row[place + 1 :]) for row in form.given)  # pyright: ignore[reportCallIssue]
    return np.array([law.step(row) for row in rows], dtype=float)


def pole_shift(discrete: DiscreteNetwork) -> float:
    """Largest shift of a pole by rounding the transition matrix less the identity, of the pole's size."""
    if discrete.order == 0:
        return 0.0
    exact = np.linalg.eigvals(discrete.dA)
    rounded = np.linalg.eigvals(discrete.dA.astype(np.float32).astype(float))
    nearest = np.min(np.abs(exact[:, None] - rounded[None, :]), axis=1)
    return float(np.max(nearest / np.abs(exact)))


def direct_radius(discrete: DiscreteNetwork) -> float:
    """Largest pole of the difference equation whose coefficients are rounded to single precision."""
    if discrete.order == 0:
        return 0.0
    coefficients = np.real(np.poly(np.eye(discrete.order) + discrete.dA)).astype(np.float32).astype(float)
    return float(np.max(np.abs(np.roots(coefficients))))


def _in_the_loop(form: Form, discrete: DiscreteNetwork, off: np.ndarray) -> tuple[float, float]:
    """Tilt (rad) and velocity error (m/s) that a deviation of the correction makes in a level channel.

    Parameters
    ----------
    form : Form
        The method.
    discrete : DiscreteNetwork
        H in discrete time.
    off : ndarray, shape (calls, 2)
        Deviation of the corrections of both channels, m/s.
    """
    omega_s = form.subject.network.omega_s
    angle, n = omega_s * form.subject.step_s, discrete.order
    cos, sin = math.cos(angle), math.sin(angle)
    # v = dV, w = sqrt(g R) phi: v' = omega_s w, w' = -omega_s (v + c), c = Q (-v) held, one column a channel
    move = np.zeros((n + 2, n + 2))
    held = np.array([cos - 1.0, -sin])
    move[:2, :2] = [[cos, sin], [-sin, cos]]
    move[:2] += np.outer(held, np.concatenate([[discrete.D - 1.0, 0.0], -discrete.C]))
    move[2:, 0] = -discrete.B
    move[2:, 2:] = np.eye(n) + discrete.dA
    drive = np.zeros((n + 2, 1))
    drive[:2, 0] = held
    state, peak = np.zeros((n + 2, 2)), np.zeros((2, 2))
    for row in off[:, None, :]:
        state = move @ state + drive * row
        peak = np.maximum(peak, np.abs(state[:2]))
    velocity, tilt = peak.max(axis=1)
    return float(tilt) / (omega_s * SEMI_MAJOR_AXIS), float(velocity)
