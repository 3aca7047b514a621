"""How does it swim: the pressure around the waving body, and the speed it reaches on its own?"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from suchus.design import Crocodile
from suchus.design.checks import Checks
from suchus.experiment import Experiment, Measure, Outcome, Progress, judge, silent, staged, stopwatch
from suchus.figures.swimming import draw_forces, draw_free, draw_pressure
from suchus.motion import Swim
from suchus.robots import ROBOTS
from suchus.water import Fit, Tether, fit, free_swim, printed_wave, swim, tether

_CONVEX, _SYMMETRIC = 0.0, 0.15  # a pressure difference counts from zero on; mirrored forces agree within 15 %
_ARMS = ("trunk and tail", "trunk only", "tail only", "as printed")


@dataclass(frozen=True, slots=True, kw_only=True)
class Swimming(Experiment):
    """The robot's own outline in a two-dimensional flow, its joints fitted to (20).

    Held, as the article's Fig. 17: the snout stays and the last of some cycles is measured. ``pressure_difference``
    is the mean pressure along the convex side of the tail less that along the concave side; which is which follows
    from the bend between the tail's root and its tip. Free: from rest, in a grid that travels along; the speed is the
    mean of the last cycle. Everything is per metre of depth.
    """

    title = "How does it swim?"
    shows = "Section IV.B, eq. (20), Fig. 17"
    claims = (
        "swim_pressure_convex",
        "swim_diagonal_force",
        "swim_pressure_falls",
        "swim_thrust_symmetric",
        "swim_s_shape",
        "swim_tail_thrust",
    )
    decides = (
        "The tail. It alone swims faster than trunk and tail together, and the trunk alone hardly at all. Running the "
        "wave as printed, from tail to head, costs a third of the speed but does not turn the body round, as drag "
        "along the body alone would have it: the tail sheds its wake behind it either way. The Reynolds number is that "
        "of the flow literature's eel, and the flow is a slice of unlimited depth: forces exceed a round body's."
    )

    robot: Crocodile = field(default_factory=lambda: ROBOTS["caiman"])
    """Who swims."""
    reading: str = "I"
    """Of (20), see ``kinematics.wave.READINGS``."""
    frequency: float = 1.0
    """Which the article does not give [Hz]."""
    reynolds: float = 7000.0
    """Frequency times length squared over viscosity [-]; the robot's own would be 1e6, beyond any affordable grid."""
    cells: int = 96
    """Cells per body length [-]."""
    coarse_cells: int = 64
    """The same where only a comparison is asked [-]."""
    cycles: int = 3
    """Of the held body; the last is measured [-]."""
    free_cycles: int = 8
    """Of the free body; the last is measured [-]."""
    waves: tuple[float, ...] = (2 / 3, 1.3)
    """Further waves per body whose speed is measured [-]; more than 1.4 ask the trunk for more than it has."""

    def __post_init__(self) -> None:
        with Checks("swimming", self) as check:
            check.number("frequency", 0.01, 20.0, "Hz")
            check.number("reynolds", 10.0, 2e4, "")
            check.whole("cells", 24, 1024)
            check.whole("coarse_cells", 24, 1024)
            check.whole("cycles", 2, 100)
            check.whole("free_cycles", 2, 100)

    def quick(self) -> "Swimming":
        """A coarse grid, a thick water, few cycles."""
        return replace(self, cells=32, coarse_cells=32, cycles=2, free_cycles=2, reynolds=1000.0, waves=(1.3,))

    def run(self, progress: Progress = silent) -> Outcome:
        """Swim."""
        with stopwatch() as seconds:
            ours, printed = (self._fit(sign=sign) for sign in (-1, 1))
            held = self._held(ours, self.cells, staged(progress, "held", 0.0, 0.3))
            back = self._held(printed, self.coarse_cells, staged(progress, "as printed", 0.3, 0.4))
            free = self._free(ours.swim, staged(progress, "free", 0.4, 0.55))
            arms = self._arms(ours.swim, printed.swim, free, staged(progress, "trunk and tail", 0.55, 0.85))
            waves = self._waves(staged(progress, "wavelengths", 0.85, 1.0))
            models = swim(self.robot, ours.swim)
            record = xr.merge(
                [_prefixed(held, "held"), _prefixed(back, "printed"), _prefixed(free, "free"), arms, waves],
                join="exact",
            )
            record["model_speed"] = models.speed
            record.attrs["misfit"] = ours.misfit
            return Outcome(
                experiment=self.name(),
                measures=self._measures(record),
                verdicts=self._verdicts(record),
                record=record,
                settings=self.settings(),
                seconds=seconds(),
            )

    @property
    def _viscosity(self) -> float:
        return self.frequency * self.robot.length**2 / self.reynolds

    def _fit(self, *, sign: int = -1, waves: float = 1.0) -> Fit:
        wave = printed_wave(self.robot, self.reading, frequency=self.frequency, sign=sign, waves_per_body=waves)
        return fit(self.robot, wave, name=f"(20), reading {self.reading}")

    def _held(self, fitted: Fit, cells: int, progress: Callable[[float], None]) -> xr.Dataset:
        held = Tether(cells=cells, viscosity=self._viscosity, cycles=self.cycles)
        return tether(self.robot, fitted.swim, held, turn=fitted.head, progress=progress)

    def _free(self, motion: Swim, progress: Callable[[float], None]) -> xr.Dataset:
        setting = Tether(cells=self.coarse_cells, viscosity=self._viscosity, cycles=self.free_cycles)
        return free_swim(self.robot, motion, setting, progress=progress)

    def _arms(self, motion: Swim, printed: Swim, both: xr.Dataset, progress: Callable[[float], None]) -> xr.Dataset:
        speeds = [both.speed.values]
        for i, some in enumerate((motion.trunk_only(), motion.tail_only(), printed)):
            speeds.append(self._free(some, _part(progress, i, 3)).speed.values)
        data = xr.Dataset({"arm_speed": (("arm", "cycle"), np.array(speeds), {"units": "m/s"})})
        return data.assign_coords(arm=list(_ARMS), cycle=np.arange(1, self.free_cycles + 1))

    def _waves(self, progress: Callable[[float], None]) -> xr.Dataset:
        speeds, misfits = [], []
        for i, waves in enumerate(self.waves):
            fitted = self._fit(waves=waves)
            speeds.append(float(self._free(fitted.swim, _part(progress, i, len(self.waves))).speed[-1]))
            misfits.append(fitted.misfit)
        data = xr.Dataset(
            {
                "speed_by_waves": ("waves", speeds, {"units": "m/s"}),
                "misfit_by_waves": ("waves", misfits, {"units": "1"}),
            },
            coords={"waves": list(self.waves)},
        )
        data.waves.attrs["units"] = "1"
        return data

    def _measures(self, record: xr.Dataset) -> Mapping[str, Measure]:
        length, speed = self.robot.length, float(record.free_speed[-1])
        tip = float(np.ptp(_level(record.free_tail_y.values)))
        arms = record.arm_speed.isel(cycle=-1)
        measures = {
            "misfit": Measure(float(record.attrs["misfit"]), "-"),
            "thrust_mean_head_to_tail": Measure(float(record.held_thrust.mean()), "N/m"),
            "thrust_mean_as_printed": Measure(float(record.printed_thrust.mean()), "N/m"),
            "convex_higher_share": Measure(_convex_higher(record), "-"),
            "power_held": Measure(float(record.held_power.mean()), "W/m"),
            "force_noise": Measure(float(record.held_noise), "-"),
            "thin_share": Measure(float(record.held_thin), "-"),
            "speed_free": Measure(speed, "m/s"),
            "speed_free_lengths": Measure(speed / length, "1/s"),
            "speed_free_gain_last_cycle": Measure(float(record.free_speed[-1] / record.free_speed[-2] - 1), "-"),
            "slip": Measure(speed / float(record.free_wave_speed), "-"),
            "strouhal": Measure(self.frequency * tip / speed, "-"),
            "cost_of_transport": Measure(float(record.free_power[-1]) / (float(record.free_weight) * speed), "-"),
            "head_yaw": Measure(float(np.ptp(record.free_heading.values)) / 2, "rad"),
        }
        for arm in _ARMS:
            measures[f"speed_{arm.replace(' ', '_')}"] = Measure(float(arms.sel(arm=arm)), "m/s")
        for i, waves in enumerate(self.waves):
            measures[f"speed_waves_{waves:.2f}".replace(".", "_")] = Measure(float(record.speed_by_waves[i]), "m/s")
        for model in record.model.values:
            measures[f"speed_{model}"] = Measure(float(record.model_speed.sel(model=model)), "m/s")
        for joint in record.joint.values:
            peak = float(abs(record.held_joint_torque.sel(joint=joint)).max())
            measures[f"joint_torque_peak_{joint}"] = Measure(peak, "N m/m")
        for i, instant in enumerate(("1", "2", "3", "4")):
            measures[f"pressure_difference_{instant}_quarter"] = Measure(float(record.held_difference[i]), "Pa")
        return measures

    def _verdicts(self, record: xr.Dataset) -> tuple[Any, ...]:
        said = _Quarters.of(record)
        track = _level(record.free_snout_y.values)
        crossings = int(np.sum(np.diff(np.sign(track)) != 0))
        arms = record.arm_speed.isel(cycle=-1)
        return (
            judge(
                "swim_pressure_convex",
                said.difference[0],
                "Mean pressure along the convex side of the tail less that along the concave side, at T/4 of (20); the "
                f"convex side has the higher one in {100 * _convex_higher(record):.0f} % of the cycle.",
                holds=said.difference[0] > _CONVEX,
            ),
            judge(
                "swim_diagonal_force",
                said.thrust[0],
                f"At T/4 the force is {said.thrust[0]:.1f} N/m forward and {said.aside[0]:.1f} N/m to the side; "
                "diagonal is where neither is below a tenth of the other.",
                holds=said.thrust[0] > 0.1 * abs(said.aside[0]) and abs(said.aside[0]) > 0.1 * said.thrust[0],
            ),
            judge(
                "swim_pressure_falls",
                said.difference[1] - said.difference[0],
                "Size of the pressure difference at T/2 against that at T/4.",
                holds=abs(said.difference[1]) < abs(said.difference[0]),
            ),
            judge(
                "swim_thrust_symmetric",
                said.thrust[2],
                f"Half a cycle apart the forces forward are {said.thrust[0]:.1f} and {said.thrust[2]:.1f} N/m, to the "
                f"side {said.aside[0]:.1f} and {said.aside[2]:.1f} N/m.",
                holds=said.mirrored,
            ),
            judge(
                "swim_s_shape",
                float(np.ptp(track)),
                f"In the last two cycles the snout crosses its own mean line {crossings} times.",
                holds=crossings >= 3,
            ),
            judge(
                "swim_tail_thrust",
                float(arms.sel(arm=_ARMS[2]) / arms.sel(arm=_ARMS[0])),
                f"With the limbs folded, trunk and tail together reach {float(arms[0]):.2f} m/s, the trunk alone "
                f"{float(arms[1]):.2f} and the tail alone {float(arms[2]):.2f} m/s.",
                holds=float(arms[0]) > 0 and float(arms[2]) > float(arms[1]),
            ),
        )

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw the pressure, the forces, the free swim."""
        record = outcome.record
        return {
            "swimming_pressure": draw_pressure(record),
            "swimming_forces": draw_forces(record),
            "swimming_free": draw_free(record),
        }


def _level(track: np.ndarray) -> np.ndarray:
    """Return a track less its mean line."""
    count = np.arange(track.size)
    return np.asarray(track - np.polyval(np.polyfit(count, track, 1), count))


def _convex_higher(record: xr.Dataset) -> float:
    return float((record.held_difference_over_cycle > 0).mean())


def _part(progress: Callable[[float], None], number: int, count: int) -> Callable[[float], None]:
    return lambda share: progress((number + share) / count)


class _Quarters(NamedTuple):
    """What Fig. 17 shows at T/4, T/2, 3T/4 and T."""

    difference: list[float]
    thrust: list[float]
    aside: list[float]

    @classmethod
    def of(cls, record: xr.Dataset) -> "_Quarters":
        quarters = [(i + 1) / 4 for i in range(4)]
        thrust, aside = (record[f"held_{name}"].interp(held_phase=quarters).values for name in ("thrust", "aside"))
        return cls(record.held_difference.values.tolist(), thrust.tolist(), aside.tolist())

    @property
    def mirrored(self) -> bool:
        size = max(abs(self.thrust[0]), abs(self.aside[0]))
        return (
            abs(self.thrust[0] - self.thrust[2]) < _SYMMETRIC * size
            and abs(self.aside[0] + self.aside[2]) < _SYMMETRIC * size
        )


def _prefixed(record: xr.Dataset, name: str) -> xr.Dataset:
    kept = {"joint", "instant"} if name == "held" else {"joint"}
    if name == "printed":
        record = record[["thrust", "aside", "power"]].drop_vars(["joint", "instant"], errors="ignore")
    names = {str(old): f"{name}_{old}" for old in record.variables if str(old) not in kept}
    return record.rename(names | {str(d): f"{name}_{d}" for d in record.dims if str(d) not in record.variables})


experiment = Swimming()
