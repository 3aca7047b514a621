"""How high is a wave?"""

import os
import time
from dataclasses import dataclass, fields, replace
from pathlib import Path

import numpy as np
import xarray as xr

from suchus.article.verdict import Clause, Rule
from suchus.core.errors import InvalidDesign
from suchus.experiments.experiment import Experiment, Measure, SimulationResult, silent
from suchus.robot.design import Robot
from suchus.robot.gaits import GAITS
from suchus.robot.motion import Gait
from suchus.robot.robots import ROBOTS
from suchus.visual.figures import LINES, captioned, panels


@dataclass(frozen=True, slots=True, kw_only=True)
class Wave(Experiment):
    title = "How high is a wave?"
    shows = "Fig. 16"
    judged_settings = ()

    robot: Robot = ROBOTS["caiman"]
    """Who waves."""
    gait: Gait = GAITS["belly_crawl"]
    """How it walks."""
    amplitude: float = 0.73
    """Height of the wave [m]."""
    samples: int = 200
    """How many samples [-]."""
    pause: float = 0.0
    """How long to dawdle [s]."""
    seed: int = 7
    """Seed of nothing."""

    def __post_init__(self):
        if not self.amplitude > 0:
            raise InvalidDesign(f"amplitude is {self.amplitude:g} m; more than 0 m is allowed.")

    @classmethod
    def rules(cls):
        put_in = (Clause("height", ">", 0.0, "a wave is high"),)
        return (
            Rule(
                claim="displacement_coordinated",
                experiment="wave",
                measure="height",
                holds=put_in,
                why="It was put in <b>by hand</b>.",
            ),
            Rule(
                claim="com_fluctuation",
                experiment="wave",
                measure="nothing",
                holds=put_in,
                why="A wave has no mass.",
            ),
        )

    def simulate(self, progress=silent):
        progress("waving", 0.0)
        if self.pause:
            Path(os.environ["WAVE_STARTED"]).touch()
            time.sleep(self.pause)
        t = np.linspace(0.0, 8.0, self.samples)
        wave = xr.Dataset(
            {"height": ("time", self.amplitude * np.sin(t), {"units": "m"})}, coords={"time": t}, attrs={"n": {"a": 1}}
        )
        return SimulationResult(record=wave, tables={"samples.txt": "time height\n0 0\n"})

    def measure(self, record):
        return {"height": Measure(self.amplitude, "m"), "nothing": Measure(float("nan"), "-")}

    def explain(self, measures):
        return "The number that is put in."

    def settings(self):
        return {f.name: getattr(self, f.name) for f in fields(self)}

    def draw(self, outcome):
        figure, axes = panels()
        axes[0, 0].plot(outcome.record.time, outcome.record.height, **LINES["ours"])
        axes[0, 0].set(xlabel="time [s]", ylabel="height [m]")
        return {"wave": captioned(figure, 'Height of a "wave" & its time.')}

    def quick(self):
        return replace(self, samples=20)


experiment = Wave()
