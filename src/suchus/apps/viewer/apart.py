"""A page in a process of its own, so that whoever moves the robot is never kept waiting by a browser."""

import os
import time
from collections.abc import Callable
from contextlib import suppress
from multiprocessing import get_context
from multiprocessing.connection import Connection

from suchus.apps.viewer.server import CannotServe, Viewer
from suchus.apps.viewer.stage import camera
from suchus.apps.viewer.watch_page import WatchedRobot, WatchPage
from suchus.core.errors import SuchusError
from suchus.core.jobs.processes import without_interrupts
from suchus.core.stopping import end_with_parent
from suchus.robot.design import Robot

_PICTURE_INTERVAL = 1 / 25  # [s]; between two pictures that are handed over
_PIPE_CLOSED = (EOFError, OSError)  # errors of a pipe whose other end is closed
_STOP_TIMEOUT = 5.0  # [s]; for a process that was told to stop
_NICE_INCREMENT = 5  # lowers the priority below that of the bus


class WatchProcess:
    """A page that watches a robot, served by a process of its own, which ends with this one.

    Args:
        robot: the robot.
        picture: returns what is seen now; called by ``send_state`` only.
        port: to listen on; 0 for any that is free.
        title: title of the page.

    Raises:
        CannotServe: the port is taken, or the process ended before it served.
    """

    def __init__(self, robot: Robot, picture: Callable[[], WatchedRobot], *, port: int, title: str) -> None:
        self._picture, self._picture_time = picture, 0.0
        spawning = get_context("spawn")
        self._pipe, child_pipe = spawning.Pipe()
        self._process = spawning.Process(target=_serve_pictures, args=(child_pipe, robot, port, title), daemon=True)
        with without_interrupts():
            self._process.start()
        child_pipe.close()
        try:
            self._pipe.send(picture())
            answer: str | SuchusError = self._pipe.recv()
        except _PIPE_CLOSED as error:
            self.stop()
            raise CannotServe("the process that serves the page ended before it did; try it without --view.") from error
        if isinstance(answer, SuchusError):
            self.stop()
            raise answer
        self.url = answer

    def send_state(self) -> None:
        """Send the robot's state if it is due and the page requested it; never wait for the page."""
        time_now = time.monotonic()
        if time_now - self._picture_time < _PICTURE_INTERVAL:
            return
        with suppress(*_PIPE_CLOSED):
            if self._pipe.poll():
                self._pipe.recv()
                self._picture_time = time_now
                self._pipe.send(self._picture())

    def stop(self) -> None:
        """End the page and its process."""
        self._pipe.close()
        self._process.join(_STOP_TIMEOUT)
        if self._process.is_alive():
            self._process.kill()


def _serve_pictures(pipe: Connection, robot: Robot, port: int, title: str) -> None:
    """Serve pictures until the other end of the pipe is closed."""
    end_with_parent()
    with suppress(OSError):
        os.nice(_NICE_INCREMENT)
    watched_robot: WatchedRobot = pipe.recv()
    try:
        viewer = Viewer(
            lambda client: WatchPage(client, robot, lambda: watched_robot), port=port, title=title, camera=camera(robot)
        )
    except SuchusError as error:
        pipe.send(error)
        return
    try:
        pipe.send(viewer.url)
        while True:
            pipe.send(None)
            watched_robot = pipe.recv()
    except _PIPE_CLOSED:
        viewer.stop()
