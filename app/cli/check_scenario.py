"""Report on a scenario, for ``schuler check``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from navcore.checks.file import Checker
from navcore.checks.report import FileReport
from navcore.engine.drivers.common import network_of, stability_of
from navcore.engine.environment import Environment, environment
from navcore.foundation.errors import InputError
from navcore.scenario.file import load, scenario_hash
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.scenario.provenance import source_of

if TYPE_CHECKING:
    from navcore.engine.strapdown_environment import StrapdownEnvironment


def _recognises(path: Path, head: bytes) -> bool:
    return path.suffix.lower() == ".toml"


def check_scenario(source: str | Path) -> FileReport:
    """Load a scenario, carry out its motion, open its recordings, analyse its loops.

    Raises
    ------
    InputError
        One fault per thing wrong.
    """
    scenario = load(str(source))
    try:
        inputs = _environment(scenario)
    except InputError as error:
        raise error.located(str(source)) from None
    warnings = list(inputs.warnings)
    for method in scenario.method:
        warnings += [f"{method.name}: {text}" for text in _warnings(scenario, method, inputs)]
    return FileReport(
        str(source),
        f"scenario, schema {scenario.schema_version}",
        _details(scenario),
        tuple(_text(scenario)),
        tuple(warnings),
    )


SCENARIO_CHECKER = Checker(_recognises, check_scenario)


def _environment(scenario: Scenario) -> Environment | StrapdownEnvironment:
    if scenario.on_ins:
        from navcore.engine.drivers.outside import prepared

        return prepared(scenario)[1]
    if not scenario.strapdown:
        return environment(scenario)
    from navcore.engine.strapdown_environment import strapdown_environment

    return strapdown_environment(scenario)


def _warnings(scenario: Scenario, method: Method, inputs: Environment | StrapdownEnvironment) -> list[str]:
    if method.undamped:
        return []
    network = network_of(scenario, method)
    law_step_s = scenario.sampling.law_step_s if scenario.strapdown else scenario.run.step_s
    truth = inputs.truth_half if isinstance(inputs, Environment) else inputs.truth
    stability = stability_of(scenario, method, law_step_s, inputs.reference, truth, network)
    return list(dict.fromkeys((*network.warnings, *stability.warnings)))


def _details(scenario: Scenario) -> dict[str, Any]:
    return {
        "title": scenario.title,
        "source": source_of(scenario),
        "fidelity": scenario.run.fidelity,
        "duration_h": scenario.run.duration_h,
        "steps": scenario.steps,
        **(
            {"rate_hz": scenario.run.rate_hz, "samples": scenario.sampling.samples}
            if scenario.strapdown
            else {}
        ),
        "motion": scenario.motion.kind,
        "reference": scenario.reference.kind,
        "methods": [
            {
                "name": m.name,
                "damping": m.damping,
                "network": m.network.id,
                "policy": m.policy.id,
                "switching": m.switching.id,
            }
            for m in scenario.method
        ],
        "scenario_sha256": scenario_hash(scenario),
    }


def _steps(scenario: Scenario) -> str:
    if scenario.strapdown:
        return f"{scenario.sampling.samples} samples at {scenario.run.rate_hz:g} Hz"
    return f"{scenario.steps} steps of {scenario.run.step_s:g} s"


def _text(scenario: Scenario) -> list[str]:
    run, site = scenario.run, scenario.site
    head = ", ".join(part for part in (scenario.title, source_of(scenario)) if part)
    lines = [f"  {head}"] if head else []
    lines += [
        f"  {run.fidelity}, {run.duration_h:g} h, {_steps(scenario)}, {run.earth}, "
        f"latitude {site.lat_deg:g}°, seed {run.seed}",
        f"  motion {scenario.motion.kind}, reference {scenario.reference.kind}",
    ]
    lines += [f"  method {m.name}: {m.kind.description(m)}" for m in scenario.method]
    return lines
