"""A user's law as a Functional Mock-up Unit for co-simulation (FMI 2.0 or 3.0), run by FMPy.

The unit has variables with the names of an exported law's inputs and outputs (`navcore.law.called.Given`,
`navcore.law.hosted.Commands`). What it does not have is not given, or is 0.
"""

from __future__ import annotations

import math
import tempfile
import weakref
from pathlib import Path
from typing import Any, ClassVar, NamedTuple

from navcore.damping import KINDS
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.law.called import Given
from navcore.law.hosted import Commands, Hosted, Start, Step, UserLaw

_NEEDED = ("v_star_e_mps", "v_star_n_mps")
_WHOLE = ("Int", "UInt", "Integer", "Boolean")


class _Port(NamedTuple):
    """A variable of the unit."""

    kind: str  # type of the interface, such as Float64
    reference: int

    def set(self, unit: Any, value: float) -> None:
        """Give it a value."""
        number = int(value) if self.kind.startswith(_WHOLE) else float(value)
        getattr(unit, f"set{self.kind}")([self.reference], [number])

    def get(self, unit: Any) -> float:
        """Read its value."""
        return float(getattr(unit, f"get{self.kind}")([self.reference])[0])


class _Unit(NamedTuple):
    """A unit that was unpacked."""

    model: Any  # FMPy's description
    folder: str
    inputs: dict[str, _Port]
    outputs: dict[str, _Port]
    step_s: float  # that it needs; 0: any

    def started(self, at: Start) -> Step:
        """Return one instance, at its beginning."""
        unit = self._instance()
        unit.enterInitializationMode()
        for name in at._fields:
            if name in self.inputs:
                self.inputs[name].set(unit, getattr(at, name))
        unit.exitInitializationMode()
        calls = [0]

        def step(given: Given) -> Commands:
            for name, port in self.inputs.items():
                port.set(unit, getattr(given, name))
            unit.doStep(calls[0] * at.step_s, at.step_s)
            calls[0] += 1
            found: dict[str, Any] = {name: port.get(unit) for name, port in self.outputs.items()}
            if "damped" in found:
                found["damped"] = found["damped"] > 0.5
            return Commands(**found)

        weakref.finalize(step, _ended, unit)
        return step

    def _instance(self) -> Any:
        from fmpy.fmi2 import FMU2Slave
        from fmpy.fmi3 import FMU3Slave

        kind = FMU3Slave if self.model.fmiVersion.startswith("3") else FMU2Slave
        unit: Any = kind(
            guid=self.model.guid,
            unzipDirectory=self.folder,
            modelIdentifier=self.model.coSimulation.modelIdentifier,
            instanceName="law",
        )
        unit.instantiate()
        if kind is FMU2Slave:
            unit.setupExperiment(startTime=0.0)
        return unit


def _ended(unit: Any) -> None:
    unit.terminate()
    unit.freeInstance()


def fmu_law(path: str | Path, id: str = "", help: str = "") -> type[UserLaw]:
    """Make a law of a Functional Mock-up Unit with the variables of an exported law (docs/export.md).

    Parameters
    ----------
    path : str or Path
        The unit, for co-simulation, FMI 2.0 or 3.0, with a binary for this machine.
    id : str
        Name in scenarios; by default that of the file.
    help : str
        What it does, in one clause.

    Returns
    -------
    type
        To be given to `navcore.register`. Each run has an instance of its own. A unit is code: it runs with
        the rights of the program.

    Raises
    ------
    InputError
        FMPy is not installed, or the unit cannot be read, is not for co-simulation, has no binary for this
        machine, or lacks an output.
    """
    file = Path(path).resolve()
    unit = _unpacked(file)
    name = id or file.stem

    class FmuLaw(UserLaw):
        """A law in a Functional Mock-up Unit."""

        law_file: ClassVar[str] = str(file)

        def start(self, at: Start) -> Step:
            """Return an instance of the unit for one run."""
            return unit.started(at)

        def host(self, at: Start) -> Hosted:
            """Return the law for one run; raises `InputError` where its rate is another one."""
            if unit.step_s and not math.isclose(unit.step_s, at.step_s, rel_tol=1e-9):
                why = Text(
                    "runs at a step of {own:g} s and is called every {here:g} s: set run.step_s, or export "
                    "it for {rate:g} Hz",
                    own=unit.step_s,
                    here=at.step_s,
                    rate=1.0 / at.step_s,
                )
                raise _refused(file, why)
            return Hosted(self, at)

        def __reduce__(self) -> Any:
            """Be found by its file in another process, where `navcore.extending.baggage` registers it."""
            return _settings_of, (str(file), name)

    FmuLaw.id, FmuLaw.help = name, help or Text("the unit in {file}", file=file.name)
    FmuLaw.speed = Text("the law runs in a unit (FMU), which takes some ten microseconds a call")
    FmuLaw.__qualname__ = f"FmuLaw({file})"
    return FmuLaw


def _settings_of(path: str, id: str) -> UserLaw:
    known = KINDS.get(id)
    found = known.settings if known is not None else None
    return found() if getattr(found, "law_file", "") == path else fmu_law(path, id)()  # pyright: ignore


def _unpacked(file: Path) -> _Unit:
    """Read a unit; what it holds lies in a folder of its own until the program ends."""
    try:
        import fmpy
    except ImportError:
        raise _refused(file, Text("needs FMPy, which is not installed: pip install fmpy")) from None
    try:
        model = fmpy.read_model_description(str(file))
    except Exception as error:  # of a ZIP, of XML, of the standard's schema
        raise _refused(file, Text("is no unit that can be read: {error}", error=str(error))) from error
    if model.coSimulation is None:
        raise _refused(file, Text("must be for co-simulation"))
    if fmpy.platform not in fmpy.supported_platforms(str(file)) and not _has_binary(file, model):
        why = Text("has no binary for this machine ({machine})", machine=fmpy.platform_tuple)
        raise _refused(file, why)
    folder = tempfile.TemporaryDirectory(prefix="schuler-fmu-")
    weakref.finalize(model, folder.cleanup)
    fmpy.extract(str(file), folder.name)
    ports = {
        causality: {
            one.name: _Port(one.type, one.valueReference)
            for one in model.modelVariables
            if one.causality == causality and one.name in names
        }
        for causality, names in (("input", Given._fields), ("output", Commands._fields))
    }
    for name in _NEEDED:
        if name not in ports["output"]:
            raise _refused(file, Text("must have the output {name}", name=name))
    fixed = getattr(model.coSimulation, "fixedInternalStepSize", None)
    variable = model.coSimulation.canHandleVariableCommunicationStepSize
    step_s = 0.0 if variable or fixed is None else float(fixed)
    return _Unit(model, folder.name, ports["input"], ports["output"], step_s)


def _has_binary(file: Path, model: Any) -> bool:
    """Whether a unit holds a binary of this machine by the names of FMI 3."""
    import zipfile

    import fmpy

    with zipfile.ZipFile(file) as archive:
        wanted = f"binaries/{fmpy.platform_tuple}/{model.coSimulation.modelIdentifier}"
        return any(name.startswith(wanted) for name in archive.namelist())


def _refused(file: Path, why: str) -> InputError:
    return InputError(Fault(file.name, "", None, why))
