"""A job: many pieces of work of one kind, and where their results stay."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Generic, NamedTuple, Protocol, TypeVar

from suchus.core.jobs.made_by import source_versions
from suchus.core.progress import Progress

Item = TypeVar("Item")
Result = TypeVar("Result")


@dataclass(frozen=True, slots=True, kw_only=True)
class Job(Generic[Item, Result]):
    """Pieces of work of one kind: each makes its result from its item alone, wherever it is done and beside what."""

    name: str
    """Name, in messages and on Dask's own pages."""
    kind: str
    """What it is called in messages, as ``study``."""
    piece: str
    """What one of its pieces is called in messages, as ``batch``."""
    unit: str
    """What progress counts, as ``runs``."""
    work: Callable[[Item, Progress], Result]
    """Makes the result of an item, and tells how far it is; a ``SuchusError`` that it raises ends the job. It, items
    and results travel as pickles to other processes and machines."""
    items: Sequence[Item]
    """What differs between the pieces."""
    sizes: Sequence[float] | None = None
    """How many units each piece has [-]; one each if None."""
    failures: Callable[[Result], int] | None = None
    """Returns how many units of a result failed; None where none can."""
    versions: Callable[[], Mapping[str, str]] = source_versions
    """Returns what decides the bytes; it must return the same on every machine. See ``made_by.source_versions``."""
    tries: int = 3
    """How often a piece is begun at most whose process or worker dies [-]."""
    died: Callable[[Item, int | None], Result] | None = None
    """Returns the result of an item whose processes died, from the exit code of the last; None where that ends the
    job."""

    def size(self, number: int) -> float:
        """Return how many units a piece has [-]."""
        return 1.0 if self.sizes is None else self.sizes[number]

    def failed(self, result: Result) -> int:
        """Return how many units of a result failed [-]."""
        return 0 if self.failures is None else self.failures(result)


class PieceCrash(NamedTuple):
    """The outcome of a piece whose processes ended before the piece was finished."""

    exit_code: int | None
    """Exit code of the last of them; negative for the signal that killed it."""


class ResultStore(Protocol[Result]):
    """Storage for the results of a job; a stored result survives the end of the program."""

    def has(self, number: int) -> bool:
        """Return whether the store has the complete result of a piece, equal to what the work would compute again."""

    def get(self, number: int) -> Result:
        """Return a result that is there."""

    def put(self, number: int, result: Result) -> None:
        """Keep a result.

        Raises:
            Unwritable: it cannot be written.
        """


class InMemory(Generic[Result]):
    """Results that stay as long as the program: for small jobs."""

    def __init__(self) -> None:
        self._results: dict[int, Result] = {}

    def has(self, number: int) -> bool:
        """Return whether a result is there."""
        return number in self._results

    def get(self, number: int) -> Result:
        """Return a result that is there."""
        return self._results[number]

    def put(self, number: int, result: Result) -> None:
        """Keep a result."""
        self._results[number] = result


AnyJob = Job[Any, Any]
