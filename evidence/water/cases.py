"""Cases in which water that ``suchus.wet`` puts into a MuJoCo model has an exact or published answer."""

from collections.abc import Callable
from dataclasses import dataclass
from math import acos, cos, exp, log, pi, radians, sin, sqrt, tan, tau
from typing import Any

import mujoco
import numpy as np
from numba import njit
from scipy.optimize import brentq

from suchus.core.physics import GRAVITY
from suchus.sim.hydro.shapes import capsule, cylinder, polyhedron
from suchus.sim.immersion import GeomCoefficients, Wave, water_loads, wet
from suchus.sim.immersion.meshes import box_triangles

DENSITY = 1000.0
"""Density of the water [kg/m3]."""
FRICTIONLESS = GeomCoefficients(drag=0.0, linear_drag=0.0, linear_turning_drag=0.0)
"""Coefficients of a geom in ideal water."""
ISSUE = "MuJoCo issue 3452"
LAMB = "Lamb, Hydrodynamics (1932), art. 114"
DNV = "DNV-RP-C205 (2010), table D-2"


@dataclass(frozen=True, slots=True, kw_only=True)
class Check:
    """A computed number beside the exact or published one."""

    case: str
    """Name of the case."""
    quantity: str
    """Name of the quantity."""
    computed: float
    """As MuJoCo's step has it, in ``unit``."""
    reference: float
    """Exact or published, in ``unit``."""
    unit: str
    """Unit of both."""
    tolerance: float
    """Greatest difference that is accepted, in ``unit``."""
    source: str
    """Where the reference is from."""

    @property
    def holds(self) -> bool:
        """Whether the computed number is within the tolerance of the reference."""
        return abs(self.computed - self.reference) <= self.tolerance


def body(geom: str, *, options: str = "", position: str = "0 0 0", inertial: str = "", others: str = "") -> str:
    """Return the MJCF of a free body.

    Args:
        geom: attributes of its geom.
        options: attributes of MuJoCo's options.
        position: position of the body.
        inertial: attributes of its inertia; that of the geom if empty.
        others: further elements of the body.
    """
    inertia = f"<inertial {inertial}/>" if inertial else ""
    return (
        f'<mujoco><option integrator="RK4" timestep="0.001" {options}/><worldbody><body name="body" pos="{position}">'
        f'<freejoint/>{inertia}<geom name="geom" {geom}/>{others}</body></worldbody></mujoco>'
    )


def ideal(xml: str, **options: Any) -> Any:
    """Return the compiled model of a body in water without drag.

    Args:
        xml: see ``body``.
        options: options of ``suchus.wet``.
    """
    defaults = {"coefficients": {"geom": FRICTIONLESS}, "splash": 0.0}
    return wet(xml, **(defaults | options)).compile()


def forward(model: Any, position: Any = (0.0, 0.0, 0.0), turn: Any = (1.0, 0.0, 0.0, 0.0)) -> Any:
    """Return the data of a free body somewhere, forces evaluated.

    Args:
        model: a ``mujoco.MjModel``.
        position: [m].
        turn: orientation, wxyz.
    """
    data = mujoco.MjData(model)
    data.qpos[:3], data.qpos[3:7] = position, turn
    mujoco.mj_forward(model, data)
    return data


def about_x(angle: float) -> tuple[float, float, float, float]:
    """Return a turn about x as a quaternion wxyz.

    Args:
        angle: [rad].
    """
    return cos(angle / 2), sin(angle / 2), 0.0, 0.0


