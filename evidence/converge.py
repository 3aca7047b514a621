"""Convergence in the time step: every measure at the step of its experiment, at a half and at a quarter of it.

Usage: python -m evidence.converge [NAME ...] [--quick | --full] [--designs N]
       python -m evidence.converge --say

NAME is an experiment, or ``designs``. Each experiment runs with its step divided by 1, 2 and 4, and its measures are
compared with their tolerances (``evidence.tolerance``). A quick form takes the time step of the full form, with which
the published numbers were computed. Outcomes say how much a measure changes with the time step
(``suchus.experiments.time_steps``): the program lists what leaves its tolerance and changes by more than that.
``--say`` runs nothing; it writes what outcomes say from the stored result.

``designs`` compares sampled robots and gaits of the study of the claims at 5, 2 and 1 ms. A finished part stays in
``out/converge``: a stopped program goes on from there. The outcome is the result ``converge`` of the store, and the
page on time steps states it.
"""

import argparse
import json
import re
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from functools import partial
from math import ceil, floor, inf, isfinite, log2, log10, nan
from pathlib import Path
from typing import Any, Literal

import numpy as np
from rich.console import Console
from rich.table import Table

from evidence import source, store, tolerance
from suchus.core.errors import SuchusError
from suchus.core.files import new_file
from suchus.core.progress import Progress, silent
from suchus.experiments import time_steps
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.experiment import Experiment
from suchus.experiments.study.chunk import run_chunk
from suchus.experiments.study.claims import Claims
from suchus.sim.land import divide_steps

NAME = "converge"
DESIGNS = "designs"
"""Name of the comparison of sampled designs."""
DIVISORS = (1, 2, 4)
"""Divisors of the time step [-]."""
FLOWS = ("salamander_swim", "swim_3d", "swim_free", "swim_sweep", "swimming")
"""Experiments whose measures are those of flows, which have time steps of their own."""
DESIGN_STEPS = (0.005, 0.002, 0.001)
"""Time steps of the sampled designs; the last is the reference [s]."""
DESIGN_COUNT = 32
"""Number of sampled designs, of which about a quarter cannot follow their gait [-]."""
DESIGN_MEASURES = ("displacement", "cost_of_transport")
DESIGN_QUANTILES = (0.5, 0.9, 1.0)
MIN_RATIO = 1.5
"""Ratio of two successive changes from which on a measure converges; halved steps of first order have 2 [-]."""
MODULES = ("suchus.experiments.catalog", "suchus.experiments.study", "suchus.sim.land")
"""What the outcome depends on."""
PAGE_WIDTH = 150
"""Width of tables that are printed into a file [character]."""
SAID = store.ROOT / "src" / "suchus" / "experiments" / time_steps.FILE
"""File of what outcomes say of the time step."""
DIGITS = 2
"""Digits of a change that outcomes say; the last is rounded up [-]."""
UNSAID: Mapping[tuple[str, str], str] = {
    (
        "bipedal_reach",
        "held_share",
    ): "the quick form stands for another time; `held` says the same change in seconds"
}
"""Moved measures whose change is another in the full form, by experiment and name, and the reason."""
ROUNDING = 1e-6
"""Relative rounding of a change that outcomes say [-]."""
RELATIVE_CHANGES = re.compile(r"(^|_)(change|gain|gained|loss)(_|$)")
"""Names of measures without a unit that are relative changes, ``a / b - 1``, or differences of such."""
ANGLES = re.compile(r"(^|_)(heading|turn|turned|turning)(_|$)")
"""Names of angles that are differences of two headings [rad]."""
PARTS = store.ROOT / "out" / NAME
"""Folder of the finished parts."""
Form = Literal["quick", "full"]
Trend = Literal["converges", "settled", "does not converge"]
"""How a measure goes on: by shrinking changes, by a last change within its tolerance, or neither."""


