"""viser's page, unpacked into files of its own, and mended in what makes it draw late or too often.

A mend that does not fit the installed viser is left out and logged once; the page works without any of them.

viser serves one page with its program packed into an attribute: every visit decodes and decompresses it
before anything can run, 2.5 MB, and the browser can keep neither the file nor what it has compiled. Here the
server unpacks it once, so that the browser loads it beside our scripts and keeps it.
"""

import gzip
import re
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
import viser
import zstandard

from navcore.foundation.errors import Fault, InputError
from schuler_bench.bridge.mends import MendedBuffer, left_out, plain_viser

_DIGITS = "".join(chr(code) for code in range(0x21, 0x7F) if chr(code) not in "\"&<>'`")
_LARGEST = 1 << 25
_WORKER = (b"type:`set_server`", b"type:`send`", b"{type:`message_batch`,messages:", b"{type:`connected`}")
"""Messages between page and worker, which curves.js and socket.js hear."""

SCRIPTS = tuple(Path(__file__).parent / f"{name}.js" for name in ("socket", "curves", "fill"))
"""Scripts for the page, to run before viser's program, which sends through ``schuler.send(message)`` and
changes HTML by ``schuler.fill(element, html)``; the second puts in the curves that
`schuler_bench.bridge.mends` leaves out."""


class Mend(NamedTuple):
    """A replacement in viser's program; without it the page works, and is slower."""

    name: str
    before: str
    after: str


MENDS = (
    # Each is explained to viser's authors in docs/architecture.md.
    Mend("the 3D view rests when nothing moves", "Bfe=250,", "Bfe=0,"),
    Mend("the 3D view is not drawn every second", "Vfe=1e3;", "Vfe=1e4;"),
    Mend(
        "messages do not wait for a frame of the 3D view",
        "i&&document.hidden?(r(),e.requestRender()):a?r():e.requestRender()",
        "i?(r(),a||e.requestRender()):e.requestRender()",
    ),
    Mend(
        "messages are not held back to be shown evenly",
        "void 0||p>100||d-l.jsTimeMinusPythonTime",
        "void 0||p>=0||d-l.jsTimeMinusPythonTime",
    ),
    Mend(
        "no control's newest value is dropped",
        "n=LL(50).send,r=b.useMemo(()=>({folderDepth:0",
        "n=window.schuler.send,r=b.useMemo(()=>({folderDepth:0",
    ),
    Mend(
        "a plot over time is not made twice, and fills its large window",
        "onExpand:n}),(0,Y.jsx)(pA,{opened:t,onClose:r,size:`xl`,children:(0,Y.jsx)(I0,{...e})})]})",
        "onExpand:n}),b.useMemo(()=>(0,Y.jsx)(pA,{opened:t,onClose:r,size:`96vw`,children:(0,Y.jsx)(I0,{...e,"
        "props:{...e.props,height:Math.round(.78*innerHeight)}})}),[t,t&&e])]})",
    ),
    Mend(
        "a plotly figure is not made twice, and fills its large window",
        "onExpand:r}),(0,Y.jsx)(pA,{opened:n,onClose:i,size:`xl`,children:(0,Y.jsx)(SX,{jsonStr:e,aspectRatio:t})})",
        "onExpand:r}),b.useMemo(()=>(0,Y.jsx)(pA,{opened:n,onClose:i,size:`96vw`,children:(0,Y.jsx)(SX,{jsonStr:e,"
        "aspectRatio:.78*innerHeight/(.96*innerWidth-40)})}),[n,n&&e,t])",
    ),
    Mend(
        "a plotly figure is drawn once its width is known",
        "Plotly.react(s.current,c.data,{...c.layout,width:o,height:o*t},c.config)},[c,o,t])",
        "o>9&&Plotly.react(s.current,c.data,{...c.layout,width:o,height:o*t},c.config)},[c,o,t])",
    ),
    Mend(
        "a plotly figure's frame has a name",
        "t.purge(e)}},[]),(0,Y.jsxs)($C,{ref:a,className:yX,",
        "t.purge(e)}},[]),(0,Y.jsxs)($C,{ref:a,className:yX+` plotly-container`,",
    ),
    Mend(
        "of a block of HTML only what differs is made anew",
        "e.innerHTML=n}}break;case`multiple`:e.multiple=r&&",
        "window.schuler.fill(e,n)}}break;case`multiple`:e.multiple=r&&",
    ),
    Mend(
        "a command's title does not draw the 3D view",
        "new Set([`GuiUpdateMessage`,",
        "new Set([`CommandUpdateMessage`,`GuiUpdateMessage`,",
    ),
)
"""Text of viser's program and what stands in its place."""


@dataclass(frozen=True)
class Program:
    """Parts of viser's page.

    Attributes
    ----------
    html : str
        The page, without program and style.
    program : bytes
        JavaScript module, mended.
    style : bytes
        Style sheet.
    zstd : bytes
        WebAssembly with which the program decompresses messages: it looks for the compiled module in
        ``globalThis.__viserZstdWasm``.
    """

    html: str
    program: bytes
    style: bytes
    zstd: bytes


def viser_program() -> Program:
    """Unpack and mend the page of the installed viser.

    Raises
    ------
    InputError
        The page holds no packed program.
    """
    page = (Path(viser.__file__).parent / "client" / "build" / "index.html").read_text(encoding="utf-8")
    before, _, rest = page.partition("<script ")
    attributes, _, rest = rest.partition(">")
    loader, _, after = rest.partition("</script>")
    wasm = re.search(r'gzWasm="([^"]*)"', loader)
    packed = dict(re.findall(r'data-(\w+)="([^"]*)"', attributes))
    if not wasm or not {"p", "ss", "cs"} <= packed.keys():
        wanted = "holds no packed program, as that of viser 1.1.1 does: make setup"
        raise InputError(Fault("installation", "viser's page", viser.__version__, wanted))
    whole = zstandard.ZstdDecompressor().decompress(unpack(packed["p"]), max_output_size=_LARGEST)
    style, program = int(packed["ss"]), int(packed["cs"])
    code = whole[style : style + program]
    if not all(sign in code for sign in _WORKER):
        left_out("curves that a page has are not sent again")
        MendedBuffer.shortens = False
    return Program(
        html=before + after,
        program=code if plain_viser() else mended(code),
        style=whole[:style],
        zstd=gzip.decompress(unpack(wasm[1].replace("\\\\", "\\"))),
    )


def mended(program: bytes) -> bytes:
    """Put `MENDS` into viser's program; one whose text is not there exactly once is left out, and logged."""
    for mend in MENDS:
        before = mend.before.encode()
        if program.count(before) == 1:
            program = program.replace(before, mend.after.encode())
        else:
            left_out(mend.name)
    return program


def unpack(text: str) -> bytes:
    """Undo viser's packing: five digits to the base 88 are four bytes, the most significant first."""
    value = np.zeros(128, dtype=np.uint64)
    value[[ord(digit) for digit in _DIGITS]] = np.arange(len(_DIGITS), dtype=np.uint64)
    digits = value[np.frombuffer(text.encode("ascii"), dtype=np.uint8)]
    whole = len(digits) // 5 * 5
    powers = np.array([88**4, 88**3, 88**2, 88, 1], dtype=np.uint64)
    content = (digits[:whole].reshape(-1, 5) @ powers).astype(">u4").tobytes()
    rest = 0
    for digit in digits[whole:]:
        rest = 88 * rest + int(digit)
    return content + rest.to_bytes(max(len(digits) - whole - 1, 0), "big")