def issue_table() -> list[Check]:
    """Return the rows of the table in MuJoCo's issue 3452 that are about water.

    The issue gives the keeled hull's acceleration but not its shape: a submerged cylinder 1 m wide, whose keel gives
    that acceleration, stands for it.
    """
    checks = []
    neutral = ideal(body('type="ellipsoid" size="0.3 0.1 0.08" density="1000"'), level=20.0, added_mass=0.0)
    acceleration = float(forward(neutral).qacc[2])
    checks.append(_check("neutrally buoyant body", "acceleration", acceleration, 0.0, "m/s2", 1e-9, ISSUE))
    for ballast in (0.5, 1.0, 3.0):
        mass = DENSITY * 0.027 + ballast
        xml = body('type="box" size="0.15 0.15 0.15"', inertial=f'pos="0 0 0" mass="{mass}" diaginertia="1 1 1"')
        model = ideal(xml, level=20.0, added_mass=0.0)
        force = mass * float(forward(model).qacc[2])
        exact = -ballast * GRAVITY
        checks.append(_check(f"float with {ballast:g} kg of ballast", "net force", force, exact, "N", 1e-8, ISSUE))
    checks += _keeled_hull()
    xml = body('type="ellipsoid" size="0.5 0.1 0.1" density="1000"')
    model = ideal(xml, level=20.0)
    data = forward(model)
    matrix = full_mass(model, data)
    mass = float(model.body_mass[1])
    for axis, published in ((0, 0.001238), (1, 0.018729), (2, 0.018729)):
        added = (matrix[axis, axis] - mass) / DENSITY
        checks.append(_check(f"hull 5 to 1, axis {'xyz'[axis]}", "added mass", added, published, "m3", 1e-6, ISSUE))
    data.xfrc_applied[1, 1] = 100.0
    mujoco.mj_forward(model, data)
    exact = 100.0 / (mass + DENSITY * 0.018729)
    checks.append(
        _check("hull 5 to 1, pushed sideways", "acceleration", float(data.qacc[1]), exact, "m/s2", 1e-3, ISSUE)
    )
    deep, high = (float(water_loads(model, forward(model, (0, 0, z))).force[1, 2]) for z in (-100.0, 100.0))
    checks.append(_check("the same, 120 m under the surface", "force", deep, mass * GRAVITY, "N", 1e-6, ISSUE))
    checks.append(_check("the same, 80 m above it", "force", high, 0.0, "N", 0.0, ISSUE))
    return checks


def _keeled_hull() -> list[Check]:
    """Return the angular acceleration of a keeled hull at 45 degrees, and its swing after a release at 30 degrees."""
    published, square = 1.118721, 0.1
    depth = published * square / (GRAVITY * sin(radians(45)))
    mass = DENSITY * pi * 0.25 * 2.0
    inertia = f'pos="0 0 {-depth}" mass="{mass}" diaginertia="{mass * square} {mass} {mass}"'
    xml = body('type="cylinder" size="0.5 1" euler="0 90 0"', inertial=inertia)
    model = ideal(xml, level=20.0, added_mass=0.0)
    rate = -float(forward(model, turn=about_x(radians(45))).qacc[3])
    checks = [_check("keeled hull at 45 degrees", "angular acceleration", rate, published, "rad/s2", 1e-6, ISSUE)]
    data = forward(model, turn=about_x(radians(30)))
    least = radians(30)
    for _ in range(20000):
        mujoco.mj_step(model, data)
        least = min(least, 2.0 * float(np.arctan2(data.qpos[4], data.qpos[3])))
    checks.append(
        _check("keeled hull let go at 30 degrees, 20 s", "heel on the other side", least, -radians(30), "rad", 1e-4,
               "energy is kept; MuJoCo alone: stays at 30 degrees, issue 3452")
    )  # fmt: skip
    return checks


def full_mass(model: Any, data: Any) -> np.ndarray:
    """Return the mass matrix, the water's added mass included, shape (dof, dof).

    Args:
        model: a ``mujoco.MjModel``.
        data: its data, forces evaluated.
    """
    matrix = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, matrix)
    return matrix