@dataclass(frozen=True, slots=True, kw_only=True)
class StepChange:
    """A measure at each time step, and how it goes on."""

    values: tuple[float, float, float]
    """Value at the step, at a half and at a quarter of it, in its own unit."""
    tolerance: float
    """Change within which it means the same, in its own unit; NaN where it has none."""
    reason: str
    """Reason of the tolerance: a key of ``tolerance.REASONS``."""

    @property
    def change(self) -> float:
        """Difference of the value at a quarter of the step from that at the step."""
        return self.values[2] - self.values[0]

    @property
    def relative_change(self) -> float:
        """Change over the size of the value at a quarter of the step [-]."""
        return self.change / abs(self.values[2]) if self.values[2] else inf

    @property
    def ratio(self) -> float:
        """First change over the second one: 2 at first order, 4 at second, below 1 without convergence [-]."""
        first, second = self.values[1] - self.values[0], self.values[2] - self.values[1]
        return first / second if second else inf if first else nan

    @property
    def order(self) -> float:
        """Order of convergence, the binary logarithm of ``ratio``; NaN where the changes have opposite signs [-]."""
        return log2(self.ratio) if 0.0 < self.ratio < inf else nan

    @property
    def limit(self) -> float:
        """Value at a vanishing step by Richardson's extrapolation; NaN where the measure does not converge."""
        if self.trend != "converges" or not isfinite(self.ratio):
            return nan
        return self.values[2] + (self.values[2] - self.values[1]) / (self.ratio - 1.0)

    @property
    def greatest(self) -> float:
        """Greatest difference of a smaller step's value, or the limit, from that at the step; infinite if unknown."""
        ends = [*self.values[1:], *([self.limit] if isfinite(self.limit) else [])]
        changes = [abs(value - self.values[0]) for value in ends]
        return max(changes) if all(map(isfinite, changes)) else inf

    @property
    def trend(self) -> Trend:
        """How it goes on."""
        if self.ratio >= MIN_RATIO:
            return "converges"
        return "settled" if abs(self.values[2] - self.values[1]) <= self.tolerance else "does not converge"


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """What a run of an experiment gave with a divided time step."""

    measures: Mapping[str, float]
    """Measures, by name."""
    units: Mapping[str, str]
    """Unit of each measure, by name."""
    verdicts: Mapping[str, str]
    """Word of each verdict, by claim."""
    timestep: float | None
    """Time step of the experiment before it was divided [s]; None where its robot decides."""
    simulations: int
    """Number of simulations whose step was divided [-]."""
    seconds: float
    """Processor time [s]."""


def run_divided(experiment: Experiment, divisor: int, progress: Progress = silent) -> Part:
    """Run an experiment with all time steps of its physics divided.

    Args:
        experiment: in the form that is to run.
        divisor: of the time steps [-].
        progress: called with the finished fraction.
    """
    start = time.process_time()
    with divide_steps(divisor) as division:
        outcome = experiment.run(progress)
    return Part(
        measures={name: float(measure.value) for name, measure in sorted(outcome.measures.items())},
        units={name: measure.unit for name, measure in sorted(outcome.measures.items())},
        verdicts={verdict.claim.key: verdict.verdict for verdict in outcome.verdicts},
        timestep=getattr(experiment, time_steps.FIELD, None),
        simulations=division.simulations,
        seconds=round(time.process_time() - start, 1),
    )


def step_changes(parts: Sequence[Part]) -> dict[str, StepChange]:
    """Return the measures that leave their tolerance at a half or a quarter of the step.

    Args:
        parts: with the step of the experiment, its half and its quarter, in this order.
    """
    bounds = tolerance.bounded(parts[0].measures)
    changes = {}
    for name in dict.fromkeys(name for part in parts for name in part.measures):
        values = [part.measures.get(name, nan) for part in parts]
        bound = bounds.get(name)
        if bound is not None and all(bound.holds(value) for value in values[1:]):
            continue
        size = nan if bound is None else 0.5 * (bound.high - bound.low)
        reason = "no number" if bound is None else bound.reason
        changes[name] = StepChange(values=(values[0], values[1], values[2]), tolerance=size, reason=reason)
    return changes


