"""What a scenario holds, for ``schuler check``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from navcore.environment import environment
from navcore.errors import InputError
from navcore.io.check import Checker, FileReport
from navcore.loop import analyse
from navcore.scenario import Method, Scenario
from navcore.scenario_file import load, scenario_hash


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
        warnings = list(_environment_warnings(scenario))
    except InputError as error:
        raise error.located(str(source)) from None
    for method in scenario.method:
        warnings += [f"{method.name}: {text}" for text in _warnings(scenario, method)]
    return FileReport(
        str(source),
        f"scenario, schema {scenario.schema_version}",
        _details(scenario),
        tuple(_text(scenario)),
        tuple(warnings),
    )


SCENARIO_CHECKER = Checker(_recognises, check_scenario)


def _environment_warnings(scenario: Scenario) -> tuple[str, ...]:
    if not scenario.strapdown:
        return environment(scenario).warnings
    from navcore.strapdown_environment import strapdown_environment

    return strapdown_environment(scenario).warnings


def _warnings(scenario: Scenario, method: Method) -> list[str]:
    if method.undamped:
        return []
    network = method.network.transfer(scenario.omega_s)
    return list(dict.fromkeys((*network.warnings, *analyse(network).warnings)))


def _details(scenario: Scenario) -> dict[str, Any]:
    return {
        "title": scenario.title,
        "source": scenario.source,
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
    head = ", ".join(part for part in (scenario.title, scenario.source) if part)
    lines = [f"  {head}"] if head else []
    lines += [
        f"  {run.fidelity}, {run.duration_h:g} h, {_steps(scenario)}, {run.earth}, "
        f"latitude {site.lat_deg:g} deg, seed {run.seed}",
        f"  motion {scenario.motion.kind}, reference {scenario.reference.kind}",
    ]
    for m in scenario.method:
        if m.damping == "free":
            lines.append(f"  method {m.name}: free")
        elif m.undamped:
            copies = f"{m.averaging.variant}, {'with' if m.averaging.earth else 'without'} the 24 h line"
            lines.append(f"  method {m.name}: averaging, {copies}")
        else:
            lines.append(
                f"  method {m.name}: {m.damping}, network {m.network.id}, policy {m.policy.id}, "
                f"switching {m.switching.id}"
            )
    return lines
