"""Who is let in by the viewer's server: nobody but a page of its own, opened with the whole address."""

import http.client
from urllib.parse import urlsplit

import pytest

pages = pytest.importorskip("suchus.apps.viewer.pages", reason="the extra viewer is not installed")
from websockets.asyncio import server  # noqa: E402
from websockets.datastructures import Headers  # noqa: E402
from websockets.exceptions import InvalidStatus  # noqa: E402
from websockets.http11 import Request  # noqa: E402
from websockets.sync.client import connect  # noqa: E402

from suchus.apps.viewer.server import Gate  # noqa: E402

pytestmark = pytest.mark.filterwarnings("default")  # viser's threads outlive its server for a moment


class Silent:
    """A page that shows nothing."""

    def run(self):
        pass

    def close(self):
        pass


@pytest.fixture(scope="module")
def viewer():
    found = pages.Viewer(lambda client: Silent(), port=0)
    yield found
    found.stop()


def answer(viewer, path, **headers):
    asking = http.client.HTTPConnection("127.0.0.1", urlsplit(viewer.url).port, timeout=120)
    asking.request("GET", path, headers=headers)
    said = asking.getresponse()
    body = said.read()
    asking.close()
    return said.status, dict(said.getheaders()), body


def test_the_page_is_for_those_who_know_the_address(viewer):
    where = urlsplit(viewer.url)
    status, headers, body = answer(viewer, where.path)
    assert status == 200
    assert b"Viser" in body
    assert "frame-ancestors 'none'" in headers["Content-Security-Policy"]
    assert headers["X-Frame-Options"] == "DENY"
    assert headers["Referrer-Policy"] == "no-referrer"
    for path in ("/", "/index.html", f"{where.path[:-2]}/", "/x" + where.path):
        assert answer(viewer, path)[0] == 403
    own = f"localhost:{where.port}"
    assert answer(viewer, where.path, Host=own, Origin=f"http://{own}")[0] == 200


@pytest.mark.parametrize("header", [{"Origin": "http://evil.example"}, {"Origin": "null"}, {"Host": "evil.example"}])
def test_a_page_of_elsewhere_is_refused_even_with_the_address(viewer, header):
    where = urlsplit(viewer.url)
    assert answer(viewer, where.path, **header)[0] == 403
    origin = header.get("Origin")
    with pytest.raises(InvalidStatus, match="403"):
        connect(
            f"ws://127.0.0.1:{where.port}{where.path}",
            origin=origin,
            additional_headers=None if origin else header,
            subprotocols=["viser-v0"],
        )
    assert viewer.watching == 0


def test_a_socket_without_the_token_takes_no_seat(viewer):
    with pytest.raises(InvalidStatus, match="403"):
        connect(f"ws://127.0.0.1:{urlsplit(viewer.url).port}/", subprotocols=["viser-v0"])
    assert viewer.watching == 0


@pytest.mark.parametrize(
    ("listens", "asks", "may"),
    [
        ("127.0.0.1", "localhost:8080", True),
        ("127.0.0.1", "[::1]:8080", True),
        ("127.0.0.1", "192.168.1.2:8080", False),
        ("127.0.0.1", "rebound.example:8080", False),
        ("0.0.0.0", "192.168.1.2:8080", True),
        ("0.0.0.0", "rebound.example:8080", False),
        ("lab.example", "lab.example:8080", True),
        ("lab.example", "rebound.example", False),
    ],
)
def test_names_that_others_may_rebind_are_not_ours(listens, asks, may):
    gate = Gate(listens)
    path = f"/{gate.token}/"
    assert gate.admits(Request(path, Headers([("Host", asks)]))) is may
    assert not gate.admits(Request("/", Headers([("Host", asks)])))
    assert not gate.admits(Request(path, Headers([("Host", asks), ("Host", asks)])))
    assert not gate.admits(Request(path, Headers([])))


def test_a_server_that_lets_everybody_in_does_not_serve(monkeypatch):
    monkeypatch.setattr(Gate, "guarded", lambda self, answer: answer)
    with pytest.raises(pages.CannotServe, match="lets in whoever asks"):
        pages.Viewer(lambda client: Silent(), port=0)
    assert server.serve.__module__ == "websockets.asyncio.server"  # nothing is left in its place
