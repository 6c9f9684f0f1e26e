"""The server's log: a line an event, for people or (SCHULER_LOG=json) for programs."""

import json
import logging
import os
import sys
import time


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


def begin_logging(how: str | None = None) -> None:
    """Send the program's log to standard error.

    Parameters
    ----------
    how : str, optional
        "json" or "text"; by default what SCHULER_LOG says, else text.
    """
    how = how or os.environ.get("SCHULER_LOG", "text")
    handler = logging.StreamHandler(sys.stderr)
    handler.setFormatter(_Lines() if how == "json" else logging.Formatter("%(name)s: %(message)s"))
    log = logging.getLogger("schuler")
    log.handlers = [handler]
    log.setLevel(logging.INFO)  # removals are told
    log.propagate = False
