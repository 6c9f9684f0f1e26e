"""Sphinx configuration. The pages are staged by `docs.site.stage`; everything works without a network."""

from __future__ import annotations

import re
from types import GenericAlias

from navcore.foundation.version import __version__

project = "Schuler Bench"
author = "Schuler Bench developers"
copyright = author  # noqa: A001
release = version = __version__
extensions = ["myst_nb", "sphinx.ext.autodoc", "numpydoc", "docs.site.mathml"]

html_theme = "furo"
html_title = project
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_copy_source = False

myst_enable_extensions = ["dollarmath", "colon_fence"]
myst_heading_anchors = 4
myst_dmath_double_inline = True

nb_execution_mode = "force"
nb_execution_raise_on_error = True
nb_execution_timeout = 120
nb_merge_streams = True

default_role = "code"
add_module_names = False
autodoc_typehints = "none"
autodoc_member_order = "bysource"
autodoc_default_options = {"members": True, "show-inheritance": True, "ignore-module-all": True}
autodoc_class_signature = "mixed"
numpydoc_show_class_members = False
numpydoc_xref_param_type = False
# One name in two modules (a type imported where it is used) is no reason to stop.
suppress_warnings = ["ref.python", "misc.highlighting_failure"]

_LITERAL = re.compile(r"(``.*?``|`[^`]*`)")


def escape_bars(app, what, name, obj, options, lines: list[str]) -> None:
    """Let |V_r - V_c| in a docstring be the magnitude that it is, not a substitution of reStructuredText."""
    for i, line in enumerate(lines):
        parts = _LITERAL.split(line)
        lines[i] = "".join(p if k % 2 else re.sub(r"(?<!\\)\|", r"\\|", p) for k, p in enumerate(parts))


def skip_inherited(app, what, name, obj, skip, options) -> bool | None:
    """Leave out what every parameter model has from pydantic, and names that only abbreviate a type."""
    return True if name.startswith("model_") or isinstance(obj, GenericAlias) else None


def setup(app) -> None:
    """Connect the two handlers above."""
    app.connect("autodoc-process-docstring", escape_bars)
    app.connect("autodoc-skip-member", skip_inherited)
