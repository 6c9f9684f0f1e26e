"""The texts in viser's messages: each page is sent them in its language, and what it chooses is read back.

The program writes English and knows nothing of a page's language. viser has no hook for what it sends; a
page's queue of messages is ours (`schuler_bench.bridge.mends`), and every message of the page passes it.
"""

import dataclasses
from collections.abc import Callable, Mapping
from typing import Any, Protocol, cast

import msgspec
from viser import _messages as messages

from navcore.foundation.text import Text

Say = Callable[[str], str]


class Language(Protocol):
    """A language as a page needs it."""

    name: str

    def text(self, text: str, names: frozenset[str] = ...) -> str:
        """Translate a text, HTML or not, in which these names stay as they are."""
        ...


_TEXTS = frozenset({"label", "hint", "title", "body", "description", "text", "content", "_markdown"})
"""Fields of viser's messages that hold a text."""
_LISTS = frozenset({"options", "_tab_labels"})
_PLOTLY, _UPLOT = "_plotly_json_str", frozenset({"series", "axes"})
_KNOWN = _TEXTS | _LISTS | _UPLOT | {_PLOTLY}
_PLOTLY_TEXTS = frozenset({"text", "name", "title", "hovertext", "hovertemplate", "ticktext", "label"})
_UPLOT_TEXTS = frozenset({"label", "values"})


class Translator:
    """Translates the messages to one page.

    Parameters
    ----------
    language : Language
        Of the page.

    Attributes
    ----------
    names : callable
        ``names()``: what users have called something, which stays as they wrote it.
    """

    def __init__(self, language: Language) -> None:
        self.name, self._language = language.name, language
        self.names: Callable[[], frozenset[str]] = frozenset
        self._meant: dict[str, dict[str, str]] = {}

    def text(self, text: str) -> str:
        """Return a text with its translation."""
        return self._language.text(text, self.names())

    def _say_label(self, label: str) -> str:
        """Translate what a control is called: it may hold a name, but is none."""
        names = self.names()
        return self._language.text(label, names - {label})

    def message(self, message: messages.Message) -> messages.Message:
        """Return a message to the page with its texts translated; the message itself stays as it is.

        viser's handles hold the same objects as its messages.
        """
        props = getattr(message, "props", None)
        if props is None:
            if not isinstance(message, (messages.GuiUpdateMessage, messages.SceneNodeUpdateMessage,
                                        messages.CommandUpdateMessage)):  # fmt: skip
                return message
            updates = self._fields(getattr(message, "uuid", ""), message.updates)
            return (
                dataclasses.replace(message, updates={**message.updates, **updates}) if updates else message
            )
        held = {name: getattr(props, name) for name in _names(type(props))}
        changed = self._fields(getattr(message, "uuid", ""), held)
        fresh = {"props": dataclasses.replace(props, **changed)} if changed else {}
        value = getattr(message, "value", None)
        if "options" in held and isinstance(value, str):
            fresh["value"] = self._label_of(message.uuid, value)  # pyright: ignore[reportAttributeAccessIssue]
        return dataclasses.replace(cast("Any", message), **fresh) if fresh else message

    def meant(self, uuid: str, value: object) -> object:
        """Return the English option behind what was chosen on the page; any other value as it is."""
        options = self._meant.get(uuid)
        return str(options.get(value, value)) if options is not None and isinstance(value, str) else value

    def _label_of(self, uuid: str, value: str) -> str:
        return next((label for label, meant in self._meant.get(uuid, {}).items() if meant == value), value)

    def _fields(self, uuid: str, fields: Mapping[str, Any]) -> dict[str, Any]:
        """Translate those fields that hold texts; only what has changed is returned."""
        changed: dict[str, Any] = {}
        for name, value in fields.items():
            if name not in _KNOWN or not value:  # the points of a line, say, have no truth value
                continue
            if name == "label" and isinstance(value, str):
                changed[name] = self._say_label(value)
            elif name in _TEXTS and isinstance(value, str):
                changed[name] = self.text(value)
            elif name == "options":
                changed[name] = self._offer(uuid, value)
            elif name in _LISTS:
                changed[name] = tuple(self._say_label(text) for text in value)
            elif name == _PLOTLY:
                changed[name] = self.figure(value)
            elif name in _UPLOT:
                changed[name] = tuple(self._uplot(part) for part in value)
        if "value" in fields and "options" not in fields and uuid in self._meant:
            changed["value"] = self._label_of(uuid, fields["value"])
        elif "value" in fields and "options" in fields:
            changed["value"] = self._label_of(uuid, fields["value"])
        return {name: value for name, value in changed.items() if value != fields[name]}

    def _offer(self, uuid: str, options: tuple[str, ...]) -> tuple[str, ...]:
        meant: dict[str, str] = {}
        for option in options:
            said = self.text(option)
            meant[option if said in meant else said] = option
        self._meant[uuid] = meant
        return tuple(meant)

    def figure(self, figure: str) -> str:
        """Return a plotly figure (JSON) with its texts translated."""
        texts: Mapping[str, Text] = getattr(figure, "texts", {})
        return msgspec.json.encode(self._walk(msgspec.json.decode(str(figure)), texts)).decode()

    def _walk(self, part: Any, texts: Mapping[str, Text], is_text: bool = False) -> Any:
        if isinstance(part, dict):
            return {
                name: self._walk(value, texts, name in _PLOTLY_TEXTS or (is_text and name == "text"))
                if name != "meta"
                else self._meta(value, texts)
                for name, value in part.items()
            }
        if isinstance(part, list):
            if part and isinstance(part[0], (int, float)):
                return part
            return [self._walk(one, texts, is_text) for one in part]
        return self.text(texts.get(part, part)) if is_text and isinstance(part, str) else part

    def _meta(self, meta: Any, texts: Mapping[str, Text]) -> Any:
        """Of what a figure tells our scripts only ``told`` is for a reader."""
        words = meta.get("told") if isinstance(meta, dict) else None
        return {**meta, "told": self.text(texts.get(words, words))} if words else meta

    def _uplot(self, part: Mapping[str, Any]) -> dict[str, Any]:
        labels = {name: part[name] for name in _UPLOT_TEXTS & part.keys()}
        said = {
            name: self.text(value) if isinstance(value, str) else tuple(map(self.text, value))
            for name, value in labels.items()
            if isinstance(value, str) or all(isinstance(one, str) for one in value)
        }
        return {**part, **said}


