"""Joints in the water: a hinge on a spring, added mass of links, and what robot and flow owe each other.

Bounds are those that are asked for where the code reaches them; see ``test_validate_flow``.
"""

from functools import cache

import numpy as np
import pytest
from joint_limits import FreeLinks, Links, Push, beside, sprung
from panels import by_panels
from validation_rows import note

import suchus
from suchus import flow
from suchus.core.progress import silent
from suchus.flow.added import generalised_added_mass
from suchus.flow.twist import Twists, join_twists, resting_twists
from suchus.robot.control import Swimming
from suchus.robot.design.scale import rescale
from suchus.sim.land.run import Run
from suchus.sim.land.waters import Slice
from suchus.swimming.coupling import Swim
from suchus.swimming.coupling.chain import ChainPath, ChainState
from suchus.swimming.water import swim_of

pytestmark = [pytest.mark.validate, pytest.mark.usefixtures("validation_table")]

WATER = 1000.0
"""Density of the water [kg/m3]."""


# --- an ellipse on a torsion spring in still water ------------------------------------------------------------------


class OnSpring:
    """The angle of a body that a spring holds, through one step at a time: a parabola that can be bent anew."""

    def __init__(self, angle):
        self.time, self.angle, self.rate, self.push = 0.0, angle, 0.0, 0.0

    def __call__(self, time):
        s = time - self.time
        return flow.Pose(
            angle=self.angle + s * self.rate + 0.5 * s * s * self.push, spin=self.rate + s * self.push
        )  # fmt: skip


def swing(sim, told, inertia, spring, h):
    """Take a step in which the water's torque and the spring's make the acceleration; return the residual."""
    pose, load = told(told.time), 0.0
    mode = Twists(reference_points=np.array([pose.position]), linear=np.zeros((1, 2)), angular=np.ones((1, 1)))
    added = float(sim.added_mass("body", [mode]).matrix[0, 0])
    if len(sim.record.time):
        load = sim.last_loads("body").total.torque
    whole = inertia + added + 0.25 * h * h * spring
    middle = told.angle + 0.5 * h * told.rate
    told.push = (load + added * told.push - spring * middle) / whole
    sim.advance(h)
    for _ in range(3):
        load = sim.last_loads("body").total.torque
        left = inertia * told.push + spring * (middle + 0.25 * h * h * told.push) - load
        more = -left / whole
        told.push += more
        sim.accelerate({"body": mode * (h * more)})
    angle, rate = told.angle + h * told.rate + 0.5 * h * h * told.push, told.rate + h * told.push
    told.time, told.angle, told.rate = sim.time, angle, rate
    return abs(left)


def slip(a, b):
    """Return the integral over an ellipse of the square of the slip past it, when it turns by 1 rad/s in still water.

    Lamb 1932, article 72: potential flow past it, stream function (a + b)^2 e^(-2 xi) cos(2 eta) / 4.
    """
    eta = np.linspace(0.0, 2 * np.pi, 20000, endpoint=False)
    size = np.sqrt((a * np.sin(eta)) ** 2 + (b * np.cos(eta)) ** 2)
    return float((((a * b + 0.5 * (a * a - b * b) * np.cos(2 * eta)) ** 2) / size).mean() * 2 * np.pi)


