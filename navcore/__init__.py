"""navcore: the physics of damped inertial navigation systems.

The contract, stated once for the whole package:

- **Frames.** The navigation frame n is east, north, up (ENU). The body frame b is right (starboard),
  forward, up. Pitch about x (bow up positive), roll about y (starboard down positive), heading clockwise from
  true north: ``C_b^n = Rz(-heading) Rx(pitch) Ry(roll)``.
- **Errors.** The computed attitude is ``C~ = (I - [phi x]) C`` with ``phi = [phi_E, phi_N, phi_U]``. Sensor
  errors are measured minus true; errors of velocity and position are computed minus true.
- **Units.** SI and radians everywhere. Other units exist only at the edges (scenario fields, screens, files);
  their factors are in `navcore.foundation.units`.
- **Arrays.** Time is the first axis: a series of n vectors has shape (n, 3).
- **Time.** t = 0 s is the start of navigation. A sensor sample is the mean over the interval that ends at its
  time.
- **Randomness.** Every random number comes from a generator seeded by the scenario and keyed by the sensor
  it feeds, so that the order in which methods run cannot change it.

Data flows one way: scenario -> truth -> sensors (made once, shared by all methods) -> mechanization with the
control law -> run -> metrics, figures, files.

Examples
--------
>>> from navcore import load, simulate
>>> run = simulate(load("zha-fast", ["run.duration_h=0.5"]))
>>> [(m.method.name, m.status) for m in run.methods]
[('free', 'ok'), ('classic2', 'ok'), ('fast (compass)', 'ok')]
"""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable

    from navcore.design.budget import Budget, budget
    from navcore.design.designs import designs
    from navcore.design.dominance import Why, why
    from navcore.design.fronts import Pareto
    from navcore.design.judged import Designs
    from navcore.design.pareto import pareto
    from navcore.design.tune import tune
    from navcore.design.tuned import Tuned
    from navcore.design.worst.result import Worst
    from navcore.engine.measures import metrics
    from navcore.engine.run import MethodRun, Run
    from navcore.engine.simulation import simulate
    from navcore.engine.verification import Verification, verify
    from navcore.exporting.exported import Exported, Packed
    from navcore.extending.c_law import c_law
    from navcore.extending.fmu_law import fmu_law
    from navcore.extending.register import register
    from navcore.fitting.imu import FittedImu
    from navcore.fitting.recorded import FittedLog
    from navcore.foundation.errors import Fault, InputError
    from navcore.foundation.version import __version__
    from navcore.networks import parse_network
    from navcore.networks.from_control import from_control
    from navcore.questions.report import Report
    from navcore.questions.run import Ran
    from navcore.scenario.file import load, presets
    from navcore.scenario.model import Scenario
    from navcore.study.studied import Studied

    export: Callable[..., Exported | Packed]
    fit: Callable[..., FittedLog | FittedImu]
    report: Callable[..., Report]
    run: Callable[..., Ran]
    run_study: Callable[..., Studied]
    worst: Callable[..., Worst]


__all__ = [
    "Budget",
    "Designs",
    "Fault",
    "InputError",
    "MethodRun",
    "Pareto",
    "Run",
    "Scenario",
    "Tuned",
    "Verification",
    "Why",
    "__version__",
    "budget",
    "c_law",
    "designs",
    "export",
    "fit",
    "fmu_law",
    "from_control",
    "load",
    "metrics",
    "pareto",
    "parse_network",
    "presets",
    "register",
    "report",
    "run",
    "run_study",
    "simulate",
    "tune",
    "verify",
    "why",
    "worst",
]

_HOME = {
    "Budget": "design.budget",
    "Pareto": "design.fronts",
    "Tuned": "design.tuned",
    "Designs": "design.judged",
    "Fault": "foundation.errors",
    "InputError": "foundation.errors",
    "MethodRun": "engine.run",
    "Run": "engine.run",
    "Scenario": "scenario.model",
    "Verification": "engine.verification",
    "Why": "design.dominance",
    "__version__": "foundation.version",
    "from_control": "networks.from_control",
    "load": "scenario.file",
    "metrics": "engine.measures",
    "parse_network": "networks",
    "presets": "scenario.file",
    "c_law": "extending.c_law",
    "fmu_law": "extending.fmu_law",
    "register": "extending.register",
    "simulate": "engine.simulation",
}


def __getattr__(name: str) -> Any:
    """Import a public name when it is first used: the package itself must load in no time."""
    if name.startswith("_") and name not in _HOME:
        raise AttributeError(f"module 'navcore' has no attribute {name!r}")
    from navcore.extending.plugins import load_plugins

    for fault in load_plugins():
        from warnings import warn

        warn(str(fault), stacklevel=2)
    if name in _HOME:
        from importlib import import_module

        return getattr(import_module(f"navcore.{_HOME[name]}"), name)
    from navcore.questions.functions import FUNCTIONS

    if name in FUNCTIONS:
        return FUNCTIONS[name]
    raise AttributeError(f"module 'navcore' has no attribute {name!r}")


def __dir__() -> list[str]:
    """Public names, those that are loaded when they are used included."""
    return [*__all__]