def _names(kind: type) -> tuple[str, ...]:
    return tuple(entry.name for entry in dataclasses.fields(kind) if entry.name in _KNOWN)


def speak(server: Any, client_id: int, language: Language | None) -> None:
    """Translate all that goes to a page from now on; None: it reads English."""
    buffer = server._websock_server._client_state_from_id[client_id].message_buffer
    buffer.translator = None if language is None else Translator(language)


def keep_names(client: Any, names: Callable[[], frozenset[str]]) -> None:
    """Let a page's texts have these names in them as users wrote them, in whatever language it is."""
    translator = _translator(client)
    if translator is not None:
        translator.names = names


def meant(server: Any, client_id: int, uuid: str, value: object) -> object:
    """Return what a page's value for a control means in English (`Translator.meant`)."""
    state = server._websock_server._client_state_from_id.get(client_id)
    translator: Translator | None = None if state is None else state.message_buffer.translator
    return value if translator is None else translator.meant(uuid, value)


def language_of(client: Any) -> str:
    """Language of a page, as a browser tells it."""
    translator = _translator(client)
    return "en" if translator is None else translator.name


def figure_said(client: Any, figure: str) -> str:
    """Return a plotly figure (JSON) in a page's language, where it stands in HTML of ours."""
    translator = _translator(client)
    return str(figure) if translator is None else translator.figure(figure)


def text_said(client: Any, text: str) -> str:
    """Return a text, HTML or not, in a page's language, where no message of viser carries it as such."""
    translator = _translator(client)
    return text if translator is None else translator.text(text)


def _translator(client: Any) -> Translator | None:
    return client._websock_connection.get_message_buffer().translator
