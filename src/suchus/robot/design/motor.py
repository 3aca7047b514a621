"""A servo as it is bought, and what of its motor acts in the physics: line of torque over speed, supply, heat."""

from dataclasses import dataclass
from math import inf, log1p

from suchus.core.checks import Checks
from suchus.core.sources import SHELVES, gather

COPPER = 0.0039
"""How much more a copper winding resists for each kelvin, as a part of it at ``ROOM_TEMPERATURE`` [1/K]."""
ROOM_TEMPERATURE = 25.0
"""Temperature at which data sheets hold, and of the air around a servo [degC]."""
SPECIFIC_HEAT = 700.0
"""Heat that a servo takes up for each kilogram [J/(kg K)].

No maker gives it: a servo is copper and steel (0.39 and 0.46 kJ/(kg K)), aluminium (0.9) and plastic (1.5). It says how
fast a servo gets warm, not how warm it gets.
"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Heat:
    """How a motor warms up: one body of one temperature, that gives its heat to the air."""

    resistance: float
    """Kelvin above the air for each watt that the winding turns into heat [K/W]."""
    capacity: float
    """Heat for each kelvin [J/K]."""
    limit: float
    """Temperature at which the servo should be switched off [degC]."""
    ambient: float = ROOM_TEMPERATURE
    """Temperature of the air around it, and of the servo at the beginning [degC]."""

    def __post_init__(self) -> None:
        with Checks("heat", self) as check:
            check.number("resistance", 1e-6, 1e6, "K/W")
            check.number("capacity", 1e-9, 1e9, "J/K")
            check.number("limit", -50.0, 500.0, "degC")
            check.number("ambient", -50.0, 100.0, "degC")
            check.that(self.limit > self.ambient, f"limit is {self.limit:g} degC, not above the air's {self.ambient:g}")

    def steady_temperature(self, loss: float) -> float:
        """Return the steady temperature of a servo at a constant loss [degC]; infinite for thermal runaway.

        Args:
            loss: what it would turn into heat with its winding at ``ROOM_TEMPERATURE`` [W].
        """
        cold = self.resistance * loss
        margin = 1.0 - COPPER * cold  # a warm winding resists more, which warms it further
        if margin <= 0.0:
            return float("inf")
        return self.ambient + cold * (1.0 + COPPER * (self.ambient - ROOM_TEMPERATURE)) / margin

    def time_to_limit(self, loss: float) -> float:
        """Return the time in which a cold servo reaches its temperature limit [s]; infinite if it never does.

        Args:
            loss: what it would turn into heat with its winding at ``ROOM_TEMPERATURE`` [W].
        """
        cold = loss * (1.0 + COPPER * (self.ambient - ROOM_TEMPERATURE))
        cools = (1.0 / self.resistance - COPPER * loss) * (
            self.limit - self.ambient
        )  # heat flow to the air at the limit [W]
        if cold <= cools:
            return inf
        time = self.capacity * (self.limit - self.ambient)
        return time / cold if abs(cools) < 1e-9 * cold else -time / cools * log1p(-cools / cold)


@dataclass(frozen=True, slots=True, kw_only=True)
class Winding:
    """The DC motor of a servo at a supply: what makes its torque fall with its speed, with the supply and with heat.

    The servo's ``torque`` is that at standstill and its ``speed`` that without load, both at ``volts`` and
    ``ROOM_TEMPERATURE``.
    """

    volts: float
    """Supply at which the servo's torque and speed hold [V]; both fall with it."""
    stall_current: float
    """Current at standstill and full torque, at that supply [A]; in between it goes with the torque."""
    idle_current: float = 0.0
    """Current that the servo takes without load [A]."""
    heat: Heat | None = None
    """How it warms up; None: it does not."""
    motor: str = ""
    """Name of the servo as it is bought, among the motors of suchus; empty for one of which nothing else is known."""

    def __post_init__(self) -> None:
        with Checks("winding", self) as check:
            check.number("volts", 0.1, 1000.0, "V")
            check.number("stall_current", 1e-6, 1e4, "A")
            check.number("idle_current", 0.0, 1e3, "A")

    @property
    def resistance(self) -> float:
        """Resistance of the winding at ``ROOM_TEMPERATURE`` [Ohm]."""
        return self.volts / self.stall_current