def is_small_difference(name: str, unit: str, change: StepChange) -> bool:
    """Return whether a measure is a difference, and changes by less than the tolerance of what is subtracted.

    A difference near zero has no meaningful two per cent. A relative change ``a / b - 1`` may move by two per cent of
    the sizes of both values, over the reference; an angle between two headings by 0.02 rad.

    Args:
        name: of the measure.
        unit: of the measure.
        change: its values at the three steps.
    """
    if unit == "rad":
        return ANGLES.search(name) is not None and change.greatest <= tolerance.RELATIVE
    if unit != "-" or RELATIVE_CHANGES.search(name) is None:
        return False
    return change.greatest <= tolerance.RELATIVE * (abs(1.0 + change.values[0]) + 1.0)


def rounded_up(change: float) -> float:
    """Return a change to ``DIGITS`` digits, the last of which is rounded up; infinite as it is."""
    if not change or not isfinite(change):
        return change
    step = 10.0 ** (floor(log10(change)) - DIGITS + 1)
    return float(f"{ceil(change / step - ROUNDING) * step:.{DIGITS}g}")


def beyond_said(name: str, moved: Mapping[str, Mapping[str, Any]], said: Mapping[str, Any]) -> list[str]:
    """Return the measures of an experiment that leave their tolerance and change by more than outcomes say.

    Args:
        name: of the experiment.
        moved: measures that left their tolerance, see ``experiment_outcome``.
        said: what outcomes say, by experiment, as in the file ``SAID``.
    """
    changes = said.get(name, {}).get("changes", {})
    return [
        measure
        for measure, row in moved.items()
        if measure not in changes or _number(row["greatest"]) > (1.0 + ROUNDING) * _number(changes[measure])
    ]


def _number(change: float | None) -> float:
    return inf if change is None else change


def said_of(outcomes: Mapping[str, Mapping[str, Any]]) -> dict[str, Any]:
    """Return what outcomes of experiments say of the time step, by experiment, as in the file ``SAID``.

    Args:
        outcomes: of the compared experiments, by name, see ``experiment_outcome``; those without simulations say
            nothing.
    """
    said = {}
    for name, outcome in sorted(outcomes.items()):
        if outcome["simulations"]:
            rows = {m: row for m, row in sorted(outcome["moved"].items()) if (name, m) not in UNSAID}
            rounded = {m: rounded_up(_number(row["greatest"])) for m, row in rows.items()}
            changes = {m: change if isfinite(change) else None for m, change in rounded.items()}
            entry = {"measures": outcome["measures"], time_steps.FIELD: outcome[time_steps.FIELD], "changes": changes}
            said[name] = entry
    return said


def write_said(outcomes: Mapping[str, Mapping[str, Any]], file: Path = SAID) -> Path:
    """Write what outcomes of experiments say of the time step, and return its file.

    Args:
        outcomes: of the compared experiments, by name.
        file: where.
    """
    with new_file(file) as draft:
        draft.write_text(json.dumps(said_of(outcomes), indent=1) + "\n", encoding="utf-8")
    return file


def verdict_changes(parts: Sequence[Part]) -> dict[str, list[str]]:
    """Return the verdicts that differ between the steps, by claim, with the word at each step."""
    words = {claim: [part.verdicts.get(claim, "") for part in parts] for claim in parts[0].verdicts}
    return {claim: row for claim, row in words.items() if len(set(row)) > 1}


def experiment_outcome(parts: Sequence[Part]) -> dict[str, Any]:
    """Return what is kept of an experiment: counts, the measures that moved and the verdicts that changed.

    Args:
        parts: with the step of the experiment, its half and its quarter; the first alone where nothing was divided.
    """
    moved = step_changes(parts) if len(parts) == len(DIVISORS) else {}
    units = parts[0].units
    return {
        "measures": len(parts[0].measures),
        "simulations": parts[0].simulations,
        time_steps.FIELD: parts[0].timestep,
        "seconds": round(sum(part.seconds for part in parts), 1),
        "moved": {
            name: {
                "values": list(change.values), "tolerance": change.tolerance, "reason": change.reason,
                "change": change.change, "order": change.order, "limit": change.limit, "trend": change.trend,
                "greatest": change.greatest if isfinite(change.greatest) else None,
                "small_difference": is_small_difference(name, units.get(name, ""), change),
            }
            for name, change in moved.items()
        },
        "judged": len(parts[0].verdicts),
        "verdicts": verdict_changes(parts) if len(parts) == len(DIVISORS) else {},
    }  # fmt: skip


