"""What a folder of a test holds."""

from pathlib import Path


def contents(folder: Path) -> dict[str, bytes]:
    """Content of each file in a folder and below, where links lead."""
    files = (path for path in folder.rglob("*") if path.is_file())
    return {str(path.relative_to(folder)): path.read_bytes() for path in files}
