"""What can go wrong, each a sentence: what, the value, what is allowed, the remedy."""

import re
import sys
import warnings
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from difflib import get_close_matches
from typing import Any

_LONG_WORD, _LONG_TEXT = 300, 3000  # characters of a message; what is longer was given to us, and is known to the giver


def shortened(text: str) -> str:
    """Return a message without what is too long to be read: the middle of words and of the whole."""
    text = re.sub(rf"\S{{{_LONG_WORD},}}", lambda word: f"{word[0][:160]}...{word[0][-60:]}", text)
    return text if len(text) <= _LONG_TEXT else f"{text[: _LONG_TEXT - 500]} ... {text[-400:]}"


class SuchusError(Exception):
    """Base of every error that suchus raises on purpose; its text never repeats pages of what was given."""

    def __str__(self) -> str:
        return shortened(str(self.args[0])) if self.args else ""


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


class NoMemory(SuchusError, MemoryError):
    """The memory does not suffice."""

    def __init__(
        self, message: str = "the memory does not suffice for this; ask for less at a time, or give more."
    ) -> None:
        super().__init__(message)


@contextmanager
def out_of_memory() -> Iterator[None]:
    """While the block runs, raise ``NoMemory`` where MuJoCo gets no memory, which raises errors of several kinds."""
    try:
        yield
    except Exception as error:
        if isinstance(error, SuchusError) or "Could not allocate memory" not in str(error):
            raise
        raise NoMemory from error


class IncompatibleRecord(SuchusError, ValueError):
    """A record that lacks what is asked of it, or was written by another version."""


class OtherMuJoCo(SuchusError, RuntimeError):
    """A MuJoCo whose memory is laid out otherwise than its own description says, so that water cannot act in it.

    Attributes:
        field: which field is not where it should be.
    """

    def __init__(self, field: str, version: str, reason: str) -> None:
        """Compose the message from the field, MuJoCo's version and the reason, a clause."""
        self.field = field
        super().__init__(
            f"the field {field} of MuJoCo {version} is not where it should be: {reason}. Water needs a version of "
            "MuJoCo that suchus was tested with, 4.0; dry land works with this one too."
        )


class BusFailure(SuchusError, RuntimeError):
    """Servos that cannot be reached or had to be stopped; the command line ends with 3.

    Attributes:
        record: of what was driven until then; None where nothing was.
    """

    def __init__(self, message: str, *, record: Any = None) -> None:
        super().__init__(message)
        self.record = record


class NotConverged(SuchusError, RuntimeError):
    """An iteration that ended without an answer."""


class UnknownName(SuchusError, KeyError):
    """A name that is not in the catalog.

    Attributes:
        name: the name asked for.
        available: the names that exist.
    """

    def __init__(self, kind: str, name: str, available: Iterable[str]) -> None:
        """Compose the message, with the available name that is most similar to the unknown one."""
        self.name = name
        self.available = tuple(available)
        matches = get_close_matches(str(name)[:_LONG_WORD], self.available, n=1)
        hint = f" Did you mean {matches[0]!r}?" if matches else ""
        existing = f"there is {', '.join(self.available)}" if self.available else f"no {kind} there has a name"
        super().__init__(f"there is no {kind} named {name!r}; {existing}.{hint}")


class AmbiguousName(SuchusError, ValueError):
    """Two things of one name in a catalog."""

    def __init__(self, kind: str, name: str, first_place: str, second_place: str) -> None:
        super().__init__(
            f"there are two {kind}s named {name!r}: {first_place} and {second_place}; give one of them another name."
        )


class BrokenFile(SuchusError, ImportError):
    """A module or a file of the user's in a catalog that cannot be loaded; the message says where and why."""


class Doubtful(UserWarning):
    """A result that stands and may be farther off than usual; the message says by how much and what helps.

    Attributes:
        kind: a word that stands in the names of the settings that mend it; empty if it is the only one of its kind. Of
            many warnings of a kind the command line says the worst.
        size: how bad it is among those of its kind.
    """

    def __init__(self, text: str, *, kind: str = "", size: float = 0.0) -> None:
        super().__init__(text)
        self.kind = kind
        self.size = size


_OF_LIBRARIES = (RuntimeWarning, DeprecationWarning, PendingDeprecationWarning, FutureWarning, ResourceWarning)
"""Kinds of warnings that are about code and not about results."""


@contextmanager
def plain_warnings(*labels: str, options: Iterable[str] = ()) -> Iterator[None]:
    """Write warnings as sentences on standard error, each once, after ``labels`` and without the place in the code.

    Warnings of the code of libraries, such as NumPy's of an overflow, say nothing to a user and are left out: what they
    leave is not finite, and is refused or named where it arises. Of many ``Doubtful`` warnings of one kind only the one
    of greatest ``size`` is printed, when the block ends, with the options that mend it.

    Args:
        labels: names of what warns, printed in front of each warning.
        options: words of the command line that the reader may change.
    """
    prefix, messages, worst_warnings = ": ".join(("suchus", *labels)), set[str](), dict[str, Doubtful]()

    def show(message: Warning | str, *_: object, **__: object) -> None:
        """Print a warning once; of warnings of a kind store the one of greatest ``size``."""
        if isinstance(message, _OF_LIBRARIES):
            return
        kind = getattr(message, "kind", "")
        if kind and isinstance(message, Doubtful):
            worst_warnings[kind] = max(message, worst_warnings.get(kind, message), key=lambda warning: warning.size)
        elif str(message) not in messages:
            messages.add(str(message))
            print(f"{prefix}: {message}", file=sys.stderr)

    with warnings.catch_warnings():
        warnings.showwarning = show
        try:
            yield
        finally:
            for kind, message in worst_warnings.items():
                mend = [option for option in options if kind in option]
                print(f"{prefix}: {message}" + f" See {', '.join(mend)}." * bool(mend), file=sys.stderr)


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
