"""``schuler serve``: the dashboard."""

import os
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Annotated

from tyro.conf import UseAppendAction, arg

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text


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
    listen : tuple of str
        Where the output of a ship's INS and its log come in as NMEA 0183, udp://127.0.0.1:10110 or
        file:PATH for a file that grows; may be given several times. Beyond this machine the sender is named:
        udp://0.0.0.0:10110?from=192.0.2.7.
    live_scenario : str
        Preset or file whose methods, and [ins.damping], are laid on what is heard; four methods without it.
    send : str or None
        Where the damped output is sent as NMEA 0183, udp://HOST:PORT.
    send_method : str
        Whose output is sent; the first method's without it.
    class_ : bool
        The visitors form a class: each has a session of his own and follows the lesson that one of them
        leads, whose page shows the answers and sketches of all (docs/teaching.md). Not with --workers.
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
    listen: Annotated[UseAppendAction[tuple[str, ...]], arg(metavar="URL")] = ()
    live_scenario: Annotated[str, arg(metavar="SCENARIO")] = ""
    send: Annotated[str | None, arg(metavar="URL")] = None
    send_method: Annotated[str, arg(metavar="NAME")] = ""
    class_: Annotated[bool, arg(name="class")] = False
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
        live = self._live()
        if self.class_ and self.workers != 1:
            allowed = Text("must be left out with --class: a class is one process")
            raise InputError(Fault("serve", "--workers", self.workers, allowed))
        token = find_token(self.token, self.token_file, self.generate_token, os.environ)
        named = os.environ.get("SCHULER_ALLOW_ORIGIN", "").replace(",", " ").split()
        cluster = self.cluster or os.environ.get(CLUSTER) or None
        begin = (
            partial(serve, open_browser=self.open, as_class=self.class_)
            if self.workers == 1
            else partial(serve_with_workers, count=self.workers)
        )
        with live:
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

    def _live(self) -> AbstractContextManager[object]:
        """What listens while the server does; raises `InputError`."""
        if not (self.listen or self.send or self.send_method or self.live_scenario):
            return nullcontext()
        from schuler_bench.live.live import listening
        from schuler_bench.live.settings import settings_of

        settings = settings_of(self.listen, self.send, self.send_method, self.live_scenario)
        if self.workers != 1:
            allowed = "must be 1 with --listen: one process hears the INS"
            raise InputError(Fault("serve", "--workers", self.workers, allowed))
        return listening(settings)
