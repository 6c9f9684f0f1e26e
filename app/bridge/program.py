"""viser's page, unpacked into files of its own, and mended in what makes it draw late or too often.

viser serves one page with its program packed into an attribute: every visit decodes and decompresses it
before anything can run, 2.5 MB, and the browser can keep neither the file nor what it has compiled. Here the
server unpacks it once, so that the browser loads it beside our scripts and keeps it.
"""

from __future__ import annotations

import gzip
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import viser
import zstandard

from navcore.foundation.errors import Fault, InputError

_DIGITS = "".join(chr(code) for code in range(0x21, 0x7F) if chr(code) not in "\"&<>'`")
_LARGEST = 1 << 25

SOCKET_SCRIPT = Path(__file__).parent / "socket.js"
"""Script for the page, to run before viser's program, which sends through it: ``schuler.send(message)``."""
FILL_SCRIPT = Path(__file__).parent / "fill.js"
"""Script for the page, by which viser's program changes HTML: ``schuler.fill(element, html)``."""

MENDS = (
    # After each change the 3D view is drawn for 250 ms, whether or not anything moves any more: some 15
    # frames, and each costs 40 ms without a graphics card. What is made late asks for its own frame.
    ("Bfe=250,", "Bfe=0,"),
    # It is drawn once a second too, whether or not anything has changed.
    ("Vfe=1e3;", "Vfe=1e4;"),
    # Messages wait for the next frame of the 3D view, which is drawn as it was before them.
    (
        "i&&document.hidden?(r(),e.requestRender()):a?r():e.requestRender()",
        "i?(r(),a||e.requestRender()):e.requestRender()",
    ),
    # Messages that follow each other within 100 ms are held back, so that they are shown as evenly as they
    # were sent. Our server sends a picture when the page has painted the one before: waiting delays it.
    ("void 0||p>100||d-l.jsTimeMinusPythonTime", "void 0||p>=0||d-l.jsTimeMinusPythonTime"),
    # One value in 50 ms, whichever control it comes from; what comes between is dropped. See socket.js.
    (
        "n=LL(50).send,r=b.useMemo(()=>({folderDepth:0",
        "n=window.schuler.send,r=b.useMemo(()=>({folderDepth:0",
    ),
    # A plot's large window, which a button opens, is made anew with each of its pictures while it is closed.
    (
        "onExpand:n}),(0,Y.jsx)(pA,{opened:t,onClose:r,size:`xl`,children:(0,Y.jsx)(I0,{...e})})]})",
        "onExpand:n}),b.useMemo(()=>(0,Y.jsx)(pA,{opened:t,onClose:r,size:`xl`,children:(0,Y.jsx)(I0,{...e})}),"
        "[t,t&&e])]})",
    ),
    (
        "onExpand:r}),(0,Y.jsx)(pA,{opened:n,onClose:i,size:`xl`,children:(0,Y.jsx)(SX,{jsonStr:e,aspectRatio:t})})",
        "onExpand:r}),b.useMemo(()=>(0,Y.jsx)(pA,{opened:n,onClose:i,size:`xl`,children:(0,Y.jsx)(SX,{jsonStr:e,"
        "aspectRatio:t})}),[n,n&&e,t])",
    ),
    # A plotly figure is drawn before its width is known, or behind another tab without one, and anew then.
    # Its frame has a name of its own, as that of a uPlot, by which marks.js finds it before it is drawn.
    (
        "Plotly.react(s.current,c.data,{...c.layout,width:o,height:o*t},c.config)},[c,o,t])",
        "o>9&&Plotly.react(s.current,c.data,{...c.layout,width:o,height:o*t},c.config)},[c,o,t])",
    ),
    (
        "t.purge(e)}},[]),(0,Y.jsxs)($C,{ref:a,className:yX,",
        "t.purge(e)}},[]),(0,Y.jsxs)($C,{ref:a,className:yX+` plotly-container`,",
    ),
    # HTML that changes is made anew whole. See fill.js.
    (
        "e.innerHTML=n}}break;case`multiple`:e.multiple=r&&",
        "window.schuler.fill(e,n)}}break;case`multiple`:e.multiple=r&&",
    ),
    # A command's new title ("Undo ...") counts as a change of the 3D view.
    ("new Set([`GuiUpdateMessage`,", "new Set([`CommandUpdateMessage`,`GuiUpdateMessage`,"),
)
"""Text of viser's program and what stands in its place."""


@dataclass(frozen=True)
class Program:
    """What viser's page consists of.

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
        The page is not as it was when this was written.
    """
    page = (Path(viser.__file__).parent / "client" / "build" / "index.html").read_text(encoding="utf-8")
    before, _, rest = page.partition("<script ")
    attributes, _, rest = rest.partition(">")
    loader, _, after = rest.partition("</script>")
    wasm = re.search(r'gzWasm="([^"]*)"', loader)
    packed = dict(re.findall(r'data-(\w+)="([^"]*)"', attributes))
    if not wasm or not {"p", "ss", "cs"} <= packed.keys():
        raise _changed("the packed program")
    whole = zstandard.ZstdDecompressor().decompress(unpack(packed["p"]), max_output_size=_LARGEST)
    style, program = int(packed["ss"]), int(packed["cs"])
    return Program(
        html=before + after,
        program=mended(whole[style : style + program]),
        style=whole[:style],
        zstd=gzip.decompress(unpack(wasm[1].replace("\\\\", "\\"))),
    )


def mended(program: bytes) -> bytes:
    """Put `MENDS` into viser's program.

    Raises
    ------
    InputError
        A text is not there exactly once.
    """
    for before, after in MENDS:
        if program.count(before.encode()) != 1:
            raise _changed(before)
        program = program.replace(before.encode(), after.encode())
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


def _changed(what: str) -> InputError:
    return InputError([Fault("installation", "viser's page", what, "not as in viser 1.1.1: make setup")])
