"""A page that watches a robot from a process of its own."""

from time import monotonic, sleep
from urllib.request import urlopen

import pytest

from suchus.hardware.emulator import EmulatedBody
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS

pages = pytest.importorskip("suchus.apps.viewer.pages", reason="the extra viewer is not installed")
ROBOT = ROBOTS["caiman"]


@pytest.mark.slow("a process that serves a page is killed")
def test_it_takes_pictures_while_the_robot_moves_and_ends_with_it():
    body, taken = EmulatedBody(ROBOT, GAITS["belly_crawl"]), []

    def picture():
        taken.append(body.time)
        return pages.WatchedRobot(body.time, body.now, None, "with its torque on")

    page = pages.WatchProcess(ROBOT, picture, port=0, title="watched")
    try:
        port = int(page.url.split(":")[2].split("/")[0])
        with pytest.raises(pages.CannotServe, match=str(port)):
            pages.WatchProcess(ROBOT, picture, port=port, title="another")
        with urlopen(page.url, timeout=120.0) as answer:
            assert answer.status == 200
        begun, end = len(taken), monotonic() + 120.0
        while len(taken) < begun + 5 and monotonic() < end:
            body.step()
            page.send_state()
            sleep(0.01)
        assert len(taken) >= begun + 5
        page._process.kill()
        page._process.join()
        for _ in range(20):
            sleep(0.01)
            page.send_state()  # whoever moves the robot does not mind
    finally:
        page.stop()
    assert not page._process.is_alive()
