"""Sun's double-loop optimisation as a tool: a scenario in, the user's own adaptive damping table out."""

from __future__ import annotations

from navcore.studies.tuning.double_loop import Tuning, sun_scenario, tune
from navcore.studies.tuning.saving import with_table
from navcore.studies.tuning.settings import TuningSettings

__all__ = ["Tuning", "TuningSettings", "sun_scenario", "tune", "with_table"]
