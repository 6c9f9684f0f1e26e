"""The questions in docs/interface.md: ``python -m navcore.questions.page`` writes their section anew.

A test holds the page against the questions, so that no option is missing from it or told wrongly.
"""

from collections.abc import Iterator
from pathlib import Path

from navcore.foundation.markdown import markdown_table
from navcore.foundation.parameters import allowed_range
from navcore.questions import QUESTIONS
from navcore.questions.base import Option, Question, flag_of
from navcore.questions.functions import name_of

PAGE = Path(__file__).resolve().parents[2] / "docs" / "interface.md"
_BEGIN, _END = "<!-- questions: written by `make guide` -->", "<!-- end of the questions -->"
_ALL = {
    "scenario": (("--set KEY=VALUE", "overrides one field of the scenario first; may be repeated"),),
}
_LAST = (("--json", "prints one JSON document"), ("--quiet", "shows no progress bar"))


_FORCE = "lets `{flag}` replace a file that the command has not written, or that was edited since"


def section() -> str:
    """Text between the marks."""
    return "\n\n".join(("", *_parts(), ""))


def written(page: str) -> str:
    """Text of the page with the section as it is now."""
    head, _, rest = page.partition(_BEGIN)
    return f"{head}{_BEGIN}{section()}{_END}{rest.partition(_END)[2]}"


def _parts() -> Iterator[str]:
    for id, question in QUESTIONS.items():
        yield f"### `schuler {id} {question.subject.upper()}`"
        yield f"{question.help} In a notebook: `navcore.{name_of(question)}`."
        rows = [_row(question, one) for one in question.options()]
        out = f"{question.writes} for {question.written}"
        rows += [[f"`{flag}`", "", words] for flag, words in _ALL.get(question.subject, ())]
        rows += (
            [[f"`{flag_of(question.place)} {'FILE' if question.writes == 'file' else 'DIR'}`", "", out]]
            if question.writes
            else []
        )
        if question.writes == "file":
            rows.append(["`--force`", "", _FORCE.format(flag=flag_of(question.place))])
        rows += [[f"`{flag}`", "", words] for flag, words in _LAST]
        yield markdown_table(["option", "default", "meaning"], rows)


def _row(question: type[Question], one: Option) -> list[str]:
    value = "" if one.kind == "flag" else f" {'|'.join(one.choices) or one.metavar}"
    default = "" if one.default in (..., None, ()) or one.kind == "flag" else f"`{one.default}`"
    if one.default is ...:
        default = "required"
    allowed = allowed_range(question.model_fields[one.name]).removeprefix("must be ")
    help = f"{one.help} Allowed: {allowed}." if allowed else one.help
    return [f"`{one.flag}{value}`".replace("|", "\\|"), default, help]


def main() -> None:
    """Write the page."""
    PAGE.write_text(written(PAGE.read_text("utf-8")), "utf-8")


if __name__ == "__main__":
    main()
