"""Fonts of the pictures that matplotlib draws: those for English, and for Chinese names."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache
from typing import Any

CHINESE_FONTS = (
    *("Noto Sans CJK SC", "Source Han Sans SC", "Microsoft YaHei", "PingFang SC", "WenQuanYi Micro Hei"),
    *("Noto Sans CJK JP", "Noto Serif CJK SC", "Noto Serif CJK JP", "SimHei"),
)
"""Fonts with what DejaVu Sans lacks; of a collection, matplotlib may see only the first (JP)."""


@lru_cache(maxsize=1)
def installed_chinese() -> tuple[str, ...]:
    """Those of `CHINESE_FONTS` that this computer has."""
    from matplotlib.font_manager import fontManager

    known = {font.name for font in fontManager.ttflist}
    return tuple(name for name in CHINESE_FONTS if name in known)


@contextmanager
def picture_fonts(settings: dict[Any, Any]) -> Iterator[None]:
    """Let matplotlib draw with these settings, and Chinese characters with a font that has them.

    Where no such font is installed, a PNG shows boxes. An SVG holds text, which the reader's fonts show.
    """
    import matplotlib

    fonts: dict[Any, Any] = {"font.family": ["DejaVu Sans", *installed_chinese(), "sans-serif"]}
    with matplotlib.rc_context(settings | fonts), warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Glyph .* missing from")
        yield
