"""A walk that somebody watches and meddles with: commands in, state out. It knows nothing of browsers."""

from dataclasses import dataclass, field, replace
from math import cos, sin
from threading import RLock
from typing import Any, Literal

import numpy as np

from suchus.apps.viewer.history import History
from suchus.apps.viewer.knobs import (
    AIR_FRACTION,
    DIRECTION,
    LEVEL,
    PUSH_DURATION,
    SIDE_SLOPE,
    SLOPE,
    SPEED,
    Knob,
    bumps_under,
    command_knobs,
    force_on,
    push_on,
    tune_gait,
)
from suchus.core.errors import Diverged, SuchusError
from suchus.robot.control import LAWS, Coordinated, HeadingRule, Learned, Policy, Swimming
from suchus.robot.design import Robot, front_segment, layout
from suchus.robot.design.ground import BUMPS_START, Bumps
from suchus.robot.design.scale import coarse_step, control_period
from suchus.robot.motion import START, Gait, check_limits, divide_axis
from suchus.robot.robots import size_relative_to_article
from suchus.sim.fault import Fault
from suchus.sim.faults import from_table
from suchus.sim.land import Ground, Lake, Live, Push, Run

Switch = Literal["spine", "tail", "coordination", "heading", "swims"]

_OPEN = Coordinated(limbs=LAWS["off"], spine=None, tail=None)
_CORRELATION = 0.06  # [m]; of the bumps, as in the catalog of arenas


@dataclass(frozen=True, slots=True, kw_only=True)
class Settings:
    """All settings of a live walk."""

    gait: Gait
    """The gait, as the sliders set it."""
    spine: bool = True
    """Whether the trunk bends; if not, it is straight as in the article's control group."""
    tail: bool = True
    """Whether the tail swings on the ground; if not, it is straight and lifted."""
    coordination: bool = False
    """Whether the three feedback rules are on."""
    heading: bool = False
    """Whether the heading loop is on."""
    uphill: float = 0.0
    """Slope along the walk [rad]."""
    sideways: float = 0.0
    """Slope across the walk, left side up positive [rad]."""
    bumps: float = 0.0
    """Height of the bumps ahead [m]; 0 for even ground."""
    size: float = 1.0
    """Length of the robot over that of the article's, which the length of the bumps follows [-]."""
    force: float = 15.0
    """Force of the next push [N]."""
    push_duration: float = 0.2
    """Duration of the next push [s]."""
    direction: float = 1.5707963267948966
    """Direction of the next push, from forward to the left [rad]."""
    speed: float = 1.0
    """Simulated over real time [-]."""
    swim: Gait | None = None
    """Gait in which it swims; None on dry land."""
    swims: bool = True
    """Whether it swims or walks, where there is water."""
    level: float = 0.6
    """Level of the water above the ground where the walk begins [m]."""
    air_fraction: float = 1.0
    """Share of the hull's air that is kept [-]."""
    broken: tuple[Fault, ...] = ()
    """Faults, each from the beginning of the next walk on."""
    policy: Policy | None = None
    """Trained policy that decides; None for the gait and the rules that are on."""
    forward: float = 0.0
    """Commanded forward speed of the policy [m/s]."""
    turn: float = 0.0
    """Commanded turning rate of the policy, left positive [rad/s]."""

    def walking_gait(self, robot: Robot) -> Gait:
        """Return the gait of a robot with the switches of spine and tail."""
        if self.spine and self.tail:
            return self.gait
        straight_chains = [*(() if self.spine else ("neck", "trunk")), *(() if self.tail else ("tail",))]
        return divide_axis(robot, self.gait).straightened(*straight_chains)

    def current_gait(self, robot: Robot) -> Gait:
        """Return the gait in which a robot moves now: that of its policy, of its swim, or of its walk."""
        if self.policy is not None:
            return self.policy.gait
        return self.swim if self.swim is not None and self.swims else self.walking_gait(robot)

    @property
    def lake(self) -> Lake | None:
        """The water; None on dry land."""
        return None if self.swim is None else Lake(level=self.level, air_fraction=self.air_fraction)

    @property
    def control(self) -> Coordinated | Learned | Swimming:
        """The policy, the swim, or the rules that are on; a policy is told of the servos that have failed."""
        if self.policy is not None:
            parts = [fault.part for fault in self.broken if fault.part in self.policy.servos]
            failures = tuple((0.0, part) for part in parts) if "failure" in self.policy.readings else ()
            return Learned(policy=self.policy, forward=self.forward, turn=self.turn, failures=failures)
        if self.swim is not None and self.swims:
            return Swimming()
        rules = Coordinated() if self.coordination else _OPEN
        return replace(rules, heading=HeadingRule()) if self.heading else rules

    @property
    def ground(self) -> Ground:
        """The ground that it walks on."""
        correlation, start = (round(self.size * distance, 9) for distance in (_CORRELATION, BUMPS_START))
        bumps = Bumps(height=self.bumps, correlation=correlation, start=start, seed=0) if self.bumps else None
        return Ground(uphill=self.uphill, sideways=self.sideways, relief=bumps)


