"""Robot and flow solved together, step by step.

A step of the flow has four parts. The robot moves under the force of the last step and the added mass. The flow
follows. The robot repeats the step under the force that the flow returned. The water gets the change of the motion by
one solve of the pressure equation (``flow.twist``).

With F the generalised force of the water, A the added mass and a the mean acceleration of the step, the force that is
applied to the robot is ``F(a) = F* - A (a - a*)``. F* and a* are those of the last iteration.

The residual is the force applied in the last iteration minus the force that the flow returns. Its impulse is carried
over to the next step. The momentum error of MuJoCo's steps is carried over as well. The robot's momentum thus equals
the impulse of the water.

A is symmetric. Each correction updates A with the observed response of the water. A is computed anew as the body bends.
"""

import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from math import gcd, isfinite, prod
from pathlib import Path
from typing import ClassVar

import numpy as np
import xarray as xr
from jaxtyping import Float
from scipy.linalg import eigh

from suchus import flow
from suchus.core import rotation
from suchus.core.errors import Diverged, Doubtful, InvalidDesign, NotConverged, OutsideLimits
from suchus.core.progress import Progress
from suchus.flow import checkpoint as store
from suchus.flow.progress import Bar
from suchus.flow.simulation import MAX_EVENED_STEPS
from suchus.robot.control import Controller
from suchus.robot.design import layout
from suchus.robot.design.scale import control_period, physics_step
from suchus.robot.design.water import Water
from suchus.robot.motion import check_limits, cycle_targets
from suchus.sim.fault import check_faults
from suchus.sim.land.afloat import check_floats
from suchus.sim.land.batch import Beginning
from suchus.sim.land.lake import Lake
from suchus.sim.land.run import Run, check_pushes
from suchus.sim.land.stepper import CoordinateState, StepInterval, Stepper
from suchus.sim.land.waters import Slice, Space
from suchus.swimming.coupling.chain import ChainState, MidlineChain
from suchus.swimming.coupling.linked import LinkChain, LinkPath
from suchus.swimming.coupling.recorded import Series, coupling_record
from suchus.swimming.water import Outline, cycle, displaced_mass, recoil
from suchus.swimming.water.immersed import folded_limbs, half_heights
from suchus.swimming.water.samples import Samples
from suchus.swimming.water.setting import DENSITY, SwimSetting

OFF_PLANE = 0.12
"""Greatest angle of a joint out of the plane of the flow [rad]."""
MAX_RESIDUAL = 1.0
"""Residual above which a step is unconverged [-]: the residual force exceeds the greatest force so far."""
MAX_UNCONVERGED_STEPS = 5
"""Greatest number of successive unconverged steps [-]: at the start the force is too small for a comparison."""
MAX_STEP = 1.25
"""Greatest step of the flow, over the time in which the body wave moves by a cell [-].

At rest the flow has no other bound. While the robot swims, the step is about 0.9 of that time."""
STEPS = 100
"""Least number of steps of the flow in a cycle with moving limbs [-].

Forces and velocities are means over a step. The error of their product, the power, is of second order: up to 0.5 % with
42 steps, 0.1 % with 100."""
MIN_PHYSICS_STEPS = 30
"""Least number of physics steps in a step of the flow, by the speed of the gait; the water is faster, and so about half
of them are left [-].

Energy error: 1e-2 with 1, 2e-3 with 5, 8e-4 with 10. A swim in a slice of 64 cells is 4.5, 1.7 and 0.1 % slower in its
second and third second with physics steps of 2, 1 and 0.5 ms, compared to 0.25 ms. The flow takes most of the time."""
MIN_LINKED_PHYSICS_STEPS = 5
"""The same for a body of links, whose steps of the flow ``STEPS`` bounds too [-]."""
MIN_EFFECTIVE_INERTIA = 0.1
"""Least inertia along a correction after an update of the added mass, over the inertia before it [-].

It is chosen: with less, the next guess of the acceleration would be more than ten times as large."""
_MAX_ROUNDS, _ROUND_TOLERANCE = 10, 1e-4
"""Greatest number of rounds for the explicit part of the added mass, which the robot's own matrix cannot hold; and the
relative change of the acceleration at which they have converged [-]."""
MIN_FLOOR_CELLS = 2.0
"""Least water between a body and the floor [cells]; with less the grid does not resolve the film between them."""
MAX_SLICE_CELLS = 4096
"""Cells per body length above which no more are proposed [-]."""
_CHANGING = {
    "force": "_force",
    "push": "_push",
    "owed": "_residual_impulse",
    "strayed": "_momentum_defect",
    "added": "_added_mass",
    "kept": "_implicit_added_mass",
    "computed": "_computed",
    "greatest": "_max_force",
    "greatest_momentum": "_greatest_momentum",
    "strikes": "_strikes",
    "effort": "_effort",
    "start_added": "_start_added",
}
"""Attributes that change during a swim, by their names in a checkpoint."""
_POSTURE_FIELDS = {"place": "position", "rate": "rate"}
"""Fields of a ``ChainState``, by their names in a checkpoint."""
MAX_THICKENING = 0.05
"""Area that a slice gains by its least half-width, over the body's, above which a warning is issued [-]. The swimmer is
4 % as thick as long: its slice of 64 cells a length gains 46 % and swims at .086 m/s in its second cycle, at 96 cells 2
% and .159, at 128 cells .162, at 192 cells .167 (f L2 / nu = 1500)."""
_WIDER = 1.25
"""Swing for which the box is made, over that of the commanded midline [-]."""


