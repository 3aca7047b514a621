"""The robot's own body in the water of three dimensions: free, or kept from moving on."""

from dataclasses import dataclass, replace
from math import prod
from pathlib import Path

import numpy as np
import xarray as xr

from suchus import flow
from suchus.design import GRAVITY, Robot, cable_joints, layout
from suchus.design.checks import Checks
from suchus.design.profile import stations
from suchus.design.water import Water
from suchus.errors import InvalidDesign
from suchus.motion.swim import trunk_yaws
from suchus.water.diary import Diary, Progress, run_on
from suchus.water.immersed import immersed
from suchus.water.outline import Outline
from suchus.water.pool import SLACK, cycle_means, motion_key
from suchus.water.slender import cycle, recoil
from suchus.water.swimming import wave_speed
from suchus.water.tank import DENSITY, GROWS, Tether, check_motion
from suchus.water.undulation import Motion
from suchus.water.view import midline
from suchus.water.wake import Filmed, wake

AHEAD, BEHIND, BESIDE, ABOVE = 0.15, 0.35, 0.2, 0.15
"""Water ahead of the snout, behind the tail, beside the widest swing and above the back [body length]."""
FINEST = 1024
"""Most cells per body length [-]."""
STEPS, SECONDS = 1.1, 1.2e-7
"""Steps in a cycle over the cells per body length [-], and processor time of a step over the cells [s]: what they were
at 96 to 192 cells a length."""
_MARGIN = 8.0
"""Cells between the body's widest reach and the sides that the solver needs, its half-width included [-]."""
FIN_STARTS, FIN_RISES = 2 / 3, 0.05
"""Where a raised tail begins, from the snout, and over which length it rises [body length]."""
_DRAWN = 0.05
"""Swing to a side that the box leaves to a body that draws to the side and turns, beside its own [body length]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Basin:
    """How finely and how long a swim in three dimensions is resolved."""

    cells: int
    """Cells per body length [-]."""
    viscosity: float
    """Kinematic viscosity of the water [m2/s]."""
    cycles: int
    """Number of cycles that are simulated; the last is measured [-]."""
    tail_height: float = 0.0
    """Height of the last third of the body, as a fin as thick as the tail is; 0 leaves the tail as it is [m]."""
    limbs: bool = False
    """Whether the limbs are in the water, folded straight back along the body."""
    beside: float = BESIDE
    """Water beside the widest swing, to each side [body length]."""
    moves_on: bool = True
    """Whether the body may move along its course; it always sways and turns freely."""
    frames: int = 0
    """Instants of the last cycle at which the vortices are kept, for films [-]."""
    tolerance: float = 1e-4
    """Mean divergence left over, in fastest speed per cell [-]."""

    def __post_init__(self) -> None:
        with Checks("basin", self) as check:
            check.whole("cells", 32, FINEST)
            check.whole("cycles", 1, 1000)
            check.whole("frames", 0, 200)
            check.number("viscosity", 1e-7, 10.0, "m2/s")
            check.number("beside", 0.0, 3.0, "body lengths")
            check.number("tail_height", 0.0, 1.0, "m")
            check.number("tolerance", 5e-7, 1e-2, "")


def half_heights(outline: Outline, tail_height: float = 0.0) -> np.ndarray:
    """Return half of the body's height at the stations, limbs left out, with a raised tail if it is asked for [m].

    Args:
        outline: of the robot.
        tail_height: height that the last third is raised to, where it is not as high [m].
    """
    share = outline.s / outline.robot.length
    rise = np.clip((share - FIN_STARTS) / FIN_RISES, 0.0, 1.0)
    fall = np.clip((1.0 - share) / FIN_RISES, 0.0, 1.0)
    fin = 0.5 * tail_height * np.sqrt(rise * (2.0 - rise) * fall * (2.0 - fall))
    return np.maximum(outline.silhouette.half_height, fin)


def folded(robot: Robot) -> tuple[flow.Capsule, ...]:
    """Return the limbs of a robot, stretched and turned straight back from the hips, which lie in the body's plane.

    Each link is a capsule and each foot a ball, rigid with the body at the hip.
    """
    place, found = layout(robot), []
    names = [segment.name for segment in place.robot.axis]
    for limb in place.limbs:
        girdle = limb.girdle
        at = stations(place.robot)[names.index(girdle.segment)][0]
        at += place.robot.axis[names.index(girdle.segment)].front - girdle.at
        aside, behind = -limb.side * girdle.aside, 0.0  # the body's y points to the robot's right
        for link in girdle.limb.links:
            ends = (behind, aside), (behind + link.length, aside)
            found.append(flow.Capsule(at=at, start=ends[0], end=ends[1], radius=link.radius))
            behind += link.length
        found.append(flow.Capsule(at=at, start=(behind, aside), end=(behind, aside), radius=girdle.limb.foot.radius))
    return tuple(found)


def trunk(
    outline: Outline,
    motion: Motion,
    *,
    grow: float = 0.0,
    tail_height: float = 0.0,
    limbs: bool = False,
    sway: complex = 0j,
    turn: complex = 0j,
) -> flow.Trunk:
    """Return the robot as a bending body in space, its sections ellipses, divided at its joints.

    Args:
        outline: of the robot; stations about one cell apart serve well.
        motion: how it swims.
        grow: time over which the motion grows from nothing [s].
        tail_height: see ``half_heights`` [m].
        limbs: whether it has its limbs, see ``folded``; without them otherwise.
        sway: harmonic of the snout's displacement to the right [m]; zero for a free body, which finds it by itself.
        turn: harmonic of the head's direction [rad].
    """
    spine = immersed(outline, motion, sway=sway, turn=turn, grow=grow).spine
    cuts, high = tuple(sorted(outline.places.tolist())), half_heights(outline, tail_height)
    if limbs:
        return flow.Limbed(spine=spine, half_height=high, cuts=cuts, limbs=folded(outline.robot))
    return flow.Trunk(spine=spine, half_height=high, cuts=cuts)


def check_swim_in_space(robot: Robot, motion: Motion, basin: Basin) -> None:
    """Refuse what joints, servos, grid, box or machine cannot follow, before anything runs.

    Raises:
        OutsideLimits: the joints or servos cannot follow the motion.
        InvalidDesign: the boundary layer is too thin for the grid, with the cells that would do and the hours that they
            take; the body would reach out of the box, or is too thin for the grid; the machine has not the memory.
    """
    outline = Outline(robot, basin.cells + 1)
    sway, turn = recoil(outline, motion, 0.0, Water(viscosity=basin.viscosity))
    resolved = Tether(cells=basin.cells, viscosity=basin.viscosity, cycles=basin.cycles)

    def cost(cells: int) -> str:
        finer = replace(basin, cells=cells) if cells <= FINEST else None
        if finer is None:
            return f", more than the {FINEST} that are allowed"
        count = prod(basin_grid(robot.length, outline, motion, finer, sway, turn).cells)
        hours = count * STEPS * cells * basin.cycles * SECONDS / 3600.0
        return f", {count / 1e6:.3g} million cells that take some {hours:.2g} hours for {basin.cycles} cycles"

    check_motion(outline, motion, resolved, sway, turn, cost)
    least, beside = _MARGIN / basin.cells, basin.beside
    if beside + _DRAWN < least:
        raise InvalidDesign(
            f"the box leaves {beside:.3g} body lengths of water beside the widest swing, and the body would leave it: "
            f"give at least {least - _DRAWN:.2g}, better {BESIDE}."
        )
    setup_of(robot, motion, basin).check()


def setup_of(robot: Robot, motion: Motion, basin: Basin) -> flow.Setup:
    """Return what is simulated when a robot swims in a basin: the half above its plane of symmetry."""
    outline = Outline(robot, basin.cells + 1)
    sway, turn = recoil(outline, motion, 0.0, Water(viscosity=basin.viscosity))
    grow = GROWS / motion.frequency
    body = flow.FreeBody(
        shape=trunk(outline, motion, grow=grow, tail_height=basin.tail_height, limbs=basin.limbs),
        start=(0.5 * robot.length, 0.0, 0.0), free=(basin.moves_on, True, True),
    )  # fmt: skip
    return flow.Setup(
        grid=basin_grid(robot.length, outline, motion, basin, sway, turn), viscosity=basin.viscosity, density=DENSITY,
        bodies=(body,), follow="body", sides=flow.Sides(low=flow.Mirror()), tolerance=basin.tolerance,
    )  # fmt: skip


def swim_in_space(
    robot: Robot,
    motion: Motion,
    basin: Basin,
    *,
    checkpoint: Path | str | None = None,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Return a swim from rest in the plane of symmetry, the body as heavy as the water it displaces.

    The upper half is computed: beyond the plane lies its image. The grid travels with the body's centre.

    Args:
        robot: who swims.
        motion: how: with its joints, or as a wave that its midline follows exactly.
        basin: grid, water and time.
        checkpoint: file from which a run that was stopped goes on; None keeps nothing.
        progress: called with the share that is done; None shows a progress bar.

    Returns:
        Per cycle ``speed`` forward and ``thrust`` of the water forward, ``power`` on it; ``joint_torque`` over the last
        cycle, that of the water on what lies behind each place of ``Outline.places``; fields at the end.

    Raises:
        OutsideLimits: the joints or servos cannot follow the motion.
        InvalidDesign: the boundary layer is too thin for the grid.
        Diverged: the flow diverged.
    """
    check_swim_in_space(robot, motion, basin)
    period, sim = 1.0 / motion.frequency, flow.Simulation(setup_of(robot, motion, basin))
    end, about = basin.cycles * period, repr((robot, motion_key(motion), basin))
    filmed = Filmed(motion.frequency, end, basin.frames)

    def look(sim: flow.Simulation, diary: Diary) -> None:
        filmed.look(sim, diary)
        if end - sim.time > period * (1.0 + SLACK):
            return
        spine, (position, _) = midline(sim), sim.frame
        diary.note("track", sim.time, heading=spine.heading[0], tail=spine.y[-1] + position[1])

    diary = run_on(sim, end, period / 4, look, about=about, checkpoint=checkpoint, progress=progress)
    return _record(sim, diary, Outline(robot, basin.cells + 1), motion, basin).merge(filmed.record(diary))


