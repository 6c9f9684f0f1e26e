"""Networks as functions of their damping coefficient, compiled: what a running law needs to re-tune one.

Each function gives Q = 1 - H = (b_1 p^(n-1) + ... + b_n)/(p^n + a_1 p^(n-1) + ... + a_n) in p = s/omega_s.
The numerators are formed as differences on paper, not on the machine: they stay right down to xi = 1e-22,
where `ramp` begins.
"""

import math

from navcore.foundation.compiled import inlined


@inlined
def complementary_difference(zeta, eta):
    """Return a_1..a_4, b_1..b_4 of Liu's network (theory.md 3.2)."""
    middle = 2.0 + 2.0 * zeta + 2.0 * eta + 4.0 * zeta * eta
    outer = 1.0 + 2.0 * eta
    b1 = 2.0 * zeta * (1.0 - 2.0 * eta)
    return outer + 2.0 * zeta, middle, outer + 4.0 * zeta, 1.0, b1, 0.0, 2.0 * zeta, 0.0


@inlined
def pole2_difference(xi, n1, n2, printed):
    """Return a_1, a_2, b_1, b_2 of Sun's network (theory.md 3.3), exact or as printed."""
    total, product = n1 + n2, n1 * n2
    a, b = total + 2.0, product + 2.0 * total
    if printed:
        w1 = 2.0 * b / (a + math.sqrt(max(0.0, (n1 - n2) ** 2 + 4.0 - 4.0 * total)))
        return a * xi, b * xi * xi, -2.0 * xi * (product * xi * xi - 1.0 + total / w1), 0.0
    return a * xi, b * xi * xi, 2.0 * xi * (1.0 - product * xi * xi), 2.0 * total * xi * xi


@inlined
def unity2_difference(zeta, r, zeta2, alpha):
    """Return a_1, a_2, b_1, b_2 of `unity2` (theory.md 3.4).

    alpha is in units of omega_s. 0 stands for not given: of alpha, then of zeta2, which is max(0.7, zeta).
    """
    excess = (r - 1.0) * (r + 1.0)
    if alpha > 0.0:
        beta = (2.0 * zeta * r * alpha + excess) / excess
    else:
        if zeta2 <= 0.0:
            zeta2 = max(0.7, zeta)
        half = 2.0 * zeta * zeta2 * r
        root = math.sqrt(half * half + excess * excess)
        q = (half + root) / excess if r > 1.0 else -excess / (half + root)
        alpha, beta = 2.0 * zeta2 * q, q * q
    c3 = 2.0 * zeta * r + alpha
    c1 = r * r * alpha + 2.0 * zeta * r * beta
    return c3, r * r * beta, c3 - c1, 0.0
