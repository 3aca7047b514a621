"""Conducting a training: each generation is stored, and the best policy so far is always on disk."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
import xarray as xr

from suchus.core.errors import IncompatibleRecord, InvalidDesign
from suchus.core.jobs import LAND_SOURCES, Store, source_versions
from suchus.core.progress import Progress, silent
from suchus.core.writing import write
from suchus.experiments.train.evaluate import draw_episodes, evaluate_policies, evaluate_table, with_network
from suchus.experiments.train.judging import Judgement, judge
from suchus.experiments.train.network_search import NetworkSearch
from suchus.experiments.train.spec import FAULT_KINDS, Training
from suchus.experiments.train.table_search import EXPLORATION, TableSearch
from suchus.robot.control.policy import SUFFIX, Policy, policy_bytes, save_policy, with_training

CURVE = "learning_curve.csv"
"""File of the learning curve."""
_SOURCE_FILES = (
    *LAND_SOURCES,
    *(f"experiments/train/{name}.py" for name in ("evaluate", "network_search", "spec", "table_search", "tracking")),
)
_DECIDING = partial(source_versions, _SOURCE_FILES, ("cma",))
_NETWORK_NUMBER = 100_000  # first store number of the generations of the network
_CHECK_INTERVAL = 5  # generations of the network between two comparisons with the best so far
_CHECK_EPISODES = 8
_TABLE_FRACTION = 0.4  # of the time, for the table
MAX_GENERATIONS = 400
"""Greatest number of generations of the network [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TrainingResult:
    """A policy and how it was trained."""

    policy: Policy
    """The best policy."""
    table: Policy
    """The same without a network."""
    path: Path
    """File of the policy."""
    judgement: Judgement
    """What the policy reaches in full physics."""
    table_judgement: Judgement
    """What the table alone reaches."""
    table_generations: int
    """Generations of the table [-]."""
    network_generations: int
    """Generations of the network [-]."""


class _Curve:
    """The learning curve: a line for each generation, written as it goes."""

    def __init__(self, path: Path) -> None:
        self._path, self._rows = path, ["stage,generation,loss"]

    def add(self, stage: str, generation: int, loss: float) -> None:
        """Add a generation and write the curve."""
        self._rows.append(f"{stage},{generation},{loss:.6g}")
        write(self._path, "\n".join([*self._rows, ""]))


def train(
    training: Training,
    folder: str | Path,
    *,
    minutes: float = 15.0,
    table_generations: int | None = None,
    network_generations: int | None = None,
    progress: Progress = silent,
    say: Callable[[str], None] = lambda _: None,
) -> TrainingResult:
    """Train a policy: first its table, then its network; judge both in full physics, and keep the better one.

    Each finished generation is stored. A training that was stopped goes on where it was, and the same numbers of
    generations give the same bytes.

    Args:
        training: what is trained.
        folder: folder of the policy, its learning curve and its store.
        minutes: time after which no further generation begins [min]; two fifths of it are for the table.
        table_generations: generations of the table; None for as many as each command needs, as far as time allows.
        network_generations: generations of the network; None for as many as time allows.
        progress: told the stage and the share that is done.
        say: told a sentence now and then.

    Raises:
        InvalidDesign: a number of generations or minutes that is too small.
        NoOptimiser: the library of the optimiser is not installed.
        Unwritable: the folder cannot be written to.
        IncompatibleRecord: its store is of another training or version.
    """
    folder = Path(folder)
    check_extent(training, minutes, table_generations, network_generations)
    deadline, begin = time.monotonic() + 60.0 * minutes, time.monotonic()
    table_deadline = begin + 60.0 * minutes * (_TABLE_FRACTION if network_generations != 0 else 1.0)
    curve = _Curve(folder / CURVE)
    path = folder / f"{training.name}{SUFFIX}"

    def move(stage: str, fraction: float) -> None:
        done = (time.monotonic() - begin) / max(60.0 * minutes, 1e-9)
        progress(stage, min(max(fraction, done), 1.0) if table_generations is None else fraction)

    with Store(folder / "generations", training, kind="training", versions=_DECIDING).opened() as store:
        if training.start is not None:
            table, table_count = training.taken_table, 0
        else:
            search = _train_table(training, store, table_generations, table_deadline, curve, move, path)
            table, table_count = search.policy(), search.generation
            say(
                f"table of {table_count} generations: up to {search.max_speed:.3g} m/s and {search.max_turn:.3g} "
                f"rad/s, mean loss {search.table_loss():.3g}"
            )
        best, generations, losses = _train_network(
            training, store, table, network_generations, deadline, curve, move, path
        )
    record = {
        "command": repeat_command(training, table_count, generations),
        "table generations": str(table_count),
        "network generations": str(generations),
        "seed": str(training.seed),
    }
    move("judging in full physics", 0.99)
    table_judgement = judge(training.robot, table, lake=training.lake)
    judgement = table_judgement if best is None else judge(training.robot, best, lake=training.lake)
    if best is not None and not training.kind.has_faults and judgement.error > table_judgement.error:
        say(
            f"the network is left out: in full physics its error is {judgement.error:.3g}, that of the table "
            f"{table_judgement.error:.3g}"
        )
        best, judgement = None, table_judgement
    if best is None and training.kind.has_faults:
        say("no network was better than the table in the episodes, so that the policy is the table alone")
    if losses:
        record |= {"episode loss of the table": f"{losses[0]:.4g}", "episode loss": f"{min(losses):.4g}"}
    record |= {"error": f"{judgement.error:.4g}", "error of the table": f"{table_judgement.error:.4g}"}
    policy = with_training(best or table, **record)
    save_policy(policy, path)
    return TrainingResult(
        policy=policy,
        table=table,
        path=path,
        judgement=judgement,
        table_judgement=table_judgement,
        table_generations=table_count,
        network_generations=generations,
    )


def check_extent(
    training: Training, minutes: float, table_generations: int | None, network_generations: int | None
) -> None:
    """Refuse minutes and generations with which there is no policy.

    Args:
        training: the training.
        minutes: its time [min].
        table_generations: generations of the table; None where time decides.
        network_generations: generations of the network; None where time decides.

    Raises:
        InvalidDesign: a number is too small or too large, or a task with faults has no network.
    """
    if not 0.05 <= minutes <= 1e5:
        raise InvalidDesign(f"train.minutes is {minutes:g} min; 0.05 to 100000 min is allowed.")
    if table_generations is not None and not 2 * EXPLORATION < table_generations <= 10_000:
        raise InvalidDesign(
            f"train.table_generations is {table_generations}; {2 * EXPLORATION + 1} to 10000 are allowed: "
            f"{2 * EXPLORATION} find how fast the robot can walk and turn."
        )
    if network_generations is not None and not 0 <= network_generations <= 100_000:
        raise InvalidDesign(f"train.network_generations is {network_generations}; 0 to 100000 are allowed.")
    if training.kind.has_faults and network_generations == 0:
        raise InvalidDesign(
            f"train.network_generations is 0, and the task {training.task} trains a network: a table knows no faults. "
            "Give 1 at least, or take the task velocity."
        )


def repeat_command(training: Training, table_generations: int, network_generations: int, seeds: int = 1) -> str:
    """Return the command that makes the same policy again, to the byte.

    Args:
        training: the training, with its first seed.
        table_generations: generations of the table [-].
        network_generations: generations of the network [-].
        seeds: number of seeds [-].
    """
    options = [f"--robot {training.robot.name}"]
    options += [f"--gait {training.gait.name}"] if training.gait is not None else []
    options += [f"--{name} {value:g}" for name in ("speed", "turn") if (value := getattr(training, name)) is not None]
    options += [] if training.axis else ["--still-axis"]
    options += [f"--hidden {training.hidden}"] if training.hidden else []
    options += [f"--seed {training.seed}"]
    options += [f"--seeds {seeds}"] if seeds > 1 else []
    options += [f"--table-generations {table_generations}"] if training.start is None else []
    options += [f"--start {training.start.name}"] if training.start is not None else []
    options += [f"--faults {' '.join(training.faults)}"] if training.faults != FAULT_KINDS else []
    options += [f"--joints {' '.join(training.joints)}"] if training.joints else []
    options += [f"--onset {training.onset[0]:g} {training.onset[1]:g}"] if training.onset else []
    return " ".join(["suchus train", training.task, *options, f"--network-generations {network_generations}"])


def _train_table(
    training: Training,
    store: Store,
    generations: int | None,
    deadline: float,
    curve: _Curve,
    progress: Progress,
    path: Path,
) -> TableSearch:
    """Search the table until its generations or its time are over; those in the store are not computed again.

    A store in which the network has begun has all generations of its table.
    """
    search = TableSearch(training)
    has_network = store.has(_NETWORK_NUMBER)
    target = search.complete_generations if generations is None else generations
    while search.generation < target:
        is_stored = store.has(search.generation)
        may_end = search.generation > 2 * EXPLORATION and generations is None
        if may_end and not is_stored and (has_network or time.monotonic() > deadline):
            break
        progress(f"table: {search.stage}", search.generation / target)
        candidates = search.ask()
        table = _stored(store, search.generation, candidates, lambda rows: evaluate_table(training, rows))
        search.tell(table.speed.values, table.turn.values)
        if search.generation > 2 * EXPLORATION:
            curve.add("table", search.generation, search.table_loss())
            if not has_network:
                _keep(path, search.policy())
    return search


def _train_network(
    training: Training,
    store: Store,
    table: Policy,
    generations: int | None,
    deadline: float,
    curve: _Curve,
    progress: Progress,
    path: Path,
) -> tuple[Policy | None, int, list[float]]:
    """Search the network until its generations or the time are over.

    Every few generations the mean of the search plays the same episodes as the best so far; the better one stays.

    Returns:
        The best policy with a network, None if no network is better than the table; the number of generations; and the
        losses of the compared networks in the same episodes, the first of which corrects nothing.
    """
    search, best, target = NetworkSearch(training), None, MAX_GENERATIONS if generations is None else generations
    check_episodes = draw_episodes(training, table, _CHECK_EPISODES, 10**6)
    losses: list[float] = []
    while search.generation < target:
        number = _NETWORK_NUMBER + search.generation
        if generations is None and not store.has(number) and time.monotonic() > deadline:
            break
        progress(f"network: generation {search.generation}", search.generation / target)
        weights = search.ask()
        episodes = draw_episodes(training, table, search.episode_count, search.generation)
        is_check = search.generation % _CHECK_INTERVAL == 0

        def evaluated(rows: np.ndarray, episodes: tuple = episodes, is_check: bool = is_check) -> xr.Dataset:  # type: ignore[type-arg]
            policies = [with_network(training, table, row) for row in rows]
            losses = evaluate_policies(training, policies, episodes)
            check = evaluate_policies(training, policies[-1:], check_episodes) if is_check else np.array([np.nan])
            return xr.Dataset({"loss": ("candidate", losses), "check": ("one", check)})

        result = _stored(store, number, weights, evaluated)
        check_loss = float(result.check.values[0])
        if is_check:
            curve.add("network", search.generation, check_loss)
            if search.generation > 0 and check_loss < min(losses):
                best = with_network(training, table, weights[-1])
                _keep(path, best)
            losses.append(check_loss)
        search.tell(result.loss.values)
    if search.generation:
        last = with_network(training, table, search.mean)
        loss = float(evaluate_policies(training, [last], check_episodes)[0])
        best = last if loss < min(losses) else best
        losses.append(loss)
    return best, search.generation, losses


def _keep(path: Path, policy: Policy) -> None:
    """Write the best policy so far."""
    write(path, policy_bytes(policy))


def _stored(store: Store, number: int, candidates: np.ndarray, make: Callable[[np.ndarray], xr.Dataset]) -> xr.Dataset:
    """Return a generation, from the store if it is there.

    Args:
        store: store of the generations.
        number: number of the generation.
        candidates: what is asked for, one row each.
        make: evaluates the candidates.
    """
    if not store.has(number):
        store.put(number, make(candidates).assign(candidates=(("row", "parameter"), candidates)))
    table = store.get(number)
    if not np.array_equal(table.candidates.values, candidates):
        raise IncompatibleRecord(
            f"{store.part(number)} holds other candidates than the training asks for; this machine or its libraries "
            "round differently: choose another place."
        )
    return table
