"""Results of the flows on disk: one JSON file for each, written whole or not at all, with the digest of its causes."""

import json
import time
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path

import numpy as np

from suchus.atlas.case import Case, Curves
from suchus.errors import SuchusError, UnreadableFile
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
    with new_file(place(folder, outcome.case)) as draft:
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
