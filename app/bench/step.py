"""Which way one step of a slider takes through the code: ``python -m schuler_bench.bench.step [--list]``.

A dashboard in this process, a visitor by websocket, and a profile function in every thread: the files of
`schuler_bench` and `navcore` between the slider's message and its figures, their functions and their calls.
Compiled kernels are not seen.
"""

import sys
import threading
from collections import Counter
from pathlib import Path
from types import CodeType, FrameType
from typing import Any

from schuler_bench.bench.dashboard import ZETA
from schuler_bench.bench.visitor import PAGE_PAINTED, PAGE_STATE, Visitor
from schuler_bench.serve import open_dashboard

_ROOT = Path(__file__).resolve().parents[2]
_STEPS = 5
_PAUSE_S = 0.5
_calls: Counter[CodeType] = Counter()
_tracing = threading.Event()


def _called(frame: FrameType, event: str, _: Any) -> None:
    if event == "call" and _tracing.is_set():
        _calls[frame.f_code] += 1


def trace_step(*, moving: bool) -> dict[CodeType, str]:
    """Trace a step of the slider zeta, once the steps before it have loaded all that it needs.

    Parameters
    ----------
    moving : bool
        The slider goes on moving: only the pictures in front are sent. Else it rests, and all views follow.

    Returns
    -------
    dict
        Functions of `schuler_bench` and `navcore` that were called, without those of measuring, and the file
        of each.
    """
    _calls.clear()
    server, dashboard = open_dashboard(port=0)
    try:
        with Visitor(server.port) as visitor:
            visitor.set(PAGE_STATE, "1920x1080|Method|Frequency|Errors")
            visitor.wait_for_run(1)
            visitor.ask("edit-method", "2")
            visitor.control(ZETA)
            visitor.rest(1.0)
            for step in range(_STEPS):
                picture, run = visitor.picture_number, visitor.run_number
                if moving:
                    visitor.set(PAGE_PAINTED, f"{picture} 1")
                    visitor.rest(_PAUSE_S)
                if step == _STEPS - 1:
                    _tracing.set()
                visitor.set(ZETA, round(0.6 + 0.02 * step, 3))
                if moving:
                    visitor.wait(lambda before=picture: visitor.picture_number > before, "a picture")
                else:
                    visitor.wait_for_run(run + 1)
                visitor.rest(0.1)
                _tracing.clear()
                visitor.rest(_PAUSE_S)
    finally:
        server.stop()
        dashboard.close()
    names = {code: code.co_filename.removeprefix(f"{_ROOT}/") for code in _calls}
    return {
        code: name
        for code, name in names.items()
        if name.startswith(("schuler_bench/", "navcore/")) and not name.startswith("schuler_bench/bench")
    }


def main() -> None:
    """Print the numbers, and with ``--list`` the files with their calls."""
    threading.setprofile(_called)  # before a dashboard opens: its threads of computing stay
    sys.setprofile(_called)
    for name, moving in (("while the slider moves", True), ("at rest", False)):
        functions = trace_step(moving=moving)
        files: Counter[str] = Counter()
        for code, file in functions.items():
            files[file] += _calls[code]
        print(f"{name}: {len(files)} files, {len(functions)} functions, {sum(files.values())} calls")
        if "--list" in sys.argv:
            print("\n".join(f"{count:6d}  {file}" for file, count in sorted(files.items())))


if __name__ == "__main__":
    main()
