"""deploy/nginx.conf before a running server: TLS, websocket, stickiness, as Debian's nginx reads it."""

import os
import pwd
import re
import shutil
import socket
import ssl
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest
from websockets.sync.client import connect

from schuler_bench.bench.process import free_port
from tests.attack.conftest import eventually, running
from tests.attack.wire import ask

NGINX = shutil.which("nginx", path=f"{os.environ.get('PATH', '')}:/usr/sbin")


def missing() -> str:
    """What this machine lacks for these tests; empty when nothing is missing."""
    if NGINX is None or shutil.which("openssl") is None:
        return "nginx and openssl are not installed"
    if os.geteuid() == 0 and "nobody" not in {user.pw_name for user in pwd.getpwall()}:
        return "nginx started by root works as the user nobody, who is not known here"
    return ""


pytestmark = [pytest.mark.attack, pytest.mark.skipif(bool(missing()), reason=missing())]

NAME = "bench.example.org"


@dataclass
class Proxy:
    tls: int
    plain: int
    context: ssl.SSLContext

    def get(self, path: str, host: str = NAME) -> str:
        with socket.create_connection(("127.0.0.1", self.tls), timeout=5) as raw:
            with self.context.wrap_socket(raw, server_hostname=NAME) as secure:
                request = f"GET {path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n"
                secure.sendall(request.encode())
                answer = b""
                while piece := secure.recv(65536):
                    answer += piece
        return answer.decode("latin-1")


@pytest.fixture(scope="module")
def proxy(tmp_path_factory: pytest.TempPathFactory, repo_root: Path) -> Iterator[Proxy]:
    folder = tmp_path_factory.mktemp("nginx")
    subject = ["-subj", f"/CN={NAME}", "-addext", f"subjectAltName=DNS:{NAME}"]
    files = ["-keyout", str(folder / "key.pem"), "-out", str(folder / "cert.pem")]
    words = ["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "1", *subject, *files]
    subprocess.run(words, check=True, capture_output=True)
    with running(allow_origins=[f"https://{NAME}"]) as bench:
        plain, tls = free_port(), free_port()
        ours = (repo_root / "deploy" / "nginx.conf").read_text("utf-8")
        for old, new in (
            ("server 127.0.0.1:8080;", f"server 127.0.0.1:{bench.port};"),
            ("listen 80;", f"listen 127.0.0.1:{plain};"),
            ("listen 443 ssl;", f"listen 127.0.0.1:{tls} ssl;"),
            (f"/etc/ssl/certs/{NAME}.pem", str(folder / "cert.pem")),
            (f"/etc/ssl/private/{NAME}.key", str(folder / "key.pem")),
        ):
            assert ours.count(old) == 1, old
            ours = ours.replace(old, new)
        kinds = ("client_body", "proxy", "fastcgi", "uwsgi", "scgi")
        paths = "".join(f"{kind}_temp_path {folder}/{kind};" for kind in kinds)
        whole = f"pid {folder}/pid; error_log {folder}/errors; daemon off; master_process off;"
        whole += f"events {{}} http {{ access_log off; {paths}\n{ours}\n}}"
        (folder / "nginx.conf").write_text(whole)
        assert NGINX is not None
        process = subprocess.Popen([NGINX, "-c", str(folder / "nginx.conf"), "-p", str(folder)])
        context = ssl.create_default_context(cafile=str(folder / "cert.pem"))
        found = Proxy(tls, plain, context)
        try:
            eventually(lambda: _listens(tls), 10.0)
            yield found
        finally:
            process.terminate()
            process.wait(10.0)


def _listens(port: int) -> bool:
    with socket.socket() as probe:
        return probe.connect_ex(("127.0.0.1", port)) == 0


def test_page_and_websocket_pass_the_proxy(proxy: Proxy) -> None:
    first = proxy.get("/")
    assert " 302 " in first.splitlines()[0] and "Strict-Transport-Security" in first
    found = re.search(r"^Location: (\S+)\r$", first, re.MULTILINE | re.IGNORECASE)
    assert found is not None
    page = proxy.get(f"/{found[1].lstrip('/')}" if "://" not in found[1] else f"/{found[1].split('/', 3)[3]}")
    assert " 200 " in page.splitlines()[0] and "Content-Security-Policy" in page
    with connect(
        f"wss://{NAME}/s/behind-the-proxy-00000000",
        sock=socket.create_connection(("127.0.0.1", proxy.tls)),
        ssl=proxy.context,
        origin=f"https://{NAME}",  # pyright: ignore[reportArgumentType]
        subprotocols=["viser-v1.1.1"],  # pyright: ignore[reportArgumentType]
        compression=None,
        max_size=None,
    ) as page_socket:
        assert len(page_socket.recv(timeout=5)) > 0


def test_plain_requests_are_sent_to_tls_and_figures_stay_inside(proxy: Proxy) -> None:
    moved = ask(proxy.plain, "/s/x/", {"Host": NAME})
    assert moved.status == 301 and moved.headers["Location"] == f"https://{NAME}/s/x/"
    assert " 404 " in proxy.get("/metrics").splitlines()[0], "the server of this test has none"


def test_another_name_is_refused_by_the_server(proxy: Proxy) -> None:
    assert " 421 " in proxy.get("/", host="evil.example").splitlines()[0]
