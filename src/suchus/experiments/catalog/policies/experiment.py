"""Does a trained policy follow commands better than gaits by hand and feedback rules, and what does it bear?"""

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import product
from typing import Any, ClassVar, NamedTuple, Self

import numpy as np
import xarray as xr

from suchus.core.checks import Checks
from suchus.core.errors import Doubtful, UnsuitedRobot
from suchus.experiments.catalog._replayed import replayed
from suchus.experiments.catalog.policies.figure import ARM_LABELS, condition_label, draw_errors, draw_tracking
from suchus.experiments.experiment import (
    Experiment,
    Measures,
    Outcome,
    Progress,
    Replay,
    SimulationResult,
    estimated,
    estimated_fraction,
    silent,
    staged,
)
from suchus.experiments.train import TrackedMotion, motion
from suchus.robot.control import Control, Coordinated, HeadingRule, Learned, Policy, Walking
from suchus.robot.design import Robot, layout
from suchus.robot.design.scale import coarse_step, control_period
from suchus.robot.motion import START, Gait, suits
from suchus.robot.policies import POLICIES, policy_of
from suchus.robot.robots import ROBOTS
from suchus.sim.fault import Fault
from suchus.sim.faults import FAULTS, Backlash, Delayed
from suchus.sim.land import Ground, Lake, Run, Tolerances, simulate
from suchus.sim.land.tolerances import with_masses
from suchus.sim.metrics import cost_of_transport

STILL_AXIS = "still_axis"
"""Arm of the policy that may not bend spine and tail."""
ARMS = ("policy", "fault_policy", "untold_policy", STILL_AXIS, "open_loop", "feedback")
"""Controls that are compared."""
UNDISTURBED = "undisturbed"
"""Condition of a walk without a disturbance."""
DISTURBANCES = ("heavier", "latency", "slippery", "play")
"""Disturbances that are no failures of one joint."""
_TOLD = "_told"  # ends the name of a policy that is told of the fault
_FAULT_TASKS = {"fault_policy": "fault", "untold_policy": "velocity_untold"}  # tasks with faults, by their arms
_MAIN_TASKS = ("velocity", "swim")  # names of the shipped policies that are judged
_SAMPLE_STRIDE = 5  # control periods between two samples
_MAX_ASYMMETRY = 0.5  # of the gait by hand, and of the walk by which its unequal strokes are calibrated
_MAX_RATE, _RATE_STEP = 4.0, 0.95  # greatest frequency of the gait by hand over the gait's, and the step of its search


class Case(NamedTuple):
    """A condition and a command."""

    condition: str
    """``undisturbed``, one of ``DISTURBANCES``, or ``limp_LF_yaw`` and its like, of a fault and a joint."""
    speed: float
    """Commanded forward speed [m/s]."""
    turn: float
    """Commanded turning rate, left positive [rad/s]."""


