"""Training of policies that follow commands: a table of gaits by CMA-ES, then a network that corrects it."""

from suchus.experiments.train.conduct import TrainingResult, train
from suchus.experiments.train.judging import COMMANDS, Judgement, judge
from suchus.experiments.train.replicates import train_seeds
from suchus.experiments.train.spec import FAULT_KINDS, TASKS, Training
from suchus.experiments.train.tracking import TrackedMotion, motion

__all__ = [
    "COMMANDS",
    "FAULT_KINDS",
    "TASKS",
    "Judgement",
    "TrackedMotion",
    "Training",
    "TrainingResult",
    "judge",
    "motion",
    "train",
    "train_seeds",
]
