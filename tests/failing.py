"""Writes, renames, fsyncs and closes that fail, one after the other: a disk that is full for a moment, at any time."""

import builtins
import errno
import io
import os

from suchus.core.errors import Unwritable

KINDS = ("open", "write", "close", "rename", "fsync", "link", "mkdir")
"""What can fail."""


class Failing:
    """Lets the n-th of the operations of a kind in a folder fail, and counts them."""

    def __init__(self, monkeypatch, place, kind, which):
        self.place, self.kind, self.which, self.count = str(place), kind, which, 0
        opened = builtins.open

        def open_(file, mode="r", *rest, **more):
            writes = any(c in mode for c in "wax+") and self.inside(file)
            if writes:
                self.step("open")
            made = opened(file, mode, *rest, **more)
            if writes:
                write = made.write
                made = Writing(made, lambda data: (self.step("write"), write(data))[1], lambda: self.step("close"))
            return made

        monkeypatch.setattr(io, "open", open_)
        monkeypatch.setattr(builtins, "open", open_)
        for name, kind in {"rename": "rename", "replace": "rename", "link": "link", "mkdir": "mkdir"}.items():
            monkeypatch.setattr(os, name, self.counted(getattr(os, name), kind))
        monkeypatch.setattr(os, "fsync", self.counted(os.fsync, "fsync", anywhere=True))

    def counted(self, real, kind, *, anywhere=False):
        def call(path, *rest, **more):
            if anywhere or self.inside(path):
                self.step(kind)
            return real(path, *rest, **more)

        return call

    def inside(self, path):
        return not isinstance(path, int) and os.path.abspath(os.fspath(path)).startswith(self.place)  # noqa: PTH100

    def step(self, kind):
        if kind == self.kind:
            self.count += 1
            if self.count == self.which:
                raise OSError(errno.ENOSPC, "No space left on device")


class Writing:
    """A file whose writes are counted, and the first of its closings, which a network's disk may refuse."""

    def __init__(self, file, write, closed):
        self.file, self.write, self.closed = file, write, closed

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        first = not self.file.closed
        self.file.close()
        if first:
            self.closed()

    def __getattr__(self, name):
        return getattr(self.file, name)


def each_failing(place, work, monkeypatch, most=None):
    """Yield kind, number and error of each failure of some work, one after the other.

    Args:
        place: the folder in which they fail.
        work: what writes there; called anew for each failure.
        monkeypatch: pytest's.
        most: failures of a kind, spread over all there are; all if None.
    """
    for kind in KINDS:
        with monkeypatch.context() as patch:
            failing = Failing(patch, place, kind, 0)
            work()
        step = 1 if most is None else max(failing.count / most, 1)
        for which in sorted({1 + int(i * step) for i in range(int(failing.count / step))}):
            with monkeypatch.context() as patch:
                failing = Failing(patch, place, kind, which)
                try:
                    error = work()
                except Unwritable as caught:
                    error = caught
            if failing.count >= which:  # there is less to do where nothing was before
                yield kind, which, error
