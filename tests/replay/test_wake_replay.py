"""A swim in three dimensions as one page: what is packed, what is refused, and the page in a browser."""

import base64
import json
import re

import numpy as np
import pytest
from tests.replay.test_player import BROWSER, browser, fits_a_phone, until  # noqa: F401
from tests.wakes import ringed

from suchus.core.errors import IncompatibleRecord
from suchus.visual.figures import vortices
from suchus.visual.replay import page, save, wake_replay


def unpacked(page):
    """The page's description and a function that reads its arrays."""
    meta = json.loads(re.search(r'<script id="meta"[^>]*>(.*?)</script>', page, re.S)[1])
    raw = base64.b64decode(re.search(r'<script id="data"[^>]*>(.*?)</script>', page, re.S)[1])
    return meta, lambda ref: np.frombuffer(raw, ref["kind"], ref["count"], ref["start"])


def test_surfaces_and_midlines_come_back_from_the_page():
    record = ringed()
    meta, take = unpacked(wake_replay(record, title="A ring", caption="It moves."))
    assert len(meta["frames"]) == 3
    for i, one in enumerate(meta["frames"]):
        found, spin = vortices.surface(record, i)
        points = take(one["points"]).reshape(-1, 3) * meta["scale"] / 32767 + meta["middle"]
        assert points == pytest.approx(found.points, abs=1e-4)
        assert take(one["faces"]).reshape(-1, 3) == pytest.approx(found.faces)
        assert take(one["spin"]) / 127 * meta["limit"] == pytest.approx(
            np.clip(spin, -meta["limit"], meta["limit"]), abs=0.1
        )
    lines = meta["lines"]["half_width"]
    assert take(lines["array"]) * lines["scale"] / 32767 == pytest.approx(
        record.film_half_width.values.ravel(), abs=1e-5
    )


def test_a_page_stays_small_by_coarser_blocks(monkeypatch):
    record = ringed()
    fine = wake_replay(record)
    monkeypatch.setattr(page, "MAX_ARRAY_BYTES", 40_000)
    coarse = wake_replay(record)
    assert [unpacked(page)[0]["coarse"] for page in (fine, coarse)] == [1, 2]
    assert len(coarse) < len(fine)
    assert len(fine) < 1_000_000


@pytest.mark.parametrize("name", ["vortices", "film_heading", "half_height"])
def test_a_record_without_vortices_is_refused(name):
    with pytest.raises(IncompatibleRecord, match=f"the record has no {name}"):
        wake_replay(ringed().drop_vars(name))


def test_words_cannot_break_the_page():
    page = wake_replay(ringed(1), title="<script>alert(1)</script>", caption="</script><!--")
    assert "<script>alert" not in page
    assert page.count("<script") == 3


needs_browser = pytest.mark.skipif(BROWSER is None, reason="no chromium is installed: the page is not tried in one")


@pytest.fixture(scope="module")
def address(tmp_path_factory):
    return save(wake_replay(ringed(), caption="What is seen."), tmp_path_factory.mktemp("wake") / "swim.html").as_uri()


@needs_browser
def test_it_plays_from_a_file_without_network_or_complaint(browser, address):  # noqa: F811
    shown, complaints, asked = browser.new_page(viewport={"width": 640, "height": 480}), [], []
    shown.on("console", lambda message: complaints.append(message.text))
    shown.on("pageerror", lambda error: complaints.append(str(error)))
    shown.on("request", lambda request: asked.append(request.url))
    shown.goto(address + "#t=0")
    until(shown, "window.suchus")
    with_vortices = shown.locator("main").screenshot()
    shown.get_by_role("checkbox").uncheck()
    shown.wait_for_timeout(200)
    assert len(shown.locator("main").screenshot()) < len(with_vortices)
    shown.get_by_role("button", name="Play").click()
    until(shown, "window.suchus.shown() > 0")
    shown.get_by_role("button", name="Pause").click()
    shown.locator("canvas").focus()
    shown.keyboard.press("End")
    until(shown, "window.suchus.shown() === 2")
    shown.get_by_role("combobox", name="View").select_option("above")
    assert shown.evaluate("window.suchus.camera.elevation") > 1.5
    assert complaints == []
    assert asked == [address]
    shown.close()


@needs_browser
def test_it_fits_a_phone(browser, address):  # noqa: F811
    assert fits_a_phone(browser, address)


@needs_browser
@pytest.mark.slow("a browser is begun for it alone")
def test_without_webgl_there_is_a_picture(browser, address):  # noqa: F811
    shown = browser.new_page()
    shown.add_init_script("HTMLCanvasElement.prototype.getContext = () => null")
    shown.goto(address)
    assert shown.locator("#still img").is_visible()
    assert not shown.locator("#play").is_visible()
    shown.close()
