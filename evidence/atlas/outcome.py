"""Flows side by side, each in a process of its own, and their results on disk.

There is one JSON file for each, written whole or not at all, with the digest of its causes; what is finished is kept,
whatever happens to the others.
"""

import hashlib
import json
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, field
from functools import cache, partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from evidence.atlas.case import Case, Curves
from suchus.core.errors import SuchusError, UnreadableFile
from suchus.core.files import code_digest, digest, new_file, plain, read_json
from suchus.core.files.provenance import syntax_of
from suchus.core.jobs import Job, finish, place_for, source_versions
from suchus.core.progress import Progress, silent

_FOLDER = Path(__file__).parent
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
    grid: int = 1
    """Which of the flow's grids it was computed on, 1 for the finest."""
    seconds: float
    """Processor time [s]."""
    failed: str = ""
    """The error, if there are no curves; else empty."""
    curves: Curves = field(default_factory=dict)
    """Its curves and numbers by name, see ``case.Curves``."""

    @property
    def flow(self) -> str:
        """Name of the flow on its grid, as ``flow_on`` gives it."""
        return flow_on(self.case, self.grid)


def flow_on(case: str, grid: int) -> str:
    """Return the name of a flow on one of its grids, and of its file: ``in_line``, ``in_line.grid2``."""
    return case if grid == 1 else f"{case}.grid{grid}"


def digest_of(case: Case, *, quick: bool, grid: int = 1) -> str:
    """Return the digest of a flow's set-up, of the flow solver's source and of the atlas's that it names."""
    effort = asdict(case.effort(grid, quick=quick))
    code = [code_digest("flow"), *(_syntax_digest(_FOLDER / name) for name in case.code)]
    return digest({"case": case.name, "effort": effort, "quick": quick, "code": code})


@cache
def _syntax_digest(file: Path) -> str:
    """Return the SHA-256 of the syntax tree of a module of the atlas."""
    return hashlib.sha256(syntax_of(file.read_bytes())).hexdigest()


def compute(case: Case, *, quick: bool, grid: int = 1, progress: Progress = silent) -> FlowOutcome:
    """Compute a flow; an error of the solver is kept as an outcome too, with its sentence."""
    effort = case.effort(grid, quick=quick)
    began = time.process_time()
    curves, failed = dict[str, np.ndarray](), ""
    try:
        curves = {name: np.asarray(curve, float) for name, curve in case.run(effort, progress).items()}
    except SuchusError as error:
        failed = str(error)
    return FlowOutcome(
        case=case.name, digest=digest_of(case, quick=quick, grid=grid), quick=quick, cells=effort.cells, grid=grid,
        failed=failed, seconds=time.process_time() - began, curves=curves,
    )  # fmt: skip


def place(folder: str | Path, flow: str) -> Path:
    """Return the file of the outcome of a flow on one of its grids, by the name that ``flow_on`` gives."""
    folder = Path(folder)
    return folder / "flows" / f"{flow}.json"


def save_outcome(outcome: FlowOutcome, folder: str | Path) -> None:
    """Write an outcome; an earlier one stays until it is whole.

    Raises:
        Unwritable: the place cannot be written to.
    """
    curves = {name: _short(curve) for name, curve in outcome.curves.items()}
    values = {name: getattr(outcome, name) for name in FlowOutcome.__dataclass_fields__}
    with new_file(place(folder, outcome.flow), lasting=True) as draft:
        draft.write_text(json.dumps({**values, "curves": curves}) + "\n", encoding="utf-8")


def _short(curve: np.ndarray) -> object:
    rounded = np.vectorize(lambda value: float(f"{value:.{_DIGITS}g}"), otypes=[float])(curve)
    return plain(rounded)


def load_outcome(folder: str | Path, case: str, grid: int = 1) -> FlowOutcome | None:
    """Return a flow's outcome, None if there is none.

    Raises:
        UnreadableFile: the file holds something else.
    """
    path = place(folder, flow_on(case, grid))
    if not path.is_file():
        return None
    values = read_json(path)
    if not isinstance(values, Mapping) or set(values) != set(FlowOutcome.__dataclass_fields__):
        raise UnreadableFile(f"{path} holds no outcome of the atlas; delete it and compute the row anew.")
    curves = {name: np.array(curve, float) for name, curve in values["curves"].items()}
    return FlowOutcome(**{**values, "curves": curves})


