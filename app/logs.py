"""The server's log: a line an event, for people or (SCHULER_LOG=json) for programs."""

import json
import logging
import logging.handlers
import os
import sys
import time
from typing import Any

from navcore.foundation.visible import visible


class _Lines(logging.Formatter):
    """One JSON object a line, an exception's trace within it."""

    def format(self, record: logging.LogRecord) -> str:
        """Write one event."""
        line = {
            "time": time.strftime("%Y-%m-%dT%H:%M:%S", time.gmtime(record.created))
            + f".{record.msecs:03.0f}Z",
            "level": record.levelname.lower(),
            "logger": record.name,
            "message": record.getMessage(),
        }
        if record.exc_info:
            line["exception"] = self.formatException(record.exc_info)
        return json.dumps(line, ensure_ascii=False)


class _People(logging.Formatter):
    """Name and message in one line; what it quotes from outside does nothing to the terminal."""

    def formatMessage(self, record: logging.LogRecord) -> str:  # noqa: N802 - the name is logging's
        """Write the line of an event."""
        return visible(super().formatMessage(record))

    def formatException(self, ei: Any) -> str:  # noqa: N802 - the name is logging's
        """Write an exception's trace."""
        return "\n".join(map(visible, super().formatException(ei).splitlines()))


def begin_logging(how: str | None = None, *, to_file: bool = True) -> None:
    """Send the program's log to standard error, or to the file that SCHULER_LOG_FILE names.

    The file is rotated: beyond 10 MB (SCHULER_LOG_BYTES) it becomes FILE.1, and that FILE.2, the last one.

    Parameters
    ----------
    how : str, optional
        "json" or "text"; by default what SCHULER_LOG says, else text.
    to_file : bool
        Heed SCHULER_LOG_FILE; only one process may rotate a file.
    """
    how = how or os.environ.get("SCHULER_LOG", "text")
    file = os.environ.get("SCHULER_LOG_FILE")
    handler: logging.Handler = logging.StreamHandler(sys.stderr)
    if file and to_file:
        most = int(os.environ.get("SCHULER_LOG_BYTES", "10000000"))
        handler = logging.handlers.RotatingFileHandler(file, maxBytes=most, backupCount=2, encoding="utf-8")
    handler.setFormatter(_Lines() if how == "json" else _People("%(name)s: %(message)s"))
    log = logging.getLogger("schuler")
    log.handlers = [handler]
    log.setLevel(logging.INFO)  # removals are logged
    log.propagate = False