def drafts() -> list[Check]:
    """Return the drafts of floats at three densities: roots of exact volumes."""
    checks = []
    for ratio in (0.2, 0.5, 0.95):
        ball = 0.1 * brentq(lambda x, s=ratio: x * x * (3 - x) / 4 - s, 0.0, 2.0, xtol=1e-15)
        lying = 0.1 * brentq(
            lambda x, s=ratio: (acos(1 - x) - (1 - x) * sqrt(x * (2 - x))) / pi - s, 0.0, 2.0, xtol=1e-15
        )
        for name, geom, half, exact in (
            ("sphere", 'type="sphere" size="0.1"', 0.1, ball),
            ("lying cylinder", 'type="cylinder" size="0.1 0.3" euler="0 90 0"', 0.1, lying),
            ("standing cylinder", 'type="cylinder" size="0.1 0.3"', 0.3, 0.6 * ratio),
            ("box", 'type="box" size="0.3 0.15 0.075"', 0.075, 0.15 * ratio),
            ("capsule", 'type="capsule" size="0.1 0.2"', 0.3, _capsule_draft(ratio)),
        ):
            model = ideal(body(f'{geom} density="{DENSITY * ratio}"'), added_mass=0.0)
            data = mujoco.MjData(model)

            def surplus(z: float, model: Any = model, data: Any = data) -> float:
                data.qpos[2] = z
                mujoco.mj_forward(model, data)
                return float(data.qacc[2])

            draft = half - float(brentq(surplus, -half, half, xtol=1e-13))
            checks.append(_check(f"{name} of {ratio:g} of water's density", "draft", draft, exact, "m", 1e-9, "exact"))
    return checks


def _capsule_draft(ratio: float) -> float:
    """Return the draft of a standing capsule of radius 0.1 m whose cylinder is 0.4 m long [m]."""
    radius, length = 0.1, 0.4
    whole = pi * radius**2 * (length + 4 / 3 * radius)

    def volume(draft: float) -> float:
        lower = min(draft, radius)
        upper = min(max(draft - radius - length, 0.0), radius)
        cap = pi * lower**2 * (3 * radius - lower) / 3
        top = pi * (radius**2 * upper - upper**3 / 3)
        return cap + pi * radius**2 * min(max(draft - radius, 0.0), length) + top

    return float(brentq(lambda draft: volume(draft) - ratio * whole, 0.0, length + 2 * radius, xtol=1e-15))


def periods() -> list[Check]:
    """Return periods of small heave and roll of a box that is half under water, with and without added mass."""
    checks = []
    half = np.array([0.3, 0.15, 0.075])
    mass, draft = 0.5 * DENSITY * 8.0 * float(np.prod(half)), half[2]
    area = 4.0 * half[0] * half[1]
    geom = f'type="box" size="{half[0]} {half[1]} {half[2]}" density="500"'
    for added in (0.0, 1.0):
        model = ideal(body(geom, options='timestep="0.002"').replace('timestep="0.001" ', ""), added_mass=added)
        data = forward(model, (0.0, 0.0, 1e-4))
        total = float(full_mass(model, data)[2, 2])
        period = _period(model, data, lambda state: float(state.qpos[2]))
        exact = tau * sqrt(total / (DENSITY * GRAVITY * area))
        words = "with added mass" if added else "without added mass"
        checks.append(_check(f"heave of a box {words}", "period", period, exact, "s", 1e-3 * exact, "exact, linear"))
    keel = 0.03
    inertia = 0.09
    xml = body(
        geom, options='timestep="0.002"', inertial=f'pos="0 0 {-keel}" mass="{mass}" diaginertia="{inertia} 1 1"'
    )
    model = ideal(xml.replace('timestep="0.001" ', ""), added_mass=0.0)
    centre = -draft / 2
    height = centre + (2 * half[1]) ** 2 / (12 * draft) + keel
    exact = tau * sqrt(inertia / (mass * GRAVITY * height))
    period = _period(model, forward(model, turn=about_x(1e-3)), lambda state: float(state.qpos[4]))
    checks.append(_check("roll of a box", "period", period, exact, "s", 2e-3 * exact, "exact, linear"))
    return checks


def _period(model: Any, data: Any, coordinate: Callable[[Any], float]) -> float:
    """Return the mean time between downward crossings of zero of a coordinate, over five periods [s]."""
    crossings, before = [], coordinate(data)
    while len(crossings) < 6 and data.time < 60.0:
        mujoco.mj_step(model, data)
        after = coordinate(data)
        if before > 0.0 >= after:
            crossings.append(data.time - model.opt.timestep * after / (after - before))
        before = after
    return float(np.mean(np.diff(crossings)))


