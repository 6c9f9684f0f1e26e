"""Many exported laws compiled at once, and run from Python on the same inputs as the program's own law."""

import ctypes
import shutil
import subprocess
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from navcore.exporting.c import CPrinter
from navcore.exporting.form import WHOLE, Form
from navcore.exporting.replay import INPUTS
from navcore.exporting.step import NO_SAMPLE, NOT_YET, SAMPLE
from navcore.exporting.target_c import sources

FLAGS = "-std=c99 -Wall -Wextra -Werror -Wconversion -Wshadow".split()
"""Of the contract, and one more."""


def compiler() -> str:
    """Name of a C compiler; empty where there is none."""
    return shutil.which("cc") or shutil.which("gcc") or shutil.which("clang") or ""


def busy_inputs(calls: int = 3000, step_s: float = 1.0, seed: int = 3) -> np.ndarray:
    """Inputs in which all happens: turns, steps of the log, noise, an outage, samples late or missing."""
    rng = np.random.default_rng(seed)
    t = step_s * np.arange(calls)
    inputs = np.zeros((calls, len(INPUTS)))
    column = {name: inputs[:, place] for place, name in enumerate(INPUTS)}
    course = 0.4 + 3.0 * np.clip((t - 900.0) / 60.0, 0.0, 1.0) + 0.02 * np.sin(0.05 * t)
    speed = 6.0 + 3.0 * np.clip((t - 1500.0) / 200.0, 0.0, 1.0)
    east, north = speed * np.sin(course), speed * np.cos(course)
    column["v_e_mps"][:] = east + 0.3 * np.sin(1.24e-3 * t) + 0.05
    column["v_n_mps"][:] = north + 0.2 * np.cos(1.24e-3 * t)
    column["lat_rad"][:] = 0.7 + np.cumsum(north) * step_s / 6.37e6
    column["yaw_rad"][:] = np.mod(course, 2.0 * np.pi)
    change = np.where((t > 600.0) & (t < 1100.0), 0.9, 0.0) + np.where(t > 2000.0, -0.7, 0.0)
    noise = rng.normal(0.0, 0.05, (calls, 2))
    column["log_e_mps"][:] = east + change + noise[:, 0]
    column["log_n_mps"][:] = north - 0.5 * change + noise[:, 1]
    word = np.full(calls, SAMPLE)
    word[(t > 1250.0) & (t < 1400.0)] = NO_SAMPLE
    word[(t > 1700.0) & (t < 1712.0)] = NOT_YET
    word[2500::3] = NOT_YET
    column["log_valid"][:] = word
    return inputs


def library(forms: Sequence[tuple[str, Form]], folder: Path, single: bool = False, flags: Sequence[str] = ()):
    """Compile laws, each with its own prefix, into one library."""
    folder.mkdir(parents=True, exist_ok=True)
    names = []
    for prefix, form in forms:
        for name, text in sources(form, prefix, single).items():
            (folder / name).write_text(text)
        real = CPrinter(form.program, prefix, single).real
        take = "\n".join(
            f"        in.{name} = ({'int' if name in WHOLE else real})given[{i}];"
            for i, name in enumerate(form.inputs)
        )
        give = "\n".join(f"        found[{i}] = (double)out.{name};" for i, name in enumerate(form.outputs))
        (folder / f"{prefix}_run.c").write_text(
            f'#include "{prefix}.h"\n'
            f"void {prefix}_run(const double *given, double *found, long n);\n"
            f"void {prefix}_run(const double *given, double *found, long n)\n{{\n"
            f"    {prefix}_state s;\n    const {prefix}_start at = {{0, 0, 0}};\n"
            f"    {prefix}_init(&s, &at);\n"
            f"    for (long k = 0; k < n; k++) {{\n        {prefix}_in in;\n"
            f"        {prefix}_out out;\n{take}\n"
            f"        {prefix}_step(&s, &in, &out);\n{give}\n"
            f"        given += {len(form.inputs)};\n        found += {len(form.outputs)};\n    }}\n}}\n"
        )
        names += [f"{prefix}.c", f"{prefix}_run.c"]
    made = folder / "laws.so"
    command = [compiler(), *FLAGS, *flags, "-O1", "-shared", "-fPIC", *names, "-lm", "-o", str(made)]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[:4000]
    return ctypes.CDLL(str(made))


def called(laws: ctypes.CDLL, prefix: str, form: Form, inputs: np.ndarray) -> np.ndarray:
    """Outputs of an exported law."""
    given = np.ascontiguousarray(inputs, dtype=float)
    found = np.empty((len(given), len(form.outputs)))
    pointers = (one.ctypes.data_as(ctypes.POINTER(ctypes.c_double)) for one in (given, found))
    getattr(laws, f"{prefix}_run")(*pointers, ctypes.c_long(len(given)))
    return found
