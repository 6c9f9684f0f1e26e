"""A network that is re-tuned while it runs, compiled: its coefficients from xi, its state carried over.

The state is that of the observer form, whose first element is the correction itself:
v_i' = -a_i v_1 + v_(i+1) + b_i u, c = v_1, in normalised time. Whatever happens to a and b, the correction
cannot jump. The discrete form is bilinear, prewarped at omega_s, stored as dA (physics.md 3.5).
"""

from __future__ import annotations

from navcore.compiled import inlined, kernel
from navcore.control.layout import (
    DAMPING,
    EXTERNAL,
    FRESH,
    INPUT_MEAN,
    MAX_STATES,
    NETWORK_A,
    NETWORK_B,
    NETWORK_C,
    NETWORK_D,
    NETWORK_STEADY,
    ORDER,
    POLE_COEFFICIENTS,
    TAN_HALF,
    TUNED_XI,
    TUNING_PARAMETERS,
    X_E,
    X_N,
    XI_TARGET,
    ZERO_COEFFICIENTS,
)
from navcore.network.retuning import complementary_difference, pole2_difference, unity2_difference
from navcore.network.tuning_codes import COMPLEMENTARY, POLE2

_A, _B = POLE_COEFFICIENTS, ZERO_COEFFICIENTS


@inlined
def _coefficients(p, s, xi):
    """Put a_i, b_i of Q = 1 - H for this damping coefficient into the state."""
    code = int(p[TUNING_PARAMETERS])
    q1, q2, q3 = p[TUNING_PARAMETERS + 1], p[TUNING_PARAMETERS + 2], p[TUNING_PARAMETERS + 3]
    if code == COMPLEMENTARY:
        a1, a2, a3, a4, b1, b2, b3, b4 = complementary_difference(xi, q1)
        s[_A + 2], s[_A + 3], s[_B + 2], s[_B + 3] = a3, a4, b3, b4
    elif code == POLE2:
        a1, a2, b1, b2 = pole2_difference(xi, q1, q2, q3 != 0.0)
    else:
        a1, a2, b1, b2 = unity2_difference(xi, q1, q2, q3)
    s[_A], s[_A + 1], s[_B], s[_B + 1] = a1, a2, b1, b2


@inlined
def _denominator(n, a, s):
    """1 + a a_1 + a^2 a_2 + ...: the determinant of I - a A."""
    total, power = 1.0, a
    for i in range(n):
        total += power * s[_A + i]
        power *= a
    return total


@kernel
def tune(p, s, xi):
    """Put the discrete network for a damping coefficient in place; its states are left as they are."""
    n, a = int(p[ORDER]), p[TAN_HALF]
    _coefficients(p, s, xi)
    s[TUNED_XI] = xi
    determinant = _denominator(n, a, s)
    inputs, power = 0.0, 1.0
    # dA column by column, A times a column of (I - a A)^-1, whose first element is a^j / determinant
    for j in range(n):
        first = power / determinant
        s[NETWORK_C + j] = first
        inputs += power * s[_B + j]
        below = 0.0
        for i in range(n - 1, -1, -1):
            s[NETWORK_A + MAX_STATES * i + j] = 2.0 * a * (below - s[_A + i] * first)
            below = (1.0 if i == j else 0.0) - a * s[_A + i] * first + a * below
        power *= a
    first = inputs / determinant
    s[NETWORK_D] = a * first
    below = 0.0
    for i in range(n - 1, -1, -1):
        value = s[_B + i] - a * s[_A + i] * first + a * below
        s[NETWORK_B + i] = 2.0 * a * value
        below = value
    steady = s[_B + n - 1] / s[_A + n - 1]
    s[NETWORK_STEADY] = steady
    for i in range(n - 1):
        s[NETWORK_STEADY + i + 1] = s[_A + i] * steady - s[_B + i]


@inlined
def _to_continuous(n, a, s, x, u):
    """Pass from x to v = (I - a A)^-1 (x + a B u): the observer state at the sample itself, in place."""
    total, power = 0.0, 1.0
    for i in range(n):
        s[x + i] += a * s[_B + i] * u
        total += power * s[x + i]
        power *= a
    first = total / _denominator(n, a, s)
    below = 0.0
    for i in range(n - 1, -1, -1):
        below = s[x + i] - a * s[_A + i] * first + a * below
        s[x + i] = below


@inlined
def _to_discrete(n, a, s, x, u):
    """Pass from v to x = v - a (A v + B u), in place."""
    first = s[x]
    for i in range(n):
        after = s[x + i + 1] if i + 1 < n else 0.0
        s[x + i] -= a * (after - s[_A + i] * first + s[_B + i] * u)


@inlined
def _keep_derivatives(n, s, x, mean, a1, a2, a3, b1, b2, b3):
    """Change v so that the correction's derivatives for the constant input ``mean`` are those of before.

    y^(i) = v_(i+1) - a_1 y^(i-1) - ... - a_i y + b_i mean, with the a, b of before (arguments) and of now.
    """
    y0 = s[x]
    y1 = s[x + 1] - a1 * y0 + b1 * mean
    s[x + 1] = y1 + s[_A] * y0 - s[_B] * mean
    if n > 2:
        y2 = s[x + 2] - a1 * y1 - a2 * y0 + b2 * mean
        y3 = s[x + 3] - a1 * y2 - a2 * y1 - a3 * y0 + b3 * mean
        s[x + 2] = y2 + s[_A] * y1 + s[_A + 1] * y0 - s[_B + 1] * mean
        s[x + 3] = y3 + s[_A] * y2 + s[_A + 1] * y1 + s[_A + 2] * y0 - s[_B + 2] * mean


@kernel
def retune(p, s, xi, u_e, u_n, mean_e, mean_n, smooth):
    """Pass to another damping coefficient with the correction continuous.

    Parameters
    ----------
    xi : float
        New damping coefficient.
    u_e, u_n : float
        Present input, m/s: the correction that it gives stays as it is.
    mean_e, mean_n : float
        Standing part of the input, m/s, for ``smooth``.
    smooth : bool
        The correction's derivatives stay too, as for a constant input ``mean``: a standing difference is no
        event for the new network. Without it the new network takes the whole input as having just begun.
    """
    if xi == s[TUNED_XI]:
        return
    n, a = int(p[ORDER]), p[TAN_HALF]
    a1, a2, a3 = s[_A], s[_A + 1], s[_A + 2]
    b1, b2, b3 = s[_B], s[_B + 1], s[_B + 2]
    _to_continuous(n, a, s, X_E, u_e)
    _to_continuous(n, a, s, X_N, u_n)
    tune(p, s, xi)
    if smooth:
        _keep_derivatives(n, s, X_E, mean_e, a1, a2, a3, b1, b2, b3)
        _keep_derivatives(n, s, X_N, mean_n, a1, a2, a3, b1, b2, b3)
    _to_discrete(n, a, s, X_E, u_e)
    _to_discrete(n, a, s, X_N, u_n)


@kernel
def follow_target(p, s, u_e, u_n):
    """Re-tune to the target; the low-pass of the input is what stands.

    When the log has just come back, its difference is an event for any network.
    """
    smooth = p[DAMPING] != EXTERNAL or s[FRESH] != 1.0
    retune(p, s, s[XI_TARGET], u_e, u_n, s[INPUT_MEAN], s[INPUT_MEAN + 1], smooth)
