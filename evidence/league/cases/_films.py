"""Long swimmers that were filmed from above: their wave with its whole envelope, and their bodies from drawings."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from scipy.interpolate import PchipInterpolator

from evidence.league import Given, Numbers
from evidence.league.cases._water import DENSITY, KnownSwim, form_of, fresh
from evidence.league.swims import ModelSwimmer, waters
from suchus.core.errors import InvalidDesign
from suchus.robot.design import Robot
from suchus.robot.design.drawing import Drawing
from suchus.robot.design.scale import swim_servo_for
from suchus.robot.motion import Gait
from suchus.swimming.water import fit


@dataclass(frozen=True, slots=True, kw_only=True)
class FilmedEnvelope:
    """A wave whose amplitude was filmed along the whole body: ``A(x) sin 2 pi (x / wave - f t)``, A by PCHIP."""

    length: float
    """Length of the body [m]."""
    frequency: float
    """Frequency of the wave [Hz]."""
    wavelength: float
    """Length of one whole wave [body length]."""
    positions: tuple[float, ...]
    """Where the amplitude was filmed, rising from 0 to 1 [body length]."""
    amplitudes: tuple[float, ...]
    """Half of the distance from side to side there [body length]."""

    def __post_init__(self) -> None:
        """Refuse an envelope that does not reach from snout to tail."""
        rising = all(a < b for a, b in zip(self.positions, self.positions[1:], strict=False))
        if not (rising and self.positions[:1] == (0.0,) and self.positions[-1:] == (1.0,)) or len(
            self.positions
        ) != len(self.amplitudes):
            raise InvalidDesign(
                f"an envelope has positions {self.positions} and {len(self.amplitudes)} amplitudes; positions rise "
                "from 0 to 1, with an amplitude for each."
            )

    @property
    def period(self) -> float:
        """Period of one cycle [s]."""
        return 1.0 / self.frequency

    def displacement(self, x: np.ndarray, time: np.ndarray) -> np.ndarray:
        """Return how far the midline lies off the axis [m]."""
        position = x / self.length
        phase = 2 * np.pi * (position / self.wavelength - self.frequency * time)
        return np.asarray(self.length * self._envelope()(position) * np.sin(phase))

    def slope(self, x: np.ndarray, time: np.ndarray) -> np.ndarray:
        """Return dy/dx [-]."""
        position, envelope = x / self.length, self._envelope()
        phase = 2 * np.pi * (position / self.wavelength - self.frequency * time)
        growth = envelope.derivative()(position) * np.sin(phase)
        return np.asarray(growth + envelope(position) * 2 * np.pi / self.wavelength * np.cos(phase))

    def _envelope(self) -> PchipInterpolator:
        return PchipInterpolator(self.positions, self.amplitudes)


@dataclass(frozen=True, slots=True, kw_only=True)
class LongBody:
    """Drawing of a long swimmer without limbs, its sections ellipses."""

    name: str
    """Name of the animal."""
    stations: tuple[float, ...]
    """Where it was measured, from the snout [body length]."""
    half_width: tuple[float, ...]
    """Half of the width there [body length]."""
    half_height: tuple[float, ...]
    """Half of the height there, fins included; at 1 that of the trailing edge [body length]."""
    joints: int = 14
    """Number of joints [-]."""

    def robot(self, length: float, wide: float, high: float, density: float, beat: float) -> Robot:
        """Return it at a length, of the density of its water or a little less.

        Args:
            length: [m].
            wide: factor on the drawn width [-].
            high: factor on the drawn height [-].
            density: mass over volume [kg/m3].
            beat: frequency for which the joints are stiff enough to follow the film [Hz].
        """
        half_width = tuple(wide * value for value in self.half_width)
        half_height = tuple(high * value for value in self.half_height)
        fine = np.linspace(0.0, 1.0, 401)
        area = np.pi * np.interp(fine, self.stations, half_width) * np.interp(fine, self.stations, half_height)
        mass = density * float(np.trapezoid(area, fine)) * length**3
        drawing = Drawing(
            name=self.name, length=length, mass=mass, density=density, stations=self.stations, half_width=half_width,
            half_height=half_height, joints=tuple(0.05 + 0.88 * i / (self.joints - 1) for i in range(self.joints)),
        )  # fmt: skip
        return drawing.robot(swim_servo_for(mass, length, beat))


@lru_cache(maxsize=256)
def _robot(body: LongBody, length: float, wide: float, high: float, density: float, beat: float) -> Robot:
    return body.robot(length, wide, high, density, beat)


@lru_cache(maxsize=256)
def _gait(robot: Robot, wave: FilmedEnvelope) -> Gait:
    return fit(robot, wave, name=f"{robot.name}_film", max_misfit=0.4).gait


@dataclass(frozen=True, slots=True, kw_only=True)
class FilmedSwim:
    """A long animal and the shape of its filmed wave."""

    body: LongBody
    """Drawing."""
    positions: tuple[float, ...]
    """Where its envelope was filmed [body length]."""
    shape: tuple[float, ...]
    """Amplitude there over that of the tail's tip [-]."""

    def motion(self, numbers: Numbers) -> tuple[Robot, Gait]:
        """Return body and gait.

        Args:
            numbers: ``length`` [m], ``frequency`` [Hz], ``wavelength`` and ``tail`` (from side to side) [body length],
                ``wide`` and ``high`` [-], ``density`` [kg/m3].
        """
        robot = _robot(
            self.body, numbers["length"], numbers["wide"], numbers["high"], 0.9995 * numbers["density"],
            1.5 * numbers["frequency"],
        )  # fmt: skip
        wave = FilmedEnvelope(
            length=numbers["length"], frequency=1.0, wavelength=numbers["wavelength"], positions=self.positions,
            amplitudes=tuple(0.5 * numbers["tail"] * value for value in self.shape),
        )  # fmt: skip
        return robot, replace(_gait(robot, wave), period=1.0 / numbers["frequency"])

    def swimmer(self, numbers: Numbers) -> ModelSwimmer:
        """Return the animal in its water.

        Args:
            numbers: those of ``motion`` and of ``cases._water.fresh``.
        """
        robot, gait = self.motion(numbers)
        return ModelSwimmer(
            robot=robot, gait=gait, water=waters(numbers), form=form_of(numbers), added_mass=numbers["added_mass"],
            ramp=1.0,
        )  # fmt: skip

    def water(self, given: Mapping[str, Given], viscosity: float = 1e-6) -> dict[str, Given]:
        """Return the numbers of its water.

        Args:
            given: numbers of body and wave.
            viscosity: kinematic [m2/s].
        """
        numbers = {name: number.value for name, number in given.items()} | {"density": DENSITY}
        robot, gait = self.motion(numbers)
        return fresh(
            KnownSwim(
                robot=robot, gait=gait, wavelength=numbers["wavelength"], swing=numbers["tail"], viscosity=viscosity
            )
        )


def filmed_swing(numbers: Numbers) -> float:
    """Return the filmed way of the tail's tip from side to side [m]."""
    return numbers["tail"] * numbers["length"]