LINE = Winding(volts=1.0, stall_current=1.0)
"""A winding that gives the straight line of torque over speed and says nothing of supply, current and heat."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Motor:
    """A servo as it is bought: what its maker or who measured it says, each number with its source."""

    name: str
    """Name under which it is sold, with its supply where there are several."""
    maker: str
    """Who makes it."""
    family: str
    """Servos of one family hang on one bus and one supply, so that a robot can be built of them."""
    protocol: str
    """How it is spoken to, as ``dynamixel``, ``feetech`` or ``pwm``: a name among the protocols of servos."""
    model_number: int
    """Number that it answers for its model on its bus [-]; 0 where it has none."""
    volts: float
    """Supply at which the numbers hold [V]."""
    volts_range: tuple[float, float]
    """Least and greatest supply [V]."""
    stall_torque: float
    """Torque at standstill at ``volts`` [N m]."""
    no_load_speed: float
    """Speed without load at ``volts`` [rad/s]."""
    stall_current: float
    """Current at standstill at ``volts`` [A]."""
    idle_current: float
    """Current without load, electronics included [A]."""
    continuous_torque: float
    """Torque that it can give continuously [N m]: the maker's rated torque if there is one, else a share of stall."""
    temperature_limit: float
    """Temperature at which it switches off, or should be switched off [degC]."""
    play: float
    """Play of its gear, whole width [rad]; 0 where nobody says it."""
    steps: int
    """Steps of its angle in a whole turn [-]."""
    turn: float
    """How far it turns when it is told angles [rad]."""
    mass: float
    """Mass with its case [kg]."""
    size: tuple[float, float, float]
    """Length, width and height of its case [m]."""
    price: tuple[float, float]
    """Least and greatest price that was seen for one [EUR]."""
    protection: str = ""
    """Its protection against water as its maker says it, as IP68; empty for none."""
    sources: tuple[tuple[str, str], ...] = ()
    """Fields and where their numbers come from."""

    def __post_init__(self) -> None:
        with Checks(f"motor {self.name}", self) as check:
            check.that(bool(self.name), "a motor needs a name")
            check.choice("protocol", gather("protocol", SHELVES["protocols"]))  # by file names: nothing is imported
            check.whole("model_number", 0, 65535)
            check.number("volts", 0.1, 1000.0, "V")
            check.range("volts_range", 0.1, 1000.0, "V")
            check.number("stall_torque", 1e-6, 1e5, "N m")
            check.number("no_load_speed", 0.01, 1e4, "rad/s")
            check.number("stall_current", 1e-6, 1e4, "A")
            check.number("idle_current", 0.0, 1e3, "A")
            check.number("continuous_torque", 1e-9, 1e5, "N m")
            check.number("temperature_limit", 30.0, 300.0, "degC")
            check.number("play", 0.0, 1.0, "rad")
            check.whole("steps", 16, 2**24)
            check.number("turn", 0.1, 1e4, "rad")
            check.number("mass", 1e-5, 1e3, "kg")
            check.each("size", ("length", "width", "height"), 1e-4, 10.0, "m")
            check.each("price", ("least", "greatest"), 0.0, 1e6, "EUR")
            check.that(
                self.continuous_torque <= self.stall_torque,
                f"continuous_torque is {self.continuous_torque:g} N m, above stall_torque, {self.stall_torque:g} N m",
            )
            min_volts, max_volts = self.volts_range
            check.that(
                min_volts <= self.volts <= max_volts,
                f"volts is {self.volts:g} V, outside volts_range, {min_volts:g} to {max_volts:g} V",
            )

    def source(self, field: str) -> str:
        """Return the source of a number; empty if none is given."""
        return dict(self.sources).get(field, "")

    @property
    def unconfirmed_fields(self) -> tuple[str, ...]:
        """Fields whose numbers are from memory or a guess: to be confirmed before anybody buys by them."""
        return tuple(field for field, text in self.sources if text.startswith(("from memory", "a guess")))

    @property
    def heat(self) -> Heat:
        """Thermal model by which the servo stays at its temperature limit at continuous torque."""
        cold = self.volts * self.stall_current * (self.continuous_torque / self.stall_torque) ** 2
        hot = cold * (1.0 + COPPER * (self.temperature_limit - ROOM_TEMPERATURE))
        resistance = (self.temperature_limit - ROOM_TEMPERATURE) / hot
        return Heat(resistance=resistance, capacity=SPECIFIC_HEAT * self.mass, limit=self.temperature_limit)

    def winding(self, volts: float) -> Winding:
        """Return its winding at a supply [V].

        Raises:
            InvalidFields: the supply is not one that it bears.
        """
        with Checks(f"motor {self.name}", self) as check:
            min_volts, max_volts = self.volts_range
            check.that(
                min_volts <= volts <= max_volts,
                f"{volts:g} V is no supply for {self.name}; {min_volts:g} to {max_volts:g} V is allowed",
            )
        supply_ratio = volts / self.volts
        return Winding(
            volts=volts,
            stall_current=supply_ratio * self.stall_current,
            idle_current=self.idle_current,
            heat=self.heat,
            motor=self.name,
        )