class Calibration(NamedTuple):
    """What the gait does at its own frequency, by which commands become a gait by hand."""

    speed: float
    """Speed of the gait [m/s]."""
    turn_per_asymmetry: float
    """Turning rate over the inequality of the strokes [rad/s]; 0 where unequal strokes do not turn the robot."""
    max_rate: float
    """Greatest frequency that the servos follow, over that of the gait [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Policies(Experiment):
    """Tracking errors of policies, of the gait by hand and of the feedback rules, undisturbed and disturbed.

    All of them play the gait of the policy. The gait by hand is open-loop: its frequency is in proportion to the
    commanded speed, and its unequal strokes to the commanded turning rate, by two walks of the robot as designed. The
    feedback rules play it at the same frequency and hold their heading; they take no turning rate. The tracking error
    is the mean of the errors of speed and of turning rate, each over its greatest command; a robot that falls counts
    as standing still. All controls get the same robots as built. Disturbances act on a walk straight ahead at
    ``test_speed``. A policy whose network reads failures walks twice with a failed joint: told of it, and not.

    Where a policy has several seeds, they take turns: the first robot gets the first seed, and so on, so that intervals
    are over pairs of a robot and a seed. A policy whose spine and tail are held straight walks undisturbed beside the
    one that may bend them; both were trained with the same budget.
    """

    title = "Does a trained policy follow its commands, and what does it bear?"
    shows = "Beyond the article"
    answers = (
        "tracking_error_policy",
        "tracking_error_open_loop",
        "tracking_error_feedback",
        "within_policy",
        "fallen_policy",
        "cost_policy",
    )
    reproduces = False
    follows_gait = False
    answer_minima: ClassVar[Mapping[str, float]] = {"cycles": 4.0, "robots": 6}

    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot that the policy moves."""
    policy: Policy | None = None
    """The policy that is judged; None for the robot's ``velocity`` or ``swim`` of the catalog."""
    fault_policy: Policy | None = None
    """A policy that was trained to be told of faults; None for ``fault`` of the catalog, where there is one."""
    untold_policy: Policy | None = None
    """A policy that was trained with faults of which it was not told; None for ``velocity_untold`` of the catalog."""
    still_policy: Policy | None = None
    """A policy that may not bend spine and tail; None for that of the catalog, where there is one."""
    arms: tuple[str, ...] = ARMS
    """Controls that are compared, ``policy`` among them."""
    speeds: tuple[float, ...] = (0.2, 0.6, 1.0)
    """Commanded speeds over the greatest one that was trained [-]."""
    turns: tuple[float, ...] = (-1.0, 0.0, 1.0)
    """Commanded turning rates over the greatest one that was trained [-]."""
    test_speed: float = 0.6
    """Commanded speed of disturbed walks over the greatest one that was trained [-]."""
    disturbances: tuple[str, ...] = DISTURBANCES
    """Disturbances: a heavier robot, late commands, less friction, play in all gears."""
    faults: tuple[str, ...] = ("limp", "locked")
    """Faults of a joint, as the catalog names them."""
    joints: tuple[str, ...] = ()
    """Joints that fail; empty for the first servo of the first and of the last limb, and a middle one of the trunk."""
    heavier: float = 1.1
    """Mass of the heavier robot over its mass [-]."""
    latency: float = 0.02
    """Time by which commands are late [s]."""
    friction: float = 0.5
    """Friction of the slippery ground over that of the ground [-]."""
    play: float = 0.05
    """Play of each gear, from one end to the other [rad]."""
    goal: float = 0.2
    """Errors of speed and of turning rate within which a command is followed, over the greatest commands [-]."""
    robots: int = 6
    """Number of robots as built [-]."""
    settling: float = 2.0
    """Duration before the motion is measured, over the period of the gait [-]."""
    cycles: float = 4.0
    """Duration over which the motion is measured, over the period of the gait [-]."""
    timestep: float = 0.005
    """Time step of the physics [s]."""
    tolerances: Tolerances = field(default_factory=Tolerances)
    """Tolerances of the robots and their grounds."""
    seed: int = 0
    """Seed of the robots as built [-]."""

    def __post_init__(self) -> None:
        """Refuse settings outside their ranges, unknown names, and policies of other robots."""
        with Checks(self.name(), self) as check:
            check.rising("speeds", 0.0, 1.0, "")
            check.rising("turns", -1.0, 1.0, "")
            check.number("test_speed", 0.0, 1.0, "")
            check.number("heavier", 0.1, 10.0, "")
            check.number("latency", 0.0, 1.0, "s")
            check.number("friction", 0.01, 10.0, "")
            check.number("play", 0.0, 1.0, "rad")
            check.number("goal", 0.0, 1.0, "")
            check.whole("robots", 1, 1000)
            check.number("settling", 0.0, 100.0, "")
            check.number("cycles", 0.5, 100.0, "")
            check.number("timestep", 1e-5, control_period(self.robot), "s")
            check.whole("seed", 0, 2**31)
            for name, options in (
                ("arms", ARMS),
                ("disturbances", DISTURBANCES),
                ("faults", tuple(FAULTS)),
                ("joints", layout(self.robot).servos),
            ):
                unknown = [choice for choice in getattr(self, name) if choice not in options]
                check.that(not unknown, f"{self.name()}.{name} has {unknown}; there is {', '.join(options)}")
            check.that("policy" in self.arms, f"{self.name()}.arms is {self.arms}; 'policy' is needed among them")
            for policy in (self.policy, self.fault_policy, self.untold_policy, self.still_policy):
                if policy is not None:
                    policy.check_robot(self.robot)
            check.that(
                self.still_policy is None or not self.still_policy.bends_axis,
                f"{self.name()}.still_policy may bend spine and tail; a policy of suchus train --still-axis is needed",
            )

    def quick(self) -> "Policies":
        """One robot, two commands, two disturbed walks, a cycle each, without the second policy."""
        return replace(
            self,
            arms=("policy", "open_loop", "feedback"),
            speeds=(self.test_speed,),
            turns=(0.0, 1.0),
            disturbances=("heavier",),
            faults=("limp",),
            joints=self.joint_names[:1],
            robots=1,
            settling=0.25,
            cycles=1.0,
        )

    def for_robot(self, robot: Robot) -> Self:
        """Return the same question for another robot and the policy of the catalog that was trained for it."""
        plain = replace(
            self,
            robot=robot,
            joints=(),
            policy=None,
            fault_policy=None,
            untold_policy=None,
            still_policy=None,
            timestep=coarse_step(robot),
        )
        return replace(plain, joints=plain.joint_names[: len(self.joints)])

    @property
    def judged_policy(self) -> Policy:
        """The policy that is judged.

        Raises:
            UnsuitedRobot: the catalog has no policy for the robot.
        """
        if self.policy is not None:
            return self.policy
        for task in _MAIN_TASKS:
            if f"{task}_{self.robot.name}" in POLICIES:
                return policy_of(self.robot, task)
        return policy_of(self.robot, _MAIN_TASKS[0])

    def policy_with_faults(self, arm: str) -> Policy | None:
        """Return the policy of an arm that was trained with faults; None where there is none for the robot.

        Args:
            arm: ``fault_policy`` or ``untold_policy``.
        """
        given: Policy | None = getattr(self, arm)
        if given is not None:
            return given
        task = _FAULT_TASKS[arm]
        if task in POLICIES or f"{task}_{self.robot.name}" in POLICIES:
            try:
                return policy_of(self.robot, task)
            except UnsuitedRobot:
                return None
        return None

    @property
    def straight_policy(self) -> Policy | None:
        """The policy that may not bend spine and tail; None where the catalog has none for the robot and the task."""
        if self.still_policy is not None:
            return self.still_policy
        name = f"{self.judged_policy.task}_{STILL_AXIS}"
        for full_name in (f"{name}_{self.robot.name}", name):
            if full_name in POLICIES and POLICIES[full_name].robot == self.robot.name:
                return POLICIES[full_name]
        return None

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Joints that fail."""
        place = layout(self.robot)
        if self.joints:
            return self.joints
        limbs = (place.limbs[0], place.limbs[-1]) if place.limbs else ()
        names = [place.servos[limb.servos][0] for limb in limbs]
        if place.trunk_yaw:
            names.append(place.servos[place.trunk_yaw[len(place.trunk_yaw) // 2]])
        return tuple(dict.fromkeys(names)) or place.servos[:1]

    @property
    def _swims(self) -> bool:
        """Whether the policy was trained in water."""
        return self.judged_policy.task == "swim"

    def _policies(self) -> dict[str, Policy]:
        """Return the policies by their arms."""
        policies = {"policy": self.judged_policy}
        for arm in _FAULT_TASKS:
            policy = self.policy_with_faults(arm) if arm in self.arms else None
            if policy is not None and policy not in policies.values():
                policies[arm] = policy
        straight = self.straight_policy if STILL_AXIS in self.arms else None
        if straight is not None and self.judged_policy.bends_axis:
            policies[STILL_AXIS] = straight
        return policies

    def arm_names(self) -> tuple[str, ...]:
        """Return the arms that there are: policies, those that are told of faults, the gait by hand, feedback rules."""
        names = []
        for arm, policy in self._policies().items():
            names += [arm, f"{arm}{_TOLD}"] if "failure" in policy.readings and self.faults else [arm]
        has_limbs = bool(layout(self.robot).limbs)
        names += [arm for arm in ("open_loop", "feedback") if arm in self.arms and (arm == "open_loop" or has_limbs)]
        return tuple(names)

    def cases(self) -> tuple[Case, ...]:
        """Return the commands of undisturbed walks, then each disturbance of the walk at ``test_speed``."""
        policy = self.judged_policy
        commands = [
            Case(UNDISTURBED, speed * policy.max_speed, turn * policy.max_turn)
            for speed, turn in product(self.speeds, self.turns)
        ]
        test = Case(UNDISTURBED, self.test_speed * policy.max_speed, 0.0)
        if test not in commands:
            commands.append(test)
        disturbances = [name for name in self.disturbances if name != "slippery" or not self._swims]
        failures = [f"{kind}_{joint}" for kind, joint in product(self.faults, self.joint_names)]
        return (*commands, *(test._replace(condition=name) for name in (*disturbances, *failures)))

    def _faults(self, condition: str) -> tuple[Fault, ...]:
        """Return the faults of a condition, from the start of the walk on."""
        servos = layout(self.robot).servos
        if condition == "latency":
            return tuple(Delayed(servo, self.latency) for servo in servos)
        if condition == "play":
            return tuple(Backlash(servo, self.play) for servo in servos)
        kind, _, joint = condition.partition("_")
        return (FAULTS[kind](joint, at=START),) if joint in servos else ()  # type: ignore[call-arg]

    def _control(self, arm: str, case: Case, calibration: Calibration, robot: int = 0) -> tuple[Gait, Control]:
        """Return the gait and the control of an arm for a command.

        Args:
            arm: name of the arm.
            case: condition and command.
            calibration: what the gait does at its own frequency.
            robot: number of the robot, which decides the seed of the policy.
        """
        policies, gait = self._policies(), self.judged_policy.gait
        policy = policies.get(arm.removesuffix(_TOLD))
        if policy is not None:
            policy = policy.seeds[robot % len(policy.seeds)]
            failures = tuple((START, fault.part) for fault in self._faults(case.condition)) if _is_told(arm) else ()
            return policy.gait, Learned(policy=policy, forward=case.speed, turn=case.turn, failures=failures)
        rate = np.clip(case.speed / calibration.speed, 0.05, calibration.max_rate) if calibration.speed > 0.0 else 1.0
        asked_gait = replace(gait, period=gait.period / float(rate))
        if arm == "open_loop":
            slope = calibration.turn_per_asymmetry * rate
            asymmetry = float(np.clip(case.turn / slope, -_MAX_ASYMMETRY, _MAX_ASYMMETRY)) if slope else 0.0
            return asked_gait, Walking(asymmetry=asymmetry)
        rules = Coordinated().suited(self.robot, asked_gait)
        return asked_gait, replace(rules, heading=HeadingRule()) if gait.has("strokes") else rules

    def _run(self, gait: Gait, control: Control, condition: str, seed: int | None, label: str = "") -> Run:
        """Return a run of the design, or of a robot as built, in a condition.

        Args:
            gait: gait of the run.
            control: control of the run.
            condition: name of the condition.
            seed: seed of the robot as built; None for the design.
            label: name in tables.
        """
        run = Run(
            robot=self.robot,
            gait=gait,
            control=control,
            ground=Ground(friction_scale=self.friction if condition == "slippery" else 1.0),
            lake=Lake(level=self.robot.length) if self._swims else None,
            faults=self._faults(condition),
            label=label,
        )
        run = run if seed is None else self.tolerances.draw_run(run, seed)
        if condition == "heavier":
            count = len(self.robot.axis) + len(self.robot.girdles)
            run = replace(run, robot=with_masses(run.robot, [self.heavier] * count))
        return run

    def _window(self) -> tuple[float, float]:
        """Return beginning and end of the measured time, on samples [s]."""
        interval, period = _SAMPLE_STRIDE * control_period(self.robot), self.judged_policy.gait.period
        times = (START + self.settling * period, START + (self.settling + self.cycles) * period)
        start, end = (round(float(np.ceil(time / interval - 1e-9)) * interval, 12) for time in times)
        return start, end

    def _simulate(self, runs: Sequence[Run], progress: Any) -> xr.Dataset:
        """Simulate runs without warnings of servos that lag: that they do is a part of the tracking error."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", Doubtful)
            return simulate(
                list(runs),
                duration=self._window()[1],
                timestep=self.timestep,
                sample_stride=_SAMPLE_STRIDE,
                progress=progress,
            )

    def _calibrate(self, progress: Any) -> Calibration:
        """Return what the gait of the policy does at its own frequency, with equal and with unequal strokes."""
        gait = self.judged_policy.gait
        can_steer = gait.has("strokes")
        asymmetries = (0.0, _MAX_ASYMMETRY) if can_steer else (0.0,)
        runs = [self._run(gait, Walking(asymmetry=asymmetry), UNDISTURBED, None) for asymmetry in asymmetries]
        reached = motion(self._simulate(runs, progress), *self._window())
        slope = (reached.turn[-1] - reached.turn[0]) / _MAX_ASYMMETRY if can_steer else 0.0
        rate = _MAX_RATE
        while rate > 1.0 and not suits(self.robot, replace(gait, period=gait.period / rate)):
            rate *= _RATE_STEP
        return Calibration(float(reached.speed[0]), float(slope), max(rate, 1.0))

    def simulate(self, progress: Progress = silent) -> SimulationResult:
        """Walk under every command, and in every condition, with robots as built.

        Raises:
            UnsuitedRobot: no policy was trained for the robot.
        """
        policy, arms, cases = self.judged_policy, self.arm_names(), self.cases()
        needs_calibration = "open_loop" in arms or "feedback" in arms
        calibration = (
            self._calibrate(staged(progress, "calibration", 0.0, 0.03))
            if needs_calibration
            else Calibration(0.0, 0.0, 1.0)
        )
        seeds = np.random.SeedSequence(self.seed).generate_state(self.robots).tolist()
        cells, runs = [], []
        for (i, arm), (j, case) in product(enumerate(arms), enumerate(cases)):
            if _is_told(arm) and not self._is_failure(case.condition):
                continue
            if arm == STILL_AXIS and case.condition != UNDISTURBED:
                continue
            for k, seed in enumerate(seeds):
                gait, control = self._control(arm, case, calibration, k)
                cells.append((i, j, k))
                runs.append(self._run(gait, control, case.condition, seed, f"{arm}, {case.condition}"))
        walks = self._simulate(runs, staged(progress, "walks", 0.03, 1.0))
        start, end = self._window()
        record = _gather(
            motion(walks, start, end),
            cost_of_transport(walks, start, end).values,
            cells,
            (len(arms), len(cases), self.robots),
        )
        record = record.assign_coords(
            arm=list(arms),
            condition=("case", [case.condition for case in cases]),
            commanded_speed=("case", [case.speed for case in cases], {"units": "m/s"}),
            commanded_turn=("case", [case.turn for case in cases], {"units": "rad/s"}),
        )
        record.attrs |= {"max_speed": policy.max_speed, "max_turn": policy.max_turn, "goal": self.goal}
        return SimulationResult(record=record, replays=self._replays(walks, arms, cases, cells))

    def _is_failure(self, condition: str) -> bool:
        """Return whether a condition is the failure of a joint."""
        return condition not in (UNDISTURBED, *DISTURBANCES)

    def _replays(
        self, walks: xr.Dataset, arms: Sequence[str], cases: Sequence[Case], cells: Sequence[tuple[int, int, int]]
    ) -> Mapping[str, Replay]:
        """Return the replay of the policy in the last condition beside the last arm.

        Args:
            walks: record of all runs.
            arms: names of the arms.
            cases: conditions and commands.
            cells: arm, case and robot of each run.
        """
        case = len(cases) - 1
        pair = [cells.index((arm, case, 0)) for arm in (0, len(arms) - 1)]
        label = condition_label(cases[case].condition)
        return replayed(
            "policies_replay.html",
            walks.isel(run=pair[0]),
            self.robot,
            ghost=walks.isel(run=pair[1]) if pair[0] != pair[1] else None,
            labels=(ARM_LABELS[arms[0]], ARM_LABELS[arms[-1]]),
            title=f"Policy {self.judged_policy.name}",
            caption=f"The policy, {label}, and, half transparent, {ARM_LABELS[arms[-1]]} under the same command.",
        )

    def measure(self, record: xr.Dataset) -> Measures:
        """Return tracking errors, falls and costs of each control, over the commands and in each condition."""
        speed_error, turn_error = _errors(record)
        error = 0.5 * (speed_error + turn_error)
        greater_error = speed_error.where(speed_error > turn_error, turn_error)
        undisturbed = record.condition == UNDISTURBED
        measures = Measures()
        for arm in _measured_arms(record):
            of_arm = {"arm": arm}
            grid = {"case": undisturbed}
            follows = greater_error <= record.attrs["goal"]
            measures |= estimated(f"tracking_error_{arm}", error.sel(of_arm).isel(grid).mean("case"), "-")
            measures |= estimated(f"speed_error_{arm}", speed_error.sel(of_arm).isel(grid).mean("case"), "-")
            measures |= estimated(f"turn_error_{arm}", turn_error.sel(of_arm).isel(grid).mean("case"), "-")
            measures |= estimated(f"within_{arm}", follows.sel(of_arm).isel(grid).mean("case"), "-")
            measures |= estimated_fraction(f"fallen_{arm}", record.fallen.sel(of_arm).isel(grid).max("case"))
            straight = {"case": undisturbed & (record.commanded_turn == 0.0)}
            measures |= estimated(f"cost_{arm}", record.cost.sel(of_arm).isel(straight).mean("case", skipna=False), "-")
            if arm == "policy":
                for number in np.flatnonzero(undisturbed.values):
                    measures |= estimated(f"command_error_{number}", greater_error.sel(of_arm).isel(case=number), "-")
            else:
                excess = (error.sel(of_arm) - error.sel(arm="policy")).isel(grid).mean("case")
                measures |= estimated(f"error_excess_{arm}", excess, "-")
            if arm == STILL_AXIS:
                costs = record.cost.isel(straight).mean("case", skipna=False)
                measures |= estimated(f"cost_excess_{arm}", costs.sel(of_arm) - costs.sel(arm="policy"), "-")
        for condition in _conditions(record):
            test = {"case": (record.condition == condition) & (record.commanded_turn == 0.0)}
            test["case"] &= abs(record.commanded_speed - record.commanded_speed[-1]) < 1e-9
            at_test, falls = error.isel(test).isel(case=0), record.fallen.isel(test).isel(case=0)
            for arm in record.arm.values:
                if not np.isfinite(at_test.sel(arm=arm)).all():
                    continue
                measures |= estimated(f"tracking_error_{condition}_{arm}", at_test.sel(arm=arm), "-")
                measures |= estimated_fraction(f"fallen_{condition}_{arm}", falls.sel(arm=arm))
                if arm != "policy":
                    excess = at_test.sel(arm=arm) - at_test.sel(arm="policy")
                    measures |= estimated(f"error_excess_{condition}_{arm}", excess, "-")
        return measures

    def explain(self, measures: Mapping[str, float]) -> str:
        """Say how well each control follows the commands, and who is better in which condition."""
        policy, conditions = self.judged_policy, list(dict.fromkeys(case.condition for case in self.cases()))
        rivals = [arm for arm in self.arm_names() if arm != "policy"]
        outcomes: dict[str, dict[str, list[str]]] = {
            arm: {outcome: [] for outcome in ("better", "worse", "open")} for arm in rivals
        }
        for arm, condition in product(rivals, conditions):
            name = f"error_excess_{condition}_{arm}"
            if name in measures:
                outcomes[arm][comparison(measures, name)].append(condition_label(condition))
        return self.render_explanation(
            measures,
            policy=policy,
            arms=[arm for arm in self.arm_names() if f"tracking_error_{arm}" in measures],
            labels=ARM_LABELS,
            outcomes={arm: {key: names for key, names in rows.items() if names} for arm, rows in outcomes.items()},
            comparison={
                arm: comparison(measures, f"error_excess_{arm}") for arm in rivals if f"error_excess_{arm}" in measures
            },
            seed_count=len(policy.seeds),
            axis=self._axis_comparison(measures),
            commands=sum(case.condition == UNDISTURBED for case in self.cases()),
            missed=self.missed_commands(measures),
            falls=[name for name, value in measures.items() if _is_fall(name, value)],
            fall_text=lambda name: _fall_text(name, self.arm_names()),
        )

    def missed_commands(self, measures: Mapping[str, float]) -> list[Case]:
        """Return the commands that the policy follows, by the median over robots, with more error than the goal."""
        return [
            case
            for number, case in enumerate(self.cases())
            if case.condition == UNDISTURBED and measures.get(f"command_error_{number}", 0.0) > self.goal
        ]

    def _axis_comparison(self, measures: Mapping[str, float]) -> dict[str, Any]:
        """Return what spine and tail bring to a policy, for the explanation; empty where nothing was compared."""
        straight = self._policies().get(STILL_AXIS)
        if straight is None or f"error_excess_{STILL_AXIS}" not in measures:
            return {}
        bending = self.judged_policy
        return {
            "error": comparison(measures, f"error_excess_{STILL_AXIS}"),
            "cost": comparison(measures, f"cost_excess_{STILL_AXIS}"),
            "seeds": min(len(bending.seeds), len(straight.seeds)),
            "differences": training_differences(bending, straight),
        }

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw commands and what was reached, and the tracking error in each condition."""
        return {"policies_tracking": draw_tracking(outcome.record), "policies_errors": draw_errors(outcome)}


def training_differences(first: Policy, second: Policy) -> list[str]:
    """Return in what the trainings of two policies differ that should be compared: budget, seeds or commands."""
    records = [dict(policy.training) for policy in (first, second)]
    differences = [
        name for name in ("table generations", "network generations") if records[0].get(name) != records[1].get(name)
    ]
    differences += ["seeds"] if len(first.seeds) != len(second.seeds) else []
    has_other_commands = (first.speeds, first.turns) != (second.speeds, second.turns)
    return differences + (["commands"] if has_other_commands else [])


def comparison(measures: Mapping[str, float], name: str) -> str:
    """Return by the interval of an excess whether the policy is ``better``, ``worse``, or whether that is ``open``.

    Args:
        measures: measures by name.
        name: name of the error of another control minus that of the policy.
    """
    if measures[f"{name}_low"] > 0.0:
        return "better"
    return "worse" if measures[f"{name}_high"] < 0.0 else "open"


def _is_told(arm: str) -> bool:
    """Return whether an arm is a policy that is told of the fault."""
    return arm.endswith(_TOLD)


def _is_fall(name: str, value: float) -> bool:
    """Return whether a measure says that robots fell."""
    return name.startswith("fallen_") and not name.endswith(("_low", "_high")) and value > 0.0


def _fall_text(name: str, arms: Sequence[str]) -> str:
    """Return the arm and the condition of a measure of falls, in words."""
    text = name.removeprefix("fallen_")
    arm = max((arm for arm in arms if text == arm or text.endswith(f"_{arm}")), key=len)
    condition = text.removesuffix(arm).removesuffix("_")
    return f"{ARM_LABELS[arm]} {condition_label(condition) if condition else 'under some command'}"


def _gather(
    reached: TrackedMotion, cost: np.ndarray, cells: Sequence[tuple[int, int, int]], shape: tuple[int, int, int]
) -> xr.Dataset:
    """Return what was reached over arm, case and robot, NaN where nobody walked.

    Args:
        reached: motion of each run.
        cost: cost of transport of each run [-].
        cells: arm, case and robot of each run.
        shape: numbers of arms, cases and robots.
    """
    dims, places = ("arm", "case", "robot"), tuple(np.array(cells).T)
    data = {}
    for name, values, unit, long_name in (
        ("speed", reached.speed, "m/s", "mean speed along the heading"),
        ("turn", reached.turn, "rad/s", "turning rate, left positive"),
        ("fallen", reached.has_fallen, "1", "whether it fell"),
        ("cost", np.where(reached.has_fallen, np.nan, cost), "1", "mechanical cost of transport"),
    ):
        array = np.full(shape, np.nan)
        array[places] = values
        data[name] = (dims, array, {"units": unit, "long_name": long_name})
    return xr.Dataset(data)


def _errors(record: xr.Dataset) -> tuple[xr.DataArray, xr.DataArray]:
    """Return the sizes of the errors of speed and turning rate over their greatest commands [-]."""
    return (
        abs(record.speed - record.commanded_speed) / record.attrs["max_speed"],
        abs(record.turn - record.commanded_turn) / record.attrs["max_turn"],
    )


def _conditions(record: xr.Dataset) -> list[str]:
    """Return the conditions of a record, each once."""
    return list(dict.fromkeys(map(str, record.condition.values)))


def _measured_arms(record: xr.Dataset) -> list[str]:
    """Return the arms that walked undisturbed; a policy that is told of a fault walks with faults alone."""
    undisturbed = record.speed.isel(case=record.condition.values == UNDISTURBED)
    return [str(arm) for arm in record.arm.values if np.isfinite(undisturbed.sel(arm=arm)).all()]


experiment = Policies()
