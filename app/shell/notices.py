"""Messages of the page: notifications at its edge, notes beside controls."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Literal

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text, quoted
from schuler_bench.jobs.words import for_a_page, without_folders
from schuler_bench.plots import style

if TYPE_CHECKING:
    import viser

Tone = Literal["error", "warning", "info"]

_TONES: dict[Tone, tuple[str, str]] = {
    "error": (style.DANGER, "#FDECEA"),
    "warning": ("#8A5A00", "#FFF6E0"),
    "info": (style.MUTED, style.SEA),
}
_NOTICE_COLORS: dict[Tone, Literal["red", "orange", "blue"]] = {
    "error": "red",
    "warning": "orange",
    "info": "blue",
}
_LONGEST_NOTICE = 600
_LARGE = 1 << 20


def tell(client: viser.ClientHandle, title: str, lines: Iterable[str], tone: Tone = "error") -> None:
    """Show a notification that goes away by itself; errors stay longer."""
    text = Text.joined("\n", lines)
    if len(text) > _LONGEST_NOTICE:
        text = text[: _LONGEST_NOTICE - 3] + "..."
    seconds = 10.0 if tone == "info" else 15.0
    client.add_notification(title, text, color=_NOTICE_COLORS[tone], auto_close_seconds=seconds)


@contextmanager
def busy(client: viser.ClientHandle, title: str, size: int) -> Iterator[Callable[[str], None]]:
    """Say at once that something large is being read; give ``say(what)``, which says what comes next.

    Parameters
    ----------
    client : viser.ClientHandle
        Whose page says it.
    title : str
        Above.
    size : int
        Bytes; what is small is over before anybody has read a word.
    """
    if size < _LARGE:
        yield lambda what: None
        return
    shown = client.add_notification(title, "", loading=True, with_close_button=False, auto_close_seconds=None)
    client.flush()

    def say(what: str) -> None:
        shown.body = what
        client.flush()

    try:
        yield say
    finally:
        shown.remove()


@contextmanager
def told(client: viser.ClientHandle, title: str, otherwise: Callable[[], None]) -> Iterator[None]:
    """Tell what is wrong with an input, or why a file cannot be stored, and do something else instead."""
    try:
        yield
    except InputError as error:
        tell(client, title, fault_lines(error))
        otherwise()
    except OSError as error:
        tell(client, title, [error.strerror or without_folders(str(error))])
        otherwise()


def note(lines: Iterable[str], tone: Tone) -> str:
    """HTML of a note that stands beside the control it is about; empty without lines."""
    message = Text.joined("<br>", (quoted(line) for line in lines))
    if not message:
        return ""
    ink, ground = _TONES[tone]
    return Text(
        '<div role="note" class="sb-note sb-{tone}" style="margin:0 10px 8px;padding:4px '
        "8px;font-size:13px;line-height:1.35;color:{ink};background:{ground};border-left:3px "
        'solid {ink};border-radius:2px">{shown}</div>',
        tone=tone,
        ink=ink,
        ground=ground,
        shown=message,
    )


def heading(text: str) -> str:
    """HTML of a small heading between controls."""
    return Text(
        '<div style="margin:6px 10px 4px;font-size:13px;font-weight:600;color:{ink}">{text:html}</div>',
        ink=style.INK,
        text=text,
    )


def small(text: str) -> str:
    """HTML of a line of secondary text."""
    return Text(
        '<div style="margin:0 10px 8px;font-size:13px;line-height:1.35;color:{muted}">{text:html}</div>',
        muted=style.MUTED,
        text=text,
    )


def refusal(
    fault: Fault, kept: str = "", field: str = "", entered: object = None, *, typed: bool = False
) -> str:
    """One fault in words, for a reader who looks at a control.

    Parameters
    ----------
    fault : Fault
        What is wrong.
    kept : str
        The value that stays in force.
    field : str
        The control's own field, dotted. Where the fault is in another field, both are named.
    entered : object
        What the control was given.
    typed : bool
        It is a text that was typed for a number: it stands in quotation marks, so that a blank is seen.

    Returns
    -------
    str
        The value, what it must be, what is kept.
    """
    remedy = Text("{allowed} ({kept} is kept)", allowed=fault.allowed, kept=kept) if kept else fault.allowed
    if field and fault.field and not f"{field}.".startswith(f"{fault.field}."):
        other = fault.field if fault.value is None else f"{fault.field} = {_excerpt(fault.value)}"
        return Text(
            "{shown} does not go with {other}: {told}", shown=_excerpt(entered), other=other, told=remedy
        )
    if fault.value is None:
        return remedy
    shown = _excerpt(repr(fault.value) if typed else fault.value)
    return Text("{shown} was refused: {told}", shown=shown, told=remedy)


def fault_lines(error: InputError) -> list[str]:
    """Faults of an error, one line each."""
    return [str(fault) for fault in for_a_page(error).faults]


def _excerpt(value: object) -> str:
    text = f"{value:.6g}" if isinstance(value, float) else str(value)
    return text if len(text) <= 40 else text[:37] + "..."
