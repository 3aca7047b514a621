"""Ground: how it tilts, what stands up from it, how much friction it has, and how a body's surfaces meet it."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from math import radians
from types import MappingProxyType

import numpy as np
from jaxtyping import Float
from scipy.ndimage import gaussian_filter, map_coordinates

from suchus.core.checks import Checks
from suchus.core.rotation import from_axis_angle, multiply

REACH = (-1.0, 6.0)
"""Along which relief extends, from the hips of a robot at the start [m]."""
HALF_WIDTH = 1.4
"""How far it extends to either side [m]; beyond it the ground is even."""
CELL = 0.025
"""Distance between the points of a height field [m]; about the size of a foot."""
_RAMP = 0.15  # [m]; over which bumps grow from nothing
_MIN_SIZE = 1e-5  # [m]; of heights, lengths and widths
_OUTER = (0.02, 0.98)  # quantiles between which the height of a field is measured


@dataclass(frozen=True, slots=True, kw_only=True)
class Step:
    """A single step up across the path; the ground stays high behind it."""

    at: float
    """Position of its edge, ahead of the hips at the start [m]."""
    height: float
    """[m]."""

    def __post_init__(self) -> None:
        with Checks("step", self) as checks:
            checks.number("at", *REACH, "m")
            checks.number("height", _MIN_SIZE, 0.5, "m")


@dataclass(frozen=True, slots=True, kw_only=True)
class Stone:
    """A block in the path."""

    at: float
    """Position of its middle, ahead of the hips at the start [m]."""
    aside: float
    """Position of its middle, to the left of the hips at the start [m]."""
    height: float
    """[m]."""
    length: float
    """Length along the path [m]."""
    width: float
    """Across it [m]."""

    def __post_init__(self) -> None:
        with Checks("stone", self) as checks:
            checks.number("at", *REACH, "m")
            checks.number("aside", -HALF_WIDTH, HALF_WIDTH, "m")
            checks.number("height", _MIN_SIZE, 0.5, "m")
            checks.number("length", _MIN_SIZE, 1.0, "m")
            checks.number("width", _MIN_SIZE, 1.0, "m")


@dataclass(frozen=True, slots=True, kw_only=True)
class Bumps:
    """A field of random bumps ahead of even ground: smoothed noise."""

    height: float
    """Height from low to high: between them lie 96 % of the field [m]."""
    correlation: float
    """Distance over which heights lose their correlation, to 1/e [m]."""
    start: float
    """Position at which the field begins, ahead of the hips at the start [m]."""
    seed: int
    """Seed of the noise."""
    scale: float = 1.0
    """Factor on the extent of the field, on the distance of its points and on the ramp before it [-]; for robots much
    smaller or larger than the article's."""

    @property
    def reach(self) -> tuple[float, float]:
        """Along which it extends, from the hips of a robot at the start [m]."""
        return REACH[0] * self.scale, REACH[1] * self.scale

    @property
    def half_width(self) -> float:
        """Half-width, to either side [m]."""
        return HALF_WIDTH * self.scale

    @property
    def cell(self) -> float:
        """Between its points [m]."""
        return CELL * self.scale

    def __post_init__(self) -> None:
        with Checks("bumps", self) as checks:
            checks.number("height", _MIN_SIZE, 0.5, "m")
            checks.number("scale", 1e-3, 100.0, "")
            checks.number("correlation", CELL * self.scale, 1.0 * self.scale, "m")
            checks.number("start", *self.reach, "m")
            checks.whole("seed", 0, 2**32 - 1)


Relief = Step | Stone | Bumps
"""Anything that rises above even ground."""


@lru_cache(maxsize=64)
def field(bumps: Bumps) -> Float[np.ndarray, "across along"]:
    """Return the heights of a field of bumps on a grid of its cells from the right rear corner on [m].

    Smoothing white noise with a Gaussian of half the correlation length leaves a correlation of 1/e at that length.
    """
    lateral_cells, axial_cells = round(2 * HALF_WIDTH / CELL) + 1, round((REACH[1] - REACH[0]) / CELL) + 1
    noise = np.random.default_rng(bumps.seed).standard_normal((lateral_cells, axial_cells))
    smooth = gaussian_filter(noise, bumps.correlation / 2 / bumps.cell, mode="wrap")
    lower_quantile, upper_quantile = np.quantile(smooth, _OUTER)
    distance = bumps.reach[0] + bumps.cell * np.arange(axial_cells) - bumps.start
    ramp = np.clip(distance / (_RAMP * bumps.scale), 0.0, 1.0)
    heights = np.asarray(
        (smooth - (lower_quantile + upper_quantile) / 2) / (upper_quantile - lower_quantile) * bumps.height * ramp
    )
    heights.flags.writeable = False
    return heights


def heights(relief: Relief | None, x: Float[np.ndarray, "*b"], y: Float[np.ndarray, "*b"]) -> Float[np.ndarray, "*b"]:
    """Return the height of the ground anywhere [m].

    Args:
        relief: None for even ground.
        x: ahead of the hips at the start [m].
        y: to the left of them [m].
    """
    if isinstance(relief, Step):
        return np.where((x >= relief.at) & (x <= REACH[1]) & (np.abs(y) <= HALF_WIDTH), relief.height, 0.0)
    if isinstance(relief, Stone):
        is_on_stone = (np.abs(x - relief.at) <= relief.length / 2) & (np.abs(y - relief.aside) <= relief.width / 2)
        return np.where(is_on_stone, relief.height, 0.0)
    if isinstance(relief, Bumps):
        grid = field(relief)
        grid_index = np.stack([(y + relief.half_width) / relief.cell, (x - relief.reach[0]) / relief.cell])
        return np.asarray(map_coordinates(grid, grid_index, order=1, cval=float(grid.min())))
    return np.zeros_like(x)


