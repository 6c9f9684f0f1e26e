"""Half-period averaging: no network, but a mean of free navigations that are half a period apart."""

from typing import ClassVar

from navcore.averaging import Averaging
from navcore.averaging.record import MUST_STAND
from navcore.damping.base import Carrying, Configured, Covering, Damping, Need
from navcore.foundation.parameters import Parameters
from navcore.foundation.text import Text


class HalfPeriodAveraging(Damping):
    """Averaged copies of the free navigation (Zhao 2015; theory.md 5)."""

    id: ClassVar[str] = "averaging"
    help: ClassVar[str] = Text(
        "none, but copies of the navigation half a period ahead are averaged (Zhao 2015)"
    )
    settings: ClassVar[type[Parameters] | None] = Averaging
    blocks: ClassVar[tuple[str, ...]] = ("averaging",)
    carrying: ClassVar[Carrying] = "copies"
    covering: ClassVar[Covering] = "seeds"
    no_covariance: ClassVar[str] = Text("averaging combines several navigations")
    needs: ClassVar[tuple[Need, ...]] = (
        Need("standing start", MUST_STAND),
        Need(
            "coupled channels",
            Text(
                'needs run.fidelity "error_model" or "strapdown": two channels by themselves have neither '
                "Foucault nor 24 h oscillation"
            ),
        ),
        Need(
            "simulated IMU",
            Text(
                "needs a simulated IMU: its forecast comes from a simulated alignment record (no imu.file or "
                "ins.file)"
            ),
        ),
    )

    def label(self, method: Configured) -> str:
        """Kind and variant."""
        return Text("averaging ({variant})", variant=self._averaging(method).variant)

    def description(self, method: Configured) -> str:
        """Kind, variant, and whether a copy runs against the 24 h line."""
        averaging = self._averaging(method)
        if averaging.earth:
            return Text("averaging, {variant}, with the 24 h line", variant=averaging.variant)
        return Text("averaging, {variant}, without the 24 h line", variant=averaging.variant)

    def _averaging(self, method: Configured) -> Averaging:
        return getattr(method, self.id)
