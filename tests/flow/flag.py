"""A flag behind a cylinder, as a chain of rigid links joined by torsion springs: the cases of Turek and Hron.

Turek and Hron 2006 (Lect. Notes Comput. Sci. Eng. 53, 371-385): a cylinder and a beam behind it in a channel. The chain
has the beam's bending stiffness in plane strain, at joints in the middles of equal lengths, and its mass; it cannot be
stretched or sheared, as their St. Venant-Kirchhoff beam can, though hardly is.

As a script it runs one case and keeps its series: ``python tests/flow/flag.py FSI3 28 128 out/flag 6.0``, and with
``inf 2`` behind these only cells around cylinder and beam are so fine, and half as fine the channel's.
"""

import json
import sys
import time as clock
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import mujoco
import numpy as np

from suchus import flow
from suchus.core.writing import keep
from suchus.flow import checkpoint as store
from suchus.swimming.coupling.chain import ChainPath, ChainState, MidlineChain
from suchus.swimming.water.outline import BodySilhouette

WATER = 1000.0
"""Density of the water [kg/m3]."""
VISCOSITY = 1e-3
"""Kinematic viscosity of the water [m2/s]."""
CHANNEL = 2.5, 0.41
"""Length and width of the channel [m]."""
CENTRE = 0.2, 0.2
"""Middle of the cylinder [m]."""
RADIUS, BEAM, THICKNESS = 0.05, 0.35, 0.02
"""Radius of the cylinder, length of the beam behind it, and how thick that is [m]."""
POISSON = 0.4
"""Poisson's ratio of the beam [-]."""
RAMP = 0.4
"""Time in which the water comes up to its speed [s]; theirs is 2 s. What it goes over to does not depend on it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FlagCase:
    """One of the cases, and what is published of it as middle and half of the range over a period."""

    speed: float
    """Mean speed of the water that enters [m/s]."""
    density: float
    """Of the beam [kg/m3]."""
    modulus: float
    """Young's modulus of the beam [Pa]."""
    shaken: float
    """Turn of the tip, each joint bent alike, up to which the angles at which the springs rest swing at first [rad]."""
    tip_x: tuple[float, float]
    """Way of the tip along the channel [m]."""
    tip_y: tuple[float, float]
    """Way of the tip across it [m]."""
    frequency: float
    """Of the way across [Hz]."""
    drag: tuple[float, float]
    """Force on cylinder and beam along the channel [N/m]."""
    lift: tuple[float, float]
    """Force across it [N/m]."""


CASES = {
    "FSI2": FlagCase(
        speed=1.0, density=10000.0, modulus=1.4e6, shaken=0.4, tip_x=(-14.85e-3, 12.70e-3),
        tip_y=(1.30e-3, 81.6e-3), frequency=1.93, drag=(215.06, 77.65), lift=(0.61, 237.8),
    ),
    "FSI3": FlagCase(
        speed=2.0, density=1000.0, modulus=5.6e6, shaken=0.8, tip_x=(-2.88e-3, 2.72e-3),
        tip_y=(1.47e-3, 34.99e-3), frequency=5.46, drag=(460.5, 27.74), lift=(2.50, 153.91),
    ),
}  # fmt: skip
"""The authors' page of 2008 and later, level 4 with their shortest step, which took the place of the tables of 2006:
wwwold.mathematik.tu-dortmund.de/~featflow/en/benchmarks/cfdbenchmarking/fsi_benchmark.html."""


class ParabolicInflow(flow.Inflow):
    """Water that enters as it flows in a channel and comes up to its speed little by little."""

    def inflow_velocity(self, time, *places):
        share = 0.5 * (1 - np.cos(np.pi * min(time / RAMP, 1.0)))
        return share * super().inflow_velocity(time, *places)


@dataclass(frozen=True)
class FlagOutline:
    """What ``MidlineChain`` asks of a robot's outline: a cylinder, and the beam that the joints bend behind it."""

    count: int
    stations: int

    class robot:  # noqa: N801 (stands for one)
        """The body whose outline it is."""

        length = 2 * RADIUS + BEAM

    @property
    def spacing(self):
        """Length of the beam that a joint bends [m]."""
        return BEAM / self.count

    @property
    def joints(self):
        return tuple(f"joint_{k}" for k in range(self.count))

    @cached_property
    def joint_positions(self):
        return 2 * RADIUS + (np.arange(self.count) + 0.5) * self.spacing

    @cached_property
    def s(self):
        return np.linspace(0.0, self.robot.length, self.stations)

    @cached_property
    def silhouette(self):
        cylinder = np.sqrt(np.maximum(self.s * (2 * RADIUS - self.s), 0.0))
        half = np.maximum(cylinder, np.where(self.s > RADIUS, 0.5 * THICKNESS, 0.0))
        return BodySilhouette(half, np.ones(self.stations))

    def joints_at(self, s):
        """The share of each joint's bend that lies ahead of points; it takes two stations' way, links are rigid."""
        return 0.5 + 0.5 * np.clip((s[:, None] - self.joint_positions) / self.s[1], -1.0, 1.0)


