"""The same training with several seeds, whose policies go into one file: the best first, then the others."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from suchus.core.errors import InvalidDesign
from suchus.core.progress import Progress, portion, silent
from suchus.experiments.train.conduct import TrainingResult, check_extent, repeat_command, train
from suchus.experiments.train.spec import Training
from suchus.robot.control.policy import SUFFIX, save_policy, with_replicates, with_training

MAX_SEEDS = 20
"""Greatest number of seeds of a training [-]."""
ERROR, EPISODE_LOSS = "error", "episode loss"
"""Entries of the record of a training by which policies of several seeds are compared."""
_KEPT = (ERROR, "error of the table", EPISODE_LOSS, "episode loss of the table")


def train_seeds(
    training: Training,
    folder: str | Path,
    *,
    seeds: int = 1,
    minutes: float = 15.0,
    table_generations: int | None = None,
    network_generations: int | None = None,
    progress: Progress = silent,
    say: Callable[[str], None] = lambda _: None,
) -> TrainingResult:
    """Train with several seeds, each with the same commands and the same numbers of generations as the first.

    The policy with the smallest error in full physics is the policy of the file; in a task with faults it is that with
    the smallest loss in its episodes. The others are its ``replicates``. The file is written after each seed.

    Args:
        training: what is trained, with the first seed.
        folder: folder of the policy; each seed has a folder ``seed_NUMBER`` in it.
        seeds: number of seeds.
        minutes: time of all seeds together [min].
        table_generations: generations of each table; None for as many as the first one makes.
        network_generations: generations of each network; likewise.
        progress: told the stage and the share that is done.
        say: told a sentence now and then.

    Raises:
        InvalidDesign: a number of seeds, minutes or generations that is too small or too large.
    """
    if not 1 <= seeds <= MAX_SEEDS:
        raise InvalidDesign(f"train.seeds is {seeds}; 1 to {MAX_SEEDS} are allowed.")
    check_extent(training, minutes / seeds, table_generations, network_generations)
    if seeds == 1:
        return train(
            training,
            folder,
            minutes=minutes,
            table_generations=table_generations,
            network_generations=network_generations,
            progress=progress,
            say=say,
        )
    results: list[TrainingResult] = []
    of_seed = training
    for number in range(seeds):
        of_seed = replace(of_seed, seed=training.seed + number)
        result = train(
            of_seed,
            Path(folder) / f"seed_{of_seed.seed}",
            minutes=minutes / seeds,
            table_generations=table_generations,
            network_generations=network_generations,
            progress=portion(progress, number, seeds),
            say=say,
        )
        results.append(result)
        network_generations = result.network_generations
        if training.start is None:
            table_generations = result.table_generations
            of_seed = replace(of_seed, speed=result.policy.max_speed, turn=result.policy.max_turn)
        joined = _joined(training, results, Path(folder))
    return joined


def _joined(training: Training, results: list[TrainingResult], folder: Path) -> TrainingResult:
    """Write the policies of all seeds so far into one file, and return the best result with it.

    Args:
        training: the training with its first seed.
        results: results of the seeds, in their order.
        folder: folder of the file.
    """
    measure = EPISODE_LOSS if training.kind.has_faults else ERROR
    best = min(results, key=lambda result: float(dict(result.policy.training)[measure]))
    others = [result.policy for result in results if result is not best]
    command = repeat_command(training, best.table_generations, best.network_generations, len(results))
    policy = with_training(
        with_replicates(best.policy, others, _KEPT),
        **{
            "command": command,
            "seeds": " ".join(dict(result.policy.training)["seed"] for result in results),
            "errors of the seeds": " ".join(dict(result.policy.training)[ERROR] for result in results),
        },
    )
    return replace(best, policy=policy, path=save_policy(policy, folder / f"{training.name}{SUFFIX}"))