def design_values(count: int, timestep: float, progress: Progress = silent) -> dict[str, list[float]]:
    """Return displacement and cost of transport of sampled designs, with spine and tail.

    Args:
        count: number of designs [-].
        timestep: of the physics [s].
        progress: called with the finished fraction.

    Returns:
        Lists by name, with an entry for each design; NaN where a design cannot follow its gait.
    """
    full = Claims().study(count, timestep)
    study = replace(full, arms=full.arms[:1], measure=DESIGN_MEASURES, chunk=count, every=1)
    table = run_chunk(study, 0, progress)
    names = [name for name in ("displacement_x", "displacement_y", "cost_of_transport") if name in table]
    return {name: [float(value) for value in table[name].values] for name in names}


def design_outcome(values: Mapping[float, Mapping[str, Sequence[float]]]) -> dict[str, Any]:
    """Return quantiles of the changes of sampled designs from each time step to the smallest one.

    Designs that advance less than ``Claims.least`` are counted, and left out.

    Args:
        values: of each design, by time step [s] and name, see ``design_values``.
    """
    steps = sorted(values, reverse=True)
    reference = {name: np.array(column) for name, column in values[steps[-1]].items()}
    walks = np.isfinite(reference["displacement_x"])
    selection = np.abs(reference["displacement_x"]) >= Claims().least
    rows = []
    for step in steps[:-1]:
        for name in ("displacement_x", "cost_of_transport"):
            change = (np.array(values[step][name]) - reference[name])[selection] / np.abs(reference[name][selection])
            finite = change[np.isfinite(change)]
            rows.append(
                {
                    "timestep": step, "measure": name, "designs": len(finite), "bias": float(np.median(finite)),
                    **{f"q{100 * q:.0f}": float(np.quantile(np.abs(finite), q)) for q in DESIGN_QUANTILES},
                    "beyond": int((np.abs(finite) > tolerance.RELATIVE).sum()),
                }
            )  # fmt: skip
    return {
        "samples": len(walks), "walked": int(walks.sum()), "measured": int(selection.sum()),
        "reference": steps[-1], "rows": rows,
    }  # fmt: skip


def probe() -> dict[str, float]:
    """Return how far two sampled designs get with the coarsest of the time steps."""
    values = design_values(2, 2 * DESIGN_STEPS[0])
    return {f"{name}_{k}": value for name, column in values.items() for k, value in enumerate(column)}


class Store:
    """Finished parts in a folder, each valid for the code that made it.

    Args:
        folder: of the parts.
        code: digest of the code that makes them.
    """

    def __init__(self, folder: Path, code: str) -> None:
        """Remember folder and code."""
        self._folder, self._code = folder, code

    def part(self, name: str, compute: Callable[[], dict[str, Any]]) -> dict[str, Any]:
        """Return a part: as it was stored by the same code, or computed and stored now.

        Args:
            name: of the part, and of its file.
            compute: returns it.
        """
        file = self._folder / f"{name}.json"
        try:
            stored = json.loads(file.read_text(encoding="utf-8"))
            if stored["code"] == self._code:
                return dict(stored["part"])
        except (OSError, ValueError, KeyError, TypeError):
            pass  # missing, damaged or of another program: it is computed
        part = compute()
        file.parent.mkdir(parents=True, exist_ok=True)
        with new_file(file) as draft:
            draft.write_text(json.dumps({"code": self._code, "part": part}), encoding="utf-8")
        return part


