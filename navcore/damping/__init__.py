"""Kinds of damping: free, internal, external, averaging of free copies, a Kalman filter; one class each."""

from navcore.damping.base import Damping
from navcore.foundation.registry import loaded

_PLACES = (
    "navcore.damping.free:Free",
    "navcore.damping.internal:Internal",
    "navcore.damping.external:External",
    "navcore.damping.averaging:HalfPeriodAveraging",
    "navcore.damping.kalman:Kalman",
)

KINDS: dict[str, Damping] = {kind.id: kind for kind in (loaded(place)() for place in _PLACES)}
"""Kinds by name, in the order in which the page offers them."""
WHOLE: dict[str, Damping] = {
    kind.id: kind
    for kind in (loaded(f"navcore.damping.whole:{name}")() for name in ("WholeInternal", "WholeExternal"))
}
"""Kinds of the same names with a network in the azimuth channel too."""
GYROCOMPASS: Damping = loaded("navcore.damping.gyrocompass:GyrocompassExternal")()
"""External damping with a gyrocompass in the azimuth channel."""
