"""A Kalman filter in the place of a network."""

from collections.abc import Iterator
from typing import ClassVar

from navcore.damping.base import Carrying, Configured, Covering, Damping, Need
from navcore.foundation.parameters import Parameters, quantity
from navcore.foundation.text import Text


class KalmanSettings(Parameters):
    """Block ``kalman`` of a method with ``damping = "kalman"``: further states, and how large they may be."""

    current_std_mps: float = quantity(
        0.0,
        unit="m/s",
        ge=0.0,
        le=50.0,
        slider=(0.0, 2.0),
        label=Text("current known to"),
        help=Text(
            "Standard deviation of the velocity of the water, east and north, which the filter estimates: "
            "current and tide. 0: it takes the water to stand still."
        ),
    )
    current_tau_s: float = quantity(
        20_000.0,
        unit="s",
        ge=1.0,
        le=1e7,
        slider=(600.0, 200_000.0),
        log=True,
        label=Text("current changes in"),
        help=Text("Correlation time of the velocity of the water."),
    )
    scale_std_ppm: float = quantity(
        0.0,
        unit="ppm",
        ge=0.0,
        le=500_000.0,
        slider=(0.0, 20_000.0),
        label=Text("scale known to"),
        help=Text(
            "Standard deviation of the scale error of the log, which the filter estimates. 0: it takes the "
            "scale to be right."
        ),
    )

    @property
    def further(self) -> bool:
        """Whether the filter has further states."""
        return bool(self.current_std_mps or self.scale_std_ppm)


class Kalman(Damping):
    """A free navigation that a Kalman filter corrects with the log (theory.md 16)."""

    id: ClassVar[str] = "kalman"
    help: ClassVar[str] = Text(
        "no network, but a Kalman filter that is told the scenario's own figures and measures "
        "against the log (error_model and strapdown)"
    )
    settings: ClassVar[type[Parameters] | None] = KalmanSettings
    blocks: ClassVar[tuple[str, ...]] = ("kalman",)
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

    def of(self, method: Configured) -> Damping:
        """Kind for the budget: with further states the filter's own covariance is not the floor."""
        settings: KalmanSettings = getattr(method, self.id)
        return _FURTHER if settings.further else self


class _FurtherKalman(Kalman):
    """A Kalman filter that also estimates the water or the scale of the log."""

    covering: ClassVar[Covering] = "seeds"

    def description(self, method: Configured) -> str:
        """Name the measurement of the filter, and what it estimates of the log."""
        settings: KalmanSettings = getattr(method, self.id)
        found = (Text("current"), settings.current_std_mps), (Text("scale"), settings.scale_std_ppm)
        states = Text.joined(", ", (name for name, size in found if size))
        return Text(
            "Kalman filter on the difference to the log, which also estimates its {states}", states=states
        )


_FURTHER = _FurtherKalman()
