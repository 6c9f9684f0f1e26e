"""A Kalman filter in the place of a network."""

from collections.abc import Iterator
from typing import ClassVar

from navcore.damping.base import Carrying, Configured, Covering, Damping, Need
from navcore.foundation.text import Text


class Kalman(Damping):
    """A free navigation that a Kalman filter corrects with the log (theory.md 16)."""

    id: ClassVar[str] = "kalman"
    help: ClassVar[str] = Text(
        "no network, but a Kalman filter that is told the scenario's own figures and measures "
        "against the log (error_model and strapdown)"
    )
    blocks: ClassVar[tuple[str, ...]] = ()
    uses_log: ClassVar[bool] = True
    carrying: ClassVar[Carrying] = "filter"
    covering: ClassVar[Covering] = "filter"
    no_covariance: ClassVar[str] = Text("the Kalman filter corrects by its own gains")
    no_loop: ClassVar[str] = Text("the gains of the Kalman filter change at every step")
    needs: ClassVar[tuple[Need, ...]] = (
        Need(
            "coupled channels",
            Text(
                'needs run.fidelity "error_model" or "strapdown": it estimates both channels and the heading'
            ),
        ),
        Need(
            "log",
            Text('needs reference.kind = "log": the filter must be told the noise of what it measures with'),
        ),
        Need(
            "simulated IMU",
            Text(
                "needs a simulated IMU: the filter must be told its random errors (no imu.file or ins.file)"
            ),
        ),
    )

    def description(self, method: Configured) -> str:
        """Name the measurement of the filter."""
        return Text("Kalman filter on the difference to the log")

    def notices(self, method: Configured) -> Iterator[str]:
        """Yield also that policy and switching method are not used."""
        yield from super().notices(method)
        if method.policy.id != "constant" or method.switching.id != "hard":
            yield Text('damping = "kalman": policy and switching are not used')