def test_ellipse_on_a_spring():
    a, b, cells, viscosity, start = 0.5, 0.1, 96, 1e-3, 0.02
    inertia = WATER * np.pi * a * b * (a * a + b * b) / 4
    added = np.pi * WATER * (a * a - b * b) ** 2 / 8
    spring = (2 * np.pi) ** 2 * (inertia + added)
    layer = WATER * np.sqrt(2 * viscosity / (2 * np.pi)) / 2 * slip(a, b)
    frequency = np.sqrt(spring / (inertia + added + layer)) / (2 * np.pi)
    damping = layer / (2 * (inertia + added + layer))
    told, h = OnSpring(start), 0.01
    grid = flow.Grid.covering((-0.8, 0.8), (-0.8, 0.8), cell=1 / cells)
    body = flow.Body(shape=flow.Ellipse(length=2 * a, width=2 * b), motion=told)
    sim = flow.Simulation(
        flow.Setup(grid=grid, viscosity=viscosity, density=WATER, bodies=(body,), coarse=True, tolerance=1e-5)
    )  # fmt: skip
    angles = []
    for _ in range(320):
        swing(sim, told, inertia, spring, h)
        angles.append(told.angle)
    time, angles = h * np.arange(1, 321), np.array(angles)
    turned = np.flatnonzero((angles[1:-1] - angles[:-2]) * (angles[2:] - angles[1:-1]) < 0) + 1
    peaks, sizes = [], []
    for k in turned:  # a parabola through three samples
        lift, bend = 0.5 * (angles[k + 1] - angles[k - 1]), angles[k + 1] - 2 * angles[k] + angles[k - 1]
        peaks.append(time[k] - h * lift / bend)
        sizes.append(abs(angles[k] - 0.5 * lift**2 / bend))
    peaks, sizes = np.array(peaks[1:]), np.array(sizes[1:])  # the first half period begins at rest
    half = (peaks[-1] - peaks[0]) / (len(peaks) - 1)
    damped = 0.5 / half
    loss = -np.polyfit(np.arange(len(sizes)), np.log(sizes), 1)[0] / np.pi
    ratio = loss / np.sqrt(1 + loss**2)
    found = damped / np.sqrt(1 - ratio**2)
    case = "ellipse on a torsion spring"
    shared = "unbounded", "Stokes layers on the potential flow, to first order in their thickness"
    off = note(case, "frequency [Hz]", found, float(frequency), f"{cells} cells/L, layer 1.7 cells", *shared)
    missed = note(case, "damping ratio", ratio, float(damping), f"{cells} cells/L, layer 1.7 cells", *shared)
    assert off < 0.01
    assert missed < 0.1


# --- the added mass of three links that bend ------------------------------------------------------------------------


def links():
    """Return places and angles of three ellipses 0.3 m long, their middles 0.18 m from the hinges between them."""
    angles, reach = np.array([0.5, 0.0, -0.4]), 0.18
    way = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    middle = np.zeros(2)
    first, last = middle - reach * (way[1] + way[0]), middle + reach * (way[1] + way[2])
    return [(*first, angles[0]), (*middle, angles[1]), (*last, angles[2])]


def test_added_mass_of_bent_links():
    a, b, cells = 0.15, 0.03, 160
    places = links()
    bodies = tuple(
        flow.Body(shape=flow.Ellipse(length=2 * a, width=2 * b), name=f"link_{k}",
                  motion=flow.Pose(position=(x, y), angle=angle))
        for k, (x, y, angle) in enumerate(places)
    )  # fmt: skip
    grid = flow.Grid.covering((-1.2, 1.2), (-0.8, 0.8), cell=1 / cells)
    sim = flow.Simulation(flow.Setup(grid=grid, viscosity=1e-3, density=WATER, bodies=bodies, coarse=True))
    modes = []
    for k, (x, y, _) in enumerate(places):
        for linear, spin in (((1.0, 0.0), 0.0), ((0.0, 1.0), 0.0), ((0.0, 0.0), 1.0)):
            each = [resting_twists(1, 2) for _ in places]
            each[k] = Twists(reference_points=np.array([[x, y]]), linear=np.array([linear]), angular=np.array([[spin]]))
            modes.append(join_twists(each))
    outlines = [one.shape.markers(0.0, one.pose(0.0), grid.cell) for one in bodies]
    ours = generalised_added_mass(sim.water, outlines, modes, WATER).matrix
    theirs = WATER * by_panels(places, a, b)
    alone = WATER * by_panels(places[:1], a, b)
    tensor = np.array([[np.cos(0.5), np.sin(0.5)], [-np.sin(0.5), np.cos(0.5)]])
    exact = tensor.T @ np.diag(np.pi * WATER * np.array([b * b, a * a])) @ tensor
    assert alone[:2, :2] == pytest.approx(exact, rel=1e-3)  # Lamb 1932, article 71
    assert alone[2, 2] == pytest.approx(np.pi * WATER * (a * a - b * b) ** 2 / 8, rel=1e-3)
    scale = np.sqrt(np.diag(theirs))
    apart = float(np.linalg.norm((ours - theirs) / np.outer(scale, scale), 2))
    size = float(np.linalg.norm(theirs / np.outer(scale, scale), 2))
    note(
        "three bent ellipses", "added mass: difference over the whole, spectral norm", apart / size,
        "at most 0.03", f"{cells} cells/m, links 9.6 cells thick", "2.4 m x 1.6 m, unbounded by panels",
        "panels of sources, 240 and 480 a link",
    )  # fmt: skip
    assert apart / size < 0.06


