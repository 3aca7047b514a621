"""What can go wrong, each a sentence: what, the value, what is allowed, the remedy."""

from collections.abc import Iterable
from difflib import get_close_matches
from typing import Any


class SuchusError(Exception):
    """Base of every error that suchus raises on purpose."""


class InvalidDesign(SuchusError, ValueError):
    """A robot, gait or setting that cannot exist."""


class OutsideLimits(SuchusError, ValueError):
    """A command that the robot's joints or servos cannot follow."""


class UnsuitedRobot(SuchusError, ValueError):
    """A robot that lacks what is needed of it."""


class UnreadableFile(SuchusError, ValueError):
    """A file that is missing, broken, or says something else than it should."""


class Unwritable(SuchusError, OSError):
    """A place that nothing can be written to."""


class IncompatibleRecord(SuchusError, ValueError):
    """A record that lacks what is asked of it, or was written by another version."""


class NotConverged(SuchusError, RuntimeError):
    """An iteration that ended without an answer."""


class UnknownName(SuchusError, KeyError):
    """A name that is not on the shelf.

    Attributes:
        name: the name asked for.
        available: the names that exist.
    """

    def __init__(self, kind: str, name: str, available: Iterable[str]) -> None:
        self.name = name
        self.available = tuple(available)
        near = get_close_matches(name, self.available, n=1)
        hint = f" Did you mean {near[0]!r}?" if near else ""
        super().__init__(f"there is no {kind} named {name!r}; there is {', '.join(self.available)}.{hint}")

    def __str__(self) -> str:
        return str(self.args[0])


class Unreachable(SuchusError, ValueError):
    """Points that a limb or the spine cannot reach.

    Attributes:
        points: the offending points, shape (n, 3) [m].
        reach: nearest and farthest distance that can be reached [m].
    """

    def __init__(self, message: str, *, points: Any, reach: tuple[float, float]) -> None:
        super().__init__(message)
        self.points = points
        self.reach = reach


class Diverged(SuchusError, RuntimeError):
    """A simulation that left the realm of finite numbers.

    Attributes:
        time: when [s].
        record: what was recorded until then.
    """

    def __init__(self, message: str, *, time: float, record: Any = None) -> None:
        super().__init__(message)
        self.time = time
        self.record = record
