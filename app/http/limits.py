"""How much one visitor, and all of them together, may take."""

from dataclasses import dataclass, replace

MIB = 1 << 20


@dataclass(frozen=True)
class Limits:
    """Bounds of the server.

    Attributes
    ----------
    visitors : int
        Open pages (websockets). When all places are taken, the one that has been idle longest makes room for
        a page that a person opens; the others see that the bench is full.
    pages_per_address : int
        Open pages of one address: a lecture room behind one router fits, and leaves a few places to others.
    idle_s : float
        A page that has sent nothing for so long may lose its place to another.
    half_open : int
        Connections that are no open page: requests that are still coming, answers that are still going.
    request_s : float
        How long a request may take to arrive.
    frame_bytes : int
        Largest single message from a browser. viser's page sends uploads in pieces of 512 KiB.
    frames_waiting : int
        Messages of one connection that are read ahead.
    upload_bytes : int
        Largest uploaded file.
    uploads_at_once : int
        Unfinished uploads of one visitor.
    all_uploads_bytes : int
        Unfinished uploads of all visitors together.
    upload_stall_s : float
        An upload of which nothing has come for so long is given up when others need its room.
    text_characters : int
        Longest text a control accepts.
    frames_per_second : int
        A browser that sends more is read more slowly; nothing is lost. A page of ours sends at most about 60.
    frames_at_once : int
        Frames that may arrive in a second, read or unread; a ping or a fragment counts as five. More end the
        connection.
    fragments : int
        Parts in which one message may come. Browsers send large ones in parts of 64 KiB.
    token_guesses : int
        Wrong tokens of one address that are judged at once.
    token_refill_s : float
        So long it takes until one more is.
    all_guesses : int
        Tokens of all addresses that are judged at once.
    all_refill_s : float
        Time between two more.
    ping_s : float
        A page that answers no ping for twice this long is dropped, and with it all that waits to be sent.
    close_s : float
        How long a closing handshake may take; bounds the time to stop.
    """

    visitors: int = 64
    pages_per_address: int = 56
    idle_s: float = 60.0
    half_open: int = 128
    request_s: float = 10.0
    frame_bytes: int = 2 * MIB
    frames_waiting: int = 4
    upload_bytes: int = 16 * MIB
    uploads_at_once: int = 4
    all_uploads_bytes: int = 128 * MIB
    upload_stall_s: float = 30.0
    text_characters: int = 20_000
    frames_per_second: int = 100
    frames_at_once: int = 5000
    fragments: int = 300
    token_guesses: int = 30
    token_refill_s: float = 1.0
    all_guesses: int = 300
    all_refill_s: float = 0.05
    ping_s: float = 20.0
    close_s: float = 1.0

    def shared_by(self, workers: int) -> "Limits":
        """Limits of one of several processes that judge tokens: all together keep these."""
        return replace(
            self,
            token_guesses=max(1, self.token_guesses // workers),
            token_refill_s=self.token_refill_s * workers,
            all_guesses=max(1, self.all_guesses // workers),
            all_refill_s=self.all_refill_s * workers,
        )
