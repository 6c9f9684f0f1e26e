"""Errors that a Kalman filter is not told of: its response to each, along a run (theory.md 16).

On the linear model the filter's gains depend on the truth and on what it is told, not on the errors. Its true
error is therefore that of its own covariance and the response to each further error, which is a run with this
error alone, from a start without error.
"""

import numpy as np

from navcore.design.seeds import alone
from navcore.design.sources import only
from navcore.engine.drivers.kalman import Gains
from navcore.engine.drivers.linear import carried_out
from navcore.engine.environment import environment
from navcore.foundation.text import Text
from navcore.mechanization.recorder import QUANTITIES
from navcore.quantities import COMPONENTS
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.sensors.rounding import DITHERED


def untold_errors(scenario: Scenario, method: Method, t_s: np.ndarray) -> dict[str, np.ndarray]:
    """Response of the filter to each error of a known shape, by source; they add up with their signs.

    Parameters
    ----------
    scenario : Scenario
        Complete and checked; of a strapdown one the error model along its motion.
    method : Method
        With a Kalman filter.
    t_s : ndarray, shape (m,)
        Times, s.

    Returns
    -------
    dict of ndarray, shape (m, 7)
        Errors for `navcore.quantities.COMPONENTS`.
    """
    told = alone(scenario, method)
    step_s = told.run.step_s
    every = told.run.model_copy(update={"output_step_s": step_s})
    told = told.model_copy(update={"run": every})
    parts = [part for part in (*told.imu.all_parts(), *told.reference.all_parts()) if part.has_shape]
    if told.reference.kind == "log":  # rounding that no noise averages out
        parts += [part for part in told.reference.all_parts() if told.reference.dither < DITHERED * part.lsb]
    labels = {part.label: part.source for part in parts}
    if method.event:
        labels.setdefault(Text("log events"), "log_events")
    gains, errors = Gains(), {}
    for label, source in labels.items():
        quiet = only(told, label)
        env = environment(quiet)
        run, *_ = carried_out(
            told, quiet.method[0], env, np.zeros(len(COMPONENTS)), lambda _: None, None, gains
        )
        rows = run.recorder.rows[: int(run.recorder.cursor["row"]), :QUANTITIES]
        at = np.minimum(np.rint(t_s / step_s).astype(int), len(rows) - 1)
        errors[source] = rows[at, : len(COMPONENTS)]
    return errors