def righting() -> list[Check]:
    """Return the righting levers of a box: GZ = sin(heel) (GM + BM tan^2(heel) / 2) while its deck is dry."""
    half, keel = (0.3, 0.15, 0.075), 0.03
    mass = 0.5 * DENSITY * 8.0 * half[0] * half[1] * half[2]
    inertial = f'pos="0 0 {-keel}" mass="{mass}" diaginertia="0.1 0.2 0.3"'
    model = ideal(body(f'type="box" size="{half[0]} {half[1]} {half[2]}"', inertial=inertial), added_mass=0.0)
    radius = (2 * half[1]) ** 2 / (12 * half[2])
    height = -half[2] / 2 + radius + keel
    checks = []
    for degrees in (5, 10, 20, 25):
        heel = radians(degrees)
        loads = water_loads(model, forward(model, turn=about_x(heel)))
        # torque about the middle of the waterline, and that of the weight, which hangs below it
        moment = float(loads.torque[1, 0]) + mass * GRAVITY * -keel * sin(heel)
        exact = sin(heel) * (height + 0.5 * radius * tan(heel) ** 2)
        checks.append(
            _check(f"box heeled by {degrees} degrees", "righting lever", -moment / (mass * GRAVITY), exact, "m", 1e-9,
                   "wall-sided formula, exact")
        )  # fmt: skip
    return checks


def terminal_speeds() -> list[Check]:
    """Return terminal speeds of a sphere with a drag coefficient, of one in oil, and of a plate that falls flat."""
    checks = []
    radius, ratio = 0.05, 1.5
    volume = 4 / 3 * pi * radius**3
    pull = (ratio - 1.0) * DENSITY * volume * GRAVITY
    exact = sqrt(2.0 * pull / (DENSITY * 0.47 * pi * radius**2))
    chosen = {"geom": GeomCoefficients(linear_drag=0.0)}
    sphere = body(f'type="sphere" size="{radius}" density="{ratio * DENSITY}"')
    speed = _terminal(wet(sphere, level=1000.0, coefficients=chosen).compile())
    checks.append(_check("sphere, drag coefficient 0.47", "terminal speed", speed, exact, "m/s", 1e-4 * exact, "exact"))
    oil = body(f'type="sphere" size="0.001" density="{ratio * DENSITY}"').replace("RK4", "Euler")
    exact = 2.0 / 9.0 * (ratio - 1.0) * DENSITY * GRAVITY * 1e-6 / 10.0
    speed = _terminal(wet(oil, level=1000.0, viscosity=10.0).compile())
    checks.append(_check("sphere in oil, Re 1e-6", "terminal speed", speed, exact, "m/s", 1e-3 * exact, "Stokes 1851"))
    side, thickness = 0.2, 0.002
    plate = body(f'type="box" size="{side / 2} {side / 2} {thickness / 2}" density="2700"')
    pull = 1.7 * DENSITY * side**2 * thickness * GRAVITY
    exact = sqrt(2.0 * pull / (DENSITY * 1.17 * side**2))
    speed = _terminal(wet(plate, level=1000.0).compile())
    checks.append(
        _check("square plate that falls flat", "terminal speed", speed, exact, "m/s", 2e-2 * exact,
               "drag coefficient 1.17, Hoerner (1965), 3-16")
    )  # fmt: skip
    return checks


def _terminal(model: Any) -> float:
    """Return the speed at which a body falls after 20 s [m/s]."""
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 20000)
    return -float(data.qvel[2])


