"""The work array of the simulation: one flat array, rows of a width known when compiling.

Only so does LLVM see that the rows do not overlap and vectorises loops over twenty of them; with two
dimensions or with row views it did not (twice the time). A tile is small enough for the first-level cache.
"""

from navcore.foundation.compiled import inlined
from navcore.motion.truth import COLUMNS

TILE = 64
"""Samples of a tile."""
HALO = 3
"""Samples of a tile beyond its own: one before, two after, for the quadrature."""
W = 72
"""Width of a row: TILE + HALO, rounded up to a cache line."""

# Rows: first the 15 quantities of `navcore.motion.truth`, then these.
NAV = COLUMNS  # 6: rate of the navigation frame, specific force in it
TRIG = NAV + 6  # 6: sine and cosine of pitch, roll, heading
C = TRIG + 6  # 9: C_b^n row by row
SIG = C + 9  # 6: body rate, specific force
INC = SIG + 6  # 6: perfect increments
ERR = INC + 6  # 6: their errors
NORMAL = ERR + 6  # 6: unit normal numbers, without gaps: three sensors, then at HALF_NORMALS the other three
HALF_NORMALS = 3 * TILE
WORK = (NORMAL + 6) * W
"""Length of the work array."""

_MOST_TILES = 1024


@inlined
def tile_size(block_samples):
    """Samples of the tiles that a block is cut into; the last one may be shorter."""
    return -(-block_samples // -(-block_samples // TILE))


@inlined
def tile_number(block, tile):
    """Number of a block's tile in the run: from it follow its normal numbers."""
    return block * _MOST_TILES + tile
