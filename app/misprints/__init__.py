"""Misprint laboratory: each printed error that changes a result, computed as printed and corrected.

The rows of theory.md section 8; a new one is an entry in its paper's file. Nothing is typed in: both curves
come from the networks, loops, filters and error model that everything else runs on.
"""

from schuler_bench.misprints.base import Axis, Comparison, Curve, Misprint, Number
from schuler_bench.misprints.deng import DENG
from schuler_bench.misprints.liu import LIU
from schuler_bench.misprints.sun import SUN
from schuler_bench.misprints.zha import ZHA
from schuler_bench.misprints.zhao import ZHAO

MISPRINTS: dict[str, Misprint] = {item.id: item for item in (*DENG, *LIU, *ZHAO, *SUN, *ZHA)}
"""All misprints by id, paper by paper in the order of theory.md section 8."""

__all__ = ["MISPRINTS", "Axis", "Comparison", "Curve", "Misprint", "Number"]
