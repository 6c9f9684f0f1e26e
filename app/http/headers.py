"""Response headers: what the browser must not do with our page."""

from __future__ import annotations

from collections.abc import Collection


def security_headers(host: str, framed_by: Collection[str] = ()) -> dict[str, str]:
    """Return the headers of every answer.

    Scripts run only from this server's own files: no inline script, no inline handler and no ``eval``, so
    that text which reaches the page as HTML by mistake stays harmless. viser needs: WebAssembly (zstd),
    workers made from blobs, inline styles, pictures and fonts from blobs and data addresses.

    Parameters
    ----------
    host : str
        The Host header, already checked; the websocket goes there. Some browsers do not count it as 'self'.
    framed_by : collection of str
        Origins whose pages may show the answer in a frame; none by default.
    """
    socket = f"ws://{host} wss://{host}" if host else ""
    policy = {
        "default-src": "'none'",
        "script-src": "'self' 'wasm-unsafe-eval'",
        "worker-src": "blob:",
        "style-src": "'self' 'unsafe-inline'",
        "img-src": "'self' data: blob:",
        "font-src": "'self' data:",
        "connect-src": f"'self' {socket} data: blob:",
        "base-uri": "'none'",
        "form-action": "'none'",
        "frame-ancestors": " ".join(sorted(framed_by)) or "'none'",
    }
    return {
        "Content-Security-Policy": "; ".join(f"{key} {value}".strip() for key, value in policy.items()),
        "X-Content-Type-Options": "nosniff",
        # For old browsers: those that know frame-ancestors ignore it.
        "X-Frame-Options": "DENY",
        # The path of a page is a capability: whoever knows it sees the visitor's work.
        "Referrer-Policy": "no-referrer",
        "Cross-Origin-Opener-Policy": "same-origin",
        "Cross-Origin-Resource-Policy": "same-origin",
        "Permissions-Policy": "camera=(), microphone=(), geolocation=()",
    }
