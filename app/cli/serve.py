"""``schuler serve``: the dashboard."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Annotated

from tyro.conf import UseAppendAction, arg


@dataclass(frozen=True)
class ServeCommand:
    """Serve the dashboard until Ctrl-C.

    Attributes
    ----------
    host : str
        Name or address to listen on.
    port : int
        0: any free one.
    token : str or None
        What a visitor must know; compulsory beyond this machine. Better given as SCHULER_TOKEN: other users
        can read a command line.
    allow_origin : tuple of str
        A further address under which the page may be opened, e.g. behind a reverse proxy.
    open : bool
        Open the page in the browser.
    """

    host: Annotated[str, arg(metavar="HOST")] = "127.0.0.1"
    port: Annotated[int, arg(metavar="PORT")] = 8080
    token: Annotated[str | None, arg(metavar="T")] = None
    allow_origin: Annotated[UseAppendAction[tuple[str, ...]], arg(metavar="URL")] = ()
    open: bool = False

    def execute(self) -> int:
        """Serve; 0 when asked to end."""
        from app.serve import serve

        token = os.environ.get("SCHULER_TOKEN") if self.token is None else self.token
        origins = self.allow_origin
        serve(self.host, self.port, token=token or None, allow_origins=origins, open_browser=self.open)
        return 0
