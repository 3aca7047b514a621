"""A server of the lessons for phones in the room: the pages that were written, and nothing else of the folder."""

import ipaddress
import socket
from collections.abc import Mapping, Sequence
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from threading import Thread
from types import TracebackType
from typing import Any
from urllib.parse import unquote, urlsplit

from suchus.core.errors import SuchusError

_UNROUTED = ("192.0.2.1", 9)
"""An address that documentation reserves; a datagram socket connects to it without sending anything."""
_REQUEST_TIMEOUT = 30.0
"""Time that a phone has for its request [s]."""


class PortTaken(SuchusError):
    """The port for the lessons cannot be listened on."""


class LessonServer:
    """Serves files by their names to every device that reaches this computer; the first one also as ``/``.

    It listens from the start, so that a taken port is said before anything is computed, and answers from ``wait`` or
    ``start`` on.

    Args:
        files: the files; read anew for each request.
        port: port to listen on; 0 for any that is free.

    Raises:
        PortTaken: the port cannot be listened on.
    """

    def __init__(self, files: Sequence[Path], port: int) -> None:
        served = {file.name: file for file in files} | {"": files[0]}
        self._thread: Thread | None = None
        try:
            self._server = ThreadingHTTPServer(("", port), _handler(served))
        except OSError as error:
            raise PortTaken(
                f"nothing can be served on port {port} ({error.strerror or error}); take another --port, or 0 for any "
                "that is free."
            ) from error

    @property
    def address(self) -> str:
        """Address of the lessons in the network of this computer, with a slash at its end."""
        return f"http://{network_address()}:{self._server.server_port}/"

    def start(self) -> None:
        """Answer requests in a thread of its own, until the block ends."""
        self._thread = Thread(target=self._server.serve_forever, daemon=True)
        self._thread.start()

    def wait(self) -> None:
        """Answer requests until Ctrl-C."""
        try:
            self._server.serve_forever()
        except KeyboardInterrupt:
            return

    def __enter__(self) -> "LessonServer":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """End the thread before the socket is closed: on a closed socket it would ask without pause."""
        if self._thread is not None:
            self._server.shutdown()
            self._thread.join()
        self._server.server_close()


def network_address() -> str:
    """Return the address of this computer in its network; ``127.0.0.1`` where it has no network."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(_UNROUTED)
            address = str(probe.getsockname()[0])
        except OSError:
            return "127.0.0.1"
    return "127.0.0.1" if ipaddress.ip_address(address).is_unspecified else address


def _handler(served: Mapping[str, Path]) -> type[BaseHTTPRequestHandler]:
    """Return a request handler that answers with files of these names."""

    class Handler(BaseHTTPRequestHandler):
        """Answers GET and HEAD; every other method is refused by its base class."""

        timeout = _REQUEST_TIMEOUT

        def do_GET(self) -> None:
            self._answer(with_body=True)

        def do_HEAD(self) -> None:
            self._answer(with_body=False)

        def log_message(self, *_: Any) -> None:
            """Say nothing of each request."""

        def _answer(self, *, with_body: bool) -> None:
            """Send a page, or a sentence with status 404 where no page has the name."""
            file = served.get(unquote(urlsplit(self.path).path).removeprefix("/"))
            try:
                content = b"" if file is None else file.read_bytes()
            except OSError:  # asked for before it is written, or removed since
                file, content = None, b""
            if file is None:
                content = b"There is no such page here. Open the address without what follows its last slash.\n"
            self.send_response(HTTPStatus.NOT_FOUND if file is None else HTTPStatus.OK)
            self.send_header("Content-Type", f"text/{'plain' if file is None else 'html'}; charset=utf-8")
            self.send_header("Content-Length", str(len(content)))
            self.send_header("X-Content-Type-Options", "nosniff")
            self.send_header("Cache-Control", "no-cache")
            self.end_headers()
            if with_body:
                self.wfile.write(content)

    return Handler
