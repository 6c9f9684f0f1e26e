"""``python -m tools.wasm``: compile the error model of the moving report to WebAssembly, anew.

The source and the binary are both in ``assets/moving``; ``build.json`` holds their digests, the compiler and
the command. The compiler is that of the wheel ``ziglang``, which no lock names: ``pip install ziglang`` in an
environment of its own, and run this tool with it. With ``--check`` nothing is written, and the digests are
compared.
"""

import hashlib
import json
import subprocess
import sys
import tempfile
from pathlib import Path

FOLDER = Path(__file__).parent.parent / "assets" / "moving"
SOURCE, BINARY, BUILD = FOLDER / "error_model.c", FOLDER / "error_model.wasm", FOLDER / "build.json"
OPTIONS = (
    "-std=c99 -Wall -Wextra -Werror -Wconversion -target wasm32-freestanding -O2 -nostdlib "
    "-Wl,--no-entry -Wl,--strip-all -Wl,--export=run -Wl,--export=__heap_base"
)


def digest(path: Path) -> str:
    """SHA-256 of a file."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def faults() -> list[str]:
    """Say in what source and binary differ from what was built."""
    build = json.loads(BUILD.read_text("utf-8"))
    return [
        f"{path.name} is not the one that was built: run python -m tools.wasm"
        for path in (SOURCE, BINARY)
        if build["sha256"][path.name] != digest(path)
    ]


def build() -> None:
    """Compile the source, and note what was done; exits where there is no compiler or it refuses."""
    zig = [sys.executable, "-m", "ziglang"]
    asked = subprocess.run([*zig, "version"], capture_output=True, text=True, check=False)
    if asked.returncode:
        sys.exit("there is no compiler: pip install ziglang")
    with tempfile.TemporaryDirectory() as folder:
        made = Path(folder) / BINARY.name
        command = [*zig, "cc", *OPTIONS.split(), SOURCE.name, "-o", str(made)]
        if subprocess.run(command, cwd=FOLDER, check=False).returncode:
            sys.exit("it does not compile")
        BINARY.write_bytes(made.read_bytes())
    told = {
        "command": f"python -m ziglang cc {OPTIONS} {SOURCE.name} -o {BINARY.name}",
        "compiler": f"ziglang {asked.stdout.strip()}",
        "sha256": {path.name: digest(path) for path in (SOURCE, BINARY)},
    }
    BUILD.write_text(json.dumps(told, indent=2) + "\n", "utf-8")
    print(f"{BINARY.name}: {BINARY.stat().st_size} bytes")


if __name__ == "__main__":
    if "--check" in sys.argv:
        print("\n".join(found := faults()) or "as built")
        sys.exit(bool(found))
    build()