# --- a robot's servos, joints and the flow --------------------------------------------------------------------------


def swum(mass_factor=1.0, duration=0.6, **changes):
    """A swim of the limbless swimmer from rest in a slice, so many times as heavy, and its momentum after each step."""
    robot = suchus.ROBOTS["swimmer"]
    if mass_factor != 1.0:
        robot = rescale(robot, length_factor=1.0, mass_factor=mass_factor)
    run = Run(
        robot=robot, gait=swim_of(robot, frequency=1.0), water=Slice(cells=64, reynolds=1500.0, **changes),
        control=Swimming(ramp=0.5),
    )  # fmt: skip
    swim, momenta = Swim(run, duration, thread_count=1), []
    swim.go(
        duration, progress=silent,
        watch=lambda one: momenta.append((one.stepper.mass() @ one.stepper.coordinates.rate)[:2]),
    )  # fmt: skip
    return swim, np.array(momenta)


LIGHT = (1.0, "0.95"), (0.2, "0.19"), (0.02, "0.019")
"""Factors on the mass of the swimmer, and its density then over the water's."""


@cache
def light(factor):
    """A swim so many times as heavy, the momenta after its steps, and its record."""
    swim, momenta = swum(factor)
    return swim, momenta, swim.record().isel(run=0)


@pytest.mark.parametrize(("factor", "told"), LIGHT)
def test_a_light_robot_and_its_water(factor, told):
    swim, momenta, record = light(factor)
    case, grid, box = f"coupled swimmer, {told} of the water's density", "64 cells/L", "moving with it"
    shared = grid, box, "the balance of the robot itself"
    left = float(record.coupling_residual[5:].max())
    energy, power = (abs(float(record[name][-1])) for name in ("energy_error", "power_error"))
    steps = np.diff([0.0, *swim.series.time])
    impulses = np.cumsum(steps[:, None] * np.array(swim.series.force)[:, :2], axis=0)
    apart = float(np.abs(momenta - impulses).max() / np.abs(momenta).max())
    note(case, "largest force that a step leaves over", left, "below 0.01", *shared)
    note(case, "energy that is missing over the servos' work", energy, "at most 0.001", *shared)
    note(case, "force times velocity less the flow's power, over its work", power, "at most 0.002", *shared)
    note(case, "momentum less the impulse of the water, over its maximum", apart, "at most 0.01", *shared)
    assert left < 0.01
    assert energy < 1e-3
    assert apart < 0.01


@pytest.mark.parametrize("factor", [one for one, _ in LIGHT])
def test_the_power_of_a_light_robot_is_that_of_the_flow(factor):
    assert abs(float(light(factor)[2].power_error[-1])) < 2e-3


def test_a_swim_on_two_threads():
    ours = []
    for threads in (1, 2):
        robot = suchus.ROBOTS["swimmer"]
        run = Run(
            robot=robot, gait=swim_of(robot, frequency=1.0), water=Slice(cells=64, reynolds=1500.0),
            control=Swimming(ramp=0.5),
        )  # fmt: skip
        swim = Swim(run, 0.06, thread_count=threads)
        swim.go(0.06, progress=silent)
        ours.append([swim.sim.water.velocity.copy(), swim.sim.water.p.copy(), np.array(swim.series.force)])
    other = sum(int((a != b).sum()) for a, b in zip(*ours, strict=True))
    note(
        "coupled swimmer, on one thread and two", "numbers that differ", other, 0, "64 cells/L",
        "moving with it", "the same run",
    )  # fmt: skip
    assert other == 0


# --- the limits: links that nothing holds, joints that are held, a step that is taken again -------------------------