def basin_grid(
    length: float, outline: Outline, motion: Motion, basin: Basin, sway: complex, turn: complex
) -> flow.Grid:  # fmt: skip
    """Return the cells around the upper half of a body whose snout is near the origin."""
    swing = float(np.abs(cycle(outline, motion, sway, turn).y).max()) / length + _DRAWN
    high = max(outline.silhouette.half_height.max(), 0.5 * basin.tail_height) / length + ABOVE
    grid = flow.Grid.covering(
        (-AHEAD * length, (1.0 + BEHIND) * length),
        (-(swing + basin.beside) * length, (swing + basin.beside) * length),
        (0.0, high * length),
        cell=length / basin.cells,
    )
    return replace(grid, origin=(*grid.origin[:2], 0.0))  # what it grew above and below lies above


_PER_CYCLE = {"velocity_x": ("speed", "m/s"), "force_x": ("thrust", "N"), "power": ("power", "W")}


def _record(sim: flow.Simulation, diary: Diary, outline: Outline, motion: Motion, basin: Basin) -> xr.Dataset:
    period, series, robot = 1.0 / motion.frequency, sim.record, outline.robot
    means = dict(zip(_PER_CYCLE, cycle_means(series, period, basin.cycles, tuple(_PER_CYCLE)), strict=True))
    track, last = diary.page("track"), series.after((basin.cycles - 1) * period * (1.0 + SLACK))
    torques = last.along("torque_behind")[:, 1 + np.argsort(np.argsort(outline.places))]
    sign = {"velocity_x": -1.0, "force_x": -1.0, "power": 1.0}  # the body swims towards -x
    data = xr.Dataset(
        {name: ("cycle", sign[column] * means[column], {"units": unit}) for column, (name, unit) in _PER_CYCLE.items()}
    )
    data = data.assign(
        moment=("moment", last.time, {"units": "s"}),
        joint_torque=(("moment", "joint"), torques, {"units": "N m"}),
        servo_torque=(("moment", "servo"), _at_servos(outline, torques), {"units": "N m"}),
        servo_limit=("servo", [robot.servo(name).torque for name in _servos(robot)], {"units": "N m"}),
        swing=((), float(np.ptp(track["tail"])), {"units": "m", "long_name": "of the tail's tip, peak to peak"}),
        head_yaw=((), 0.5 * float(np.ptp(track["heading"])), {"units": "rad"}),
        weight=((), DENSITY * GRAVITY * sim.setup.bodies[0].shape.mass(sim.time).size, {"units": "N"}),
        wave_speed=((), wave_speed(outline, motion, cycle(outline, motion)), {"units": "m/s"}),
        thin=((), sim.thin["body"], {"units": "1"}),
        steps=((), float(len(last.time)), {"units": "1", "long_name": "in the last cycle"}),
        million_cells=((), float(np.prod(sim.setup.grid.cells)) / 1e6, {"units": "1"}),
        joint_place=("joint", outline.places, {"units": "m"}),
    )
    return data.assign_coords(servo=list(_servos(robot)), cycle=np.arange(1, basin.cycles + 1)).merge(wake(sim))


def _servos(robot: Robot) -> tuple[str, ...]:
    place = layout(robot)
    return (*trunk_yaws(robot), *(place.servos[i] for i in place.cables))


def _at_servos(outline: Outline, torques: np.ndarray) -> np.ndarray:
    """Return what the water asks of the yaw servos and of the cable's servo, shape (moment, servo) [N m].

    The cable bends its joints alike, so that its servo takes the mean of their moments, over the ratio of half the
    cords' distance to the pulley.
    """
    robot, yaws = outline.robot, len(trunk_yaws(outline.robot))
    behind = torques[:, yaws : yaws + len(cable_joints(robot))].mean(axis=1)
    cable = behind * robot.tail.pulley / (0.5 * robot.tail.cord_spacing)
    return np.column_stack([torques[:, :yaws], cable])
