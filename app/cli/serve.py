"""``schuler serve``: the dashboard."""

import os
from dataclasses import dataclass
from functools import partial
from pathlib import Path
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
        What a visitor must know; compulsory beyond this machine. Better given as SCHULER_TOKEN or in a file:
        other users can read a command line.
    token_file : Path or None
        File whose first line is the token; also SCHULER_TOKEN_FILE.
    generate_token : bool
        Make a token, and print the link that carries it once; with --token-file it is written there.
    allow_origin : tuple of str
        A further address under which the page may be opened, e.g. behind a reverse proxy; also
        SCHULER_ALLOW_ORIGIN, several with commas between them.
    frame_origin : tuple of str
        An origin whose pages may show a single view (?view=bode) in a frame; no page may without it.
    workers : int
        Processes behind one door, for many visitors: about one a core. Sessions stay with their worker; one
        that fails is started again.
    cluster : str or None
        Scheduler of a Dask cluster, tcp://HOST:PORT, that computes heavy jobs (verification, bands, budgets,
        searches); also SCHULER_CLUSTER. Needs the extra: schuler-bench[cluster].
    lessons : Path or None
        Folder of lessons of one's own, Markdown files (docs/teaching.md), shown after those of the program.
    open : bool
        Open the page in the browser.
    """

    host: Annotated[str, arg(metavar="HOST")] = "127.0.0.1"
    port: Annotated[int, arg(metavar="PORT")] = 8080
    token: Annotated[str | None, arg(metavar="T")] = None
    token_file: Annotated[Path | None, arg(metavar="FILE")] = None
    generate_token: bool = False
    allow_origin: Annotated[UseAppendAction[tuple[str, ...]], arg(metavar="URL")] = ()
    frame_origin: Annotated[UseAppendAction[tuple[str, ...]], arg(metavar="URL")] = ()
    workers: Annotated[int, arg(metavar="N")] = 1
    cluster: Annotated[str | None, arg(metavar="ADDRESS")] = None
    lessons: Annotated[Path | None, arg(metavar="DIR")] = None
    open: bool = False

    def execute(self) -> int:
        """Serve; 0 when asked to end."""
        from schuler_bench.http.address import find_token
        from schuler_bench.jobs.elsewhere import CLUSTER
        from schuler_bench.serve import serve
        from schuler_bench.workers import serve_with_workers

        if self.lessons is not None:
            from schuler_bench.views.learn.own import use_lessons

            use_lessons(self.lessons)
        token = find_token(self.token, self.token_file, self.generate_token, os.environ)
        named = os.environ.get("SCHULER_ALLOW_ORIGIN", "").replace(",", " ").split()
        cluster = self.cluster or os.environ.get(CLUSTER) or None
        begin = (
            partial(serve, open_browser=self.open)
            if self.workers == 1
            else partial(serve_with_workers, count=self.workers)
        )
        begin(
            self.host,
            self.port,
            token=token.value,
            show_token=token.generated,
            allow_origins=(*self.allow_origin, *named),
            frame_origins=self.frame_origin,
            cluster=cluster,
        )
        return 0
