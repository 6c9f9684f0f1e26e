"""Target FMU: a Functional Mock-up Unit 3.0 for co-simulation, with its C source."""

from __future__ import annotations

import hashlib
import io
import platform
import shutil
import subprocess
import tempfile
import zipfile
from collections.abc import Sequence
from pathlib import Path
from xml.sax.saxutils import quoteattr

from navcore.exporting import target_c
from navcore.exporting.about import facts, filled, note_of
from navcore.exporting.form import WHOLE, Form, unit_of
from navcore.exporting.printing import INDENT

_KINDS = "Float32 Int8 UInt8 Int16 UInt16 UInt32 Int64 UInt64 Boolean String Binary Clock".split()
_MISSING = [f"fmi3{way}{kind}" for way in ("Get", "Set") for kind in _KINDS] + [
    f"fmi3{name}"
    for name in (
        "GetNumberOfVariableDependencies GetVariableDependencies GetFMUState SetFMUState FreeFMUState "
        "SerializedFMUStateSize SerializeFMUState DeserializeFMUState GetDirectionalDerivative "
        "GetAdjointDerivative GetIntervalDecimal GetIntervalFraction GetShiftDecimal GetShiftFraction "
        "SetIntervalDecimal SetIntervalFraction SetShiftDecimal SetShiftFraction EvaluateDiscreteStates "
        "EnterContinuousTimeMode CompletedIntegratorStep SetTime SetContinuousStates "
        "GetContinuousStateDerivatives GetEventIndicators GetContinuousStates GetNominalsOfContinuousStates "
        "GetNumberOfEventIndicators GetNumberOfContinuousStates GetOutputDerivatives ActivateModelPartition"
    ).split()
]
"""Functions of the interface that the unit does not offer, but must have."""
_DATE = (1980, 1, 1, 0, 0, 0)
"""Of all files within: the same export gives the same bytes."""


def files(form: Form, prefix: str, single: bool, bounds: Sequence[float]) -> dict[str, str | bytes]:
    """Return the files by name; parameters as of `navcore.exporting.target_c.files`."""
    sources = target_c.sources(form, prefix, single)
    token = "{" + hashlib.sha256("".join(sources.values()).encode()).hexdigest()[:32] + "}"
    values = facts(form, prefix, bounds) | {
        "guard": prefix.upper(),
        "token": token,
        "inputs": str(len(form.inputs)),
        "outputs": str(len(form.outputs)),
        "take": "\n".join(
            f"{INDENT}in.{name} = ({'int' if name in WHOLE else 'float' if single else 'double'})values[{i}];"
            for i, name in enumerate(form.inputs)
        ),
        "give": "\n".join(f"{INDENT}found[{i}] = (double)out.{name};" for i, name in enumerate(form.outputs)),
        "missing": "\n".join(f"NOT_THERE({name})" for name in _MISSING),
    }
    sources["fmi3.c"] = filled("fmi3.c", values)
    inside: dict[str, str | bytes] = {
        "modelDescription.xml": _description(form, prefix, values),
        "sources/buildDescription.xml": _build(prefix),
        **{f"sources/{name}": text for name, text in sources.items()},
    }
    inside |= _binary(prefix, sources)
    return {f"{prefix}.fmu": _zipped(inside), "vectors.csv": target_c.vectors_csv(form)}


def _description(form: Form, prefix: str, values: dict[str, str]) -> str:
    units = sorted({unit for name in (*form.inputs, *form.outputs) if (unit := unit_of(name))})
    variables = ['<Float64 name="time" valueReference="0" causality="independent" variability="continuous"/>']
    variables += [_variable(form, name, i + 1, "input") for i, name in enumerate(form.inputs)]
    first = 1 + len(form.inputs)
    variables += [_variable(form, name, first + i, "output") for i, name in enumerate(form.outputs)]
    places = range(first, first + len(form.outputs))
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        f'<fmiModelDescription fmiVersion="3.0" modelName={quoteattr(prefix)} '
        f"instantiationToken={quoteattr(values['token'])} description={quoteattr(values['description'])} "
        f'generationTool={quoteattr("Schuler Bench " + values["version"])} variableNamingConvention="flat">',
        f'<CoSimulation modelIdentifier={quoteattr(prefix)} canHandleVariableCommunicationStepSize="false" '
        f'fixedInternalStepSize="{values["step_s"]}"/>',
        "<UnitDefinitions>",
        *(f"<Unit name={quoteattr(unit)}/>" for unit in units),
        "</UnitDefinitions>",
        f'<DefaultExperiment startTime="0" stepSize="{values["step_s"]}"/>',
        "<ModelVariables>",
        *variables,
        "</ModelVariables>",
        "<ModelStructure>",
        *(f'<Output valueReference="{place}"/>' for place in places),
        *(f'<InitialUnknown valueReference="{place}"/>' for place in places),
        "</ModelStructure>",
        "</fmiModelDescription>",
    ]
    return "\n".join(lines) + "\n"


def _variable(form: Form, name: str, place: int, causality: str) -> str:
    kind = "Int32" if name in WHOLE else "Float64"
    unit = f" unit={quoteattr(unit_of(name))}" if unit_of(name) and kind == "Float64" else ""
    begins = ' start="0"' if causality == "input" else ' initial="calculated"'
    about = f" description={quoteattr(note_of(form, name))}" if note_of(form, name) else ""
    return (
        f'<{kind} name="{name}" valueReference="{place}" causality="{causality}" variability="discrete"'
        f"{begins}{unit}{about}/>"
    )


def _build(prefix: str) -> str:
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n<fmiBuildDescription fmiVersion="3.0">\n'
        f"<BuildConfiguration modelIdentifier={quoteattr(prefix)}>\n"
        f'<SourceFileSet language="C99">\n<SourceFile name="{prefix}.c"/>\n<SourceFile name="fmi3.c"/>\n'
        "</SourceFileSet>\n</BuildConfiguration>\n</fmiBuildDescription>\n"
    )


def _binary(prefix: str, sources: dict[str, str]) -> dict[str, bytes]:
    """Binary for this machine by its place in the unit; nothing where none can be made."""
    machine = {"x86_64": "x86_64-linux", "aarch64": "aarch64-linux"}.get(platform.machine(), "")
    if not machine or platform.system() != "Linux" or not shutil.which("cc"):
        return {}
    with tempfile.TemporaryDirectory() as folder:
        for name, text in sources.items():
            Path(folder, name).write_text(text)
        names = [name for name in sources if name.endswith(".c")]
        command = [
            "cc",
            "-std=c99",
            "-O2",
            "-fPIC",
            "-shared",
            "-fvisibility=hidden",
            *names,
            "-lm",
            "-o",
            "law.so",
        ]
        subprocess.run(command, cwd=folder, check=True, capture_output=True)
        return {f"binaries/{machine}/{prefix}.so": Path(folder, "law.so").read_bytes()}


def _zipped(inside: dict[str, str | bytes]) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in inside.items():
            entry = zipfile.ZipInfo(name, _DATE)
            entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
            archive.writestr(entry, content)
    return stream.getvalue()