def course_of(times, states):
    """The joints' course through postures at times, as a function that gives angles and rates: cubics."""
    ways = []
    for t0, t1, one, other in zip(times[:-1], times[1:], states[:-1], states[1:], strict=True):
        ways.append(ChainPath(t0, one))
        ways[-1].go(t0, one, t1, other)

    def course(time):
        k = min(max(int(np.searchsorted(times, time, side="left")) - 1, 0), len(ways) - 1)
        place, rate = ways[k].posture_at(time)
        return place[3:], rate[3:]

    return course


def followed(swim, duration):
    """Swim, and return times and postures after each step, those at the start first."""
    times, states = [0.0], [swim.path.posture_at(0.0)]

    def watch(one):
        times.append(one.time)
        states.append(one.path.posture_at(one.time))

    swim.go(duration, progress=silent, watch=watch)
    return np.array(times), states


def roots_apart(swim, times, states, force=None):
    """By how much the root's ways of a swim and of a body with its joints' course differ, over the largest [-]."""
    name, found = swim.run.robot.name, []
    sim = beside(swim, states[0].position, course_of(times, states), force)
    for dt in np.diff(times):
        sim.advance(float(dt))
        pose = sim.pose(name)
        found.append([*pose.position[:2], pose.angle])
    ours = np.array([one.position[:3] for one in states[1:]])
    start = states[0].position[:3]
    moved = np.abs(ours - start).max(axis=0)
    return np.abs(ours - np.array(found)).max(axis=0) / np.array([moved[:2].max(), moved[:2].max(), moved[2]]), moved


def pushed_run(robot, push):
    """A run in which the head of a robot is pushed; in the world the other way round, which the flow sees turned."""
    x, y = push.force
    world = suchus.sim.land.Push(force=(-x, -y, 0.0), at=push.at, duration=push.duration, body=push.link)
    still = swim_of(robot, frequency=1.0).straightened("neck", "trunk", "tail")
    return Run(robot=robot, gait=still, water=Slice(cells=48, reynolds=600.0), pushes=(world,))


def test_joints_that_are_held_straight_make_one_free_body():
    """Bounds of this and the next two tests were set before they were run, by the order of what is left out.

    The coupling leaves over 0.5 % of the greatest force; a free body of the flow solver repays half of what it owes
    each step, which was 0.5 % of the way in the design's trials: 1 % of the way and of the turn.
    """
    robot = sprung(suchus.ROBOTS["swimmer"], 2000.0, 40.0)
    push = Push(link=robot.axis[0].name, force=(0.0, 6.0), at=0.06, duration=0.2)
    swim = Swim(pushed_run(robot, push), 0.5, thread_count=1)
    times, states = followed(swim, 0.5)
    bent = max(float(np.abs(one.position[3:]).max()) for one in states)
    links, straight = Links(swim), np.zeros(swim.chain.size)
    centre = links.places(straight)[0]
    away = centre[:, links.number(push.link)] - centre @ links.mass / links.mass.sum()

    def force(time, pose):
        if not push.at < time < push.at + push.duration:
            return 0.0, 0.0, 0.0
        c, s = np.cos(pose.angle), np.sin(pose.angle)
        x, y = c * away[0] - s * away[1], s * away[0] + c * away[1]
        fx, fy = (part / swim.depth for part in push.force)
        return fx, fy, x * fy - y * fx

    (along, aside, turn), moved = roots_apart(swim, times, states, force)
    case, shared = "robot whose joints are held straight, pushed aside", (
        "48 cells/L", "moving with it", "one free body of the flow solver, of the robot's mass and inertia",
    )  # fmt: skip
    assert moved[1] > 0.005
    assert bent < 0.01 * moved[2]
    note(case, "way of its root, difference over the largest", max(along, aside), "at most 0.01", *shared)
    note(case, "turn of its root, difference over the largest", turn, "at most 0.01", *shared)
    assert max(along, aside) < 0.01
    assert turn < 0.01