def profile(relief: Relief | None, x: Float[np.ndarray, "*b"]) -> Float[np.ndarray, "*b"]:
    """Return the height of the ground along the line on which a robot starts [m].

    Args:
        relief: None for even ground.
        x: ahead of the hips at the start [m].
    """
    return heights(relief, x, np.zeros_like(x))


@dataclass(frozen=True, slots=True, kw_only=True)
class Contact:
    """Coulomb friction and softness of the robot's surfaces; the ground adds nothing of its own."""

    foot_friction: float
    """Friction coefficient of the feet [-]."""
    skin_friction: float
    """Friction coefficient of belly, head and tail [-]."""
    time_constant: float
    """Time constant of the correction of penetration, MuJoCo's ``solref[0]`` [s]."""
    torsion: float = 0.005
    """Torsional friction over the sliding one [m]; 5 thousandths of a body length."""
    rolling: float = 0.0001
    """Rolling friction over the sliding one [m]; a ten-thousandth of a body length."""
    depth: float = 0.001
    """Penetration over which the contact stiffens, MuJoCo's ``solimp[2]`` [m]; a thousandth of a body length."""

    def __post_init__(self) -> None:
        with Checks("contact", self) as check:
            check.number("foot_friction", 0.01, 3.0, "")
            check.number("skin_friction", 0.01, 3.0, "")
            check.number("time_constant", 1e-4, 1.0, "s")
            for field in ("torsion", "rolling", "depth"):
                check.number(field, 0.0, 1.0, "m")


@dataclass(frozen=True, slots=True, kw_only=True)
class Grains:
    """Dry grains in which feet, belly and tail sink, by resistive force theory; ``sim.hydro.plates`` has the law.

    Grains hold by their strength, which grows with depth, and do not spring back. Level ground only; the grains are
    deep, and do not remember where a foot has been.
    """

    strength: float = 0.254e6
    """Vertical stress over depth on a level plate that moves down [N/m3]: 0.254e6 in loosely packed poppy seeds,
    0.464e6 in closely packed ones (Li, Zhang and Goldman, Science 339, 1408, 2013, supplementary material)."""
    creep_speed: float = 1e-3
    """Speed of a part far below which the grains resist in proportion to it [m/s]: a resting foot sinks that slowly."""

    def __post_init__(self) -> None:
        with Checks("grains", self) as check:
            check.number("strength", 1e3, 1e9, "N/m3")
            check.number("creep_speed", 1e-9, 1.0, "m/s")


@dataclass(frozen=True, slots=True, kw_only=True)
class Ground:
    """Ground: even or with relief, possibly tilted, or of grains."""

    friction_scale: float = 1.0
    """Factor on the friction coefficients of all the robot's surfaces, and on the strength of grains [-], 0.01 to
    10."""
    uphill: float = 0.0
    """Slope along the walk, up positive [rad], -1 to 1."""
    sideways: float = 0.0
    """Slope across the walk, left side up positive [rad], -1 to 1."""
    relief: Relief | None = None
    """Step, stone or bumps on it; None where it is even."""
    grains: Grains | None = None
    """Grains in which the robot sinks; None where the ground is hard."""

    def __post_init__(self) -> None:
        with Checks("ground", self) as check:
            check.number("friction_scale", 0.01, 10.0, "")
            check.number("uphill", -1.0, 1.0, "rad")
            check.number("sideways", -1.0, 1.0, "rad")
            check.that(
                self.grains is None or (self.relief is None and self.uphill == 0.0 and self.sideways == 0.0),
                "ground.grains are level and even, as the measurements behind them: leave out uphill, sideways and "
                "relief, or grains",
            )

    @property
    def strength(self) -> float:
        """Strength of the grains with the factor on friction [N/m3]; 0 where the ground is hard."""
        return 0.0 if self.grains is None else self.friction_scale * self.grains.strength

    def looks_like(self, ground: "Ground") -> bool:
        """Return whether another ground has the same slopes and relief, whatever its friction."""
        return (self.uphill, self.sideways, self.relief) == (ground.uphill, ground.sideways, ground.relief)


def slope(uphill: float, sideways: float) -> Float[np.ndarray, "4"]:
    """Return the orientation wxyz in which a ground with these slopes is seen, gravity pointing down.

    Args:
        uphill: along the walk, up positive [rad].
        sideways: left side up positive [rad].
    """
    pitch_rotation = from_axis_angle(np.array([0.0, 1.0, 0.0]), -uphill)
    roll_rotation = from_axis_angle(np.array([1.0, 0.0, 0.0]), sideways)
    return multiply(pitch_rotation, roll_rotation)


BUMPS_START = 0.42
"""Where bumps begin, ahead of the hips at the start [m]: just ahead of the front feet."""
STONE = Stone(at=0.75, aside=0.0, height=0.05, length=0.06, width=0.05)
"""A stone that fits between the feet."""

ARENAS: Mapping[str, Ground] = MappingProxyType(
    {
        "flat": Ground(),
        "uphill": Ground(uphill=radians(10)),
        "downhill": Ground(uphill=radians(-10)),
        "sideways": Ground(sideways=radians(10)),
        "step": Ground(relief=Step(at=0.66, height=0.02)),
        "stone": Ground(relief=STONE),
        "bumps": Ground(relief=Bumps(height=0.03, correlation=0.06, start=BUMPS_START, seed=0)),
        "sand": Ground(grains=Grains()),
    }
)
"""Grounds by name; vary one with ``dataclasses.replace``."""
