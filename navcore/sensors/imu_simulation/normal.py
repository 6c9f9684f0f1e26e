"""Normal numbers from a counter: Philox 2x32-10 and Box-Muller, branchless, so that LLVM vectorises them.

Philox: Salmon, Moraes, Dror, Shaw, "Parallel random numbers: as easy as 1, 2, 3" (2011). A number depends on
the key and its place only, so chunks of any length, in any order, give the same noise.
"""

import hashlib

import numpy as np

from navcore.foundation.compiled import inlined, kernel
from navcore.foundation.trigonometry import sincos_cycles
from navcore.sensors.imu_simulation.work import HALF_NORMALS, NORMAL, W

_MULTIPLIER = np.uint64(0xD256D193)
_WEYL = np.uint64(0x9E3779B9)
_LOW = np.uint64(0xFFFFFFFF)
_32 = np.uint64(32)
_SCALE = 2.0**-32
_MANTISSA = np.uint64(0x000FFFFFFFFFFFFF)
_ONE = np.uint64(0x3FF0000000000000)
_52 = np.uint64(52)
_2_TO_52 = np.uint64(0x4330000000000000)
_LN2 = 0.6931471805599453
_SQRT2 = 1.4142135623730951


def stream_key(seed: int, stream: str) -> int:
    """Key of one stream of numbers, 32 bits, from the scenario's seed and the stream's name."""
    digest = hashlib.sha256(f"{seed}:{stream}".encode()).digest()
    return int.from_bytes(digest[:4], "little")


@inlined
def _two_rounds(low, high, key):
    """Two rounds of Philox 2x32; 32-bit numbers held in uint64."""
    product = _MULTIPLIER * (low & _LOW)
    low, high = (product >> _32) ^ key ^ high, product & _LOW
    key = (key + _WEYL) & _LOW
    product = _MULTIPLIER * (low & _LOW)
    return (product >> _32) ^ key ^ high, product & _LOW, (key + _WEYL) & _LOW


@inlined
def _philox(low, high, key):
    """Ten rounds, written out: a loop here would keep the loop around it from being vectorised."""
    low, high, key = _two_rounds(low, high, key)
    low, high, key = _two_rounds(low, high, key)
    low, high, key = _two_rounds(low, high, key)
    low, high, key = _two_rounds(low, high, key)
    low, high, key = _two_rounds(low, high, key)
    return low, high


@inlined
def _as_float(n):
    """Float of a whole number below 2^52 by its bits: AVX2 has no vector form of the conversion."""
    return np.uint64(n | _2_TO_52).view(np.float64) - 4503599627370496.0


@inlined
def _minus_log(x):
    """-ln x for 0 < x < 1, to 1e-9: exponent from the bits, the rest by the series of atanh."""
    bits = np.float64(x).view(np.uint64)
    exponent = _as_float(bits >> _52) - 1023.0
    m = np.uint64((bits & _MANTISSA) | _ONE).view(np.float64)
    large = m > _SQRT2
    m = 0.5 * m if large else m
    exponent = exponent + 1.0 if large else exponent
    s = (m - 1.0) / (m + 1.0)
    z = s * s
    series = 1.0 + z * (1.0 / 3.0 + z * (0.2 + z * (1.0 / 7.0 + z * (1.0 / 9.0 + z * (1.0 / 11.0)))))
    return -(exponent * _LN2 + 2.0 * s * series)


@inlined
def _fill_uniforms(tile, key, count, w):
    # The masks tell the compiler that 32-bit products suffice; what they cut off goes into the key.
    place = np.uint64(tile)
    low, mixed = place & _LOW, (key ^ (place >> _32)) & _LOW
    for i in range(count):
        a, b = _philox(np.uint64(i), low, mixed)
        w[NORMAL * W + i] = (_as_float(a) + 0.5) * _SCALE
        w[NORMAL * W + HALF_NORMALS + i] = (_as_float(b) + 0.5) * _SCALE


@inlined
def _fill_radii(count, w):
    for i in range(count):
        w[NORMAL * W + i] = np.sqrt(2.0 * _minus_log(w[NORMAL * W + i]))


@inlined
def _fill_turned(count, w):
    for i in range(count):
        radius = w[NORMAL * W + i]
        s, c = sincos_cycles(w[NORMAL * W + HALF_NORMALS + i])
        w[NORMAL * W + i] = radius * c
        w[NORMAL * W + HALF_NORMALS + i] = radius * s


@kernel
def fill_normals(tile, key, count, w):
    """Write 2 ``count`` unit normal numbers of a tile to NORMAL W of the work array and HALF_NORMALS further.

    A kernel of its own with constant places: inlined into the simulation loop, or with the places as
    arguments, it was not vectorised (four times the time). Three short loops, each of one long chain of
    operations: the processor then works on several numbers at once. ``key``: of the stream, uint64.
    """
    _fill_uniforms(tile, key, count, w)
    _fill_radii(count, w)
    _fill_turned(count, w)
