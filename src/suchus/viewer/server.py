"""The server: one page per browser, each with a walk or a player of its own."""

import io
import logging
import socket
import warnings
from collections.abc import Callable
from contextlib import redirect_stdout
from http import HTTPStatus
from http.client import HTTPConnection, HTTPException
from threading import Event, Lock
from typing import Any, Protocol

import viser

from suchus.errors import SuchusError
from suchus.viewer.gate import LOOPBACK, Gate
from suchus.viewer.stage import CAMERA, LOOKS_AT

MOST = 4
"""Browsers that are served at once; each walk takes a tenth to a fifth of a processor core at real time [-]."""


class CannotServe(SuchusError, OSError):
    """A place in the network that cannot be listened on."""


class BrowserPage(Protocol):
    """The page that one browser shows."""

    def run(self) -> None:
        """Live until closed."""

    def close(self) -> None:
        """End soon."""


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
        most: how many browsers are served at once.
        title: of the panel of controls.
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
        most: int = MOST,
        title: str = "suchus",
        camera: tuple[tuple[float, float, float], tuple[float, float, float]] = (CAMERA, LOOKS_AT),
    ) -> None:
        _check_free(host, port)
        warnings.filterwarnings("ignore", message="Queued a .* on a closed connection")  # a browser left in mid-frame
        logging.getLogger("websockets.server").setLevel(logging.CRITICAL)  # a browser that leaves early is no error
        self._open, self._most = open_page, most
        self._pages: dict[int, BrowserPage | None] = {}
        self._lock = Lock()
        self._over = Event()
        gate = Gate(host)
        with redirect_stdout(io.StringIO()), gate.before():  # viser has a banner of its own
            self._server = _Server(host=host, port=port, label=title, verbose=False)
        self._server.gui.configure_theme(show_logo=False, show_share_button=False, brand_color=(0, 114, 178))
        self._server.initial_camera.position, self._server.initial_camera.look_at = camera
        self._server.initial_camera.fov = 0.72
        self._server.on_client_connect(self._come)
        self._server.on_client_disconnect(self._go)
        bound = self._server.get_port()
        try:
            _check_shut(host, bound)
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
        while not self._over.wait(0.5):
            pass

    def stop(self) -> None:
        """End all pages and the server."""
        self._over.set()
        with self._lock:
            pages = list(self._pages.values())
        for page in pages:
            if page is not None:
                page.close()
        with redirect_stdout(io.StringIO()):
            self._server.stop()

    def _come(self, client: Any) -> None:
        with self._lock:
            full = len(self._pages) >= self._most or self._over.is_set()
            if not full:
                self._pages[client.client_id] = None
        if full:
            client.gui.add_markdown(
                f"**All {self._most} places are taken.** As many browsers are watching as this server lets in. "
                "Close one of them and reload this page, or start the server with a greater `--most`."
            )
            return
        try:
            page = self._open(client)
        except SuchusError as error:
            client.gui.add_markdown(f"**This cannot be shown.** {error}")
            return
        with self._lock:
            gone = client.client_id not in self._pages
            if not gone:
                self._pages[client.client_id] = page
        if not gone:
            page.run()

    def _go(self, client: Any) -> None:
        with self._lock:
            page = self._pages.pop(client.client_id, None)
        if page is not None:
            page.close()


def _check_free(host: str, port: int) -> None:
    """Refuse a place that cannot be listened on; viser would search for another one, or for ever."""
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


def _check_shut(host: str, port: int) -> None:
    """Refuse to serve where somebody without the whole address is let in."""
    near = {"0.0.0.0": "127.0.0.1", "::": "::1", "": "127.0.0.1"}.get(host, host)
    asking = HTTPConnection(near, port, timeout=10.0)
    try:
        asking.request("GET", "/")
        status = asking.getresponse().status
    except (OSError, HTTPException) as error:
        raise CannotServe(f"the server on {host}, port {port} does not answer: {error}.") from error
    finally:
        asking.close()
    if status != HTTPStatus.FORBIDDEN:
        raise CannotServe("the server lets in whoever asks, which it must not; install the viser that suchus names.")


def _bracketed(host: str) -> str:
    return f"[{host}]" if ":" in host else host
