"""A proposed network takes the place of a method's own: one step of undo."""

from typing import Any

from navcore.foundation.errors import InputError
from navcore.foundation.text import Text
from schuler_bench.editing.edits import with_network
from schuler_bench.shell import notices
from schuler_bench.shell.view import Frame


def change_network(frame: Frame, index: int, network: dict[str, Any], name: str) -> bool:
    """Put a network into a method of the present scenario; False, with a notification, where it cannot be.

    Parameters
    ----------
    frame : Frame
        Of the page.
    index : int
        Of the method.
    network : dict
        Block as in a scenario file.
    name : str
        Of the step in the history.
    """
    session = frame.session
    with session.lock:
        try:
            changed = with_network(session.scenario, index, network)
            session.change(changed, None, name=name, selected=index)
        except InputError as error:
            notices.tell(frame.client, Text("The proposal cannot be used"), notices.fault_lines(error))
            return False
    return True