def at_full_step(experiment: Experiment) -> Experiment:
    """Return the quick form of an experiment with the time step of its full form."""
    quick = experiment.quick()
    step = getattr(experiment, time_steps.FIELD, None)
    return quick if step is None else replace(quick, **{time_steps.FIELD: step})  # type: ignore[type-var]


def compare_experiment(
    name: str, form: Form, parts: Store, say: Callable[[str], None] = lambda _: None
) -> dict[str, Any]:
    """Return what is kept of an experiment; without a simulation to divide it runs once.

    Args:
        name: of the experiment.
        form: in which it runs.
        parts: finished ones.
        say: called with each stage.
    """
    experiment = at_full_step(EXPERIMENTS[name]) if form == "quick" else EXPERIMENTS[name]
    finished: list[Part] = []
    for divisor in DIVISORS:
        say(f"{name}: step / {divisor}")
        compute = partial(lambda divisor: asdict(run_divided(experiment, divisor)), divisor)
        finished.append(Part(**parts.part(f"{form}/{name}_{divisor}", compute)))
        if not finished[-1].simulations:
            break
    return experiment_outcome(finished)


def compare_designs(count: int, parts: Store, say: Callable[[str], None] = lambda _: None) -> dict[str, Any]:
    """Return what is kept of the sampled designs.

    Args:
        count: number of designs [-].
        parts: finished ones.
        say: called with each stage.
    """
    values = {}
    for step in DESIGN_STEPS:
        say(f"{count} designs: {1e3 * step:g} ms")
        values[step] = parts.part(f"designs/{count}_{1e6 * step:.0f}us", partial(design_values, count, step))
    return design_outcome(values)


def table_of_measures(outcomes: Mapping[str, Mapping[str, Any]], said: Mapping[str, Any]) -> Table:
    """Return a table of the measures that moved by more than their tolerance and by more than outcomes say.

    Ends of an interval stand in it where their measure does not.

    Args:
        outcomes: of the experiments, by name, see ``experiment_outcome``.
        said: what outcomes say, by experiment, as in the file ``SAID``.
    """
    table = Table("experiment", "measure", "step", "step / 2", "step / 4", "change", "of tolerance", "order", "trend")
    for name, outcome in outcomes.items():
        beyond = beyond_said(name, outcome["moved"], said)
        for measure, row in ((measure, outcome["moved"][measure]) for measure in beyond):
            if measure.removesuffix("_low").removesuffix("_high") in set(beyond) - {measure}:
                continue
            size, value = row["tolerance"], row["values"][2]
            table.add_row(
                name, measure, *(f"{number:.5g}" for number in row["values"]),
                f"{100 * row['change'] / abs(value):+.1f} %" if value else "-",
                f"{max(abs(number - row['values'][0]) for number in row['values']) / size:.1f}" if size else "-",
                f"{row['order']:.1f}", row["trend"],
                style="red" if row["trend"] == "does not converge" else None,
            )  # fmt: skip
    return table


def table_of_designs(outcome: Mapping[str, Any]) -> Table:
    """Return a table of the quantiles of the changes of sampled designs."""
    title = f"{outcome['measured']} of {outcome['samples']} designs, against {1e3 * outcome['reference']:g} ms"
    table = Table("step [ms]", "measure", "median", *(f"|{100 * q:.0f} %|" for q in DESIGN_QUANTILES), "> 2 %",
                  title=title)  # fmt: skip
    for row in outcome["rows"]:
        shares = [f"{100 * row[f'q{100 * q:.0f}']:.2f} %" for q in DESIGN_QUANTILES]
        table.add_row(
            f"{1e3 * row['timestep']:g}", row["measure"], f"{100 * row['bias']:+.2f} %", *shares, str(row["beyond"])
        )
    return table


def said() -> dict[str, Any]:
    """Return what outcomes say of the time step, by experiment."""
    return dict(json.loads(SAID.read_text(encoding="utf-8")))


def _stored() -> dict[str, Any]:
    """Return the outcome that the store holds; an empty one where it holds none."""
    return dict(store.load(NAME).values) if store.path_of(NAME).is_file() else {"quick": {}, "full": {}, DESIGNS: {}}


