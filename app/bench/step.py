"""Which way one step of a slider takes through the code: ``python -m app.bench.step [--list]``.

A dashboard in this process, a visitor by websocket, and a profile function in every thread: the files of
`app` and `navcore` between the slider's message and its figures, their functions and their calls. Compiled
kernels are not seen.
"""

from __future__ import annotations

import sys
import threading
from collections import Counter
from pathlib import Path
from types import CodeType, FrameType
from typing import Any

_ROOT = Path(__file__).resolve().parents[2]
_STEPS = 5
_PAUSE_S = 0.5


class Trace:
    """Calls of each function of ours while ``on``, in all threads that begin after `begin`."""

    def __init__(self) -> None:
        self.calls: Counter[CodeType] = Counter()
        self.on = False

    def begin(self) -> None:
        """Watch this thread, and every one that begins from now on."""
        threading.setprofile(self._called)
        sys.setprofile(self._called)

    def _called(self, frame: FrameType, event: str, _: Any) -> None:
        if self.on and event == "call":
            self.calls[frame.f_code] += 1

    def files(self) -> dict[str, int]:
        """Calls by file, of `app` and `navcore`; measuring itself is left out."""
        files: Counter[str] = Counter()
        for code, count in self.calls.items():
            path = Path(code.co_filename)
            if path.is_relative_to(_ROOT):
                name = str(path.relative_to(_ROOT))
                if name.startswith(("app/", "navcore/")) and not name.startswith("app/bench"):
                    files[name] += count
        return dict(sorted(files.items()))

    def functions(self) -> int:
        """Number of different functions."""
        files = self.files()
        return sum(code.co_filename.removeprefix(f"{_ROOT}/") in files for code in self.calls)


def trace_step(trace: Trace, *, moving: bool) -> None:
    """Trace a step of the slider zeta, once the steps before it have loaded all that it needs.

    Parameters
    ----------
    trace : Trace
        Already begun: threads that compute outlive a dashboard.
    moving : bool
        The slider goes on moving: only the pictures in front are sent. Else it rests, and all views follow.
    """
    from app.bench.dashboard import ZETA
    from app.bench.visitor import PAGE_PAINTED, PAGE_STATE, Visitor
    from app.serve import open_dashboard

    trace.calls.clear()
    server, dashboard = open_dashboard(port=0)
    try:
        with Visitor(server.port) as visitor:
            visitor.set(PAGE_STATE, "1920x1080|Method|Frequency|Errors")
            visitor.wait_for_run(1)
            visitor.set("method", "complementary")
            visitor.control(ZETA)
            visitor.rest(1.0)
            for step in range(_STEPS):
                picture, run = visitor.picture_number, visitor.run_number
                if moving:
                    visitor.set(PAGE_PAINTED, f"{picture} 1")
                    visitor.rest(_PAUSE_S)
                trace.on = step == _STEPS - 1
                visitor.set(ZETA, round(0.6 + 0.02 * step, 3))
                if moving:
                    visitor.wait(lambda before=picture: visitor.picture_number > before, "a picture")
                else:
                    visitor.wait_for_run(run + 1)
                visitor.rest(0.1)
                trace.on = False
                visitor.rest(_PAUSE_S)
    finally:
        server.stop()
        dashboard.close()


def main() -> None:
    """Print the numbers, and with ``--list`` the files with their calls."""
    trace = Trace()
    trace.begin()
    for name, moving in (("while the slider moves", True), ("at rest", False)):
        trace_step(trace, moving=moving)
        files = trace.files()
        print(f"{name}: {len(files)} files, {trace.functions()} functions, {sum(files.values())} calls")
        if "--list" in sys.argv:
            print("\n".join(f"{count:6d}  {file}" for file, count in files.items()))


if __name__ == "__main__":
    main()
