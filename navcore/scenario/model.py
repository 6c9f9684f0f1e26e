"""The scenario: joins the parameter models of the parts, checks what only the whole can tell."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from pydantic import PrivateAttr, ValidationError

from navcore.damping import GYROCOMPASS, WHOLE
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.faults import faults_from
from navcore.foundation.text import Text
from navcore.foundation.units import HOUR
from navcore.networks.known import transfer_at
from navcore.scenario.bounds import MAX_METHODS
from navcore.scenario.fields import ScenarioFields
from navcore.scenario.ins_faults import ins_faults
from navcore.scenario.method import Method
from navcore.scenario.needs import need_faults
from navcore.scenario.own_ins import REPLACED
from navcore.scenario.refused import Refused, refused_methods
from navcore.scenario.requirement import clause_faults
from navcore.scenario.strapdown_faults import strapdown_faults

MAX_STEPS = 3_000_000
"""About 35 days at 1 s: bounds a run to seconds, and its memory to 0.3 GB (1.6 GB along a moving truth)."""
_METHODS_ALLOWED = Text("must be 1 to {max_methods} blocks [[method]]", max_methods=MAX_METHODS)


class Scenario(ScenarioFields):
    """A complete, checked scenario.

    Build it with `Scenario.parse` or `navcore.scenario.file.load`.
    """

    _refused: tuple[Refused, ...] = PrivateAttr(default=())

    @property
    def refused(self) -> tuple[Refused, ...]:
        """Methods that were left out when it was read, because the rest of the scenario refuses them."""
        return self._refused

    @classmethod
    def parse(cls, data: dict[str, Any], where: str = "", *, apart: bool = False) -> Scenario:
        """Validate a mapping as read from TOML; names are filled in and made unique.

        Parameters
        ----------
        data : dict
            Blocks of the scenario.
        where : str
            Named in faults.
        apart : bool
            Leave out methods that the rest of the scenario refuses, as long as one is left. A method that
            reads a log where there is none is a fault all the same.

        Raises
        ------
        InputError
            One fault per field that is wrong, each with value and allowed range.
        """
        methods = data.get("method")
        if isinstance(methods, list | tuple) and len(methods) > MAX_METHODS:
            raise InputError(Fault(where, "method", len(methods), _METHODS_ALLOWED))
        try:
            scenario = cls.model_validate(data)
        except ValidationError as error:
            raise InputError(faults_from(error, cls, data, where)) from None
        if scenario.on_ins:
            replaced = Text("must be left out: [ins] takes its place")
            faults = [Fault("", name, None, replaced) for name in REPLACED if name in data]
            if faults:
                raise InputError(faults).located(where)
        scenario = scenario.with_ins().with_sensors()
        faults = list(scenario.faults())
        # A log that is not there is wrong input (interface.md), not a method that does not suit the scenario.
        without_log = scenario.reference.kind == "none" and any(one.reads_log for one in scenario.method)
        refused = (
            refused_methods(scenario.method, scenario._faults_with)
            if apart and faults and not without_log
            else ()
        )
        if refused:
            places = {one.place for one in refused}
            left = tuple(one for place, one in enumerate(scenario.method) if place not in places)
            scenario = scenario.model_copy(update={"method": left})
            faults = list(scenario.faults()) if left else faults
        if faults:
            raise InputError(faults).located(where)
        scenario._refused = refused
        methods = tuple(m.model_copy(update={"name": m.label()}) for m in scenario.method)
        return scenario.model_copy(update={"method": methods})

    def with_ins(self) -> Scenario:
        """Return the scenario with the output of the ship's INS as its motion, where it runs on one."""
        if not self.on_ins:
            return self
        log = self.reference
        if log.kind == "none" and log.file is not None:
            log = log.model_copy(update={"kind": "file"})
        return self.model_copy(update={"motion": self.ins.track(), "reference": log})

    def with_sensors(self) -> Scenario:
        """Return the scenario with networks that are designed for its sensors and log."""
        return self.model_copy(update={"method": tuple(map(self.designed, self.method))})

    def designed(self, method: Method) -> Method:
        """Return a method with its network designed for the sensors, and for the log where that enters."""
        figures = self.figures()
        if method.kind.self_referenced:
            figures = replace(figures, log_noise=0.0, log_drift=0.0)
        return method.model_copy(update={"network": method.network.with_sensors(figures)})

    def _faults_with(self, method: Method) -> Iterator[Fault]:
        """Yield the faults of the scenario with one method alone."""
        return self.model_copy(update={"method": (method,)}).faults()

    def faults(self) -> Iterator[Fault]:
        """Yield the faults of the whole scenario: lengths, names, missing references, refused networks."""
        run = self.run
        if self.steps < 1:
            yield Fault(
                "",
                "run.duration_h",
                run.duration_h,
                Text("must hold at least one step of {step_s:g} s", step_s=run.step_s),
            )
        if self.steps > MAX_STEPS:
            yield Fault(
                "",
                "run.duration_h",
                run.duration_h,
                Text(
                    "is {duration_h:.3g} steps of {step_s:g} s; at most {max_steps}",
                    duration_h=run.duration_h * HOUR / run.step_s,
                    step_s=run.step_s,
                    max_steps=MAX_STEPS,
                ),
            )
        if not 1 <= len(self.method) <= MAX_METHODS:
            yield Fault("", "method", len(self.method), _METHODS_ALLOWED)
        yield from _method_faults(self)
        yield from self.alignment.faults()
        for i, one in enumerate(self.requirement):
            yield from one.faults(f"requirement.{i}", run.duration_h)
        yield from clause_faults(self.requirement)
        yield from need_faults(self)
        yield from strapdown_faults(self)
        yield from ins_faults(self)


def _method_faults(scenario: ScenarioFields) -> Iterator[Fault]:
    seen: dict[str, int] = {}
    for i, method in enumerate(scenario.method):
        at = f"method.{i}"
        other = seen.setdefault(method.label(), i)
        if other != i:
            yield Fault(
                "",
                f"{at}.name",
                method.label(),
                Text("must differ from the name of method.{other}", other=other),
            )
        if method.policy.needs_reference and not method.undamped and scenario.reference.kind == "none":
            yield Fault(
                "",
                f"{at}.policy.id",
                method.policy.id,
                Text('needs a reference velocity: reference.kind must not be "none"'),
            )
        if method.event and scenario.reference.kind != "log":
            yield Fault("", f"{at}.event", None, Text('needs reference.kind = "log"'))
        try:
            transfer_at(method.network, scenario.omega_s)
        except InputError as error:
            yield from error.located("", f"{at}.network.").faults
            continue
        if method.azimuth.id != "none" and method.damping not in WHOLE:
            allowed = Text(
                'needs damping = "internal" or "external", not "{damping}"', damping=method.damping
            )
            yield Fault("", f"{at}.azimuth", method.azimuth.id, allowed)
        if method.gyrocompass is not None and method.kind is not GYROCOMPASS:
            allowed = Text('needs damping = "external", not "{damping}"', damping=method.damping)
            yield Fault("", f"{at}.gyrocompass", method.damping, allowed)
        own_faults = list(method.kind.faults(method, scenario.law_step_s))
        if own_faults:
            yield from InputError(own_faults).located("", f"{at}.").faults