def _parser() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    summary = (__doc__ or "").split("\n")[0]
    parser = argparse.ArgumentParser(prog="python -m evidence.converge", description=summary)
    default = ", ".join(default_names())
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"experiments, or designs; by default {default}")
    forms = parser.add_mutually_exclusive_group()
    forms.add_argument("--quick", dest="form", action="store_const", const="quick", help="quick forms (the default)")
    forms.add_argument("--full", dest="form", action="store_const", const="full", help="full forms, as stored results")
    forms.add_argument("--say", dest="form", action="store_const", const="say", help="write what outcomes say")
    parser.add_argument("--designs", type=int, default=DESIGN_COUNT, metavar="N", help="number of sampled designs")
    parser.set_defaults(form="quick")
    return parser


def default_names() -> list[str]:
    """Return what is compared where nobody names anything: all experiments without a flow, and the designs."""
    return [*(name for name in EXPERIMENTS if name not in FLOWS), DESIGNS]


def main(words: Sequence[str]) -> int:
    """Compare, print the tables and store the outcome; return 2 for bad input, 130 where somebody stopped it."""
    arguments = _parser().parse_args(words)
    if arguments.form == "say":
        print(write_said(_stored()["quick"]))
        return 0
    names = arguments.names or default_names()
    if unknown := [name for name in names if name not in (*EXPERIMENTS, DESIGNS)]:
        choices = ", ".join((*EXPERIMENTS, DESIGNS))
        print(f"There is no experiment named {unknown[0]!r}; choose among {choices}.", file=sys.stderr)
        return 2
    if not 2 <= arguments.designs <= 100_000:
        print(f"--designs is {arguments.designs}; give 2 to 100000, best a power of two.", file=sys.stderr)
        return 2
    console = Console(stderr=True)
    parts = Store(PARTS, source.digest(source.reached(MODULES)))
    compared: dict[str, Any] = {}
    designs: dict[str, Any] = {}
    status, start = 0, time.process_time()
    with console.status("") as line:
        for number, name in enumerate(names):

            def say(stage: str, number: int = number) -> None:
                line.update(f"{number + 1} of {len(names)}: {stage}")

            try:
                if name == DESIGNS:
                    designs = compare_designs(arguments.designs, parts, say)
                else:
                    compared[name] = compare_experiment(name, arguments.form, parts, say)
                    console.print(_summary(name, compared[name]))
            except KeyboardInterrupt:
                console.print(f"Stopped. Finished parts are in {PARTS}; the same command goes on from there.")
                status = 130
                break
            except SuchusError as error:
                console.print(f"{name}: {error}", markup=False)
                status = 1
    page = Console() if sys.stdout.isatty() else Console(width=PAGE_WIDTH)
    if compared:
        page.print(table_of_measures(compared, said()))
    if designs:
        page.print(table_of_designs(designs))
    if compared or designs:
        before = _stored()  # as it is now: another process may have compared other experiments
        form = {arguments.form: before[arguments.form] | compared}
        _keep(before | form | ({DESIGNS: designs} if designs else {}), time.process_time() - start)
    return status


def _summary(name: str, outcome: Mapping[str, Any]) -> str:
    """Return in a line what an experiment's comparison gave."""
    if not outcome["simulations"]:
        return f"{name}: no simulation whose step could be divided"
    verdicts = f", {len(outcome['verdicts'])} verdicts change" * bool(outcome["verdicts"])
    beyond = len(beyond_said(name, outcome["moved"], said()))
    return (
        f"{name}: {len(outcome['moved'])} of {outcome['measures']} measures move, {beyond} by more than outcomes say"
        f"{verdicts}, {outcome['seconds']:.0f} s"
    )


def _keep(outcome: Mapping[str, Any], seconds: float) -> None:
    """Store the outcome as the result ``converge``, and print its file."""
    from evidence import renew  # noqa: PLC0415  the registry that it reads names this module

    print(renew.store(NAME, outcome, seconds))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
