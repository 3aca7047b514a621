"""What is said of a robot that was driven over its bus; it needs servos, so that it is not in the catalog."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from suchus.experiments.catalog._replayed import replayed
from suchus.experiments.experiment import Experiment, Measure, Measures, Outcome, Progress, SimulationResult, silent
from suchus.hardware import fix_in_place, wire_statistics
from suchus.robot.design import Robot
from suchus.robot.gaits import default_gait
from suchus.robot.motion import Gait
from suchus.robot.robots import ROBOTS
from suchus.visual.figures.style import COLOURS, captioned, panels, styled

_DEGREES = 180.0 / np.pi


@dataclass(frozen=True, slots=True, kw_only=True)
class Driven(Experiment):
    """A log of a robot that was driven, as an outcome that can be compared with others."""

    title = "How did the servos follow, and how did the bus keep up?"
    shows = "A robot that was driven over its bus; beyond the article"
    answers = ("error_worst", "holes", "missed", "late_p99", "temperature_most")

    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot that was driven."""
    gait: Gait = field(default_factory=lambda: default_gait(ROBOTS["caiman"]))
    """The gait in which it moved."""
    control: str = "open"
    """What decided."""
    stop: str = "sag"
    """How it ended."""

    @classmethod
    def name(cls) -> str:
        """Return what its folder says that it is."""
        return "drive"

    def simulate(self, progress: Progress = silent) -> SimulationResult:
        """Say that a log is given and not made."""
        del progress
        raise NotImplementedError("a log is told by tell()")

    def tell(self, record: xr.Dataset, seconds: float) -> Outcome:
        """Return the outcome of a log."""
        measures = self.measure(record)
        return Outcome(
            experiment=self.name(),
            measures=measures,
            verdicts=(),
            record=record,
            settings=self.settings(),
            decides=self.explain({name: one.value for name, one in measures.items()}),
            replays=replayed(
                "drive_replay.html",
                fix_in_place(record, self.robot),
                self.robot,
                caption="The angles that the servos told. Where nobody measured the robot's place, it is held above "
                "one.",
            )
            if record.sizes["time"] > 1
            else {},
            seconds=seconds,
        )

    def measure(self, record: xr.Dataset) -> Measures:
        """Return what the log says of servos and bus, and what metrics say of the walk where it was measured."""
        told = wire_statistics(record)
        off = np.sqrt(((record.servo_angle - record.servo_asked) ** 2).mean("time"))
        current = np.abs(record.servo_current)
        found = Measures(
            {
                "duration": Measure(float(record.time[-1] - record.time[0]), "s"),
                "late_median": Measure(told["late_median"], "s"),
                "late_p99": Measure(told["late_p99"], "s"),
                "late_most": Measure(told["late_most"], "s"),
                "missed": Measure(float(told["missed"]), "-"),
                "holes": Measure(told["holes"], "-"),
                "holes_worst": Measure(told["worst_holes"], "-"),
                "clamped": Measure(float(told["clamped"]), "-"),
                "error_worst": Measure(float(off.max()), "rad"),
                "temperature_most": Measure(told["hottest"], "degC"),
                "current_most": Measure(_most(current.values), "A"),
                "voltage_least": Measure(-_most(-record.servo_voltage.values), "V"),
            }
        )
        return found | {f"error_{name}": Measure(float(off.sel(servo=name)), "rad") for name in record.servo.values}

    def explain(self, measures: Mapping[str, float]) -> str:
        """Return what decided, in a sentence or two."""
        if not np.isfinite(measures["error_worst"]):
            return f"For {measures['duration']:.1f} s servos were sent where they were to be; they tell nothing of it."
        worst = max((name for name in measures if name.startswith("error_") and name != "error_worst"),
                    key=lambda name: measures[name])  # fmt: skip
        return (
            f"Over {measures['duration']:.1f} s the servos were off what was asked of them by at most "
            f"{_DEGREES * measures['error_worst']:.1f} degrees (root mean square, {worst.removeprefix('error_')}). "
            f"{measures['holes']:.2%} of the readings were missing and {measures['missed']:.0f} ticks were left out."
        )

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw how far servos were off, how hot they got, and the delay of ticks."""
        if not np.isfinite(outcome.measures["error_worst"].value):
            return {}
        with styled():
            return {"drive": self._draw(outcome.record)}

    def _draw(self, record: xr.Dataset) -> Figure:
        figure, axes = panels(3, 1, sharex=True, height=8.5)
        off = _DEGREES * (record.servo_angle - record.servo_asked).values
        size = np.sqrt(np.nanmean(off**2, axis=0))
        time = record.time.values
        for rank, i in enumerate(np.argsort(size)[::-1][:4]):
            colour = list(COLOURS.values())[rank]
            axes[0, 0].plot(time, off[:, i], color=colour, label=str(record.servo.values[i]).replace("_", " "))
        axes[0, 0].set_ylabel("off [degrees]")
        axes[0, 0].legend(
            loc="upper right", ncols=4, title="angle less what was asked, of the four servos farthest off"
        )
        heat = record.servo_temperature.values
        for i in range(heat.shape[1]):
            axes[1, 0].plot(time, heat[:, i], color=COLOURS["neutral"], linewidth=0.8)
        hottest = np.full(len(time), np.nan)
        seen = np.isfinite(heat).any(axis=1)
        hottest[seen] = np.nanmax(heat[seen], axis=1)
        axes[1, 0].plot(time, hottest, color=COLOURS["alarm"], label="the hottest")
        axes[1, 0].set_ylabel("temperature [°C]")
        axes[1, 0].legend(loc="upper left", title="servos, grey; the hottest, red")
        took = 1e3 * (record.tick_began + record.tick_took).values
        axes[2, 0].plot(time, took, color=COLOURS["ours"], linewidth=0.8, label="from the plan until goals are sent")
        axes[2, 0].set_ylabel("late [ms]")
        missing = 100.0 * (1.0 - record.servo_heard.values.mean(axis=1))
        twin = axes[2, 0].twinx()
        twin.plot(time, missing, color=COLOURS["alarm"], linewidth=0.8)
        twin.set_ylabel("unheard [%]", color=COLOURS["alarm"])
        twin.set_ylim(0.0, max(5.0, 1.05 * float(missing.max())))
        axes[2, 0].set_xlabel("time [s]")
        axes[2, 0].legend(loc="upper left")
        return captioned(
            figure,
            "What servos and bus did while the robot was driven: how far the servos were off what was asked of them, "
            "how "
            "warm they got, the delay of the goals of each tick and how many servos were not heard in it.",
        )

    def quick(self) -> "Driven":
        """Return the same: a log is as long as it is."""
        return self


def _most(values: np.ndarray) -> float:
    """Return the greatest of what is finite; NaN if nothing is."""
    known = values[np.isfinite(values)]
    return float(known.max()) if known.size else float("nan")
