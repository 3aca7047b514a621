"""When do the feet stand, and which way do spine and tail bend meanwhile?"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

import numpy as np
import xarray as xr

from suchus import blueprint
from suchus.design import LEGS, Crocodile
from suchus.design.checks import Checks
from suchus.experiment import Experiment, Measure, Outcome, Progress, Replay, Simulated, silent, staged
from suchus.figures import captioned
from suchus.figures.gait_diagram import GaitTrack, gait_diagram
from suchus.gaits import GAITS
from suchus.kinematics.tail import bend_of_servo
from suchus.land import Run, simulate
from suchus.metrics import (
    between,
    diagonal_phase_error,
    duty_factor,
    lateral_bend,
    loaded,
    sensed_phase,
    spine_amplitude,
    spine_swings,
    tail_amplitude,
    tail_swing_least,
    tail_swings,
    vertical_bend,
)
from suchus.motion import START, Gait, as_table
from suchus.paper import CYCLES
from suchus.paper.signs import spine_lateral
from suchus.replay import replay
from suchus.robots import ROBOTS
from suchus.verdict import Reading, listed

_CAPTION = "The crawl of the gait diagram: thick tracks are feet that stand."


@dataclass(frozen=True, slots=True, kw_only=True)
class GaitDiagram(Experiment):
    """The article's Fig. 12 for our crawl: as commanded, and as foot pressure and joint angles tell.

    A foot stands when its pressure exceeds half a newton. Phases are those of the first harmonic of stance. Bends are
    sums of joint angles, of the tail those of its cable section and, up and down, its pitch joint; their sense is the
    article's: right and down are positive. The commanded cycle is written as a table of servo angles, a gait file in
    which any angle can be changed, the vertical ones too.
    """

    title = "When do the feet stand, and which way do spine and tail bend?"
    shows = "Section III.D, Fig. 12"
    judged_with = ("robot", "gait", "cycles")

    robot: Crocodile = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot that crawls."""
    gait: Gait = field(default_factory=lambda: GAITS["belly_crawl"])
    """The gait that is shown."""
    cycles: int = int(CYCLES)
    """How many cycles are shown [-]."""

    def __post_init__(self) -> None:
        with Checks(self.name(), self) as check:
            check.whole("cycles", 2, 1000)  # one cycle cannot show that it repeats itself

    def quick(self) -> "GaitDiagram":
        """The same: it takes a second."""
        return replace(self)

    def simulate(self, progress: Progress = silent) -> Simulated:
        """Crawl."""
        end = START + self.cycles * self.gait.period
        run = Run(robot=self.robot, gait=self.gait)
        record = simulate([run], duration=end, progress=staged(progress, "crawl", 0.0, 1.0)).isel(run=0)
        told = record.servo_target.sel(servo="tail_cable")
        record["commanded_tail"] = told.copy(data=bend_of_servo(self.robot.tail, told.values)).drop_vars("servo")
        page = partial(replay, record, self.robot, caption=_CAPTION)
        return Simulated(
            record=record,
            tables={"gait_table.toml": blueprint.render(as_table(self.robot, self.gait))},
            replays={"gait_replay.html": Replay(caption=_CAPTION, make=page)},
        )

    def measure(self, record: xr.Dataset) -> Mapping[str, Measure]:
        """Return duty factors and phases by pressure, lags and amplitudes of the bends."""
        walk = between(record).isel(time=slice(0, -1))  # whole cycles: the last sample begins the next one
        duty, phase = duty_factor(record), sensed_phase(record)
        measures = {f"duty_factor_{leg}": Measure(float(duty.sel(leg=leg)), "-") for leg in LEGS}
        measures |= {f"phase_{leg}": Measure(float(phase.sel(leg=leg)), "cycle") for leg in LEGS[1:]}
        sensed, commanded = _sensed(walk), _commanded(walk)
        for name, amplitude in (("spine", spine_amplitude), ("tail", tail_amplitude)):
            lag, gain = _against(walk, sensed[name], commanded[name])
            measures[f"{name}_lag"] = Measure(lag, "cycle")
            measures[f"{name}_amplitude"] = Measure(float(amplitude(record)), "rad")
            measures[f"{name}_gain"] = Measure(gain, "-")
            upright = sensed[f"{name}_vertical"]
            measures[f"{name}_vertical_mean"] = Measure(float(upright.mean()), "rad")
            measures[f"{name}_vertical_amplitude"] = Measure(float(np.ptp(upright)) / 2, "rad")
        return measures | {
            "duty_factor_greatest": Measure(float(duty.max()), "-"),
            "duty_factor_commanded": Measure(float(record.duty_factor), "-"),
            "diagonal_phase_error": Measure(float(diagonal_phase_error(record)), "cycle"),
            "period": Measure(_period(walk), "s"),
            "cycles": Measure(
                float(round(float(walk.limb_phase.sel(leg="LF")[-1] - walk.limb_phase.sel(leg="LF")[0]))), "cycle"
            ),
            "spine_changes_per_cycle": Measure(float(spine_swings(record)), "-"),
            "tail_changes_per_cycle": Measure(float(tail_swings(record)), "-"),
            "tail_swing_least": Measure(float(tail_swing_least(record)), "rad"),
        }

    def explain(self, measures: Mapping[str, float]) -> str:
        """Say how what the feet and joints do differs from what is commanded."""
        m = {name: Reading(value) for name, value in measures.items()}
        duties = listed([f"{m[f'duty_factor_{leg}']:.0%} ({leg})" for leg in LEGS])
        return (
            f"Commanded are limb phases and bends; what the feet make of them is felt by their pressure. Feet are told "
            f"to stand {m['duty_factor_commanded']:.0%} of the cycle and stand {duties}; the stances of diagonal pairs "
            f"are up to {m['diagonal_phase_error']:.2f} cycle apart. The spine bends by "
            f"{m['spine_amplitude']:deg.0f} degrees to each side, {m['spine_gain']:.0%} of its command and "
            f"{m['spine_lag']:.3f} cycle after it; the tail by {m['tail_amplitude']:deg.0f} degrees, "
            f"{m['tail_gain']:.0%} of its command and {m['tail_lag']:.3f} cycle after it. Up and down the spine moves "
            f"by {m['spine_vertical_amplitude']:deg.1f} degrees about {m['spine_vertical_mean']:deg.1f} and the tail "
            f"by {m['tail_vertical_amplitude']:deg.1f} about {m['tail_vertical_mean']:deg.1f} (down is positive)."
        )

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw commanded and sensed."""
        walk = between(outcome.record)
        commanded, sensed = _commanded(walk), _sensed(walk)
        meant = (np.mod(walk.limb_phase, 1.0) >= 1.0 - walk.duty_factor).transpose("leg", "time").values
        stands = loaded(walk).transpose("leg", "time").values
        time = walk.time.values
        tracks = [
            GaitTrack(time=time, stance=stands, **sensed, label="simulated"),
            GaitTrack(time=time, stance=meant, **commanded, label="commanded"),
        ]
        marks = list(np.arange(START, time[-1] + 0.01, self.gait.period))
        figure = captioned(
            gait_diagram(tracks, cycles=marks),
            "Gait diagram in the form of the article's Fig. 12, black as simulated (foot pressure, joint angles), grey "
            "as commanded. Filled: a foot stands, or spine and tail bend to the right; open: they bend to the left. "
            "Below, the lateral angles, then the vertical ones.",
        )
        return {"gait_diagram": figure}


def _sensed(record: xr.Dataset) -> dict[str, np.ndarray]:
    """Return the lateral and vertical angles of spine and tail in the article's signs [rad]."""
    angles = {}
    for part in ("spine", "tail"):
        angles[part] = lateral_bend(record, part).values
        angles[f"{part}_vertical"] = vertical_bend(record, part).values
    return angles