_PLAIN: dict[str, Knob] = {
    "uphill": SLOPE, "sideways": SIDE_SLOPE, "push_duration": PUSH_DURATION, "direction": DIRECTION, "speed": SPEED,
    "level": LEVEL, "air_fraction": AIR_FRACTION,
}  # fmt: skip


def plain_knobs(robot: Robot, policy: Policy | None = None) -> dict[str, Knob]:
    """Return the knobs of the fields of ``Settings`` that are numbers, for a robot and its policy."""
    commands = {} if policy is None else command_knobs(policy)
    return {**_PLAIN, "bumps": bumps_under(robot), "force": force_on(robot), **commands}


@dataclass(slots=True)
class Instant:
    """State of the walk at one instant, for the page."""

    time: float = 0.0
    """Time since the walk was begun [s]."""
    state: dict[str, np.ndarray] = field(default_factory=dict)
    """Values by the names of ``record.VARIABLES``, without run and time."""
    forward: float = 0.0
    """Displacement of the centre of mass since the first cycle began [m]."""
    lateral_displacement: float = 0.0
    """Displacement of the centre of mass to the left [m]."""
    push_force: tuple[float, float, float] | None = None
    """The force of a push that lasts [N]."""
    level: float | None = None
    """Level of the water above the ground where the walk began, against gravity [m]; None on dry land."""
    trouble: str = ""
    """Reason why the walk ended; empty while it goes on."""


