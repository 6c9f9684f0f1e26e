"""Sphinx extension: formulas become MathML while the site is built, so that a page needs no network."""

from __future__ import annotations

import re
from html import escape
from typing import Any

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.util import logging

# Without a font for mathematics a browser stretches no fence, and spaces a bar as an operator.
_MENDED = (
    (re.compile(r"<mo>&#x0005B;</mo><mtable>(.*?</mtable>)<mo>&#x0005D;</mo>"), r'<mtable class="matrix">\1'),
    (re.compile(r"<mo [^>]*>&#x0007B;</mo><mtable>"), '<mtable class="cases">'),
    (re.compile(r"<mo>(&#x0007C;|&#x02016;)</mo>"), r'<mo lspace="0" rspace="0">\1</mo>'),
)
_TAG = re.compile(r"\\tag\{(\w+)\}")
_logger = logging.getLogger(__name__)


def mathml(latex: str, *, block: bool) -> str:
    r"""A formula as MathML.

    ``aligned`` is not known to latex2mathml; it becomes an array of right and left aligned columns.

    Raises
    ------
    ValueError
        A command is not known (latex2mathml writes it out as a word).
    """
    latex = re.sub(r"\\begin\{aligned\}", r"\\begin{array}{rlrl}", latex).replace(
        r"\end{aligned}", r"\end{array}"
    )
    converted = convert(latex.strip(), display="block" if block else "inline")
    for pattern, replacement in _MENDED:
        converted = pattern.sub(replacement, converted)
    unknown = re.search(r"\\[A-Za-z]+", converted)
    if unknown:
        raise ValueError(f"unknown LaTeX command {unknown[0]} in: {latex}")
    return converted


def _converted(node: nodes.Node, *, block: bool) -> tuple[str, str]:
    """MathML of a node, and its equation number."""
    latex = node.astext()
    tag = _TAG.search(latex)
    try:
        return mathml(_TAG.sub("", latex), block=block), tag[1] if tag else ""
    except ValueError as error:
        _logger.warning("%s", error, location=node)
        return escape(latex), ""


def _inline(translator: Any, node: nodes.math) -> None:
    translator.body.append(_converted(node, block=False)[0])
    raise nodes.SkipNode


def _block(translator: Any, node: nodes.math_block) -> None:
    formula, number = _converted(node, block=True)
    ids = "".join(f'<span id="{escape(name)}"></span>' for name in node.get("ids", ()))
    shown = f'<span class="equation-number">({number})</span>' if number else ""
    translator.body.append(f'<div class="equation">{ids}<div>{formula}</div>{shown}</div>\n')
    raise nodes.SkipNode


def setup(app: Any) -> dict[str, bool]:
    """Register the renderer and make it the one that is used."""
    app.add_html_math_renderer("mathml", inline_renderers=(_inline, None), block_renderers=(_block, None))
    app.config.html_math_renderer = "mathml"
    return {"parallel_read_safe": True, "parallel_write_safe": True}