def check_swim(run: Run, duration: float) -> None:
    """Refuse a run whose gait, faults, control or body a flow cannot have, before the flow is set up.

    Args:
        run: run with a ``Slice`` or a ``Space``.
        duration: [s].

    Raises:
        InvalidDesign, OutsideLimits: see ``Swim``.
    """
    check_limits(run.robot, run.gait)
    check_faults(run.faults, run.robot, duration)
    check_pushes(run.pushes, run.robot, duration)
    linked = isinstance(run.solved_flow, Space) and run.solved_flow.linked
    if not linked and not any(hinge.turn == "yaw" for hinge in run.robot.axis_hinges):
        raise InvalidDesign(
            f"robot {run.robot.name!r} has no joint that bends its axis sideways, and the flow is around a body "
            'that does; take water="sections".'
        )
    if not linked:
        _check_plane(run)
    check_floats(run.robot, Lake(level=run.robot.length))
    for name in ("depth", "pitch"):
        if getattr(run.control, name, None) is not None:
            flow_name = type(run.solved_flow).__name__.lower()
            raise InvalidDesign(
                f"the control holds the {name}, and in a {flow_name} the body stays in its "
                f'plane: leave out {name}, or take water="sections".'
            )


def _check_plane(run: Run) -> None:
    """Refuse a gait that moves limbs, which are at rest in the flow, or bends the axis out of its plane.

    Raises:
        InvalidDesign: naming the servo.
    """
    robot, gait, place = run.robot, run.gait, layout(run.robot)
    angles = cycle_targets(robot, gait, np.linspace(0.0, 1.0, 24, endpoint=False))
    lateral = {servo.name for servo in Outline(robot, 33).servos}
    axis = {hinge.name for hinge in robot.axis_hinges} | {cable.name for cable in robot.cables}
    for number, name in enumerate(place.servos):
        swing, max_angle = float(np.ptp(angles[:, number])), float(np.abs(angles[:, number]).max())
        if name not in lateral and (swing > OFF_PLANE or (name in axis and max_angle > OFF_PLANE)):
            fault = "bends the axis out of the plane" if name in axis else "strokes with a limb"
            raise InvalidDesign(
                f"gait {gait.name!r} {fault}: servo {name} swings by {swing:.3g} rad about angles up to "
                f"{max_angle:.3g} "
                "rad. The flow is around a body that bends in its plane, its limbs at rest: take a gait that "
                "does, say motion.swimming_gait, or water=Space(linked=True), where each piece moves as its joints do, "
                'or water="sections".'
            )


def never_negative(
    added_mass: Float[np.ndarray, "coordinate coordinate"], mass: Float[np.ndarray, "coordinate coordinate"]
) -> Float[np.ndarray, "coordinate coordinate"]:
    """Return an added mass that is positive semidefinite: negative modes are set to zero.

    Coarse cells may give a negative added mass for the bend of a thin tail, after the pressure inside the body is taken
    away. A light robot would be unstable with it.
    """
    values, shapes = eigh(added_mass, mass)
    if values[0] >= 0.0:
        return added_mass
    mass_modes = mass @ shapes
    return added_mass - (mass_modes * np.minimum(values, 0.0)) @ mass_modes.T


def update_added_mass(
    added_mass: Float[np.ndarray, "coordinate coordinate"], mass: Float[np.ndarray, "coordinate coordinate"],
    push: Float[np.ndarray, " coordinate"], water_response: Float[np.ndarray, " coordinate"],
) -> Float[np.ndarray, "coordinate coordinate"]:  # fmt: skip
    """Return the added mass after a BFGS update with the observed response of the water.

    It is symmetric, and positive definite with the robot's own mass. An update that leaves less than
    ``MIN_EFFECTIVE_INERTIA`` of the inertia along the acceleration is rejected.

    Args:
        added_mass: symmetric.
        mass: the robot's own.
        push: acceleration more.
        water_response: force of the water against it.
    """
    predicted_force = (mass + added_mass) @ push
    observed_force = mass @ push + water_response
    predicted_work, observed_work = float(push @ predicted_force), float(push @ observed_force)
    if not observed_work > MIN_EFFECTIVE_INERTIA * predicted_work > 0.0:
        return added_mass
    return np.asarray(
        added_mass
        + np.outer(observed_force, observed_force) / observed_work
        - np.outer(predicted_force, predicted_force) / predicted_work
    )


