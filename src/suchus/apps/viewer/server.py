"""The server: who is let in, and one page per browser, each with a walk or a player of its own.

Let in is whoever knows the address, by a page of this server, in a window of its own.
"""

import io
import ipaddress
import logging
import secrets
import socket
import warnings
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, redirect_stdout
from http import HTTPStatus
from http.client import HTTPConnection, HTTPException
from math import tan
from threading import Event, Lock
from time import monotonic
from typing import Any
from urllib.parse import unquote

import numpy as np
import viser
from websockets.asyncio import server
from websockets.datastructures import Headers
from websockets.http11 import Request, Response

from suchus.apps.viewer.plots import PLOTS
from suchus.apps.viewer.stage import CAMERA, LOOKS_AT
from suchus.core.errors import SuchusError

LOOPBACK = ("127.0.0.1", "localhost", "::1")
"""Names of this computer that no other one reaches."""
_ANY_ADDRESS = ("0.0.0.0", "::", "")
_REFUSAL = b"This is not the whole address. Open the one that suchus printed when it began to serve.\n"

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
        if len(hosts) != 1 or not self._is_own_name(hosts[0]) or len(origins) > 1:
            return False
        if origins and origins[0].lower() != f"http://{hosts[0].lower()}":
            return False
        path_token = unquote(request.path.partition("?")[0]).strip("/").partition("/")[0]
        return secrets.compare_digest(path_token.encode(), self.token.encode())

    def _is_own_name(self, host: str) -> bool:
        """Return whether a host name in a request is a name of this server."""
        name = host.rpartition(":")[0] if host.rpartition(":")[2].isdecimal() else host
        name = name.strip("[]").lower()
        if name == self._host.lower():
            return True
        if self._host in LOOPBACK:
            return name in LOOPBACK
        host_names = {socket.gethostname().lower(), socket.getfqdn().lower()}
        return name in LOOPBACK or _is_address(name) or (self._host in _ANY_ADDRESS and name in host_names)

    def guarded(self, answer: Answer) -> Answer:
        """Return a handler that passes admitted requests to ``answer`` and adds protective headers."""

        def guard(connection: Any, request: Request) -> Response | None:
            """Answer an admitted request with protective headers; refuse any other request with status 403."""
            if not self.admits(request):
                headers = Headers({"Content-Type": "text/plain", "Content-Length": str(len(_REFUSAL))})
                return Response(HTTPStatus.FORBIDDEN.value, "Forbidden", headers, _REFUSAL)
            (host,) = request.headers.get_all("Host")
            request.path = "/" + request.path.strip("/").partition("/")[2]
            response = answer(connection, request)
            if response is not None:
                response.headers.update(_closed(host))
            return response

        return guard

    @contextmanager
    def guard_server(self) -> Iterator[None]:
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
    """Return headers that forbid loading from other origins and embedding in other pages."""
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
    """Return whether a name is an IP address."""
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


FRAME = 1 / 20
"""Time between two pictures [s]."""
MAX_BROWSERS = 4
"""Browsers that are served at once; each walk takes a tenth to a fifth of a processor core at real time [-]."""


PANEL = 330
"""Width of the controls to the right of the scene [pixel]."""
MAX_MESSAGES = 8192
"""Messages that go to a browser at once [-]; by viser's 128 a picture of a robot arrived in parts, and its skin, in
as many meshes as it has colours, was torn in a browser that drew in between."""
_MAX_PHONE_WIDTH = 576
"""Width of a window up to which viser shows all controls in a sheet at its lower end [pixel]."""
_SHEET_FRACTION = 0.42
"""Share of the height of such a window that the sheet takes [-]."""
_FOV = 0.72
"""Vertical angle of view [rad]."""
_MIN_ASPECT = 0.8
"""Width over height of a scene from which the camera need not stand farther away [-]."""
_INK = f"""<style>
:root[data-mantine-color-scheme="light"] {{
--mantine-color-dimmed: #535b63 !important; --mantine-color-gray-6: #535b63 !important; }}
:root[data-mantine-color-scheme="light"] [role="tab"] {{ color: #005f99 !important; }}
:root[data-mantine-color-scheme="dark"] {{
--mantine-color-dimmed: #b8bcc0 !important; --mantine-color-dark-2: #b8bcc0 !important; }}
:root {{ --mantine-color-red-filled: #c92a2a !important; }}
@media (max-width: {_MAX_PHONE_WIDTH}px) {{
[style*="max-height: 60%"] {{ max-height: {100 * _SHEET_FRACTION:.0f}% !important; width: 100% !important; }}
[style*="max-height: 60%"] [style*="width: 20em"] {{ width: 100% !important; }}
}}
</style>"""
"""Labels with a contrast of 4.5 to 1 at least, and a sheet that leaves the scene free on a phone."""


