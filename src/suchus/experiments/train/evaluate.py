"""One generation in one batch of physics: candidates of a table, and networks on episodes with changing commands."""

import warnings
from dataclasses import dataclass, replace

import numpy as np
import xarray as xr
from jaxtyping import Float

from suchus.core.errors import Doubtful
from suchus.experiments.train.spec import SEGMENT_PERIODS, SEGMENTS, Training
from suchus.experiments.train.tracking import motion, tracking_loss
from suchus.robot.control import Learned
from suchus.robot.control.observation import observation_layout
from suchus.robot.control.policy import Layer, Policy
from suchus.robot.design.scale import coarse_step, control_period
from suchus.robot.motion import START
from suchus.sim.fault import Fault
from suchus.sim.faults import FAULTS
from suchus.sim.land import Run, Tolerances, simulate

_SETTLING_PERIODS, _WINDOW_PERIODS = 0.75, 2.0  # of a table's candidate, over the period of the gait
_SKIPPED_PERIODS = 1.0  # of each command of an episode
_SAMPLE_STRIDE = 5


@dataclass(frozen=True, slots=True)
class Episode:
    """Commands, faults and body of one episode, the same for all networks of a generation."""

    forward: tuple[float, ...]
    """Commanded speed of each segment [m/s]."""
    turn: tuple[float, ...]
    """Commanded turning rate of each segment [rad/s]."""
    faults: tuple[Fault, ...]
    """Faults, each from its time on."""
    body_seed: int
    """Seed of the errors of the robot as built; negative for the design itself."""


def _whole_periods(training: Training, time: float) -> float:
    """Return a time rounded up to whole sampling intervals [s]."""
    interval = _SAMPLE_STRIDE * control_period(training.robot)
    return round(np.ceil(time / interval - 1e-9) * interval, 12)