def incommensurate_steps(max_steps: int, period: int) -> int:
    """Return the number of physics steps in a step of the flow, such that steps end at different phases.

    Servos get new commands at the beginning of each control period. Light limbs follow so fast that their speed changes
    by a tenth within the period. If all steps of the flow ended at the same phase, they would all see the speed of that
    phase.

    Args:
        max_steps: physics steps [-].
        period: physics steps in a control period [-].
    """
    fair = [n for n in range(max(max_steps - 3, 1), max_steps + 1) if gcd(n, period) == 1]
    fast = [n for n in fair if max_steps > period and 1 < n % period < period - 1]
    return max(fast or fair or [max_steps])


@dataclass(frozen=True, slots=True, kw_only=True)
class LakeFloor(flow.Side):
    """A floor with friction that is at rest in the world, below a grid that travels with a body over it."""

    pose: Callable[[float], flow.Pose]
    """Pose of the body that the grid travels with, at a time [s]."""

    travels: ClassVar[tuple[bool, bool]] = False, True

    def wall_velocity(self, time: float, ndim: int) -> tuple[float, ...]:
        """Return the velocity of the floor in the frame of the grid; see ``flow.Side``."""
        return tuple(-component for component in self.pose(time).velocity[: ndim - 1])


def thickening(outline: Outline, bluntness: float, cells: int) -> float:
    """Return the area that a slice gains by its least half-width, over that of the body [-].

    Args:
        outline: outline of the robot.
        bluntness: least half-width [cells].
        cells: cells per body length [-].
    """
    half_width, s = outline.silhouette.half_width, outline.s
    min_half_width = bluntness * outline.robot.length / cells
    inward = np.minimum(s, s[-1] - s)
    cap = np.sqrt(np.maximum(min_half_width**2 - np.maximum(min_half_width - inward, 0.0) ** 2, 0.0))
    areas = [float(np.trapezoid(width, s)) for width in (half_width, np.maximum(half_width, cap))]
    return areas[1] / areas[0] - 1.0