class Session:
    """One watched walk. All methods may be called from any thread; none raises for what a person typed.

    Args:
        robot: the robot.
        gait: the gait at the beginning.
        timestep: time step of the physics [s]; the one for many runs of a robot of its size if None.
        swim: gait in which it swims in a lake; None on dry land.
        policy: trained policy that decides; it begins at half of its greatest speed. None for the gait.

    Raises:
        OutsideLimits: the robot's joints cannot follow the gait, or the swim.
        InvalidDesign: the time step does not divide the control period.
        UnsuitedRobot: the policy was trained for another robot.
    """

    def __init__(
        self,
        robot: Robot,
        gait: Gait,
        *,
        timestep: float | None = None,
        swim: Gait | None = None,
        policy: Policy | None = None,
    ) -> None:
        if policy is not None:
            policy.check_robot(robot)
        check_limits(robot, gait)
        self.robot = robot
        length_ratio = size_relative_to_article(robot).length
        self.settings = Settings(gait=gait, force=push_on(robot), size=length_ratio, swim=swim, policy=policy)
        if policy is not None:
            self.settings = replace(self.settings, forward=float(f"{policy.max_speed / 2:.2g}"))
        self.walk_count = 0
        self._timestep = coarse_step(robot) if timestep is None else timestep
        self._period = control_period(robot)
        self._lock = RLock()
        self._push: Push | None = None
        self._begin()

    def reset(self) -> None:
        """Restart the walk with the present settings, faults included."""
        with self._lock:
            self._begin()

    def advance(self, seconds: float) -> None:
        """Let so much time pass in the simulation; what is left of a control period passes next time [s]."""
        with self._lock:
            if self.state.trouble:
                return
            self._due += seconds
            while self._due >= self._period - 1e-9 and not self.state.trouble:
                self._due -= self._period
                self._step()

    def tune(self, name: str, value: object) -> str:
        """Turn a knob of the gait as far as the robot follows; return a sentence if that is not as asked.

        Args:
            name: name of the knob, see ``suchus.robot.motion.NUMBERS``.
            value: value in the unit of the knob, as the page shows it: % of a limb's reach, degrees, seconds; anything.
        """
        with self._lock:
            gait, notice = tune_gait(self.robot, self.settings.gait, name, value)
            return notice if gait == self.settings.gait else self._change(replace(self.settings, gait=gait)) or notice

    def set_gait(self, gait: Gait) -> str:
        """Walk on in another gait; return a sentence if the robot cannot."""
        with self._lock:
            return self._change(replace(self.settings, gait=gait))

    def switch(self, name: Switch, is_on: bool) -> str:
        """Turn spine, tail, the feedback rules, the heading loop or the swim on or off.

        Returns:
            A sentence if that cannot be.
        """
        with self._lock:
            changes: dict[str, Any] = {name: bool(is_on)}
            return self._change(replace(self.settings, **changes))

    def set_number(self, name: str, value: object) -> str:
        """Set slope, bumps, water, playback speed or the next push; return a sentence if that is not as asked.

        Args:
            name: a field of ``Settings`` that is a number.
            value: value in the unit of its knob; anything.
        """
        knob = plain_knobs(self.robot, self.settings.policy)[name]
        with self._lock:
            number, notice = knob.clip(value, getattr(self.settings, name) / knob.scale)
            changes: dict[str, Any] = {name: number * knob.scale}
            last_settings, self.settings = self.settings, replace(self.settings, **changes)
            if name == "bumps" and self.settings.bumps != last_settings.bumps:
                self._begin()
            elif name in ("forward", "turn"):
                return self._change(self.settings) or notice
            elif name in ("uphill", "sideways"):
                self._live.tilt(self.settings.ground)
            elif name in ("level", "air_fraction") and self.settings.lake is not None:
                return self._fill(last_settings) or notice
            return notice

    def break_part(self, part_name: str, kind: str, **parameters: object) -> str:
        """Break a part in its present state; return a sentence if that is impossible.

        Args:
            part_name: a joint, a leg or a group of sensors.
            kind: name of a fault in the catalog.
            **parameters: of that fault; those left out are as in the catalog.
        """
        with self._lock:
            try:
                fault = from_table({"kind": kind, "joint": part_name, **parameters})
                self._live.begin(fault)
            except SuchusError as error:
                return str(error)
            other_faults = self._faults_except(part_name)
            self.settings = replace(self.settings, broken=(*other_faults, fault))
            return self._tell_policy()

    def repair_part(self, part_name: str | None = None) -> None:
        """Repair a part, or all of them."""
        with self._lock:
            for fault in self.settings.broken:
                if part_name in (None, fault.part):
                    self._live.mend(fault.part)
            other_faults = () if part_name is None else self._faults_except(part_name)
            self.settings = replace(self.settings, broken=other_faults)
            self._tell_policy()

    def _tell_policy(self) -> str:
        """Tell a policy that knows of failures which servos have failed; return a sentence if that cannot be."""
        return "" if self.settings.policy is None else self._change(self.settings)

    @property
    def present_faults(self) -> tuple[Fault, ...]:
        """The faults that are present now; an intermittent one comes and goes."""
        with self._lock:
            return self._live.broken

    def _faults_except(self, part_name: str) -> tuple[Fault, ...]:
        return tuple(fault for fault in self.settings.broken if fault.part != part_name)

    def push(self) -> None:
        """Push the trunk as the settings say, now."""
        with self._lock:
            s = self.settings
            force = (s.force * cos(s.direction), s.force * sin(s.direction), 0.0)
            push = Push(force=force, at=self._live.time, duration=s.push_duration, body=front_segment(self.robot))
            self._live.push(push)
            self._push = push

    def table(self) -> dict[str, np.ndarray]:
        """Return the last seconds, by the names of ``history.columns``."""
        with self._lock:
            return self._history.table()

    def instant(self) -> Instant:
        """Return a copy of the present instant."""
        with self._lock:
            return replace(self.state)

    def _fill(self, last_settings: Settings) -> str:
        """Apply the settings of the water; restore the last settings and return a sentence if that fails."""
        lake = self.settings.lake
        assert lake is not None
        try:
            self._live.fill(lake)
        except SuchusError as error:
            self.settings = last_settings
            return str(error)
        return ""

    def _begin(self) -> None:
        """Start a new simulation from the present settings, with empty history and the robot at its start."""
        s = self.settings
        # a locked joint holds the angle that it has as the walk begins
        run = Run(
            robot=self.robot, gait=s.current_gait(self.robot), ground=s.ground, lake=s.lake, control=s.control,
            faults=s.broken,
        )  # fmt: skip
        self._live = Live(run, timestep=self._timestep)
        self._history = History(layout(self.robot).limb_names)
        self._push, self._due = None, 0.0
        self._origin = self._live.current_sample["centre_of_mass"]
        self.walk_count += 1
        self.state = Instant(state=self._live.current_sample, level=s.level if s.lake else None)
        self._history.note(0.0, self._live.current_sample, (0.0, 0.0))

    def _change(self, settings: Settings) -> str:
        """Continue the walk with other settings; keep the old ones and return a sentence if that fails."""
        try:
            self._live.walk(settings.current_gait(self.robot), settings.control)
        except SuchusError as error:
            return str(error)
        self.settings = settings
        return ""

    def _step(self) -> None:
        """Simulate one control period and update the instant that pages show; note why the walk ended."""
        try:
            self._live.step()
        except Diverged as error:
            self.state.trouble = f"{str(error).rstrip('.')}. Press reset to begin anew."
            return
        time, state = self._live.time, self._live.current_sample
        if time <= START + 1e-9:
            self._origin = state["centre_of_mass"]
        forward, lateral_displacement, _ = state["centre_of_mass"] - self._origin
        if self._push is not None and time >= self._push.at + self._push.duration:
            self._push = None
        push_force = self._push.force if self._push else None
        level = self.settings.level if self.settings.lake else None
        self.state = Instant(
            time=time,
            state=state,
            forward=float(forward),
            lateral_displacement=float(lateral_displacement),
            push_force=push_force,
            level=level,
        )
        self._history.note(time, state, (float(forward), float(lateral_displacement)))
