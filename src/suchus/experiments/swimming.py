"""How does it swim: the pressure around the waving body, and the speed it reaches on its own?"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from suchus.design import Crocodile
from suchus.design.checks import Checks
from suchus.experiment import Experiment, Measure, Outcome, Progress, Verdict, judge, silent, staged, stopwatch
from suchus.figures.swimming import draw_forces, draw_free, draw_quarters, draw_sides, film_pressure, film_vorticity
from suchus.robots import ROBOTS
from suchus.water import (
    ExactWave,
    Fit,
    Motion,
    Quarters,
    Swum,
    Tether,
    attempts,
    convex_higher,
    crossings,
    efficiency,
    fit,
    free_swim,
    level,
    printed_wave,
    readings_table,
    swim,
    tether,
    towed,
)

_ARMS = ("trunk and tail", "trunk only", "tail only", "as printed", "exact wave", "exact wave as printed")


@dataclass(frozen=True, slots=True, kw_only=True)
class Swimming(Experiment):
    """The robot's own outline in a two-dimensional flow, its joints fitted to (20).

    Held, as the article's Fig. 17: the snout stays and the last of some cycles is measured. ``pressure_difference`` is
    the mean pressure along the convex side of the tail less that along the concave side; which side is convex follows
    from the bend between the tail's root and its tip. The difference falls if its size at T/2 is below that at T/4; it
    moves by ``pressure_moves`` tail lengths towards the tip, the place being the mean along the tail weighted with the
    size of the difference. The thrust is symmetric if the forces at T/4 and 3T/4, left and right swapped, differ by
    less than 15 % of the greater part of the force (``thrust_asymmetry``). Free: from rest, in a grid that travels
    along; the speed is the mean of the last cycle, ``efficiency`` the power that towing the straight body at that speed
    takes over the power of the joints. An S-shaped track crosses its mean line at least three times in two cycles.
    Trunk, tail, and the wave that the midline follows exactly are compared after ``arm_cycles``. Other readings of
    (20) are held in a thicker water, at ``readings_reynolds``. Everything is per metre of depth.
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
        "The tail. It alone swims a little faster than trunk and tail together, and the trunk alone hardly at all. Run "
        "as printed, from tail to head, the wave itself gets nearly nowhere: drag along the body pulls it tail first, "
        "and the growing swing of the tail, which sheds its wake behind it either way, pushes it head first. The few "
        "joints make most of the wave a flapping of the tail, so the robot still goes head first, more slowly. The "
        "article's pressures do not come out in water that stays around the held body. The tail is thin for the grid, "
        "and finer grids swim faster. The Reynolds number is that of the flow literature's eel, the flow a slice of "
        "unlimited depth: forces exceed a round body's."
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
    """Cells per body length of the held body [-]."""
    coarse_cells: int = 64
    """The same of free bodies [-]."""
    cycles: int = 3
    """Of the held body; the last is measured [-]."""
    free_cycles: int = 8
    """Of the free body; the last is measured [-]."""
    arm_cycles: int = 6
    """After which trunk, tail and exact wave are compared [-]."""
    readings: tuple[str, ...] = ("A", "C", "F", "H", "K")
    """Further readings of (20) whose thrust is measured [-]; the joints cannot make the others."""
    readings_reynolds: float = 1000.0
    """Reynolds number of these [-]; their tails are up to four times as fast and would need a finer grid."""
    readings_cells: int = 32
    """Cells per body length of these [-]."""
    frames: int = 20
    """Of the films, over one cycle [-]."""
    keep: str = ""
    """Folder for what is finished of an interrupted run, from which it goes on; empty keeps nothing."""

    def __post_init__(self) -> None:
        with Checks("swimming", self) as check:
            check.number("frequency", 0.01, 20.0, "Hz")
            check.number("reynolds", 10.0, 2e4, "")
            check.number("readings_reynolds", 10.0, 2e4, "")
            for name in ("cells", "coarse_cells", "readings_cells"):
                check.whole(name, 32, 1024)
            check.whole("frames", 1, 200)
            for name in ("cycles", "free_cycles", "arm_cycles"):
                check.whole(name, 2, 100)

    def quick(self) -> "Swimming":
        """A coarse grid, a thick water, few cycles."""
        return replace(
            self, cells=32, coarse_cells=32, cycles=2, free_cycles=2, arm_cycles=2, reynolds=1000.0, readings=("H",),
            readings_cells=32, frames=4,
        )  # fmt: skip

    def run(self, progress: Progress = silent) -> Outcome:
        """Swim."""
        with stopwatch() as seconds:
            ours, printed = (self._fit(sign) for sign in (-1, 1))
            held = self._held("ours", ours, self.cells, staged(progress, "held", 0.0, 0.15))
            back = self._held("as printed", printed, self.coarse_cells, staged(progress, "as printed", 0.15, 0.2))
            free = self._free("trunk and tail", ours.swim, staged(progress, "free", 0.2, 0.4))
            arms = self._arms(ours, printed, free, staged(progress, "trunk and tail apart", 0.4, 0.9))
            readings, table = self._readings(staged(progress, "readings of (20)", 0.9, 0.95))
            drag = self._drag(float(free.speed[-1]), staged(progress, "towed", 0.95, 1.0))
            models = swim(self.robot, ours.swim)
            record = xr.merge(
                [
                    _prefixed(held, "held"),
                    _prefixed(back[["thrust", "aside", "power"]], "printed"),
                    _prefixed(free, "free"),
                    arms,
                    readings,
                ],
                join="exact",
            )
            record["model_speed"] = models.speed
            record["towed_drag"] = ((), drag, {"units": "N/m"})
            record.attrs["misfit"] = ours.misfit
            progress("films", 1.0)
            films = {"swimming_vorticity.gif": film_vorticity(record), "swimming_pressure.gif": film_pressure(record)}
            self._forget()
            return Outcome(
                experiment=self.name(),
                measures=self._measures(held, back, free, record),
                verdicts=self._verdicts(held, free, arms),
                record=record,
                settings=self.settings(),
                tables={"readings.md": table},
                films=films,
                seconds=seconds(),
            )

    def _setting(self, cells: int, cycles: int, reynolds: float | None = None) -> Tether:
        viscosity = self.frequency * self.robot.length**2 / (reynolds or self.reynolds)
        return Tether(cells=cells, viscosity=viscosity, cycles=cycles, frames=self.frames)

    def _fit(self, sign: int) -> Fit:
        wave = printed_wave(self.robot, self.reading, frequency=self.frequency, sign=sign)
        return fit(self.robot, wave, name=f"(20), reading {self.reading}")

    def _kept(self, name: str) -> Path | None:
        return Path(self.keep) / f"{name.replace(' ', '_')}.npz" if self.keep else None

    def _forget(self) -> None:
        """Remove what was kept: everything is finished."""
        for path in Path(self.keep).glob("*.npz*") if self.keep else ():
            path.unlink()

    def _held(self, name: str, fitted: Fit, cells: int, progress: Callable[[float], None]) -> xr.Dataset:
        kept, setting = self._kept(f"held {name}"), self._setting(cells, self.cycles)
        return tether(self.robot, fitted.swim, setting, turn=fitted.head, checkpoint=kept, progress=progress)

    def _free(self, arm: str, motion: Motion, progress: Callable[[float], None], cycles: int = 0) -> xr.Dataset:
        setting = self._setting(self.coarse_cells, cycles or self.free_cycles)
        return free_swim(self.robot, motion, setting, checkpoint=self._kept(f"free {arm}"), progress=progress)

    def _arms(self, ours: Fit, printed: Fit, both: xr.Dataset, progress: Callable[[float], None]) -> xr.Dataset:
        exact = [
            ExactWave(name=name, wave=printed_wave(self.robot, self.reading, frequency=self.frequency, sign=sign))
            for name, sign in zip(_ARMS[4:], (-1, 1), strict=True)
        ]
        motions: tuple[Motion, ...] = (ours.swim.trunk_only(), ours.swim.tail_only(), printed.swim, *exact)
        speeds = np.full((len(_ARMS), self.free_cycles), np.nan)
        speeds[0] = both.speed
        for i, motion in enumerate(motions):
            swum = self._free(_ARMS[i + 1], motion, _part(progress, i, len(motions)), self.arm_cycles)
            speeds[i + 1, : self.arm_cycles] = swum.speed.values[: self.free_cycles]
        data = xr.Dataset({"arm_speed": (("arm", "cycle"), speeds, {"units": "m/s"})})
        return data.assign_coords(arm=list(_ARMS), cycle=np.arange(1, self.free_cycles + 1))

    def _readings(self, progress: Callable[[float], None]) -> tuple[xr.Dataset, str]:
        """Return the mean thrust of further readings, and a table of all of them."""
        tried = {one.letter: one for one in attempts(self.robot, frequency=self.frequency)}
        setting, thrust = self._setting(self.readings_cells, self.cycles, self.readings_reynolds), []
        for i, letter in enumerate(self.readings):
            fitted, part = tried[letter].fitted, _part(progress, i, len(self.readings))
            held = None if fitted is None else tether(self.robot, fitted.swim, setting, turn=fitted.head, progress=part)
            thrust.append(float("nan") if held is None else float(held.thrust.mean()))
        told = {
            letter: f"{value:.1f} N/m at Re {self.readings_reynolds:.0f}"
            for letter, value in zip(self.readings, thrust, strict=True)
        }
        data = xr.Dataset({"reading_thrust": ("reading", thrust, {"units": "N/m"})})
        return data.assign_coords(reading=list(self.readings)), readings_table(tried.values(), told)

    def _drag(self, speed: float, progress: Callable[[float], None]) -> float:
        progress(0.0)
        return towed(self.robot, max(abs(speed), 0.02 * self.robot.length), self._setting(self.coarse_cells, 1))

    def _measures(
        self, held: xr.Dataset, back: xr.Dataset, free: xr.Dataset, record: xr.Dataset
    ) -> Mapping[str, Measure]:
        swum, quarters = Swum.of(free, self.frequency), Quarters.of(held)
        found = {
            "misfit": Measure(float(record.attrs["misfit"]), "-"),
            f"thrust_mean_{self.reading}": Measure(float(held.thrust.mean()), "N/m"),
            "thrust_mean_as_printed": Measure(float(back.thrust.mean()), "N/m"),
            **{f"thrust_mean_{r}": Measure(float(record.reading_thrust.sel(reading=r)), "N/m") for r in self.readings},
            "convex_higher_share": Measure(convex_higher(held), "-"),
            "pressure_moves": Measure(quarters.moves, "-"),
            "thrust_asymmetry": Measure(quarters.asymmetry, "-"),
            "power_held": Measure(float(held.power.mean()), "W/m"),
            "force_noise": Measure(float(held.noise), "-"),
            "thin_share": Measure(float(held["thin"]), "-"),
            "speed_free": Measure(swum.speed, "m/s"),
            "speed_free_lengths": Measure(swum.speed / self.robot.length, "1/s"),
            "speed_free_gain_last_cycle": Measure(swum.gain, "-"),
            "slip": Measure(swum.slip, "-"),
            "strouhal": Measure(swum.strouhal, "-"),
            "efficiency": Measure(efficiency(float(record.towed_drag), swum.speed, float(free.power[-1])), "-"),
            "cost_of_transport": Measure(swum.cost_of_transport, "-"),
            "head_yaw": Measure(swum.head_yaw, "rad"),
        }
        arms = _compared(record, self.arm_cycles)
        found |= {f"speed_{arm.replace(' ', '_')}": Measure(float(arms.sel(arm=arm)), "m/s") for arm in _ARMS}
        for model in record.model.values:
            found[f"speed_{model}"] = Measure(float(record.model_speed.sel(model=model)), "m/s")
        for joint in held.joint.values:
            peak = float(abs(held.joint_torque.sel(joint=joint)).max())
            found[f"joint_torque_peak_{joint}"] = Measure(peak, "N m/m")
        for i in range(4):
            found[f"pressure_difference_{i + 1}_quarter"] = Measure(quarters.difference[i], "Pa")
        return found

    def _verdicts(self, held: xr.Dataset, free: xr.Dataset, arms: xr.Dataset) -> tuple[Verdict, ...]:
        said, crossed, speeds = Quarters.of(held), crossings(free), _compared(arms, self.arm_cycles)
        both, trunk, tail = (float(speeds.sel(arm=arm)) for arm in _ARMS[:3])
        return (
            judge(
                "swim_pressure_convex",
                said.difference[0],
                "Mean pressure along the convex side of the tail less that along the concave side, at T/4 of (20); the "
                f"convex side has the higher one in {100 * convex_higher(held):.0f} % of the cycle.",
                holds=said.convex,
            ),
            judge(
                "swim_diagonal_force",
                said.thrust[0],
                f"At T/4 the force is {said.thrust[0]:.1f} N/m forward and {said.aside[0]:.1f} N/m to the side; "
                "diagonal is where neither is below a tenth of the other.",
                holds=said.diagonal,
            ),
            judge(
                "swim_pressure_falls",
                said.difference[1] - said.difference[0],
                f"Size of the pressure difference at T/2 against that at T/4: {abs(said.difference[1]):.0f} against "
                f"{abs(said.difference[0]):.0f} Pa. Its place moves by {said.moves:+.2f} tail lengths to the tip.",
                holds=said.falls,
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
                float(np.ptp(level(free.snout_y.values))),
                f"In the last two cycles the snout crosses its own mean line {crossed} times.",
                holds=crossed >= 3,
            ),
            judge(
                "swim_tail_thrust",
                tail / both,
                f"With the limbs folded, trunk and tail together reach {both:.2f} m/s in {self.arm_cycles} cycles, the "
                f"trunk alone {trunk:.2f} and the tail alone {tail:.2f} m/s.",
                holds=both > 0 and tail > trunk,
            ),
        )

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw the fields, the two sides of the tail, the forces, the free swim."""
        record = outcome.record
        return {
            "swimming_pressure": draw_quarters(record),
            "swimming_sides": draw_sides(record),
            "swimming_forces": draw_forces(record),
            "swimming_free": draw_free(record),
        }


def _part(progress: Callable[[float], None], number: int, count: int) -> Callable[[float], None]:
    return lambda share: progress((number + share) / count)


def _compared(record: xr.Dataset, cycle: int) -> xr.DataArray:
    """Return the speed of each arm in the cycle in which they are compared."""
    return record.arm_speed.sel(cycle=min(cycle, int(record.cycle[-1])))


def _prefixed(record: xr.Dataset, name: str) -> xr.Dataset:
    """Return a record whose variables and dimensions carry the name of the swim."""
    record = record.drop_vars([str(c) for c in record.coords if str(c) == "cycle"])
    names = {str(old): f"{name}_{old}" for old in {*record.variables, *record.dims} if old not in ("joint", "cycle")}
    return record.rename(names)


experiment = Swimming()
