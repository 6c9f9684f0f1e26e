"""External damping: the network is fed with the difference to a reference velocity."""

from typing import ClassVar

from navcore.damping.base import Need, NetworkDamping
from navcore.foundation.text import Text
from navcore.law.records import LawKind


class External(NetworkDamping):
    """Damping against a log: the ship's manoeuvres cancel, and the log's errors enter (theory.md 3)."""

    id: ClassVar[str] = "external"
    help: ClassVar[str] = Text("against the reference velocity")
    law: ClassVar[LawKind] = "external"
    uses_log: ClassVar[bool] = True
    needs: ClassVar[tuple[Need, ...]] = (
        Need("reference", Text('needs a reference velocity: reference.kind must not be "none"')),
    )
