"""Who is let in: whoever knows the address, by a page of this server, in a window of its own."""

import ipaddress
import secrets
import socket
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from http import HTTPStatus
from typing import Any
from urllib.parse import unquote

from websockets.asyncio import server
from websockets.datastructures import Headers
from websockets.http11 import Request, Response

LOOPBACK = ("127.0.0.1", "localhost", "::1")
"""Names of this computer that no other one reaches."""
_ANY = ("0.0.0.0", "::", "")
_REFUSED = b"This is not the whole address. Open the one that suchus printed when it began to serve.\n"

Answer = Callable[[Any, Request], Response | None]


class Gate:
    """Refuses requests that do not know the address, name another host, or come from a page of another origin.

    A page elsewhere can make a browser ask a server on its own computer, and name that server as it likes; it can
    neither read the token of the address nor lie about its origin.

    Args:
        host: what the server listens on.
    """

    def __init__(self, host: str) -> None:
        self.token = secrets.token_urlsafe(16)
        self._host = host

    def admits(self, request: Request) -> bool:
        """Return whether a request may be answered."""
        hosts, origins = (request.headers.get_all(name) for name in ("Host", "Origin"))
        if len(hosts) != 1 or not self._ours(hosts[0]) or len(origins) > 1:
            return False
        if origins and origins[0].lower() != f"http://{hosts[0].lower()}":
            return False
        first = unquote(request.path.partition("?")[0]).strip("/").partition("/")[0]
        return secrets.compare_digest(first.encode(), self.token.encode())

    def _ours(self, host: str) -> bool:
        """Return whether a name in a request is one of this server; a name that others rebind is not."""
        name = host.rpartition(":")[0] if host.rpartition(":")[2].isdecimal() else host
        name = name.strip("[]").lower()
        if name == self._host.lower():
            return True
        if self._host in LOOPBACK:
            return name in LOOPBACK
        known = {socket.gethostname().lower(), socket.getfqdn().lower()}
        return name in LOOPBACK or _is_address(name) or (self._host in _ANY and name in known)

    def guarded(self, answer: Answer) -> Answer:
        """Return what answers requests as ``answer`` does, if they are admitted, with the headers of a closed page."""

        def guard(connection: Any, request: Request) -> Response | None:
            if not self.admits(request):
                headers = Headers({"Content-Type": "text/plain", "Content-Length": str(len(_REFUSED))})
                return Response(HTTPStatus.FORBIDDEN.value, "Forbidden", headers, _REFUSED)
            (host,) = request.headers.get_all("Host")
            request.path = "/" + request.path.strip("/").partition("/")[2]
            response = answer(connection, request)
            if response is not None:
                response.headers.update(_closed(host))
            return response

        return guard

    @contextmanager
    def before(self) -> Iterator[None]:
        """Stand before the server of websockets that is begun in this block; viser offers no place of its own for it.

        ``Viewer`` tries the door before it lets anybody in, so that a viser that serves otherwise is noticed.
        """
        begin = server.serve

        def serve(*args: Any, process_request: Answer, **settings: Any) -> Any:
            return begin(*args, process_request=self.guarded(process_request), **settings)

        server.serve = serve  # type: ignore[assignment,misc]
        try:
            yield
        finally:
            server.serve = begin  # type: ignore[misc]


def _closed(host: str) -> dict[str, str]:
    """Return headers that keep a page to itself: it loads nothing from elsewhere, and stands in no other page."""
    return {
        "Content-Security-Policy": (
            "default-src 'self' 'unsafe-inline' 'unsafe-eval' data: blob:; "
            f"connect-src 'self' ws://{host} data: blob:; "
            "object-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
        ),
        "X-Frame-Options": "DENY",
        "X-Content-Type-Options": "nosniff",
        "Referrer-Policy": "no-referrer",
        "Cross-Origin-Opener-Policy": "same-origin",
        "Cross-Origin-Resource-Policy": "same-origin",
        "Cache-Control": "no-store",
    }


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True
