"""Tables of the written documents."""

from collections.abc import Iterable, Sequence


def markdown_table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Write a table in Markdown, a line a row, without a line end after the last.

    Parameters
    ----------
    head : sequence of str
        Titles of the columns.
    rows : iterable of sequence of str
        Cells, as many as the titles.

    Examples
    --------
    >>> print(markdown_table(["field", "unit"], [["xi", "-"]]))
    | field | unit |
    |---|---|
    | xi | - |
    """
    first, *others = (f"| {' | '.join(cells)} |" for cells in (head, *rows))
    return "\n".join([first, "|" + "---|" * len(head), *others])