def _simulate(runs: list[Run], duration: float, *, fast: bool) -> xr.Dataset:
    """Simulate runs with the coarse time step, without the warnings that a search causes."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", Doubtful)
        return simulate(
            runs,
            duration=duration,
            timestep=coarse_step(runs[0].robot),
            sample_stride=_SAMPLE_STRIDE,
            effort=False,
            fast=fast,
        )


def evaluate_table(training: Training, candidates: Float[np.ndarray, "candidate parameter"]) -> xr.Dataset:
    """Simulate candidates of a table, each with steady parameters.

    Args:
        training: the training.
        candidates: parameters, in the order of ``Training.bounds``.

    Returns:
        ``speed`` and ``turn`` along ``candidate``, NaN where it fell over.
    """
    names, gait = tuple(training.bounds), training.base_gait
    policies = [training.policy((0.0,), (0.0,), names, ((tuple(row),),)) for row in candidates.tolist()]
    runs = [
        Run(
            robot=training.robot,
            gait=gait,
            ground=training.ground,
            lake=training.lake,
            control=Learned(policy=policy, forward=0.0),
        )
        for policy in policies
    ]
    start = _whole_periods(training, START + _SETTLING_PERIODS * gait.period)
    end = _whole_periods(training, start + _WINDOW_PERIODS * gait.period)
    measured_motion = motion(_simulate(runs, end, fast=True), start, end)
    return xr.Dataset(
        {
            "speed": ("candidate", np.where(measured_motion.has_fallen, np.nan, measured_motion.speed)),
            "turn": ("candidate", measured_motion.turn),
        }
    )


def draw_episodes(training: Training, policy: Policy, count: int, seed: int) -> tuple[Episode, ...]:
    """Return episodes that are drawn from a seed: commands within what the table knows, bodies and faults.

    Args:
        training: the training.
        policy: policy whose table bounds the commands.
        count: number of episodes.
        seed: seed of the draw.
    """
    random = np.random.default_rng([training.seed, 1, seed])
    servos, period = training.failing_servos, control_period(training.robot)
    episodes = []
    for _ in range(count):
        forward = random.uniform(0.15, 1.0, SEGMENTS) * policy.max_speed
        turn = random.uniform(-1.0, 1.0, SEGMENTS) * policy.max_turn
        servo = servos[int(random.integers(len(servos)))] if servos else ""
        kind = training.faults[int(random.integers(len(training.faults)))]
        onset = round(float(np.ceil((START + random.uniform(*training.onset_range)) / period)) * period, 12)
        faults = (FAULTS[kind](servo, at=onset),) if training.kind.has_faults else ()  # type: ignore[call-arg]
        body_seed = int(random.integers(1_000_000))
        episodes.append(Episode(tuple(forward.tolist()), tuple(turn.tolist()), faults, body_seed))
    return tuple(episodes)


def episode_run(training: Training, policy: Policy, episode: Episode) -> Run:
    """Return the run of a policy in an episode; a policy that is told of faults is told at their onset."""
    length = SEGMENT_PERIODS * training.base_gait.period
    times = [START + number * length for number in range(SEGMENTS)]
    period = control_period(training.robot)

    def course(values: tuple[float, ...]) -> tuple[tuple[float, float], ...]:
        rows = [(0.0, values[0])]
        for time, previous, value in zip(times[1:], values, values[1:], strict=False):
            rows += [(time, previous), (round(time + period, 12), value)]
        return tuple(rows)

    failures = tuple((fault.at, fault.part) for fault in episode.faults) if training.kind.reports_failures else ()
    run = Run(
        robot=training.robot,
        gait=training.base_gait,
        ground=training.ground,
        lake=training.lake,
        faults=episode.faults,
        control=Learned(policy=policy, forward=course(episode.forward), turn=course(episode.turn), failures=failures),
    )
    return run if episode.body_seed < 0 else Tolerances().draw_run(run, episode.body_seed)


def evaluate_policies(
    training: Training, policies: list[Policy], episodes: tuple[Episode, ...], *, fast: bool = True
) -> Float[np.ndarray, " policy"]:
    """Return the mean tracking loss of policies over episodes [-].

    Args:
        training: the training.
        policies: the policies, which share a table.
        episodes: episodes that each of them plays.
        fast: whether contacts are solved in less time and with less accuracy.
    """
    runs = [episode_run(training, policy, episode) for policy in policies for episode in episodes]
    period = training.base_gait.period
    duration = _whole_periods(training, START + SEGMENTS * SEGMENT_PERIODS * period)
    record = _simulate(runs, duration, fast=fast)
    losses = np.zeros(len(runs))
    for number in range(SEGMENTS):
        begin = START + number * SEGMENT_PERIODS * period
        start = _whole_periods(training, begin + _SKIPPED_PERIODS * period)
        end = min(_whole_periods(training, begin + SEGMENT_PERIODS * period), duration)
        forward, turn = (
            np.array([getattr(episode, name)[number] for _ in policies for episode in episodes])
            for name in ("forward", "turn")
        )
        measured_motion = motion(record, start, end)
        losses += tracking_loss(measured_motion, forward, turn, policies[0].max_speed, policies[0].max_turn) / SEGMENTS
    return np.asarray(losses.reshape(len(policies), len(episodes)).mean(axis=1))


def with_network(training: Training, table: Policy, weights: np.ndarray) -> Policy:
    """Return a table with a network of weights in one row: layer by layer, the weights input by input, then the bias.

    Args:
        training: the training, which says the readings, the actions and the hidden layer.
        table: policy of the table alone.
        weights: as many as ``weight_count`` says [-].
    """
    layers, position = [], 0
    for inputs, outputs in layer_sizes(training):
        matrix = weights[position : position + inputs * outputs].reshape(inputs, outputs)
        position += inputs * outputs
        bias = weights[position : position + outputs]
        position += outputs
        layers.append(Layer(tuple(map(tuple, matrix.tolist())), tuple(bias.tolist())))
    return replace(
        table, actions=training.actions, spans=training.spans, readings=training.readings, layers=tuple(layers)
    )


def layer_sizes(training: Training) -> list[tuple[int, int]]:
    """Return the numbers of inputs and outputs of each layer."""
    inputs, outputs = observation_layout(training.robot, training.readings)[-1].columns.stop, len(training.spans)
    return [(inputs, training.hidden), (training.hidden, outputs)] if training.hidden else [(inputs, outputs)]


def weight_count(training: Training) -> int:
    """Return the number of weights and biases of the network."""
    return sum(inputs * outputs + outputs for inputs, outputs in layer_sizes(training))
