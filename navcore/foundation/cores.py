"""How many cores there are to compute on."""

import os


def cores() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def one_blas_thread() -> None:
    """Let BLAS compute each call on the thread that makes it; to be called before numpy is loaded.

    The matrices here have at most some twenty rows: beside other work, a second thread made the steady budget
    of eight methods three times slower (24 against 7 ms). What the user has set in the environment stays.
    """
    for name in ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS"):
        os.environ.setdefault(name, "1")