class FlagChain(MidlineChain):
    """The midline of cylinder and beam; its root is the cylinder's front."""

    root = 0.0

    @cached_property
    def ends(self):
        return np.array([0.0, 2 * RADIUS, *self.outline.joint_positions, self.outline.robot.length])


class Beam:
    """The chain's own mechanics: mass and what its motion costs by MuJoCo, springs between the links."""

    def __init__(self, density, modulus, count, gravity=0.0):
        spacing, mass = BEAM / count, density * THICKNESS
        self.stiffness = modulus * THICKNESS**3 / (12 * (1 - POISSON**2)) / spacing
        lengths = [spacing] * (count - 1) + [0.5 * spacing]
        inner = ""
        for k in reversed(range(count)):
            own, at = lengths[k], 0.5 * spacing if k == 0 else lengths[k - 1]
            turn = mass * own * (own**2 + THICKNESS**2) / 12
            inner = (
                f'<body pos="{at!r} 0 0"><joint axis="0 0 1"/><inertial pos="{0.5 * own!r} 0 0" mass="{mass * own!r}" '
                f'diaginertia="{turn!r} {turn!r} {turn!r}"/>{inner}</body>'
            )
        self.model = mujoco.MjModel.from_xml_string(
            f'<mujoco><compiler angle="radian" balanceinertia="true"/><option gravity="0 {gravity!r} 0"/>'
            f"<worldbody>{inner}</worldbody></mujoco>"
        )
        self.data, self.size, self.last = mujoco.MjData(self.model), count, lengths[-1]

    def at(self, angles, rates):
        """Return the mass matrix, and the generalised force that it takes not to accelerate, without springs."""
        self.data.qpos[:], self.data.qvel[:] = angles, rates
        mujoco.mj_fwdPosition(self.model, self.data)
        mujoco.mj_fwdVelocity(self.model, self.data)
        whole = np.zeros((self.size, self.size))
        mujoco.mj_fullM(self.model, self.data, whole)
        return whole, self.data.qfrc_bias.copy()

    def tip(self, angles):
        """Return where the middle of the free end is, from where it is at rest, along and across [m]."""
        self.data.qpos[:] = angles
        mujoco.mj_kinematics(self.model, self.data)
        turned = self.data.xmat[-1].reshape(3, 3)[:2, 0]
        return self.data.xpos[-1, :2] + self.last * turned - np.array([BEAM, 0.0])


SHAKES = 5
"""Periods of the published frequency over which the springs are shaken, so that beam and wake swing after seconds
rather than ten; what they go over to when they are let go does not depend on it [-]."""
CORRECTIONS, TOLERANCE, RENEWED = 5, 5e-3, 0.25
"""Corrections of a step at most; force that it may leave over, over the greatest so far [-]; and turn of the tip after
which the added mass is computed anew [rad]."""
LEAN = 0.6
"""Where in a step the springs are taken, over its length [-]. The middle lets modes that are faster than the steps ring
for ever. From 0.6 they die out, and a mode of frequency f loses ``0.1 2 pi f h`` of critical damping in steps h: a
thousandth, of the first."""
SHORT, FILTER = 8.0, 1.0
"""Links shorter than ``SHORT`` cells have a drag on what neighbouring joints turn against each other, ``FILTER`` times
what halves it in a step [-]. Short links that bend in turns are waves that the grid's kernel does not carry: the force
on them then does more work than the water loses, and they grow. Waves of n links have ``(pi / n)^4`` of it: the second
mode, in which the beam flaps, 0.03 % of critical damping with 28 links, 1.6 % with 14, and with 7 it would be 88 %."""


PATCH = (0.1, 0.7), (0.09, 0.32)
"""Where finer cells are, if they are not everywhere, along and across the channel: around cylinder and beam, as far as
these swing, and a cylinder's width behind them [m]."""


def channel(profile):
    """Return the sides of the channel, into which water comes by a profile."""
    return flow.Sides(left=ParabolicInflow(profile=profile), right=flow.Outflow(), bottom=flow.Wall(), top=flow.Wall())


def grids(cell, ratio, sides):
    """Return the cells of a set-up: one grid, or a patch of it ``ratio`` times as fine as the rest."""
    whole = flow.Grid.covering(*((0.0, size) for size in CHANNEL), cell=ratio * cell, sides=sides)
    return {"grid": whole} if ratio == 1 else {"grid": whole.patch(*PATCH, ratio=ratio), "coarse_grid": whole}


