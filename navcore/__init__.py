"""navcore: the physics of damped inertial navigation systems.

The contract, stated once for the whole package:

- **Frames.** Navigation frame n = east, north, up (ENU). Body frame b = right (starboard), forward, up.
  Pitch about x (bow up positive), roll about y (starboard down positive), heading clockwise from true
  north. ``C_b^n = Rz(-heading) Rx(pitch) Ry(roll)``.
- **Errors.** Computed attitude ``C~ = (I - [phi x]) C`` with ``phi = [phi_E, phi_N, phi_U]``. Sensor errors
are
  measured minus true, velocity and position errors computed minus true.
- **Units.** SI and radians everywhere. Other units exist only at the edges (scenario fields, screens, files);
  their factors live in `navcore.units`.
- **Arrays.** Time is the first axis: a series of n vectors has shape (n, 3).
- **Time.** t = 0 s is the start of navigation. A sensor sample is the mean over the interval that ends at its
  time.
- **Randomness.** Every random number comes from a generator seeded by the scenario and keyed by the sensor
  it feeds, so that the order in which methods run cannot change it.

Data flows one way: scenario -> truth -> sensors (made once, shared by all methods) -> mechanization with the
control law -> run -> metrics, figures, files.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from navcore.errors import Fault, InputError
    from navcore.measures import metrics
    from navcore.network import parse_network
    from navcore.run import MethodRun, Run
    from navcore.scenario import Scenario
    from navcore.scenario_file import load, presets
    from navcore.simulation import simulate
    from navcore.verification import Verification, verify

__version__ = "0.1.0"

__all__ = [
    "Fault",
    "InputError",
    "MethodRun",
    "Run",
    "Scenario",
    "Verification",
    "load",
    "metrics",
    "parse_network",
    "presets",
    "simulate",
    "verify",
]

_HOME = {
    "Fault": "errors",
    "InputError": "errors",
    "MethodRun": "run",
    "Run": "run",
    "Scenario": "scenario",
    "load": "scenario_file",
    "metrics": "measures",
    "parse_network": "network",
    "presets": "scenario_file",
    "simulate": "simulation",
    "Verification": "verification",
    "verify": "verification",
}


def __getattr__(name: str) -> Any:
    """Import a public name when it is first used: the package itself must load in no time."""
    if name not in _HOME:
        raise AttributeError(f"module 'navcore' has no attribute {name!r}")
    from importlib import import_module

    return getattr(import_module(f"navcore.{_HOME[name]}"), name)
