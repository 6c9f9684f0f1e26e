"""Exit codes of the command ``schuler`` (interface.md)."""

DONE, WRONG_INPUT, STOPPED = 0, 2, 3
