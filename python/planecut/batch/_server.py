"""The other end of a batch whose jobs are done elsewhere: a connection for each job at a time."""

from __future__ import annotations

import hmac
import json
import secrets
import socketserver
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

from ._remote import Answer, failed

CarryOut = Callable[[dict[str, Any]], Answer]
"""Has a request carried out somewhere, and waits for it."""


class _Handler(socketserver.StreamRequestHandler):
    """A connection: the token, then a request a line."""

    server: _Sockets

    def handle(self) -> None:
        if not hmac.compare_digest(self.rfile.readline(100).strip(), self.server.token.encode()):
            return
        for line in self.rfile:
            self.wfile.write(json.dumps(_answer(self.server.carry_out, json.loads(line))).encode() + b"\n")
            self.wfile.flush()


class _Sockets(socketserver.ThreadingTCPServer):
    daemon_threads = True

    def __init__(self, carry_out: CarryOut) -> None:
        super().__init__(("127.0.0.1", 0), _Handler)
        self.carry_out = carry_out
        self.token = secrets.token_hex(16)


class Server:
    """Answers the requests of a batch, on this machine alone, and of nobody who does not know the token."""

    def __init__(self, carry_out: CarryOut) -> None:
        self._server = _Sockets(carry_out)
        self.token = self._server.token
        self.address = f"127.0.0.1:{self._server.server_address[1]}"

    def __enter__(self) -> Server:
        threading.Thread(target=self._server.serve_forever, daemon=True).start()
        return self

    def __exit__(self, *_: object) -> None:
        self._server.shutdown()
        self._server.server_close()


def _answer(carry_out: CarryOut, request: dict[str, Any]) -> dict[str, Any]:
    folder = Path(request["folder"])
    # outputs may lie in folders that the batch has made for them
    request["folders"] = [str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_dir()] + [""]
    try:
        answer, files = carry_out(request)
        for name, content in files.items():
            path = folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)
    except Exception as error:  # whatever a cluster says of a task that it has lost
        return failed(" ".join(f"found {type(error).__name__}: {error}".split()))
    return answer
