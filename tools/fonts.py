"""The fonts in which the browser tests measure the layout: find them, install them, leave a browser one."""

import os
import shutil
import sys
from pathlib import Path

from tools.chromium import apt_install

NARROW, WIDE = "Liberation Sans", "DejaVu Sans"
FONTS = {
    NARROW: ("LiberationSans-Regular.ttf", "fonts-liberation"),
    WIDE: ("DejaVuSans.ttf", "fonts-dejavu-core"),
}
"""Family -> a file of it and the Debian package that holds it: as wide as Arial, and as wide as Verdana."""
_FOLDERS = ("/usr/share/fonts", "/usr/local/share/fonts", "~/.local/share/fonts", "~/.fonts")
_ONE_FAMILY = """<?xml version="1.0"?>
<!DOCTYPE fontconfig SYSTEM "fonts.dtd">
<fontconfig>
  <dir>{fonts}</dir>
  <cachedir>{folder}/cache</cachedir>
  <match target="pattern"><edit name="family" mode="append"><string>{family}</string></edit></match>
</fontconfig>
"""


def find_font(family: str) -> Path | None:
    """Return the folder with the files of a family of `FONTS`."""
    folders = (Path(folder).expanduser() for folder in _FOLDERS)
    return next((path.parent for folder in folders for path in folder.rglob(FONTS[family][0])), None)


def provide_fonts() -> str:
    """Find all fonts, or install them where that is possible; return what was done, or what is missing."""
    packages = [package for family, (_, package) in FONTS.items() if find_font(family) is None]
    if not packages:
        return f"{', '.join(FONTS)} (found)"
    command = f"apt-get install {' '.join(packages)}"
    failed = "it needs root and apt-get"
    if os.geteuid() == 0 and shutil.which("apt-get"):
        failed = apt_install(*packages)
    missing = [family for family in FONTS if find_font(family) is None]
    if not missing:
        return f"{', '.join(FONTS)} (installed by {command})"
    return f"no {', '.join(missing)}, tests in it are skipped: '{command}': {failed or 'it brought no file'}"


def one_font(family: str, folder: Path) -> dict[str, str]:
    """Return the variables of a browser's environment that leave it one family; empty without that family.

    Parameters
    ----------
    family : str
        Of `FONTS`.
    folder : Path
        For the configuration of fontconfig and its cache. macOS and Windows have no fontconfig.
    """
    fonts = find_font(family)
    if fonts is None or not sys.platform.startswith("linux"):
        return {}
    config = folder / "fonts.conf"
    config.write_text(_ONE_FAMILY.format(fonts=fonts, folder=folder, family=family), encoding="utf-8")
    return {"FONTCONFIG_FILE": str(config)}
