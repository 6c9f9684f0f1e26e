"""What a live stream costs another visitor: ``python -m tools.live_load [--rate 100] [--rounds 4]``.

One server listens. In turns nothing is sent, and an INS and its log send so many sentences a second; in each
turn a visitor moves a slider. Printed are the median and the 95th percentile from the slider to the figures
in both, the ratio of the medians, and what of a processor the server used.
"""

import argparse
import math
import socket
import statistics
import threading
import time
from itertools import chain

from schuler_bench.bench.dashboard import median_and_p95, slider_to_frame_ms
from schuler_bench.bench.process import Server, free_port
from tests.sentences import made_up

STEPS = 25


class Sender:
    """Sends seconds of a made-up INS over UDP, each in real time as often as the rate needs.

    Parameters
    ----------
    port : int
        On this machine.
    rate_hz : float
        Sentences a second.
    """

    def __init__(self, port: int, rate_hz: float) -> None:
        self._port, self._pause_s = port, 1.0 / rate_hz
        self._on, self._ended = threading.Event(), threading.Event()
        self.sent = 0
        self._lines = chain.from_iterable(made_up(10**9))
        self._thread = threading.Thread(target=self._send, daemon=True)
        self._thread.start()

    def _send(self) -> None:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as out:
            due = time.monotonic()
            while not self._ended.is_set():
                if not self._on.wait(0.2):
                    due = time.monotonic()
                    continue
                out.sendto(next(self._lines).encode(), ("127.0.0.1", self._port))
                self.sent += 1
                due += self._pause_s
                time.sleep(max(0.0, due - time.monotonic()))

    def go(self, on: bool) -> None:
        """Send, or be silent."""
        (self._on.set if on else self._on.clear)()

    def close(self) -> None:
        """End."""
        self._ended.set()
        self._thread.join()


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rate", type=float, default=100.0, help="sentences a second")
    parser.add_argument("--rounds", type=int, default=4)
    given = parser.parse_args()
    port = free_port()
    times: dict[bool, list[float]] = {False: [], True: []}
    used: dict[bool, float] = {False: 0.0, True: 0.0}
    sender = Sender(port, given.rate)
    with Server(options=("--listen", f"udp://127.0.0.1:{port}")) as server:
        slider_to_frame_ms(server.port, steps=5)
        for on in [False, True] * given.rounds:
            sender.go(on)
            time.sleep(3.0)
            before, began = server.cpu_s(), time.monotonic()
            times[on] += slider_to_frame_ms(server.port, steps=STEPS)
            used[on] += (server.cpu_s() - before) / (time.monotonic() - began) / given.rounds
    sender.close()
    alone, live = (median_and_p95(times[on]) for on in (False, True))
    spread = statistics.stdev(times[False]) / math.sqrt(len(times[False]))
    print(
        f"{sender.sent} sentences sent, {given.rate:g} a second; {len(times[True])} steps of the slider each"
    )
    print(f"alone      median {alone[0]:6.1f} ms   95 % {alone[1]:6.1f} ms   processor {used[False]:.2f}")
    print(f"beside it  median {live[0]:6.1f} ms   95 % {live[1]:6.1f} ms   processor {used[True]:.2f}")
    print(f"ratio of the medians {live[0] / alone[0]:.3f} (standard error about {spread / alone[0]:.3f})")


if __name__ == "__main__":
    main()
