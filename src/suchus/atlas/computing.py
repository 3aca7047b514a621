"""Flows side by side, each in a process of its own. What is finished is kept, whatever happens to the others."""

from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any

from suchus.atlas.case import Case
from suchus.atlas.outcome import FlowOutcome, compute, digest_of, load_outcome, save_outcome
from suchus.errors import UnreadableFile
from suchus.jobs import Job, deciding, finish, place_for
from suchus.progress import Progress, silent


def compute_all(
    cases: Iterable[Case],
    folder: Path,
    *,
    jobs: int,
    quick: bool,
    client: Any = None,
    each: Callable[[str], Progress] = lambda _: silent,
    finished: Callable[[FlowOutcome], None] = lambda _: None,
) -> dict[str, FlowOutcome]:
    """Compute flows that are not there yet, ``jobs`` at a time, and return the outcomes of all by name.

    An outcome is written as soon as it is there. One of the same set-up by the same code is kept.

    Args:
        cases: the flows; the longest should come first.
        folder: of the outcomes.
        jobs: processes at a time, which share the threads; with 1 all is done here.
        quick: whether only a trial is wanted.
        client: a ``distributed.Client``, whose workers then compute the flows; this machine if None.
        each: returns what is told how far a flow is, by its name.
        finished: called with each outcome when it is there, with those of an earlier start first.

    Raises:
        Unwritable: an outcome cannot be written.
        NoCluster: the cluster was lost.
    """
    place = place_for("the atlas", client=client, jobs=jobs)
    outcomes = _Outcomes(cases, folder, quick)
    flows = outcomes.cases
    job = Job(
        name="atlas",
        kind="atlas",
        piece="flow",
        unit="flows",
        work=partial(_computed, quick=quick),
        items=flows,
        versions=partial(deciding, ("atlas", "flow"), ("numba",)),
        tries=1,  # a flow that takes too much memory takes it again
        died=partial(_died, quick),
    )
    for number in range(len(flows)):
        if outcomes.has(number):
            finished(outcomes.get(number))
    finish(
        job,
        outcomes,
        place=place,
        each=lambda number: each(flows[number].name),
        finished=lambda _, outcome: finished(outcome),
    )
    return {case.name: outcomes.get(number) for number, case in enumerate(flows)}


def finished_outcome(case: Case, folder: Path, *, quick: bool) -> FlowOutcome | None:
    """Return the outcome of a flow if it is there and of this set-up and code; one that is broken does not count."""
    with suppress(UnreadableFile):
        old = load_outcome(folder, case.name)
        if old is not None and old.digest == digest_of(case, quick=quick):
            return old
    return None


class _Outcomes:
    """The outcomes of flows, each a JSON file in a folder."""

    def __init__(self, cases: Iterable[Case], folder: Path, quick: bool) -> None:
        self.cases: Sequence[Case] = tuple(cases)
        self._folder = folder
        held = {number: finished_outcome(case, folder, quick=quick) for number, case in enumerate(self.cases)}
        self._outcomes = {number: outcome for number, outcome in held.items() if outcome is not None}

    def has(self, number: int) -> bool:
        """Return whether an outcome is there."""
        return number in self._outcomes

    def get(self, number: int) -> FlowOutcome:
        """Return an outcome that is there."""
        return self._outcomes[number]

    def put(self, number: int, outcome: FlowOutcome) -> None:
        """Write an outcome."""
        if outcome.digest:  # that of a process that died says nothing of the flow
            save_outcome(outcome, self._folder)
        self._outcomes[number] = outcome


def _computed(case: Case, progress: Progress, quick: bool) -> FlowOutcome:
    return compute(case, quick=quick, progress=progress)


def _died(quick: bool, case: Case, code: int | None) -> FlowOutcome:
    effort = case.quick if quick else case.full
    return FlowOutcome(
        case=case.name, digest="", quick=quick, cells=effort.cells, seconds=0.0,
        failed=f"its process ended with exit code {code}; where memory was short, --jobs 1 takes less of it.",
    )  # fmt: skip
