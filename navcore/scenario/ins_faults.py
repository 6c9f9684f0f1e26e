"""Faults of a scenario on the output of a ship's own INS."""

from collections.abc import Iterator

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.networks.known import transfer_at
from navcore.quantities import QUANTITIES
from navcore.scenario.fields import ScenarioFields
from navcore.scenario.own_ins import AS_RECORDED, Ins, TruthFile
from navcore.scenario.requirement import OVER_SEEDS


def ins_faults(scenario: ScenarioFields) -> Iterator[Fault]:
    """Yield what does not go with ``[ins]``, and what needs it."""
    ins, truth = scenario.ins, scenario.truth
    if ins.file is None:
        if ins != Ins():
            yield Fault("", "ins.file", None, Text("is required: the output of the ship's INS"))
        if truth != TruthFile():
            allowed = Text("needs ins.file: the output that is held against it")
            yield Fault("", "truth.file", truth.file, allowed)
        return
    if scenario.run.fidelity != "error_model":
        allowed = Text('must be "error_model" with [ins]: the sensors stay inside the INS')
        yield Fault("", "run.fidelity", scenario.run.fidelity, allowed)
    if scenario.reference.kind == "log":
        allowed = Text('must be "file" with [ins]: the log that was recorded beside it')
        yield Fault("", "reference.kind", "log", allowed)
    yield from _own_law(scenario)
    for i, method in enumerate(scenario.method):
        if method.label() == AS_RECORDED:
            allowed = Text("must differ from the name of the INS's own output")
            yield Fault("", f"method.{i}.name", AS_RECORDED, allowed)
    for i, one in enumerate(scenario.requirement):
        if one.share is not None or one.quantity in OVER_SEEDS:
            allowed = Text(
                "is judged over many seeds, and a recording is one draw: limit a quantity of one run"
            )
            yield Fault("", f"requirement.{i}.quantity", one.quantity, allowed)
    if truth.file is not None:
        return
    if truth != TruthFile():
        yield Fault("", "truth.file", None, Text("is required: the recording of the reference"))
    for i, one in enumerate(scenario.requirement):
        if QUANTITIES[one.quantity].kind is not None:
            allowed = Text(
                "needs [truth]: without a reference a run on [ins] says what damping changes, not how large "
                "the errors are"
            )
            yield Fault("", f"requirement.{i}.quantity", one.quantity, allowed)


def _own_law(scenario: ScenarioFields) -> Iterator[Fault]:
    """Yield what is wrong with the damping that the INS itself ran."""
    own = scenario.ins.damping
    if own.kind.carrying != "law":
        allowed = Text("must be damping by a network: what this does depends on the INS's own sensors")
        yield Fault("", "ins.damping.damping", own.damping, allowed)
        return
    if own.reads_log and scenario.reference.kind == "none":
        allowed = Text('needs the log: reference.kind must not be "none"')
        yield Fault("", "ins.damping.damping", own.damping, allowed)
    try:
        transfer_at(own.network, scenario.omega_s)
    except InputError as error:
        yield from error.located("", "ins.damping.network.").faults
        return
    faults = list(own.kind.faults(own, scenario.law_step_s))
    if faults:
        yield from InputError(faults).located("", "ins.damping.").faults