def added_masses() -> list[Check]:
    """Return added masses of a sphere, spheroids, discs, plates and prisms, read from the mass matrix."""
    checks = []
    ellipse = sqrt(1.0 - 0.25)
    alpha = 2.0 * (1.0 - ellipse**2) / ellipse**3 * (0.5 * log((1.0 + ellipse) / (1.0 - ellipse)) - ellipse)
    beta = 1.0 / ellipse**2 - (1.0 - ellipse**2) / (2.0 * ellipse**3) * log((1.0 + ellipse) / (1.0 - ellipse))
    for name, geom, axis, exact, source in (
        ("sphere", 'type="sphere" size="0.1"', 2, 2 / 3 * pi * 0.1**3, "exact"),
        ("prolate spheroid 2 to 1, along", 'type="ellipsoid" size="0.2 0.1 0.1"', 0,
         alpha / (2 - alpha) * 4 / 3 * pi * 0.002, LAMB),
        ("prolate spheroid 2 to 1, across", 'type="ellipsoid" size="0.2 0.1 0.1"', 1,
         beta / (2 - beta) * 4 / 3 * pi * 0.002, LAMB),
        ("thin disc, across its plane", 'type="cylinder" size="0.1 0.00001"', 2, 8 / 3 * 0.1**3, LAMB),
        ("elliptic disc as ellipsoid", 'type="ellipsoid" size="0.1 0.1 0.00001"', 2, 8 / 3 * 0.1**3, LAMB),
        ("square plate", 'type="box" size="0.1 0.1 0.00001"', 2, 0.579 * pi / 4 * 0.2**3, DNV),
        ("plate 2 to 1", 'type="box" size="0.2 0.1 0.00001"', 2, 0.757 * pi / 4 * 0.2**2 * 0.4, DNV),
        ("plate 5 to 1", 'type="box" size="0.5 0.1 0.00001"', 2, 0.897 * pi / 4 * 0.2**2, DNV),
        ("long prism of square section, across", 'type="box" size="40 0.1 0.1"', 2, 1.51 * pi * 0.1**2 * 80, DNV),
        ("cube", 'type="box" size="0.1 0.1 0.1"', 2, 0.68 * 0.2**3, DNV),
        ("long cylinder, across", 'type="cylinder" size="0.1 40"', 0, pi * 0.1**2 * 80, "exact, Ca 1"),
        ("cylinder of length 2.5 diameters, across", 'type="cylinder" size="0.1 0.25"', 0, 0.78 * pi * 0.005, DNV),
    ):  # fmt: skip
        model = ideal(body(f'{geom} density="1"'), level=200.0)
        added = (full_mass(model, forward(model))[axis, axis] - model.body_mass[1]) / DENSITY
        checks.append(_check(name, "added mass", added, exact, "m3", 0.015 * exact, source))
    eigenvalues = []
    for geom in (
        'type="sphere" size="0.1"', 'type="ellipsoid" size="0.3 0.1 0.08"', 'type="capsule" size="0.1 0.2"',
        'type="cylinder" size="0.1 0.2"', 'type="box" size="0.3 0.15 0.07"',
    ):  # fmt: skip
        model = ideal(body(f'{geom} density="1000"'), level=20.0)
        dry = ideal(body(f'{geom} density="1000"'), level=-20.0)
        turn = (0.8, 0.36, -0.48, 0.0)
        wet_matrix, dry_matrix = (full_mass(each, forward(each, turn=turn)) for each in (model, dry))
        eigenvalues.append(float(np.linalg.eigvalsh(wet_matrix - dry_matrix).min()))
    checks.append(
        _check("five kinds of geoms", "least eigenvalue of the added mass, where below 0", min(*eigenvalues, 0.0), 0.0,
               "kg", 1e-9, ISSUE)
    )  # fmt: skip
    return checks


def surface_crossing() -> list[Check]:
    """Return the speed of a sphere after it crosses the surface without gravity: momentum or energy is kept."""
    checks = []
    for splash, word in ((1.0, "momentum, von Karman (1929)"), (0.0, "energy, Lagrange")):
        for ratio in (0.3, 1.0, 3.0):
            xml = body(f'type="sphere" size="0.1" density="{DENSITY * ratio}"', options='gravity="0 0 0"',
                       position="0 0 0.15")  # fmt: skip
            model = ideal(xml, splash=splash)
            data = mujoco.MjData(model)
            data.qvel[2] = -1.0
            while data.qpos[2] > -0.15 and data.time < 10.0:
                mujoco.mj_step(model, data)
            share = ratio / (ratio + 0.5)
            exact = share if splash else sqrt(share)
            checks.append(
                _check(f"sphere of {ratio:g} of water's density enters at 1 m/s, {word} kept", "speed under water",
                       -float(data.qvel[2]), exact, "m/s", 1e-4, "exact")
            )  # fmt: skip
    return checks