def load_outcomes(folder: str | Path, cases: Iterable[Case]) -> dict[str, FlowOutcome]:
    """Return the outcomes that a folder has of flows on their grids, by the names that ``flow_on`` gives.

    Raises:
        UnreadableFile: a file holds something else.
    """
    wanted = ((case.name, grid) for case in cases for grid in range(1, len(case.grids) + 1))
    found = (load_outcome(folder, name, grid) for name, grid in wanted)
    return {outcome.flow: outcome for outcome in found if outcome is not None}


def compute_all(
    cases: Iterable[Case],
    folder: str | Path,
    *,
    jobs: int,
    quick: bool,
    grids: Sequence[int] = (1,),
    client: Any = None,
    each: Callable[[str], Progress] = lambda _: silent,
    finished: Callable[[FlowOutcome], None] = lambda _: None,
) -> dict[str, FlowOutcome]:
    """Compute flows that are not there yet, ``jobs`` at a time, and return their outcomes by the name of ``flow_on``.

    An outcome is written as soon as it is there. One of the same set-up by the same code is kept.

    Args:
        cases: the flows; the longest should come first.
        folder: of the outcomes.
        jobs: processes at a time, which share the threads; with 1 all is done here.
        quick: whether only a trial is wanted, which is on one grid.
        grids: numbers of the grids, of which a flow may have fewer; 1 is the finest.
        client: a ``distributed.Client``, whose workers then compute the flows; this machine if None.
        each: returns what is told how far a flow is, by its name.
        finished: called with each outcome when it is there, with those of an earlier start first.

    Raises:
        Unwritable: an outcome cannot be written.
        NoCluster: the cluster was lost.
    """
    folder = Path(folder)
    place = place_for("the atlas", client=client, jobs=jobs)
    wanted = (1,) if quick else tuple(grids)
    flows = [OnGrid(case, grid) for case in cases for grid in wanted if grid <= len(case.grids)]
    outcomes = _Outcomes(flows, folder, quick)
    job = Job(
        name="atlas",
        kind="atlas",
        piece="flow",
        unit="flows",
        work=partial(_computed, quick=quick),
        items=outcomes.flows,
        versions=partial(source_versions, ("atlas", "flow"), ("numba",)),
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
        progress_of=lambda number: each(flows[number].name),
        finished=lambda _, outcome: finished(outcome),
    )
    return {flow.name: outcomes.get(number) for number, flow in enumerate(flows)}


class OnGrid(NamedTuple):
    """A flow on one of its grids: one piece of work."""

    case: Case
    """The flow."""
    grid: int
    """Number of the grid, 1 for the finest."""

    @property
    def name(self) -> str:
        """Its name, as ``flow_on`` gives it."""
        return flow_on(self.case.name, self.grid)


def finished_outcome(case: Case, folder: str | Path, *, quick: bool, grid: int = 1) -> FlowOutcome | None:
    """Return the outcome of a flow if it is there and of this set-up and code; one that is broken does not count."""
    with suppress(UnreadableFile):
        old = load_outcome(folder, case.name, grid)
        if old is not None and old.digest == digest_of(case, quick=quick, grid=grid):
            return old
    return None


class _Outcomes:
    """The outcomes of flows, each a JSON file in a folder."""

    def __init__(self, flows: Sequence[OnGrid], folder: Path, quick: bool) -> None:
        self.flows = flows
        self._folder = folder
        held = {
            number: finished_outcome(one.case, folder, quick=quick, grid=one.grid) for number, one in enumerate(flows)
        }
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


def _computed(flow: OnGrid, progress: Progress, quick: bool) -> FlowOutcome:
    return compute(flow.case, quick=quick, grid=flow.grid, progress=progress)


def _died(quick: bool, flow: OnGrid, code: int | None) -> FlowOutcome:
    effort = flow.case.effort(flow.grid, quick=quick)
    return FlowOutcome(
        case=flow.case.name, digest="", quick=quick, cells=effort.cells, grid=flow.grid, seconds=0.0,
        failed=f"its process ended with exit code {code}; where memory was short, --jobs 1 takes less of it.",
    )  # fmt: skip
