"""A run: which robot walks how, on what, with what broken, pushed when."""

from collections.abc import Sequence
from dataclasses import dataclass, field

from suchus.core.checks import Checks, require
from suchus.core.errors import InvalidDesign, UnknownName
from suchus.core.kinds import show
from suchus.robot.control import Control, OpenLoop
from suchus.robot.design import WATER_DENSITY, WATER_VISCOSITY, Robot, servo_names
from suchus.robot.design.ground import Ground
from suchus.robot.gaits import gait_of
from suchus.robot.motion import Gait
from suchus.robot.robots import ROBOTS
from suchus.sim.fault import Fault
from suchus.sim.land.lake import Lake
from suchus.sim.land.waters import FORMS, AnyWater, Form, Sections, Slice, Space
from suchus.sim.model import compile_model


@dataclass(frozen=True, slots=True, kw_only=True)
class Afloat:
    """No ground and no gravity: in vacuum, or neutrally buoyant in a fluid at rest.

    The fluid acts by MuJoCo's ellipsoid model, a drag and lift of each piece of the body by its own motion alone; it
    knows no wake, and of the added mass only what turns with a piece, not what resists its acceleration. Contacts are
    off; the physics is integrated by Runge-Kutta steps of fourth order, since those keep angular momentum.
    """

    density: float
    """Density of the fluid [kg/m3]; 0 in vacuum."""
    viscosity: float
    """Dynamic viscosity of the fluid [Pa s]; 0 in vacuum."""

    def __post_init__(self) -> None:
        require("afloat", "density", self.density, 0.0, 2e4, "kg/m3")
        require("afloat", "viscosity", self.viscosity, 0.0, 1e3, "Pa s")


VACUUM = Afloat(density=0.0, viscosity=0.0)
"""Surroundings that exert no force."""
WATER = Afloat(density=WATER_DENSITY, viscosity=WATER_VISCOSITY)
"""Fresh water of 20 degrees Celsius."""
_MAX_FORCE = 1e4  # [N]; more is a slip of the keyboard, not a push


@dataclass(frozen=True, slots=True, kw_only=True)
class Push:
    """A constant force on the centre of mass of one body.

    It is applied at every physics step; a control period that it covers in part gets a part of the force, so that
    the impulse is force times duration whatever the times.
    """

    force: tuple[float, float, float]
    """Force in the world frame: forward, left, up [N]."""
    at: float
    """Time at which the push begins [s]."""
    duration: float = 0.2
    """Duration of the push [s]."""
    body: str = "thorax"
    """Name of the body that is pushed, as ``pelvis``, ``thorax``, ``LF_tibia`` or ``tail_root``."""

    def __post_init__(self) -> None:
        with Checks("push", self) as check:
            check.each("force", ("x", "y", "z"), -_MAX_FORCE, _MAX_FORCE, "N")
            check.number("at", 0.0, 86400.0, "s")
            check.number("duration", 1e-3, 86400.0, "s")

    def overlap_fraction(self, start: float, end: float) -> float:
        """Return how much of the time from ``start`` to ``end`` the push lasts, 0 to 1 [-]."""
        overlap = min(end, self.at + self.duration) - max(start, self.at)
        return max(overlap, 0.0) / (end - start)


