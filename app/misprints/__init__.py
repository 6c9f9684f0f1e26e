"""Misprint laboratory: each printed error that changes a result, computed as printed and corrected.

The rows of theory.md section 8; a new one is an entry in its paper's file. Nothing is typed in: both curves
come from the networks, loops, filters and error model that everything else runs on.
"""

from app.misprints.base import Axis, Comparison, Curve, Misprint, Number
from app.misprints.deng import DENG
from app.misprints.liu import LIU
from app.misprints.sun import SUN
from app.misprints.zha import ZHA
from app.misprints.zhao import ZHAO

MISPRINTS: dict[str, Misprint] = {item.id: item for item in (*DENG, *LIU, *ZHAO, *SUN, *ZHA)}
"""All misprints by id, paper by paper in the order of theory.md section 8."""

__all__ = ["MISPRINTS", "Axis", "Comparison", "Curve", "Misprint", "Number"]
