"""Commands of another user of this machine, who may have no account, home or place to write to."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
STRANGER = 10001
"""User without an account; the number that the container serves under."""

_ENTER = """
set -e
if [ -n "$HIDDEN" ]; then
    mount --bind "$BASE" "$HOLD"
    mount -t tmpfs -o mode=755 none "$HIDDEN"
    mkdir -p "$BASE"
    mount --move "$HOLD" "$BASE"
fi
for place in $READ_ONLY; do mount --bind "$place" "$place"; mount -o remount,bind,ro "$place"; done
for place in $FULL; do
    mount -t tmpfs -o size=4k,mode=1777 none "$place"
    head -c 4096 /dev/zero >"$place/full"
done
exec setpriv --reuid="$USER_ID" --regid="$USER_ID" --clear-groups -- "$@"
"""


def require_users() -> None:
    """Skip the test unless another user can be made to run this very program here."""
    tried = ["unshare", "--mount", "setpriv", "--version"]
    if os.name != "posix" or os.getuid() != 0 or subprocess.run(tried, capture_output=True).returncode:
        pytest.skip("needs root, unshare and setpriv")
    if hidden(Path(sys.prefix)) or hidden(ROOT):
        pytest.skip("other users cannot read this checkout")


def hidden(place: Path) -> str:
    """First folder above a place that other users cannot search; empty when there is none."""
    return next((str(above) for above in reversed(place.parents) if not above.stat().st_mode & 0o001), "")


def entering(
    folder: Path, uid: int = STRANGER, read_only: tuple[Path, ...] = (), full: tuple[Path, ...] = ()
) -> tuple[list[str], dict[str, str]]:
    """Words before a command of a user, and what the environment must hold for them.

    Parameters
    ----------
    folder : Path
        That everyone may search.
    uid : int
        User and group of the command.
    read_only, full : tuple of Path
        Folders that are mounted read-only, or hold a disk without any room, for that command alone.
    """
    base = Path(sys.base_prefix)
    hold = folder / "hold"
    hold.mkdir(exist_ok=True)
    variables = {"BASE": str(base), "HIDDEN": hidden(base), "HOLD": str(hold)}
    mounts = {"READ_ONLY": " ".join(map(str, read_only)), "FULL": " ".join(map(str, full))}
    return ["unshare", "--mount", "sh", "-c", _ENTER, "sh"], variables | mounts | {"USER_ID": str(uid)}
