"""A user's law by its file: C source, or a Functional Mock-up Unit."""

from importlib import import_module
from pathlib import Path
from typing import Any

LAW_FILES = {".c": "c_law", ".fmu": "fmu_law"}
"""Function that makes a law of a file, and its module here, by the ending of the file's name."""


def law_of_file(path: str | Path, id: str = "") -> Any:
    """Make a law of a file, to be given to `navcore.register`.

    Parameters
    ----------
    path : str or Path
        Its ending is one of `LAW_FILES`.
    id : str
        Name in scenarios; by default that of the file.

    Returns
    -------
    type of `navcore.law.hosted.UserLaw`

    Raises
    ------
    InputError
        The file makes no law.
    """
    name = LAW_FILES[Path(path).suffix]
    return getattr(import_module(f"navcore.extending.{name}"), name)(path, id)