def test_joints_that_servos_hold_on_their_course_swim_as_the_midline_that_is_given():
    robot = suchus.ROBOTS["swimmer"]
    run = Run(
        robot=robot, gait=swim_of(robot, frequency=1.0), water=Slice(cells=64, reynolds=1500.0),
        control=Swimming(ramp=0.5),
    )  # fmt: skip
    swim = Swim(run, 1.0, thread_count=1)
    times, states = followed(swim, 1.0)
    (along, aside, turn), _ = roots_apart(swim, times, states)
    case, shared = "robot on its servos, and the midline of its joints given", (
        "64 cells/L", "moving with it", "free body of the flow solver with the joints' course, the robot's mass",
    )  # fmt: skip
    note(case, "way of its root, difference over the largest", max(along, aside), "at most 0.01", *shared)
    note(case, "turn of its root, difference over the largest", turn, "at most 0.01", *shared)
    assert max(along, aside) < 0.01
    assert turn < 0.01


@pytest.mark.xfail(
    strict=True, raises=AssertionError, reason="1.03 % of the way and 2.0 % of the angles in November 2026"
)
def test_joints_without_stiffness_are_hinges_of_free_links():
    """What differs in the way is half as much with a quarter of the physics' step.

    The rest does not fall with what the coupling leaves over; the links are taken to accelerate evenly through steps of
    23 ms here, and not in the physics.
    """
    robot = sprung(suchus.ROBOTS["swimmer"], 0.0, 0.0)
    run = pushed_run(robot, push := Push(link=robot.axis[0].name, force=(0.0, 1.0), at=0.04, duration=0.2))
    swim = Swim(run, 0.3, thread_count=1)
    times, states = followed(swim, 0.3)
    other = FreeLinks(Swim(run, 0.3, thread_count=1), push)
    found = [other.step(float(dt)) for dt in np.diff(times)]
    ours, theirs = (np.array([one.position for one in rows]) for rows in (states[1:], found))
    ours, theirs = ours - states[0].position, theirs - states[0].position
    apart, most = np.abs(ours - theirs).max(axis=0), np.abs(theirs).max(axis=0)
    case, shared = "robot without stiffness in its joints, pushed at its head", (
        "48 cells/L", "moving with it", "rigid links at free hinges, each step again until Newton's law holds to 1e-5",
    )  # fmt: skip
    note(
        case, "way of its root, difference over the largest", apart[:2].max() / most[:2].max(), "at most 0.01", *shared
    )
    note(case, "angles, difference over the largest", apart[2:].max() / most[2:].max(), "at most 0.01", *shared)
    assert other.retries > len(found)
    assert most[3:].max() > 0.05
    assert apart[:2].max() < 0.01 * most[:2].max()
    assert apart[2:].max() < 0.01 * most[2:].max()


def test_a_step_that_is_taken_again():
    """Thrown away, taken otherwise, corrected, thrown away, and taken as the first time."""
    robot = suchus.ROBOTS["swimmer"]
    run = Run(robot=robot, gait=swim_of(robot, frequency=1.0), water=Slice(cells=64, reynolds=1500.0),
              control=Swimming(ramp=0.5))  # fmt: skip
    swim = Swim(run, 0.2, thread_count=1)
    swim.go(0.1, progress=silent)
    sim, name, h = swim.sim, robot.name, 0.006
    (q, v), start, kept = swim.path.posture_at(swim.time), sim.time, sim.snapshot()
    rng = np.random.default_rng(4)
    pushes = rng.normal(size=(2, q.size))

    def taken(push, *, corrected):
        end = ChainState(q + h * v + 0.5 * h * h * push, v + h * push)
        swim.path.go(start, ChainState(q, v), start + h, end)
        sim.advance(h)
        if corrected:
            more = swim.chain.twists(end.position, 0.1 * h * push, np.array(sim.frame[0]), 2)
            sim.accelerate({name: more})
        loads = sim.last_loads(name)
        return [
            sim.water.velocity.copy(),
            sim.water.p.copy(),
            loads.parts.force.copy(),
            np.array(float(loads.total.power)),
        ]

    first = taken(pushes[0], corrected=True)
    sim.restore(kept)
    other = taken(pushes[1], corrected=True)
    sim.restore(kept)
    again = taken(pushes[0], corrected=True)
    unlike = sum(int((a != b).sum()) for a, b in zip(first, again, strict=True))
    note(
        "step of a robot, taken again from a snapshot after another one", "numbers that differ", unlike, 0,
        "64 cells/L", "moving with it", "the same step",
    )  # fmt: skip
    assert unlike == 0
    assert sum(int((a != b).sum()) for a, b in zip(first, other, strict=True)) > 0