@dataclass(frozen=True, slots=True, kw_only=True)
class Run:
    """One run of a batch; robot and gait may be given by their names in the catalogs or the paths of their files."""

    robot: Robot
    """The robot that walks: a body of any kind, as ``suchus.ROBOTS`` names them."""
    gait: Gait
    """Its periodic movement, as ``suchus.GAITS`` names them."""
    ground: Ground = field(default_factory=Ground)
    """Ground: its friction scale, slopes and relief."""
    afloat: Afloat | None = None
    """Fluid in which it floats, far from any surface; None where it stands on the ground."""
    lake: Lake | None = None
    """The water that it walks and swims in, section by section; None on dry land."""
    water: AnyWater | Form | None = None
    """The water, rung by rung: ``Sections`` of a lake, which is then ``lake``; or a ``Slice`` or a ``Space``, a flow
    that ``swimming.coupling.simulate`` solves together with the robot. Short forms: "sections", two body lengths deep,
    "slice" and "space"."""
    faults: tuple[Fault, ...] = ()
    """Faults, each with the time at which it begins; none by default."""
    pushes: tuple[Push, ...] = ()
    """Forces from outside; their sum acts where they overlap."""
    control: Control = field(default_factory=OpenLoop)
    """Controller that turns the gait and what the robot senses into servo angles."""
    zero_error: tuple[float, ...] = ()
    """Error of each servo's zero: what is added to its commanded angle, in the order of ``design.servo_names``; none
    where it is empty [rad]. ``land.Tolerances`` draws such errors."""
    play: tuple[float, ...] = ()
    """Play of each servo, gear and dead band together, whole width: so far its command must turn back before the servo
    does; none where it is empty [rad]."""
    supply: float = 1.0
    """Share of their supply that the servos get, as of a battery that sags [-]; those without a winding do not feel
    it."""
    noise: float = 0.0
    """Standard deviation of white noise on every servo angle commanded [rad]; it shakes a robot forward, so that
    results take ``zero_error`` and ``play`` instead."""
    seed: int = 0
    """Seed of the noise [-]."""
    label: str = ""
    """Name in tables and legends."""

    def __post_init__(self) -> None:
        """Resolve the names of robot, gait and water, and refuse settings that contradict each other."""
        object.__setattr__(self, "robot", ROBOTS.resolve(self.robot))
        object.__setattr__(self, "gait", gait_of(self.robot, self.gait))
        self._take_water()
        with Checks("run", self) as check:
            check.number("supply", 0.01, 2.0, "")
            check.number("noise", 0.0, 1.0, "rad")
            servos = len(servo_names(self.robot))
            for name, minimum in (("zero_error", -1.0), ("play", 0.0)):
                values = getattr(self, name)
                check.that(
                    len(values) in (0, servos),
                    f"{name} has {len(values)} values, and {self.robot.name} {servos} servos; give each one or none",
                )
                check.that(
                    all(minimum <= value <= 1.0 for value in values),
                    f"{name} is {show(values)}; each of its values must be from {minimum:g} to 1 rad",
                )
            check.whole("seed", 0, 2**32 - 1)
            check.that(
                self.lake is None or self.afloat is None,
                "a run floats in a lake or in a vacuum without gravity, not in both: leave out lake or afloat",
            )
            check.that(
                self.ground.grains is None or (self.lake is None and self.afloat is None),
                "a robot on grains is dry: leave out lake and afloat, or take hard ground",
            )
            dry = self.lake is None and self.afloat is None and self.ground == Ground()
            check.that(
                self.solved_flow is None or dry,
                "a flow that is solved together with the robot has neither surface nor ground, and the robot no weight "
                'in it: leave out lake, afloat and ground, or take water="sections"',
            )

    def _take_water(self) -> None:
        """Put the objects in the place of short forms, and the lake of sections where runs look for it."""
        if self.water == "sections":
            object.__setattr__(self, "water", Sections(lake=self.lake or Lake(level=2 * self.robot.length)))
        elif isinstance(self.water, str):
            if self.water not in FORMS:
                raise UnknownName("water", self.water, ("sections", *FORMS))
            object.__setattr__(self, "water", FORMS[self.water]())
        if isinstance(self.water, Sections):
            if self.lake not in (None, self.water.lake):
                raise InvalidDesign("run.lake and run.water are two different lakes; give one of the two.")
            object.__setattr__(self, "lake", self.water.lake)

    @property
    def solved_flow(self) -> Slice | Space | None:
        """The flow that is solved together with the robot, if any is."""
        return self.water if isinstance(self.water, Slice | Space) else None


def check_pushes(pushes: Sequence[Push], robot: Robot, duration: float) -> None:
    """Refuse pushes that cannot happen.

    Raises:
        UnknownName: the robot has no such body.
        InvalidDesign: a push does not end within the run.
    """
    if not pushes:
        return
    model = compile_model(robot)
    bodies = [model.body(i).name for i in range(1, model.nbody)]
    for push in pushes:
        if push.body not in bodies:
            raise UnknownName("body", push.body, bodies)
        if push.at + push.duration > duration + 1e-9:
            raise InvalidDesign(
                f"a push from {push.at:g} to {push.at + push.duration:g} s does not fit into a run of {duration:g} s: "
                "push earlier or shorter, or run longer."
            )
