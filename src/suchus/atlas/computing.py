"""Flows side by side, each in a process of its own. What is finished is kept, whatever happens to the others."""

from collections.abc import Callable, Generator, Iterable, Sequence
from contextlib import closing, suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from suchus import workers
from suchus.atlas.case import Case, Tell
from suchus.atlas.outcome import Outcome, compute, digest_of, load_outcome, save_outcome
from suchus.errors import UnreadableFile

_STAGE = "computing"  # a flow has one stage


@dataclass(frozen=True, slots=True, kw_only=True)
class FlowProgress:
    """Progress of the computation of a flow."""

    case: str
    """Name of the flow."""
    share: float
    """Share of it that is done [-]."""
    outcome: Outcome | None = None
    """Its outcome, when it has ended; before None."""


def compute_all(
    cases: Iterable[Case], folder: Path, *, jobs: int, quick: bool, tell: Callable[[FlowProgress], None]
) -> dict[str, Outcome]:
    """Compute flows that are not there yet, ``jobs`` at a time, and return the outcomes of all by name.

    An outcome is written as soon as it is there. One of the same set-up by the same code is kept.

    Args:
        cases: the flows; the longest should come first.
        folder: of the outcomes.
        jobs: processes at a time, which share the threads; with 1 all is done here.
        quick: whether only a trial is wanted.
        tell: called with the progress of each flow.

    Raises:
        Unwritable: an outcome cannot be written.
    """
    done, left = dict[str, Outcome](), list[Case]()
    for case in cases:
        old = finished(case, folder, quick=quick)
        if old is None:
            left.append(case)
        else:
            done[case.name] = old
            tell(FlowProgress(case=case.name, share=1.0, outcome=old))
    with closing(_computed(left, jobs, quick, tell)) as outcomes:
        for outcome in outcomes:
            done[outcome.case] = outcome
            if outcome.digest:  # that of a process that died says nothing of the flow
                save_outcome(outcome, folder)
            tell(FlowProgress(case=outcome.case, share=1.0, outcome=outcome))
    return done


def finished(case: Case, folder: Path, *, quick: bool) -> Outcome | None:
    """Return the outcome of a flow if it is there and of this set-up and code; one that is broken does not count."""
    with suppress(UnreadableFile):
        old = load_outcome(folder, case.name)
        if old is not None and old.digest == digest_of(case, quick=quick):
            return old
    return None


def _computed(
    cases: Sequence[Case], jobs: int, quick: bool, tell: Callable[[FlowProgress], None]
) -> Generator[Outcome, None, None]:  # fmt: skip
    """Yield outcomes as they are finished; when the caller stops, by Ctrl-C or an error, the processes end."""
    if jobs == 1:
        yield from (compute(case, quick=quick, tell=_telling(case.name, tell)) for case in cases)
        return
    with closing(workers.side_by_side(partial(_compute, quick=quick), cases, jobs)) as heard:
        for number, said in heard:
            if isinstance(said, workers.Done):
                yield said.value
            elif isinstance(said, workers.Died):
                yield _died(cases[number], quick, said.exit_code)
            elif isinstance(said, workers.Far):
                tell(FlowProgress(case=cases[number].name, share=said.share))


def _telling(name: str, tell: Callable[[FlowProgress], None]) -> Tell:
    return lambda share: tell(FlowProgress(case=name, share=share))


def _compute(case: Case, tell: workers.Tell, quick: bool) -> Outcome:
    """Compute one flow in a process of its own."""
    return compute(case, quick=quick, tell=partial(tell, _STAGE))


def _died(case: Case, quick: bool, code: int | None) -> Outcome:
    effort = case.quick if quick else case.full
    return Outcome(
        case=case.name, digest="", quick=quick, cells=effort.cells, seconds=0.0,
        failed=f"its process ended with exit code {code}; where memory was short, --jobs 1 takes less of it.",
    )  # fmt: skip
