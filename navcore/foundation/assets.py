"""Where the files that come with the code are: presets, lessons, models, styles."""

from pathlib import Path, PurePosixPath

_PACKAGE = Path(__file__).resolve().parents[1]


def assets_folder() -> Path:
    """Folder of the shipped files: inside the installed package, or at the top of a checkout.

    Returns
    -------
    Path
        An existing folder.

    Raises
    ------
    FileNotFoundError
        If the installation holds no assets.
    """
    installed, checkout = _PACKAGE / "_assets", _PACKAGE.parent / "assets"
    for folder in (installed, checkout):
        if folder.is_dir():
            return folder
    raise FileNotFoundError(f"no assets in {installed} or {checkout}: the installation is incomplete")


def asset_path(name: str) -> Path:
    """Path of one shipped file or folder.

    Parameters
    ----------
    name : str
        Path below the assets folder, with forward slashes, e.g. ``presets/sun-step.toml``.

    Returns
    -------
    Path
        An existing file or folder below `assets_folder`.

    Raises
    ------
    FileNotFoundError
        If there is no such asset; also if the name is absolute or leads out of the folder.
    """
    parts = PurePosixPath(name.replace("\\", "/"))
    # A name may come from a user (a preset, a lesson): nothing outside the folder exists for it.
    if not parts.parts or parts.is_absolute() or ".." in parts.parts or "\0" in name:
        raise FileNotFoundError(f"no asset named {name!r}")
    path = assets_folder() / parts
    if not path.exists():
        raise FileNotFoundError(f"no asset named {name!r}")
    return path
