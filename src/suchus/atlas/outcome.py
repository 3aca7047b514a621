"""Flows side by side, each in a process of its own, and their results on disk.

There is one JSON file for each, written whole or not at all, with the digest of its causes; what is finished is kept,
whatever happens to the others.
"""

import json
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from suchus.atlas.case import Case, Curves
from suchus.errors import SuchusError, UnreadableFile
from suchus.jobs import Job, deciding, finish, place_for
from suchus.progress import Progress, silent
from suchus.record import code_digest, digest, new_file, plain, read_json

_DIGITS = 7  # of the numbers that are kept: single precision


@dataclass(frozen=True, slots=True, kw_only=True)
class FlowOutcome:
    """Result of the computation of a flow."""

    case: str
    """Name of the flow."""
    digest: str
    """Digest of its set-up and of all code that decides its curves."""
    quick: bool
    """Whether it was the quick trial."""
    cells: int
    """Cells per diameter, chord or width [-]."""
    seconds: float
    """Processor time [s]."""
    failed: str = ""
    """The error, if there are no curves; else empty."""
    curves: Curves = field(default_factory=dict)
    """Its curves and numbers by name, see ``case.Curves``."""


def digest_of(case: Case, *, quick: bool) -> str:
    """Return the digest of a flow's set-up, of the flow solver's source and of the atlas's that it names."""
    effort = asdict(case.quick if quick else case.full)
    code = code_digest("flow", *(f"atlas/{name}" for name in case.code))
    return digest({"case": case.name, "effort": effort, "quick": quick, "code": code})


def compute(case: Case, *, quick: bool, progress: Progress = silent) -> FlowOutcome:
    """Compute a flow; an error of the solver is kept as an outcome too, with its sentence."""
    effort = case.quick if quick else case.full
    began = time.process_time()
    curves, failed = dict[str, np.ndarray](), ""
    try:
        curves = {name: np.asarray(curve, float) for name, curve in case.run(effort, progress).items()}
    except SuchusError as error:
        failed = str(error)
    return FlowOutcome(
        case=case.name, digest=digest_of(case, quick=quick), quick=quick, cells=effort.cells, failed=failed,
        seconds=time.process_time() - began, curves=curves,
    )  # fmt: skip


def place(folder: Path, case: str) -> Path:
    """Return the file of a flow's outcome."""
    return folder / "flows" / f"{case}.json"


def save_outcome(outcome: FlowOutcome, folder: Path) -> None:
    """Write an outcome; an earlier one stays until it is whole.

    Raises:
        Unwritable: the place cannot be written to.
    """
    curves = {name: _short(curve) for name, curve in outcome.curves.items()}
    values = {name: getattr(outcome, name) for name in FlowOutcome.__dataclass_fields__}
    with new_file(place(folder, outcome.case), lasting=True) as draft:
        draft.write_text(json.dumps({**values, "curves": curves}) + "\n", encoding="utf-8")


def _short(curve: np.ndarray) -> object:
    rounded = np.vectorize(lambda value: float(f"{value:.{_DIGITS}g}"), otypes=[float])(curve)
    return plain(rounded)


def load_outcome(folder: Path, case: str) -> FlowOutcome | None:
    """Return a flow's outcome, None if there is none.

    Raises:
        UnreadableFile: the file holds something else.
    """
    path = place(folder, case)
    if not path.is_file():
        return None
    values = read_json(path)
    if not isinstance(values, Mapping) or set(values) != set(FlowOutcome.__dataclass_fields__):
        raise UnreadableFile(f"{path} holds no outcome of the atlas; delete it and compute the row anew.")
    curves = {name: np.array(curve, float) for name, curve in values["curves"].items()}
    return FlowOutcome(**{**values, "curves": curves})


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
