"""Damping by a law of the user's own, one kind for each law that is registered."""

from collections.abc import Iterator
from typing import ClassVar

from navcore.damping.base import Carrying, Configured, Covering, Damping, Need
from navcore.foundation.text import Text
from navcore.law.hosted import UserLaw


class UserDamping(Damping):
    """A navigation whose corrections a user's law commands; made by `damping_of`."""

    uses_log: ClassVar[bool] = True
    carrying: ClassVar[Carrying] = "user"
    covering: ClassVar[Covering] = "seeds"
    no_covariance: ClassVar[str] = Text("what a user's law does is not known")
    no_loop: ClassVar[str] = Text("what a user's law does is not known")
    needs: ClassVar[tuple[Need, ...]] = (
        Need("coupled channels", Text('a user\'s law needs run.fidelity "error_model" or "strapdown"')),
        Need("simulated IMU", Text("a user's law needs a simulated IMU (no imu.file or ins.file)")),
    )

    def notices(self, method: Configured) -> Iterator[str]:
        """Yield also what the law says of its speed."""
        yield from super().notices(method)
        if self.settings is not None and issubclass(self.settings, UserLaw) and self.settings.speed:
            yield self.settings.speed


def damping_of(law: type[UserLaw]) -> type[Damping]:
    """Make the kind of damping of a law: it bears the law's id, and its settings are the law's fields."""
    members = {"id": law.id, "help": law.help, "settings": law, "blocks": (law.id,)}
    members |= {"__doc__": law.__doc__, "__module__": law.__module__, "__qualname__": law.__qualname__}
    return type(law.__name__, (UserDamping,), members)