def orbits() -> list[Check]:
    """Return how a neutral body follows a wave, and the force of a wave on a body that is held."""
    wave = Wave(height=0.2, length=10.0)
    number = tau / wave.length
    omega, depth = sqrt(GRAVITY * number), 1.0
    speed = 0.1 * omega * exp(-number * depth)
    top = 0.1 * exp(-number * depth) - depth  # where it is at the crest, if the middle of its orbit is at that depth
    model = ideal(body('type="sphere" size="0.02" density="1000"', position=f"0 0 {top}"), waves=wave)
    data = mujoco.MjData(model)
    data.qvel[0] = 0.1 * omega * exp(number * top)
    positions = []
    while data.time < tau / omega:
        mujoco.mj_step(model, data)
        positions.append(np.array(data.qpos[:3]))
    radius = 0.5 * float(np.ptp(np.array(positions)[:, 2]))
    exact = 0.1 * exp(-number * depth)
    checks = [_check("neutral sphere in a wave", "radius of its orbit", radius, exact, "m", 0.02 * exact, "Airy")]
    model = ideal(body('type="sphere" size="0.05" density="1000"', position=f"0 0 {-depth}"), waves=wave)
    forces = []
    for phase in np.linspace(0.0, tau, 16, endpoint=False):
        data = mujoco.MjData(model)
        data.time = phase / omega
        mujoco.mj_forward(model, data)
        forces.append(float(data.qfrc_passive[0]))
    volume = 4 / 3 * pi * 0.05**3
    exact = 1.5 * DENSITY * volume * omega * speed
    checks.append(
        _check("held sphere in a wave", "greatest horizontal force", float(np.abs(forces).max()), exact, "N",
               1e-6 * exact, "Morison: (1 + Ca) times the mass of the water times its acceleration")
    )  # fmt: skip
    return checks


def light_bodies() -> list[Check]:
    """Return the greatest speed at rest of bodies of a fiftieth of water's density, 10 s after a fall of 0.5 m."""
    checks = []
    for name, geom in (
        ("sphere", 'type="sphere" size="0.1"'),
        ("ellipsoid", 'type="ellipsoid" size="0.3 0.1 0.08"'),
        ("capsule", 'type="capsule" size="0.1 0.2"'),
        ("box", 'type="box" size="0.3 0.15 0.07"'),
    ):
        for integrator in ("Euler", "implicitfast"):
            xml = body(f'{geom} density="20"', position="0 0 0.5", options="").replace(
                'integrator="RK4" timestep="0.001"', f'integrator="{integrator}" timestep="0.002"'
            )
            model = wet(xml).compile()
            data = mujoco.MjData(model)
            mujoco.mj_step(model, data, 5000)
            checks.append(
                _check(f"light {name}, {integrator}, 2 ms", "vertical speed after 10 s", float(data.qvel[2]), 0.0,
                       "m/s", 0.05, "at rest")
            )  # fmt: skip
    return checks


