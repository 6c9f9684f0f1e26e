"""Progress of a work that is a part of another one."""

from collections.abc import Callable

Progress = Callable[[float], None]


def part_of(progress: Progress | None, begin: float, end: float) -> Progress:
    """Return what takes the fraction done of a part that goes from one fraction of the whole to another.

    Examples
    --------
    >>> part_of(print, 0.5, 1.0)(0.5)
    0.75
    """
    return lambda fraction: None if progress is None else progress(begin + (end - begin) * fraction)
