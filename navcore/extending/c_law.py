"""A user's law in C, compiled with the compiler of the machine and called as the program's own law is."""

import ctypes
import hashlib
import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from navcore.damping import KINDS
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.kernel_cache import cache_folder
from navcore.foundation.text import Text
from navcore.law.hosted import Start, Step, UserLaw, put_into
from navcore.law.law import Law

_STEP = re.compile(r"\bvoid\s+(\w+)_step\s*\(")
_ADAPTER = """\
#include <stdlib.h>
#include <stdint.h>
#include "{file}"
void *schuler_new(double lat, double v_e, double v_n)
{{
    {p}_state *s = calloc(1, sizeof *s);
    {p}_start at = {{0}};
    at.lat_rad = lat, at.v_e_mps = v_e, at.v_n_mps = v_n;
    if (s) {p}_init(s, &at);
    return s;
}}
void schuler_free(void *s) {{ free(s); }}
int64_t schuler_step(int64_t handle, double *m)
{{
    {p}_in in = {{0}};
    {p}_out out = {{0}};
    in.v_e_mps = m[0], in.v_n_mps = m[1], in.lat_rad = m[2], in.log_e_mps = m[3], in.log_n_mps = m[4];
    in.log_valid = (int)m[5], in.yaw_rad = m[6], in.accel_e_mps2 = m[7], in.accel_n_mps2 = m[8];
    {p}_step(({p}_state *)(intptr_t)handle, &in, &out);
    m[9] = out.v_star_e_mps, m[10] = out.v_star_n_mps, m[11] = out.feedback_e_mps2;
    m[12] = out.feedback_n_mps2, m[13] = out.azimuth_rate_radps, m[14] = out.damped;
    return 0;
}}
"""


class NativeHost:
    """One law in C that runs."""

    def __init__(self, library: str, name: str, at: Start) -> None:
        self._library, self._name = ctypes.CDLL(library), name
        new = self._library.schuler_new
        new.restype, new.argtypes = ctypes.c_void_p, [ctypes.c_double] * 3
        self._state = new(at.lat_rad, at.v_e_mps, at.v_n_mps)
        self._law: Law | None = None
        self.fault = ""

    def put_into(self, law: Law) -> Law:
        """Have a free law ask this one."""
        address = ctypes.cast(self._library.schuler_step, ctypes.c_void_p).value or 0
        self._law = put_into(law, address, self._state)
        return law

    def advance(self, work: Callable[[], bool]) -> bool:
        """Do a part of a run; True when it is over."""
        over = work()
        if self._law is not None and not np.isfinite(self._law.s["user"]["commanded"]).all():
            self.fault = Text('law "{id}" gives what is no number', id=self._name)
        return over or bool(self.fault)

    def shared_state(self) -> str:
        """Return nothing: what a law in C shares is not looked for."""
        return ""

    def __del__(self) -> None:
        """Give the state back."""
        self._library.schuler_free(ctypes.c_void_p(self._state))


def c_law(path: str | Path, id: str = "", help: str = "") -> type[UserLaw]:
    """Compile a law in C, with the functions and structures of an exported one (docs/export.md).

    Parameters
    ----------
    path : str or Path
        The C file: it defines ``PREFIX_init`` and ``PREFIX_step``.
    id : str
        Name in scenarios; by default that of the file.
    help : str
        What it does, in one clause.

    Returns
    -------
    type
        To be given to `navcore.register`. It runs at the speed of the program's own law, and with the rights
        of the program: what it writes beside its state, and what it never returns from, is not held back.

    Raises
    ------
    InputError
        It cannot be read, has no such function, or does not compile; the compiler's first line is named.
    """
    file = Path(path).resolve()
    try:
        text = file.read_text("utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise _refused(file, Text("cannot be read: {error}", error=str(error))) from error
    prefix = _STEP.search(text)
    if prefix is None:
        raise _refused(file, Text("must define PREFIX_init and PREFIX_step, as an exported law does"))
    library, name = _compiled(file, prefix[1]), id or file.stem

    class CLaw(UserLaw):
        """A law in C."""

        law_file: ClassVar[str] = str(file)

        def start(self, at: Start) -> Step:
            """Not used: the kernels call the law itself."""
            raise NotImplementedError

        def host(self, at: Start) -> NativeHost:
            """Return the law for one run."""
            return NativeHost(library, name, at)

        def __reduce__(self) -> Any:
            """Be found by its file in another process, where `navcore.extending.baggage` registers it."""
            return _settings_of, (str(file), name)

    CLaw.id, CLaw.help = name, help or Text("the law in {file}", file=file.name)
    CLaw.speed = ""
    CLaw.__qualname__ = f"CLaw({file})"
    return CLaw


def _settings_of(path: str, id: str) -> UserLaw:
    known = KINDS.get(id)
    found = known.settings if known is not None else None
    return found() if getattr(found, "law_file", "") == path else c_law(path, id)()  # pyright: ignore


def _refused(file: Path, why: str) -> InputError:
    return InputError(Fault(file.name, "", None, why))


def _compiled(file: Path, prefix: str) -> str:
    """Shared library of a file, compiled unless the same sources were."""
    compiler = os.environ.get("CC") or shutil.which("cc")
    if not compiler:
        raise _refused(file, Text("needs a C compiler: none is found as cc, and CC names none"))
    digest = hashlib.sha256(f"{compiler}\0{file}\0{_ADAPTER}".encode())
    for source in sorted([*file.parent.glob("*.c"), *file.parent.glob("*.h")]):
        digest.update(source.name.encode() + source.read_bytes())
    out = cache_folder() / "laws" / f"{digest.hexdigest()[:32]}.so"
    if out.is_file():
        return str(out)
    out.parent.mkdir(exist_ok=True, mode=0o700)
    with tempfile.TemporaryDirectory(dir=out.parent) as folder:
        adapter, made = Path(folder, "adapter.c"), Path(folder, "law.so")
        adapter.write_text(_ADAPTER.format(file=file, p=prefix), "utf-8")
        command = [compiler, "-std=c99", "-O2", "-shared", "-fPIC", "-o", str(made), str(adapter), "-lm"]
        ended = subprocess.run(command, capture_output=True, text=True, check=False)
        if ended.returncode:
            first = next((line for line in ended.stderr.splitlines() if "error" in line), ended.stderr[:300])
            raise _refused(file, Text("does not compile: {error}", error=first))
        os.replace(made, out)
    return str(out)