def _commanded(record: xr.Dataset) -> dict[str, np.ndarray]:
    """Return the angles that the servos are commanded to make, in the article's signs [rad]."""

    def summed(beginning: str) -> xr.DataArray:
        names = [str(name) for name in record.servo.values if str(name).startswith(beginning)]
        return record.servo_target.sel(servo=names).sum("servo")

    return {
        "spine": np.asarray(spine_lateral(summed("spine_yaw")).values),
        "tail": record.commanded_tail.values,
        "spine_vertical": summed("spine_pitch").values,
        "tail_vertical": summed("tail_pitch").values,
    }


def _harmonic(record: xr.Dataset, values: np.ndarray) -> complex:
    turn = np.exp(-2j * np.pi * (record.time.values - START) / float(record.period))
    return complex(2 * np.mean((values - values.mean()) * turn))


def _against(record: xr.Dataset, sensed: np.ndarray, commanded: np.ndarray) -> tuple[float, float]:
    """Return lag [cycle] and gain [-] of what is sensed behind what is commanded, by first harmonics."""
    there, here = _harmonic(record, commanded), _harmonic(record, sensed)
    if abs(there) < 1e-6:
        return 0.0, float("nan")
    return float(-np.angle(here / there) / (2 * np.pi)), abs(here) / abs(there)


def _period(record: xr.Dataset) -> float:
    """Return the shift in time at which the feet's loads agree best with themselves [s].

    Looked for from half to one and a half of the commanded period.
    """
    load = record.foot_force.sel(xyz="z").transpose("time", "leg").values
    step, period = float(record.time[1] - record.time[0]), float(record.period)
    shifts = np.arange(int(0.5 * period / step), min(int(1.5 * period / step), len(load) - 2))
    apart = [float(np.mean((load[n:] - load[:-n]) ** 2)) for n in shifts]
    return float(step * shifts[int(np.argmin(apart))])


experiment = GaitDiagram()