class CannotServe(SuchusError, OSError):
    """A place in the network that cannot be listened on."""


class BrowserPage(ABC):
    """The page that one browser shows.

    Args:
        client: viser's handle of the browser.
    """

    def __init__(self, client: Any) -> None:
        self._client, self._closed = client, Event()
        client.gui.add_html(_INK)
        self._status = client.gui.add_html("")

    @abstractmethod
    def draw(self, clock: float, elapsed: float) -> None:
        """Draw one picture.

        Args:
            clock: by a clock that never goes back [s].
            elapsed: time since the picture before [s].
        """

    def run(self) -> None:
        """Draw pictures until closed."""
        last_clock = monotonic()
        while not self._closed.is_set():
            clock = monotonic()
            self.draw(clock, clock - last_clock)
            last_clock = clock
            self._closed.wait(max(0.005, FRAME - (monotonic() - clock)))

    def close(self) -> None:
        """End soon."""
        self._closed.set()

    def _dock(self) -> None:
        """Put the controls to the right of the scene."""
        panel = self._client.gui.main_panel
        panel.dock_right()
        panel.set_width(PANEL)


class _Server(viser.ViserServer):  # type: ignore[misc]
    def request_share_url(self, verbose: bool = True) -> str | None:
        """Open no tunnel to the outside, whatever a browser asks."""
        del verbose
        return None