class Swim:
    """One run in a flow, from rest.

    Args:
        run: run with a ``Slice`` or a ``Space``.
        duration: [s]; infinity keeps no samples of the robot.
        timestep: time step of the physics [s]; None for the largest that the robot's size and ``MIN_PHYSICS_STEPS``
            allow.
        thread_count: number of threads of the flow.
        controller: what decides instead of the run's; None for that one.
        begin: state of the robot at the beginning; None for the controller's first posture.

    Raises:
        InvalidDesign: a gait or a controller that leaves the plane, a robot that sinks, or a grid that cannot carry it.
        OutsideLimits: a gait that the robot's joints cannot follow.
    """

    def __init__(
        self,
        run: Run,
        duration: float,
        *,
        timestep: float | None = None,
        thread_count: int | None = None,
        controller: Controller | None = None,
        begin: Beginning | None = None,
    ) -> None:
        """Set up robot and flow, and compute the added mass."""
        water = run.solved_flow
        assert water is not None
        self.run, self.water = run, water
        check_swim(run, duration)
        self.outline = Outline(run.robot, water.cells + 1)
        self._warn_of_thickening()
        self._axes = 2 if isinstance(water, Slice) else 3
        self._times = self.depth if isinstance(water, Slice) else 1.0
        self._swing = self._expected_swing()
        self.timestep = self._physics_step() if timestep is None else timestep
        self.ticks = round(duration / control_period(run.robot)) if isfinite(duration) else 0
        self.stepper = Stepper(
            run, None if self._linked else self.outline.joints, self.timestep, self.ticks, controller=controller,
            begin=begin,
        )  # fmt: skip
        start = self.stepper.coordinates.position
        self.chain: MidlineChain | LinkChain = (
            LinkChain(run.robot, self.stepper.links, start[:3])
            if self._linked
            else MidlineChain(self.outline, water.parts, (float(start[0]), float(start[1])))
        )
        self.path = self.chain.start_path(0.0, self._flow_state(self.stepper.coordinates))
        self.sim = flow.Simulation(self._setup(), thread_count=thread_count)
        self.series = Series()
        self._effort = 0.0
        self._force = np.zeros(self.chain.size)
        self._push = np.zeros(self.chain.size)
        self._residual_impulse = np.zeros(self.chain.size)  # impulse of the water that the robot has not been given yet
        self._momentum_defect = np.zeros(
            self.stepper.axis_count
        )  # see ``StepInterval.momentum_defect``; of the last step
        self._added_mass = np.zeros((self.chain.size, self.chain.size))
        self._implicit_added_mass = self._added_mass
        self._computed: np.ndarray | None = None
        self._max_force, self._strikes = 0.0, 0
        self._greatest_momentum = 0.0
        self._warned_joints: set[str] = set()
        self._flow_posture = self.path.posture_at(0.0)  # posture for which the water was told last where the body is
        self.samples = Samples()
        """What a ``watch`` of ``go`` keeps; a checkpoint holds it too."""
        self._renew()
        self._start_added = self._added_mass

    # --- what is set up ----------------------------------------------------------------------------------------

    @property
    def depth(self) -> float:
        """Depth of the water of a slice [m]."""
        fixed_depth = getattr(self.water, "depth", None)
        if fixed_depth is not None:
            return float(fixed_depth)
        half_width, _ = self.outline.silhouette
        return displaced_mass(self.outline, 1.0) / float(np.trapezoid(2 * half_width, self.outline.s))

    @property
    def viscosity(self) -> float:
        """Kinematic viscosity of the water [m2/s]."""
        return self.run.robot.length**2 / (self.run.gait.period * self.water.reynolds)

    def _expected_swing(self) -> float:
        """Return the greatest lateral displacement of the commanded midline [m]."""
        outline = Outline(self.run.robot, 65)
        return float(np.abs(cycle(outline, self.run.gait, *recoil(outline, self.run.gait, 0.0, Water())).y).max())

    def _physics_step(self) -> float:
        """Return the largest timestep of the physics that divides a control period often enough [s]."""
        period, cell = control_period(self.run.robot), self.run.robot.length / self.water.cells
        lateral_stroke, vertical_stroke = self._strokes if self._linked else (0.0, 0.0)
        min_steps = MIN_LINKED_PHYSICS_STEPS if self._linked else MIN_PHYSICS_STEPS
        fastest = 2 * np.pi / self.run.gait.period * max(self._swing, lateral_stroke, vertical_stroke, cell)
        max_step = min(physics_step(self.run.robot), 0.8 * cell / (1.5 * fastest) / min_steps)
        return float(period / np.ceil(period / max_step * (1 - 1e-9)))

    @cached_property
    def half_height(self) -> Float[np.ndarray, " station"]:
        """Half of the body's height at the stations [m]."""
        return half_heights(self.outline, self.water.tail_height)

    @property
    def _min_half_width(self) -> float:
        bluntness = self.water.blunt if isinstance(self.water, Slice) else 0.0
        return bluntness * self.run.robot.length / self.water.cells

    def _warn_of_thickening(self) -> None:
        """Warn of a slice that is much thicker than the body, because its cells are coarse."""
        bluntness = self.water.blunt if isinstance(self.water, Slice) else 0.0
        gained = thickening(self.outline, bluntness, self.water.cells)
        if gained <= MAX_THICKENING:
            return
        cells = self.water.cells
        while cells < MAX_SLICE_CELLS and thickening(self.outline, bluntness, cells) > MAX_THICKENING:
            cells = int(np.ceil(1.05 * cells))
        warnings.warn(
            f"at {self.water.cells} cells a length the slice of robot {self.run.robot.name!r} is thickened to "
            f"{2 * bluntness:g} cells where it is thinner, which adds {gained:.0%} to its area: it swims as a thicker "
            f"body, slower, and with a speed that wanders. Take at least {cells} cells.",
            Doubtful, stacklevel=4,
        )  # fmt: skip

    @property
    def _floor(self) -> float | None:
        """Depth of the floor below the body's plane; None without a floor [m]."""
        return self.water.floor if isinstance(self.water, Space) else None

    def _check_floor(self, height: float) -> None:
        """Refuse a floor that the body touches, or that the grid cannot part from it.

        Args:
            height: greatest half-height of the body [m].

        Raises:
            InvalidDesign: with the depth that would do.
        """
        assert self._floor is not None
        min_depth = height + MIN_FLOOR_CELLS * self.run.robot.length / self.water.cells
        if self._floor < min_depth:
            raise InvalidDesign(
                f"the floor is {self._floor:.3g} m below the middle of robot {self.run.robot.name!r}, whose "
                f"half-height is {height:.3g} m: fewer than {MIN_FLOOR_CELLS:g} cells of water are between them. "
                f"Give a floor of at least {min_depth:.3g} m, or more cells than {self.water.cells}."
            )

    @property
    def _linked(self) -> bool:
        """Whether each link has its own pose and the root moves in space."""
        return isinstance(self.water, Space) and self.water.linked

    @cached_property
    def _strokes(self) -> tuple[float, float]:
        """Return the greatest lateral displacement of limbs and vertical displacement of the axis in the gait [m]."""
        robot, names = self.run.robot, layout(self.run.robot).servos
        angles = cycle_targets(robot, self.run.gait, np.linspace(0.0, 1.0, 24, endpoint=False))
        swings = dict(zip(names, 0.5 * np.ptp(angles, axis=0), strict=True))
        rise, lateral = 0.0, {servo.name for servo in self.outline.servos}
        starts, hinges = 0.0, dict[str, float]()
        for segment in robot.axis:
            starts += segment.front + segment.rear
            hinges |= {hinge.name: min(starts, robot.length - starts) for hinge in segment.hinges}
        for name, lever in hinges.items():
            rise += swings.get(name, 0.0) * lever * (name not in lateral)
        limbs = [
            limb.girdle.limb.reach * sum(swings.get(name, 0.0) for name in names[limb.servos])
            for limb in layout(robot).limbs
        ]  # fmt: skip
        return max(limbs, default=0.0), rise

    def _setup(self) -> flow.Setup:
        """Return the setup of the flow: grid, body, its motion, and the sides of the box."""
        robot, axes = self.run.robot, self._axes
        setting = SwimSetting(axes=axes, cells=self.water.cells, viscosity=self.viscosity, cycles=1)
        if self.water.beside is not None:
            setting = replace(setting, beside=self.water.beside)
        swing = _WIDER * self._swing
        if isinstance(self.chain, LinkChain):
            assert isinstance(self.path, LinkPath)
            stretched = [girdle.aside + girdle.limb.reach + girdle.limb.foot.radius for girdle in robot.girdles]
            reach = max(swing, *stretched, 1.5 * self._strokes[1] + float(self.half_height.max()))
            grid = setting.grid_around(robot.length, reach)
            shape: flow.Shape = self.chain.body(self.path)
            motion = self.chain.motion(self.path)
        else:
            height = float(self.half_height.max())
            grid = setting.grid(robot.length, swing, height)
            if self._floor is not None:
                self._check_floor(height)
                grid = setting.grid_above_floor(robot.length, swing, height, self._floor)
            spine_body = self.chain.body(self.path, axes, self._min_half_width, self.half_height)
            motion, shape = self.chain.motion(self.path, axes, self._min_half_width), spine_body
            if self.water.limbs:
                assert isinstance(spine_body, flow.Trunk)
                shape = flow.Limbed(
                    spine=spine_body.spine, half_height=spine_body.half_height, cuts=spine_body.cuts,
                    limbs=folded_limbs(robot),
                )  # fmt: skip
        setting.check_thickness(robot, shape)
        body = flow.Body(shape=shape, motion=motion, name=robot.name)
        sides = flow.Sides(low=flow.Mirror()) if axes == 3 and not self._linked else flow.Sides()
        if self._floor is not None:
            sides = flow.Sides(low=LakeFloor(pose=motion))
        return flow.Setup(
            grid=grid, viscosity=self.viscosity, density=DENSITY, bodies=(body,), follow=robot.name, sides=sides,
            follow_axes=(True,) * 3 if self._linked else (True, True), tolerance=setting.largest_divergence(),
        )  # fmt: skip

    # --- between the robot's world and the flow's --------------------------------------------------------------

    def _flow_state(self, state: CoordinateState) -> ChainState:
        """Return a state of the robot in the frame of the flow.

        MuJoCo moves the robot in a step by the velocity at its end. Its velocities are therefore those of half a
        physics step before its positions, and the positions are taken back by as much.
        """
        return self.chain.flow_state(_earlier_position(state, 0.5 * self.timestep), state.rate)

    @property
    def _origin(self) -> np.ndarray:
        return np.array(self.sim.frame[0, : self.chain.axis_count])

    def _water_force(self, began: ChainState, posture: ChainState) -> np.ndarray:
        """Return the generalised force of the water in the last step on each of the robot's coordinates [N, N m]."""
        loads, place = self.sim.last_loads(self.run.robot.name), 0.5 * (began.position + posture.position)
        return self._times * self.chain.of_robot(self.chain.force(place, loads, self._origin))

    # --- going on ----------------------------------------------------------------------------------------------

    @property
    def time(self) -> float:
        """Time that has been simulated [s]."""
        return self.stepper.time

    @property
    def effort(self) -> float:
        """Work of the servos so far; braking counts as positive work [J]."""
        return self._effort

    def _renew(self, *, anew: bool = False) -> None:
        """Compute the added mass anew if the body has turned or bent enough, and after the first step.

        The argument ``anew`` forces it: corrections that do not converge show that the added mass is not valid any
        more.
        """
        posture = self.path.posture_at(self.time)
        is_first_step = len(self.series.time) == 1
        reference_place = None if is_first_step or anew else self._computed
        if (
            reference_place is not None
            and self.chain.rotation_between(posture.position, reference_place) < self.water.renewed
        ):
            return
        self._computed = posture.position
        previous_mass = self._added_mass
        modes = self.chain.modes(posture.position, self._origin, self._axes)
        added_mass = self.sim.added_mass(self.run.robot.name, modes)
        internal_mass = self.chain.unpressed(posture.position, added_mass.internal_pressure, self._origin)
        water_mass = added_mass.matrix - 0.5 * (internal_mass + internal_mass.T)
        self._added_mass = never_negative(self._times * self.chain.of_robot(water_mass), self.stepper.mass())
        if len(self.series.time):
            inertia = self.stepper.mass() + previous_mass
            eigenvalues = np.linalg.eigvals(np.linalg.solve(inertia, self._added_mass - previous_mass))
            self.series.radius.append((self.time, float(np.abs(eigenvalues).max())))
        self._implicit_added_mass = self.stepper.set_added_mass(self._added_mass)

    def _newton(self) -> np.ndarray:
        """Return the derivative of the missing acceleration with respect to the guess, without the servos."""
        inertia = self.stepper.mass() + self._implicit_added_mass
        return np.asarray(
            np.eye(self.chain.size) + np.linalg.solve(inertia, self._added_mass - self._implicit_added_mass)
        )

    def _solve_motion(
        self, count: int, force: np.ndarray, push: np.ndarray, guess: np.ndarray, newton: np.ndarray
    ) -> tuple[CoordinateState, np.ndarray, np.ndarray]:  # fmt: skip
        """Move the robot under ``force`` minus the added mass times the change of the acceleration.

        Returns the state at the end, the mean acceleration, and the force beyond the implicit part. The rounds end when
        the acceleration agrees with ``guess``. Broyden's method updates ``newton`` in place.
        """
        h, start_rate = count * self.timestep, self.stepper.initial_coordinates.rate
        explicit_mass = self._added_mass - self._implicit_added_mass
        missing = change = np.zeros_like(push)
        for round_ in range(_MAX_ROUNDS):
            end = self.stepper.go(count, force + self._added_mass @ push - explicit_mass @ guess)
            acceleration = (end.rate - start_rate) / h
            previous_missing, missing = missing, acceleration - guess
            extra_force = explicit_mass @ missing
            if np.abs(missing).max() <= _ROUND_TOLERANCE * np.abs(acceleration).max():
                break
            if round_:
                newton += np.outer(previous_missing - missing - newton @ change, change) / (change @ change)
            change = np.linalg.solve(newton, missing)
            guess = guess + change
        return end, acceleration, extra_force

    def _size(self, force: np.ndarray) -> float:
        """Return the norm of a generalised force, each coordinate divided by the square root of its inertia."""
        return float(np.sqrt((force**2 / np.diag(self.stepper.mass() + self._added_mass)).sum()))

    def _learn(self, push: np.ndarray, water_response: np.ndarray) -> np.ndarray:
        """Update the added mass with the observed response of the water, and return the change.

        Args:
            push: acceleration more.
            water_response: force of the water against it.
        """
        previous_mass = self._added_mass
        self._added_mass = update_added_mass(previous_mass, self.stepper.mass(), push, water_response)
        return self._added_mass - previous_mass

    def _adrift(self, impulse: np.ndarray) -> float:
        """Return the norm of an impulse on the whole robot over its greatest momentum so far [-]."""
        max_momentum = self._greatest_momentum
        return float(np.linalg.norm(impulse[: self.stepper.axis_count])) / max_momentum if max_momentum > 0.0 else 0.0

    def step(self, end_time: float) -> None:
        """Take one step of the flow and of the robot that ends at a time or before it [s].

        Raises:
            Diverged: robot or flow diverged, or the coupling does not converge; with the record so far.
            OutsideLimits: the water is so fast that the flow's step falls below the physics'.
            InvalidDesign: the robot leaves the plane, or the box.
        """
        stepper, sim, name = self.stepper, self.sim, self.run.robot.name
        allowed = sim.next_step()
        if allowed < self.timestep:
            raise OutsideLimits(
                f"at t = {self.time:.4g} s the flow allows a step of {allowed:.3g} s, less than the "
                f"{self.timestep:.3g} s of the robot's physics; take a timestep of at most {0.5 * allowed:.2g} s, or "
                "coarser cells."
            )
        period = self.run.gait.period
        allowed = min(allowed, MAX_STEP * period / self.water.cells)
        if self._linked:
            allowed = min(allowed, period / STEPS)
        max_steps = max(int(allowed / self.timestep), 1)
        if self._linked:
            max_steps = incommensurate_steps(max_steps, round(stepper.period / self.timestep))
        count = stepper.steps_until(end_time, max_steps, MAX_EVENED_STEPS)
        h, start, began = count * self.timestep, self.time, self._flow_state(stepper.coordinates)
        stepper.begin()
        newton = self._newton()
        foreseen = self._momentum_defect
        base_force, base_acceleration = self._force, self._push
        end, push, extra_force = self._solve_motion(
            count,
            base_force + _lessened(self._residual_impulse, foreseen) / h,
            base_acceleration,
            base_acceleration,
            newton,
        )
        applied_force = base_force - self._added_mass @ (push - base_acceleration) + extra_force
        if not np.isfinite(end.rate).all():
            raise Diverged(
                f"at t = {self.time:.4g} s the physics of robot {self.run.robot.name!r} no longer has finite numbers "
                f"under the water's force; take a shorter timestep than {self.timestep:.3g} s, or more cells.",
                time=start,
            )
        posture = self._flow_state(end)
        self.path.go(start, began, start + h, posture)
        sim.advance(h)
        self._flow_posture = posture
        water_force = self._water_force(began, posture)
        self._max_force = max(self._max_force, self._size(water_force))
        residual = first_residual = self._size(water_force - applied_force) / max(self._max_force, 1e-300)
        stretch, correction_count, mass = stepper.account(), 0, stepper.mass()
        residual_impulse = _lessened(h * (water_force - applied_force), stretch.momentum_defect - foreseen)
        while (
            correction_count < self.water.corrections
            and max(residual, self._adrift(residual_impulse)) > self.water.tolerance
        ):
            foreseen = stretch.momentum_defect
            base_force, base_acceleration = water_force, push
            likely = push + np.linalg.solve(mass + self._added_mass, water_force - applied_force)
            end, push, extra_force = self._solve_motion(
                count, base_force + _lessened(self._residual_impulse, foreseen) / h, base_acceleration, likely, newton
            )
            applied_force = base_force - self._added_mass @ (push - base_acceleration) + extra_force
            corrected_posture = self._flow_state(end)
            twist_change = self.chain.twists(
                posture.position, corrected_posture.rate - posture.rate, self._origin, self._axes
            )
            posture = corrected_posture
            self.path.go(start, began, start + h, posture)
            sim.accelerate({name: twist_change})
            water_force = self._water_force(began, posture)
            newton += np.linalg.solve(
                mass + self._implicit_added_mass, self._learn(push - base_acceleration, base_force - water_force)
            )
            residual, correction_count = self._size(water_force - applied_force) / self._max_force, correction_count + 1
            stretch = stepper.account()
            residual_impulse = _lessened(h * (water_force - applied_force), stretch.momentum_defect - foreseen)
        self._effort += stretch.effort
        self._note(
            stretch,
            water_force,
            self._fluctuation_work(stretch, push, h),
            posture,
            (first_residual, residual),
            correction_count,
        )
        self._greatest_momentum = max(self._greatest_momentum, float(np.linalg.norm(stretch.momentum)))
        self._force, self._push, self._residual_impulse, self._momentum_defect = (
            water_force,
            push,
            residual_impulse,
            stretch.momentum_defect,
        )
        self._watch(residual)
        self._renew(anew=correction_count > 0 and residual > self.water.tolerance)

    def _fluctuation_work(self, stretch: StepInterval, push: np.ndarray, h: float) -> float:
        """Return the work of the water in a step beyond the work of its mean force [J].

        The part of the force that depends on accelerations changes within a step, because the servos get new commands.
        """
        mean = 0.5 * h * (self.stepper.initial_coordinates.rate + self.stepper.coordinates.rate)
        return float((self._implicit_added_mass @ push) @ (stretch.displacement - mean))

    def _note(
        self, stretch: StepInterval, water_force: np.ndarray, fluctuation_work: float, posture: ChainState,
        residual: tuple[float, float], correction_count: int,
    ) -> None:  # fmt: skip
        """Append a finished step to the series: its end, force and loads of the water, residuals, work and energy."""
        series = self.series
        loads = self.sim.last_loads(self.run.robot.name)
        h = self.time - (series.time[-1] if series.time else 0.0)
        power = self._times * float(loads.total.power - loads.total.force @ self._drift())
        series.time.append(self.time)
        series.force.append(water_force)
        series.links.append(self._times * self.chain.link_loads(posture.position, loads, self._origin))
        series.residual.append(residual)
        series.corrections.append(correction_count)
        series.work.append(
            (
                stretch.servo_work,
                stretch.passive_work,
                float(water_force @ stretch.displacement) + fluctuation_work,
                -power * h,
            )
        )
        series.energy.append(stretch.energy)

    def _drift(self) -> np.ndarray:
        return np.asarray(self.sim.drift)

    def _watch(self, residual: float) -> None:
        """Refuse a robot that left the plane or a step that does not converge; warn of joints at their stops."""
        name, bend = self.stepper.off_plane
        if abs(bend) > OFF_PLANE:
            raise InvalidDesign(
                f"at t = {self.time:.4g} s joint {name} is bent by {bend:.3g} rad out of the plane that the flow takes "
                f"the body to stay in, more than {OFF_PLANE:g} rad; take a gait that stays in it, "
                'water=Space(linked=True), or water="sections".'
            )
        for joint, angle in self.stepper.stopped_joints.items():
            if joint not in self._warned_joints:
                self._warned_joints.add(joint)
                warnings.warn(
                    f"at t = {self.time:.4g} s joint {joint} of robot {self.run.robot.name!r} is driven to the end of "
                    f"its range, {angle:.3g} rad: from then on its stop bears what servo, spring and water do not; a "
                    "stiffer spring or a slower gait keeps it free.", Doubtful, stacklevel=3,
                )  # fmt: skip
        self._strikes = self._strikes + 1 if residual > MAX_RESIDUAL or not np.isfinite(residual) else 0
        if self._strikes >= MAX_UNCONVERGED_STEPS or not np.isfinite(residual):
            raise Diverged(
                f"at t = {self.time:.4g} s robot and flow do not converge: a force of {residual:.3g} times the "
                f"greatest so far is left over after {self.water.corrections} corrections; allow more corrections "
                f"(now {self.water.corrections}), or take more cells.", time=self.time,
            )  # fmt: skip

    def go(
        self,
        end_time: float,
        *,
        progress: Progress | None = None,
        watch: Callable[["Swim"], None] | None = None,
        checkpoint: str | Path | None = None,
        checkpoint_every: float = 15.0,
    ) -> None:
        """Simulate until a time, a whole number of control periods [s].

        A run that is killed and goes on from its checkpoint gives the same bytes. A second call for a later time does
        not: before each end the last steps are evened out, so that none is very short.

        Args:
            end_time: time to reach [s].
            progress: told the share that is done; None shows a progress bar.
            watch: called after every step; what it keeps belongs into ``samples``.
            checkpoint: file in which robot, flow and samples are kept; if it exists, the swim goes on from there.
            checkpoint_every: wall-clock seconds between two savings [s].

        Raises:
            Diverged: whatever ends a ``step``, with the record so far.
            UnreadableFile: the checkpoint is broken or belongs to another run.
            Unwritable: the checkpoint cannot be written.
        """
        checkpoint = None if checkpoint is None else Path(checkpoint)
        if checkpoint is not None and checkpoint.exists():
            store.load(self, checkpoint)
        saver = store.Saver(checkpoint, checkpoint_every)
        cells = prod(self.sim.setup.grid.cells)
        with Bar(self.time, end_time, cells, show=progress is None) as bar:
            while self.time < end_time - 0.5 * self.timestep:
                try:
                    self.step(end_time)
                except (Diverged, InvalidDesign, NotConverged, OutsideLimits) as error:
                    last_time = self.series.time[-1] if self.series.time else 0.0
                    self.stepper.end(last_time, str(error))
                    raise Diverged(str(error), time=last_time, record=self.record()) from error
                if watch is not None:
                    watch(self)
                saver.save(self)
                bar.move(self.time)
                if progress is not None:
                    progress("swimming", self.time / end_time)
        saver.save(self, is_forced=True)
        self.stepper.finish()

    # --- stopped and gone on -----------------------------------------------------------------------------------

    @property
    def setup(self) -> object:
        """Setup of the run; a state can be resumed in any swim with an equal setup."""
        return self.run, self.timestep, self.ticks, self.water

    def state(self) -> store.State:
        """Return all variables of flow and robot that change between two steps."""
        current_posture = self.path.posture_at(self.time)
        postures = {
            f"{label}.{name}": getattr(posture, field)
            for label, posture in (("posture", current_posture), ("placed", self._flow_posture))
            for name, field in _POSTURE_FIELDS.items()
        }
        parts = {
            "flow": self.sim.state(), "robot": self.stepper.state(), "series": self.series.state(),
            "samples": self.samples.state(),
        }  # fmt: skip
        attributes = {name: getattr(self, attribute) for name, attribute in _CHANGING.items()}
        return {
            **postures, **{f"own.{name}": np.array(value) for name, value in attributes.items() if value is not None},
            **{
                f"{component}.{name}": value
                for component, component_state in parts.items()
                for name, value in component_state.items()
            },
        }  # fmt: skip

    def resume(self, state: store.State) -> None:
        """Continue from the state of a swim of the same run; this swim must not have started."""

        def component_state(name: str) -> store.State:
            start = f"{name}."
            return {key.removeprefix(start): value for key, value in state.items() if key.startswith(start)}

        self.stepper.resume(component_state("robot"))
        self._flow_posture, posture = (
            ChainState(**{_POSTURE_FIELDS[key]: values for key, values in component_state(name).items()})
            for name in ("placed", "posture")
        )
        self.path.go(self.time, self._flow_posture, self.time, self._flow_posture)
        self.sim.resume(component_state("flow"))
        self.path.go(self.time, posture, self.time, posture)
        self.sim.clear_shape_cache()
        for name, value in component_state("own").items():
            setattr(self, _CHANGING[name], value if value.ndim else value.item())
        self.series, self.samples = (
            Series.from_state(component_state("series")),
            Samples.from_state(component_state("samples")),
        )

    # --- what is kept ------------------------------------------------------------------------------------------

    def record(self) -> xr.Dataset:
        """Return the record so far, with the variables of ``record.WATER`` and ``record.COUPLED``; NaN after it."""
        return coupling_record(self.run, self.chain, self.series, self.stepper.record(), self._start_added)


def _earlier_position(state: CoordinateState, span: float) -> np.ndarray:
    """Return the position of the robot a short time before a state, at its rates.

    Args:
        state: state in space with a quaternion; see ``CoordinateState``.
        span: time [s].
    """
    position, rate = state.position, state.rate
    if position.size == rate.size:
        return position - span * rate
    turned = rotation.multiply(position[3:7], rotation.from_vector(-span * rate[3:6]))
    return np.concatenate([position[:3] - span * rate[:3], turned, position[7:] - span * rate[6:]])


def _lessened(impulse: np.ndarray, momentum: np.ndarray) -> np.ndarray:
    """Return an impulse in the coordinates minus a momentum of the whole robot."""
    return np.concatenate([impulse[: momentum.size] - momentum, impulse[momentum.size :]])
