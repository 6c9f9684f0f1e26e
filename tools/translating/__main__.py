"""``make languages``: bring the catalogues up to date with the texts, and compile them.

A new text is added without a translation, one that has gone is dropped. What has no translation is printed;
with ``--missing`` nothing is written.
"""

import json
import re
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from babel.messages.catalog import Catalog, Message
from babel.messages.mofile import write_mo
from babel.messages.pofile import read_po, write_po

from schuler_bench.languages.wording import DOMAIN, FOLDER
from schuler_bench.views import load
from tools.translating.extract import Text, script_texts, texts

_NAMED = re.compile(r"\{[a-z][^{}]*\}")
LANGUAGES = ("zh_CN",)
_HEADER = """\
# Texts of Schuler Bench for readers of {language}. Written by `make languages`; the translations are ours.
"""


def po_path(language: str) -> Path:
    """Catalogue of a language; ``language`` as gettext names it."""
    return FOLDER / language / "LC_MESSAGES" / f"{DOMAIN}.po"


def script_path(language: str) -> Path:
    """Script with the words that the page's own scripts need."""
    return FOLDER / "static" / f"{language.replace('_', '-')}.js"


def read(language: str) -> Catalog:
    """Read a catalogue; an empty one when there is none."""
    path = po_path(language)
    if not path.exists():
        return Catalog(locale=language)
    with path.open("rb") as file:
        return read_po(file, locale=language)


def updated(old: Catalog, found: list[Text], language: str) -> Catalog:
    """Catalogue of all texts that need a translation or have one, with the translations there are."""
    new = Catalog(
        locale=language,
        project="Schuler Bench",
        version="1",
        header_comment=_HEADER.format(language=language),
    )
    new.revision_date = new.creation_date = old.creation_date
    for text in found:
        message = old.get(text.key)
        said = "" if message is None else _said(message)
        if text.prose or said:
            where: Any = [(text.where.partition(":")[0], None)]  # a line number would change with every edit
            key, string = ((text.key, text.many), (said,)) if text.many else (text.key, said)
            new.add(key, string, locations=where, flags=["python-brace-format"] * ("{" in text.key))
    return new


def _said(message: Message) -> str:
    """Translation of a message; Chinese has one form for any number."""
    return message.string if isinstance(message.string, str) else (message.string or ("",))[0]


def _key(message: Message) -> str:
    return message.id if isinstance(message.id, str) else message.id[0]


def translations(catalog: Catalog) -> dict[str, str]:
    """Each text that has a translation, by its form for one, with the translation."""
    return {_key(message): _said(message) for message in catalog if message.id and _said(message)}


def script(catalog: Catalog, language: str) -> str:
    """The words that scripts need, as a script.

    What they write themselves, what viser's page says, the titles of the tabs and of their modes, and the
    names of what the 3D view shows.
    """
    tabs = {name for kind in load() for name in (kind.title, kind.mode, kind.tab)}
    wanted = tabs | {text.key for text in script_texts()}
    said = dict(
        _positional(key, said) for key, said in translations(catalog).items() if key != said and key in wanted
    )
    words = json.dumps({language.replace("_", "-"): said}, ensure_ascii=False, indent=1)
    return f"// Written by `make languages` from {DOMAIN}.po.\nwindow.schuler.words = {words};\n"


def _positional(key: str, said: str) -> tuple[str, str]:
    """Number the values of a template, by which the page's script finds them in a text."""
    for number, mark in enumerate(dict.fromkeys(_NAMED.findall(key))):
        key, said = key.replace(mark, f"{{{number}}}"), said.replace(mark, f"{{{number}}}")
    return key, said


def missing(found: list[Text], said: Mapping[str, str]) -> list[str]:
    """List the texts without a translation, each with its place; the page shows them in English."""
    return [f"{text.where}: {text.key}" for text in found if text.prose and not said.get(text.key)]


def main() -> None:
    """Carry out the command."""
    found = texts()
    for language in LANGUAGES:
        catalog = updated(read(language), found, language)
        left = missing(found, translations(catalog))
        print("\n".join(left))
        if "--missing" in sys.argv:
            continue
        path = po_path(language)
        path.parent.mkdir(parents=True, exist_ok=True)
        with path.open("wb") as file:
            write_po(file, catalog, width=120, sort_by_file=False, include_lineno=False)
        with path.with_suffix(".mo").open("wb") as file:
            write_mo(file, catalog)
        script_path(language).write_text(script(catalog, language), encoding="utf-8")
        print(f"{language}: {len(catalog)} texts, {len(left)} without a translation")


if __name__ == "__main__":
    main()