def energies() -> list[Check]:
    """Return what spinning bodies that fall through the surface gain and lose of their energy, drag off."""
    checks = []
    for name, geom, potential in (
        ("ellipsoid", 'type="ellipsoid" size="0.3 0.1 0.08"', None),
        ("cylinder", 'type="cylinder" size="0.1 0.2"', _cylinder_part),
        ("capsule", 'type="capsule" size="0.1 0.2"', _capsule_part),
        ("box", 'type="box" size="0.3 0.15 0.07"', _box_part),
    ):
        for splash in (0.0, 1.0):
            xml = body(f'{geom} density="500" euler="20 30 0"', position="0 0 0.3")
            model = ideal(xml, splash=splash)
            data = mujoco.MjData(model)
            data.qvel[3:] = 1.0, 0.5, -0.7
            history = []
            for _ in range(60):
                mujoco.mj_forward(model, data)
                history.append(_energy(model, data, potential or _ellipsoid_part))
                mujoco.mj_step(model, data, 50)
            dropped = model.body_mass[1] * GRAVITY * 0.3
            change = (np.array(history) - history[0]) / dropped
            quantity = "greatest gain" if splash else "greatest change"
            value = max(float(change.max()), 0.0) if splash else float(np.abs(change).max())
            checks.append(
                _check(f"{name} that spins and falls, splash {splash:g}", f"{quantity} of energy over that of its fall",
                       value, 0.0, "-", 1e-3, "energy is kept, or a splash takes of it")
            )  # fmt: skip
    return checks


@njit
def _cylinder_part(size: tuple[float, float, float], normal: tuple[float, float, float], height: float) -> Any:
    """Return what of a cylinder is under a plane; see ``shapes.cylinder``."""
    return cylinder(size[0], size[1], normal, height)


@njit
def _capsule_part(size: tuple[float, float, float], normal: tuple[float, float, float], height: float) -> Any:
    """Return what of a capsule is under a plane; see ``shapes.capsule``."""
    return capsule(size[0], size[1], normal, height)


@njit
def _polyhedron_part(triangles: np.ndarray, normal: tuple[float, float, float], height: float) -> Any:
    """Return what of a polyhedron is under a plane; see ``shapes.polyhedron``."""
    return polyhedron(triangles, normal, height)


def _box_part(size: tuple[float, float, float], normal: tuple[float, float, float], height: float) -> Any:
    """Return what of a box is under a plane."""
    return _polyhedron_part(box_triangles(np.array(size)), normal, height)


def _ellipsoid_part(size: tuple[float, float, float], normal: tuple[float, float, float], height: float) -> Any:
    """Return volume and first moment of what of an ellipsoid is under a plane."""
    arm = np.array(size) ** 2 * normal
    extent = sqrt(arm @ normal)
    d = min(max(height / extent, -1.0), 1.0)
    volume = 4 / 3 * pi * float(np.prod(size))
    return volume * (2 + 3 * d - d**3) / 4, -volume * 3 / 16 * (1 - d * d) ** 2 * arm / extent


def _energy(model: Any, data: Any, part: Callable[..., Any]) -> float:
    """Return kinetic energy of body and water, and potential energy of both [J].

    Args:
        model: a ``mujoco.MjModel`` with one geom.
        data: its data, forces evaluated.
        part: function of the geom's size, normal and height of the surface, which returns volume and first moment.
    """
    normal = data.geom_xmat[0].reshape(3, 3)[2]
    height = -float(data.geom_xpos[0, 2])
    immersion = part(tuple(model.geom_size[0]), tuple(normal), height)
    depths = height * immersion[0] - float(normal @ np.array(immersion[1]))
    kinetic = 0.5 * float(data.qvel @ full_mass(model, data) @ data.qvel)
    return kinetic + GRAVITY * (float(model.body_mass[1]) * float(data.xipos[1, 2]) + DENSITY * depths)


def _check(
    case: str, quantity: str, computed: float, reference: float, unit: str, tolerance: float, source: str
) -> Check:
    """Return a check; see ``Check``."""
    return Check(
        case=case, quantity=quantity, computed=computed, reference=reference, unit=unit, tolerance=tolerance,
        source=source,
    )  # fmt: skip


CASES: dict[str, Callable[[], list[Check]]] = {
    "table of MuJoCo issue 3452": issue_table,
    "drafts": drafts,
    "periods": periods,
    "righting levers": righting,
    "terminal speeds": terminal_speeds,
    "added mass": added_masses,
    "through the surface": surface_crossing,
    "energy": energies,
    "waves": orbits,
    "light bodies": light_bodies,
}
"""Cases by name."""
