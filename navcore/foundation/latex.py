"""Tables as LaTeX, with the rules of the package booktabs."""

import re
from collections.abc import Sequence

_SIGNS = {
    "\\": r"\textbackslash{}", "&": r"\&", "%": r"\%", "$": r"\$", "#": r"\#", "_": r"\_", "{": r"\{",
    "}": r"\}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}", "<": r"\textless{}",
    ">": r"\textgreater{}",
}  # fmt: skip
_MATHEMATICS = {
    "φ": r"\varphi", "δ": r"\delta", "ζ": r"\zeta", "ξ": r"\xi", "σ": r"\sigma", "ω": r"\omega",
    "ψ": r"\psi", "λ": r"\lambda", "ρ": r"\rho", "τ": r"\tau", "Ω": r"\Omega", "µ": r"\mu", "μ": r"\mu",
    "°": r"^{\circ}", "′": r"{}'", "″": r"{}''", "²": "^{2}", "³": "^{3}", "√": r"\surd", "·": r"\cdot",
    "×": r"\times", "±": r"\pm", "−": "-", "≤": r"\le", "≥": r"\ge", "₀": "_{0}", "₁": "_{1}", "₂": "_{2}",
    "ₛ": r"_{\mathrm{s}}",
}  # fmt: skip

_COMPONENT = re.compile(r"(φ|δV)([ENU])\b")
"""Symbol of an error with its axis."""


def latex_text(text: str) -> str:
    r"""Write a text so that LaTeX prints it as it is.

    Greek letters and signs become mathematics, so that no package for Unicode is needed for them.

    Examples
    --------
    >>> latex_text("50 % of φE at 2σ")
    '50 \\% of $\\varphi_{\\mathrm{E}}$ at 2$\\sigma$'
    """
    signs = {sign: f"${words}$" for sign, words in _MATHEMATICS.items()} | _SIGNS
    parts = _COMPONENT.split(text)  # words, symbol, axis, words, ...
    written = ["".join(signs.get(sign, sign) for sign in one) for one in parts[::3]]
    symbols = ["".join(_MATHEMATICS.get(sign, f" {sign}") for sign in one) for one in parts[1::3]]
    errors = [rf"${one}_{{\mathrm{{{axis}}}}}$" for one, axis in zip(symbols, parts[2::3], strict=True)]
    return "".join(one for pair in zip(written, [*errors, ""], strict=True) for one in pair)


def latex_table(
    title: str, heads: Sequence[Sequence[str]], rows: Sequence[Sequence[str]], left: Sequence[bool]
) -> str:
    r"""Write a table.

    Parameters
    ----------
    title : str
        Stands above it as a comment; empty for none.
    heads, rows : sequence of sequence of str
        Lines of the heading and of the body, a text a cell.
    left : sequence of bool
        Columns of words, which begin at the left.

    Returns
    -------
    str
        A ``tabular``; its document needs ``\usepackage{booktabs}``.
    """
    lines = [f"% {title}"] if title else []
    lines += [rf"\begin{{tabular}}{{{''.join('l' if one else 'r' for one in left)}}}", r"\toprule"]
    lines += [_line(row) for row in heads]
    lines += [r"\midrule", *map(_line, rows), r"\bottomrule", r"\end{tabular}"]
    return "\n".join(lines) + "\n"


def _line(cells: Sequence[str]) -> str:
    return " & ".join(map(latex_text, cells)) + r" \\"