class Viewer:
    """A server whose browsers do not disturb each other.

    Args:
        open_page: makes the page of a browser, given viser's handle of it.
        host: name or address to listen on.
        port: to listen on; 0 for any that is free.
        max_browsers: how many browsers are served at once.
        title: title of the panel of controls.
        camera: where the camera is at first and where it looks [m].

    Raises:
        CannotServe: the port is taken, or the host is not this machine.
    """

    def __init__(
        self,
        open_page: Callable[[Any], BrowserPage],
        *,
        host: str = "127.0.0.1",
        port: int = 8080,
        max_browsers: int = MAX_BROWSERS,
        title: str = "suchus",
        camera: tuple[tuple[float, float, float], tuple[float, float, float]] = (CAMERA, LOOKS_AT),
    ) -> None:
        _check_free(host, port)
        warnings.filterwarnings(
            "ignore", message="Queued a .* on a closed connection"
        )  # a browser that left during a frame
        logging.getLogger("websockets.server").setLevel(logging.CRITICAL)  # a browser that leaves early is no error
        self._open, self._max_browsers = open_page, max_browsers
        self._pages: dict[int, BrowserPage | None] = {}
        self._lock = Lock()
        self._stop_event = Event()
        gate = Gate(host)
        with redirect_stdout(io.StringIO()), gate.guard_server():  # suppresses viser's banner
            self._server = _Server(host=host, port=port, label=title, verbose=False)
        self._server.gui.configure_theme(show_logo=False, show_share_button=False, brand_color=(0, 114, 178))
        self._server.initial_camera.position, self._server.initial_camera.look_at = camera
        self._server.initial_camera.fov = _FOV
        self._camera = camera
        self._server.on_client_connect(self._connect_client)
        self._server.on_client_disconnect(self._disconnect_client)
        bound = self._server.get_port()
        try:
            _check_refuses(host, bound)
        except CannotServe:
            self.stop()
            raise
        self.url = f"http://{'localhost' if host in LOOPBACK else _bracketed(host)}:{bound}/{gate.token}/"

    @property
    def watching(self) -> int:
        """Number of browsers that have a page [-]."""
        with self._lock:
            return len(self._pages)

    def wait(self) -> None:
        """Serve until stopped or interrupted."""
        while not self._stop_event.wait(0.5):
            pass

    def stop(self) -> None:
        """End all pages and the server."""
        self._stop_event.set()
        with self._lock:
            pages = list(self._pages.values())
        for page in pages:
            if page is not None:
                page.close()
        with redirect_stdout(io.StringIO()):
            self._server.stop()

    def _connect_client(self, client: Any) -> None:
        """Open a page for a new browser and draw it until it closes; refuse the browser if the server is full."""
        with self._lock:
            is_full = len(self._pages) >= self._max_browsers or self._stop_event.is_set()
            if not is_full:
                self._pages[client.client_id] = None
        if is_full:
            client.gui.add_markdown(
                f"**All {self._max_browsers} places are taken.** As many browsers are watching as this server lets in. "
                "Close one of them and reload this page, or start the server with a greater `--most`."
            )
            return
        client._websock_connection.get_message_buffer().max_window_size = MAX_MESSAGES
        _stand_back(client.camera, *self._camera)
        try:
            page = self._open(client)
        except SuchusError as error:
            client.gui.add_markdown(f"**This cannot be shown.** {error}")
            return
        with self._lock:
            is_gone = client.client_id not in self._pages
            if not is_gone:
                self._pages[client.client_id] = page
        if not is_gone:
            page.run()

    def _disconnect_client(self, client: Any) -> None:
        with self._lock:
            page = self._pages.pop(client.client_id, None)
        if page is not None:
            page.close()


def _stand_back(camera: Any, position: Sequence[float], looks_at: Sequence[float]) -> None:
    """Move a camera so far back that what it looks at fits between the panels, or above the sheet of a phone."""
    width, height = float(camera.image_width), float(camera.image_height)
    is_phone = width <= _MAX_PHONE_WIDTH
    aspect = (width if is_phone else max(width - PANEL - PLOTS, 1.0)) / max(height, 1.0)
    target, offset = np.array(looks_at), np.array(position) - np.array(looks_at)
    offset *= max(1.0, _MIN_ASPECT / aspect)
    if is_phone:  # centres the target above the sheet
        target = target - np.array([0.0, 0.0, _SHEET_FRACTION * float(np.linalg.norm(offset)) * tan(0.5 * _FOV)])
    camera.position = target + offset
    camera.look_at = target


def _check_free(host: str, port: int) -> None:
    """Refuse a port that cannot be listened on; viser would search for another one, or for ever."""
    try:
        family, kind, protocol, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
        with socket.socket(family, kind, protocol) as probe:
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            probe.bind(address)
    except (OSError, OverflowError, ValueError) as error:
        raise CannotServe(
            f"nothing can be served on {host}, port {port} ({getattr(error, 'strerror', None) or error}); "
            "take another --port, or 0 for any that is free."
        ) from error


def _check_refuses(host: str, port: int) -> None:
    """Refuse to serve if a request without the token is answered."""
    address = {"0.0.0.0": "127.0.0.1", "::": "::1", "": "127.0.0.1"}.get(host, host)
    connection = HTTPConnection(address, port, timeout=10.0)
    try:
        connection.request("GET", "/")
        status = connection.getresponse().status
    except (OSError, HTTPException) as error:
        raise CannotServe(f"the server on {host}, port {port} does not answer: {error}.") from error
    finally:
        connection.close()
    if status != HTTPStatus.FORBIDDEN:
        raise CannotServe("the server lets in whoever asks, which it must not; install the viser that suchus names.")


def _bracketed(host: str) -> str:
    return f"[{host}]" if ":" in host else host
