"""``suchus train TASK``: a policy that follows commands, resumable."""

import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated

import tyro

from suchus.apps.cli.options import parse
from suchus.apps.cli.terminal import working
from suchus.apps.cli.word_checks import option_values
from suchus.core.files import check_replaceable, check_writable
from suchus.experiments.train import FAULT_KINDS, TASKS, Judgement, Training
from suchus.experiments.train import train_seeds as conduct
from suchus.robot.control.policy import SUFFIX
from suchus.robot.design import Robot
from suchus.robot.motion import Gait
from suchus.robot.policies import policy_of
from suchus.robot.robots import ROBOTS


@dataclass(frozen=True, slots=True, kw_only=True)
class TrainOptions:
    """Options of ``suchus train``."""

    task: Annotated[str, tyro.conf.Positional]
    """The task: velocity, fault, velocity_untold or swim."""
    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot that is trained."""
    gait: Gait | None = None
    """Gait whose parameters are trained; by default the robot's own, or its own swim."""
    minutes: float = 15.0
    """Time after which no further generation begins, by this computer's clock [min]."""
    speed: float | None = None
    """Greatest commanded speed [m/s]; by default what the robot reaches."""
    turn: float | None = None
    """Greatest commanded turning rate [rad/s]; by default what the robot reaches."""
    still_axis: tyro.conf.FlagCreatePairsOff[bool] = False
    """Hold spine and tail straight."""
    hidden: int = 0
    """Units of the hidden layer of the network; 0 for none."""
    seed: int = 0
    """Seed of everything that is random."""
    seeds: int = 1
    """Number of seeds, from this one on; they share the time, and their policies one file."""
    table_generations: int | None = None
    """Generations of the table, in the place of time."""
    network_generations: int | None = None
    """Generations of the network, in the place of time; 0 for the table alone."""
    start: str | None = None
    """Policy, its name or its file, whose gait and table are taken, so that a network alone is trained."""
    faults: tuple[str, ...] = FAULT_KINDS
    """Faults of a servo, one of which is drawn for each episode, in the tasks fault and velocity_untold."""
    joints: tuple[str, ...] = ()
    """Servos one of which fails in them; by default those of the limbs."""
    onset: tuple[float, float] | None = None
    """Earliest and latest time of the fault after the first step [s]; by default the first half of an episode."""
    out: Path | None = None
    """Folder of the policy; by default out/train/NAME. A training that began there is continued."""


def train(words: Sequence[str]) -> int:
    """Train a policy, or finish a training, print what it reaches, and return 0.

    Raises:
        SuchusError: the words make no sense, the robot cannot do the task, or nothing can be written.
    """
    tasks = "\n".join(f"  {name}: {kind.description}" for name, kind in TASKS.items())
    description = (
        "Train a policy that follows commands. A training that was stopped is continued; Ctrl-C keeps the best.\n"
        f"{tasks}"
    )
    options = parse(TrainOptions, "suchus train", words, description)
    training = Training(
        task=options.task,
        robot=options.robot,
        gait=options.gait,
        speed=options.speed,
        turn=options.turn,
        axis=not options.still_axis,
        hidden=options.hidden,
        seed=options.seed,
        start=None if options.start is None else policy_of(options.robot, options.start),
        faults=options.faults,
        joints=options.joints,
        onset=options.onset,
    )
    folder = options.out or Path("out") / "train" / training.name
    check_writable(folder)
    check_replaceable(folder / f"{training.name}{SUFFIX}")
    cpu = time.process_time()
    with working() as bars:
        result = conduct(
            training,
            folder,
            seeds=options.seeds,
            minutes=options.minutes,
            table_generations=options.table_generations,
            network_generations=options.network_generations,
            progress=bars.reporter(training.name),
            say=bars.say,
        )
    for label, judgement in (("table", result.table_judgement), ("policy", result.judgement)):
        print(f"{label:<6}  {judgement_text(judgement)}")
    record = dict(result.policy.training)
    if "seeds" in record:
        errors = ", ".join(f"{float(error):.1%}" for error in record["errors of the seeds"].split())
        print(f"errors of the seeds {record['seeds']}: {errors}; the policy is that of seed {record['seed']}")
    print(f"{time.process_time() - cpu:.0f} s of processor time; the same bytes again: {record['command']}")
    print(f"see it: suchus view {_robot_word(words, training)} --policy {result.path}")
    print(f"policy: {result.path}")
    return 0


def judgement_text(judgement: Judgement) -> str:
    """Return the errors of a policy in a line."""
    return (
        f"error of the speed {judgement.speed_error:.1%} of {judgement.max_speed:.3g} m/s, of the turning rate "
        f"{judgement.turn_error:.1%} of {judgement.max_turn:.3g} rad/s, {judgement.falls} falls in "
        f"{len(judgement.speed)} commands"
    )


def _robot_word(words: Sequence[str], training: Training) -> str:
    """Return the robot as it was named on the command line."""
    named = option_values(words, "--robot")
    return named[-1] if named else training.robot.name