class Flag:
    """The chain in the channel, step by step; as ``coupling.Swim`` does it with a robot."""

    def __init__(self, name, count, cells, ratio=1):
        self.case, self.name = CASES[name], name
        self.setup_of = name, count, cells, ratio
        case, cell = self.case, CHANNEL[1] / cells
        self.beam = Beam(case.density, case.modulus, count)
        stations = 2 * round((2 * RADIUS + BEAM) / cell) + 1
        self.chain = FlagChain(FlagOutline(count, stations), parts=count)
        place = np.zeros(3 + count)
        place[:2] = CENTRE[0] - RADIUS, CENTRE[1]
        self.posture = ChainState(place, np.zeros(3 + count))
        self.path = ChainPath(0.0, self.posture)
        body = flow.Body(
            shape=self.chain.body(self.path, 2, 0.0, np.ones(stations)),
            motion=self.chain.motion(self.path, 2, 0.0), name="flag",
        )  # fmt: skip
        sides = channel(lambda y: 6 * case.speed * y * (CHANNEL[1] - y) / CHANNEL[1] ** 2)
        self.sim = flow.Simulation(
            flow.Setup(
                viscosity=VISCOSITY, density=WATER, bodies=(body,), coarse=True, tolerance=1e-4, sides=sides,
                **grids(cell, ratio, sides),
            ),
            thread_count=1,
        )  # fmt: skip
        self.zigzag, bends = (-1.0) ** np.arange(count), np.diff(np.eye(count), 2, axis=0)
        short = BEAM / count < SHORT * cell
        self.filter = (FILTER if short else 0.0) * bends.T @ bends / 16
        self.force, self.push = np.zeros(count), np.zeros(count)
        self.greatest, self.turned = 0.0, np.inf
        self.rows = []
        self._renew()

    @property
    def time(self):
        return self.sim.time

    def _renew(self):
        """Compute the added mass anew if the tip has turned enough, and once the wall has its skin."""
        turned = float(self.posture.position[3:].sum())
        if len(self.rows) != 1 and abs(turned - self.turned) < RENEWED:
            return
        self.turned, origin = turned, np.zeros(2)
        modes = self.chain.modes(self.posture.position, origin, 2)[3:]
        found = self.sim.added_mass("flag", modes)
        inside = self.chain.unpressed(self.posture.position, found.internal_pressure, origin)[:, 3:]
        self.added = found.matrix - 0.5 * (inside + inside.T)

    def step(self, longest=np.inf):
        """Take one step, and note it."""
        h, start, began = min(self.sim.next_step(), longest), self.time, self.posture
        angles, rates = began.position[3:], began.rate[3:]
        spring, cycles = self.beam.stiffness, (start + 0.5 * h) * self.case.frequency
        rest = self.case.shaken / self.beam.size * np.sin(2 * np.pi * cycles) if cycles < SHAKES else 0.0

        def newton(push, force):
            """Return what an acceleration leaves over, and the matrix that it is taken away with."""
            middle = angles + 0.5 * h * rates + 0.125 * h * h * push
            mass, bias = self.beam.at(middle, rates + 0.5 * h * push)
            held = spring * (angles - rest + LEAN * (h * rates + 0.5 * h * h * push))
            whole = mass + self.added
            slow = (self.zigzag @ whole @ self.zigzag) / push.size * self.filter
            left = mass @ push + bias + held + slow @ (rates / h + push) - force
            return left, whole + slow + LEAN * 0.5 * h * h * spring * np.eye(push.size)

        def gone(push):
            place, rate = began.position.copy(), began.rate.copy()
            place[3:] += h * rates + 0.5 * h * h * push
            rate[3:] += h * push
            return ChainState(place, rate)

        force, push = self.force, self.push
        for _ in range(3):  # mass and bias are those of the step's middle
            left, whole = newton(push, force - self.added @ (push - self.push))
            push = push - np.linalg.solve(whole, left)
        posture = gone(push)
        self.path.go(start, began, start + h, posture)
        self.sim.advance(h)
        made, size = 0, 1.0
        while True:
            middle = 0.5 * (began.position + posture.position)
            found = self.chain.force(middle, self.sim.last_loads("flag"), np.zeros(2))[3:]
            left, whole = newton(push, found)
            weight = np.diag(whole)
            self.greatest = max(self.greatest, float(np.sqrt((found**2 / weight).sum())))
            size = float(np.sqrt((left**2 / weight).sum())) / max(self.greatest, 1e-300)
            if size <= TOLERANCE or made == CORRECTIONS:
                break
            push = push - np.linalg.solve(whole, left)
            other = gone(push)
            more = self.chain.twists(posture.position, other.rate - posture.rate, np.zeros(2), 2)
            posture, made = other, made + 1
            self.path.go(start, began, start + h, posture)
            self.sim.accelerate({"flag": more})
        self.force, self.push, self.posture = found, push, posture
        whole = self.sim.last_loads("flag").total.force
        self.rows.append([self.time, *self.beam.tip(posture.position[3:]), *whole, size, made])
        self._renew()

    # --- stopped and gone on ---------------------------------------------------------------------------------------

    @property
    def setup(self):
        return self.setup_of

    def state(self):
        own = {name: np.array(getattr(self, name)) for name in ("force", "push", "greatest", "turned", "added", "rows")}
        now = {"place": self.posture.position, "rate": self.posture.rate}
        return {**own, **now, **{f"flow.{name}": value for name, value in self.sim.state().items()}}

    def resume(self, state):
        self.posture = ChainState(state["place"], state["rate"])
        time = float(state["flow.time"])
        self.path.go(time, self.posture, time, self.posture)
        self.sim.resume({name[5:]: value for name, value in state.items() if name.startswith("flow.")})
        self.force, self.push, self.added = state["force"], state["push"], state["added"]
        self.greatest, self.turned = float(state["greatest"]), float(state["turned"])
        self.rows = state["rows"].tolist()


COLUMNS = "time", "tip_x", "tip_y", "drag", "lift", "left", "corrections"
"""Columns of a series: time [s], way of the tip [m], forces on cylinder and beam [N/m], force that the step left over
over the greatest so far [-], and corrections that it took [-]."""


def stem(name, count, cells, ratio=1):
    """Return the name of a run's files."""
    return f"{name}_{count}_{cells}" + (f"_{ratio}" if ratio > 1 else "")


def run(name, count, cells, folder, until, *, limit=np.inf, ratio=1, every=20.0):
    """Run one case as far as ``until`` [s], or for ``limit`` seconds of the clock; return its series, a row a step.

    A checkpoint and the series lie in ``folder`` by the name of ``stem``; a case that was left there goes on.
    """
    folder.mkdir(parents=True, exist_ok=True)
    place, began = folder / stem(name, count, cells, ratio), clock.monotonic()
    flag = Flag(name, count, cells, ratio)
    saved = place.with_suffix(".checkpoint")
    if saved.exists():
        store.load(flag, saved)
    told = began
    while flag.time < until * (1 - 1e-9) and clock.monotonic() - began < limit:
        flag.step(until - flag.time)
        if clock.monotonic() - told > every:
            told = clock.monotonic()
            _keep(flag, place)
            print(f"{place.name}: {flag.time:.3f} s after {told - began:.0f} s, {len(flag.rows)} steps", flush=True)
    _keep(flag, place)
    return np.array(flag.rows)


def _keep(flag, stem):
    """Write the checkpoint, and the series with six digits."""
    store.save(flag, stem.with_suffix(".checkpoint"))
    series = dict(zip(COLUMNS, np.array(flag.rows).T, strict=True))
    text = json.dumps({name: [float(f"{value:.6g}") for value in column] for name, column in series.items()})
    keep(stem.with_suffix(".json"), text.encode())


def cycle(time, across, *others):
    """Return frequency, and middle and half of the range of each series over the last whole period.

    Periods are told by where ``across`` comes up through its middle.
    """
    late = time > time[-1] - 0.5 * (time[-1] - time[0])
    middle = 0.5 * (across[late].max() + across[late].min())
    up = np.flatnonzero((across[:-1] < middle) & (across[1:] >= middle) & late[1:])
    crossed = time[up] + (middle - across[up]) / (across[up + 1] - across[up]) * (time[up + 1] - time[up])
    if len(crossed) < 2:
        return np.nan, [(np.nan, np.nan)] * (1 + len(others))
    kept = crossed[-4:]
    last = (time >= crossed[-2]) & (time <= crossed[-1])
    found = [(0.5 * (one[last].max() + one[last].min()), 0.5 * np.ptp(one[last])) for one in (across, *others)]
    return (len(kept) - 1) / (kept[-1] - kept[0]), found


if __name__ == "__main__":
    case, links, cells, place, until, *rest = sys.argv[1:]
    limit, ratio = (*map(float, rest), *(np.inf, 1)[len(rest) :])
    rows = run(case, int(links), int(cells), Path(place), float(until), limit=limit, ratio=int(ratio))
    time, x, y, drag, lift, left, corrections = rows.T
    found = cycle(time, y, x, drag, lift)
    print(case, links, cells, found, "corrections", corrections.mean(), "left over", left[20:].max())
