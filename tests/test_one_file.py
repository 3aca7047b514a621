"""Each thing that can be added is one file in a project folder: it is written there, and used at once.

What is written here is as small as can be, and does what a line of algebra says. ``tests/docs/test_page_examples.py``
tries the larger examples of the how-to pages as what suchus ships is tried, in packages too.
"""

import importlib
import json
import os
import sys
from pathlib import Path

import numpy as np
import pytest

import suchus
from suchus import flow
from suchus.apps.cli import main
from suchus.core import sources
from suchus.sim.faults import from_table

ELSEWHERE = {"protocols": "tests/hardware/test_own_protocol.py", "policies": "tests/shelves/test_policies.py"}
"""Folders of a project whose one file is tried in another test."""

ROBOT = """
# A caiman with a longer shank
base = "caiman"

[hind_leg]
femur = 0.1  # [m]
"""
GAIT = """
# The crawl, at half the speed
base = "belly_crawl"
period = 8.0  # [s]
"""
FAULT = '''"""A servo without torque."""

from dataclasses import dataclass

from suchus.sim.fault import ServoFault


@dataclass(frozen=True, slots=True)
class Powerless(ServoFault):
    """A servo without torque."""

    joint: str
    """Name of the servo."""
    at: float = 0.0
    """When it begins [s]."""

    def apply(self, plant):
        """Take the torque away."""
        plant.parameter("actuator_forcerange", self.joint)[:] = 0.0


fault = Powerless
'''
CONTROLLER = '''"""A control that holds every servo at one angle."""

from dataclasses import dataclass

import numpy as np

from suchus.robot.control import Command
from suchus.robot.design import layout


@dataclass(frozen=True, slots=True, kw_only=True)
class Rigid:
    """Every servo at one angle."""

    angle: float = 0.05
    """The angle [rad]."""
    feels = False

    @staticmethod
    def start(runs, period):
        """Start it for the runs of a batch."""
        return Holding(runs)


class Holding:
    """One angle for each run of a batch."""

    def __init__(self, runs):
        shape = layout(runs.robots[0])
        angles = np.array([control.angle for control in runs.controls])
        self._targets = np.tile(angles[:, None], len(shape.servos))
        self._phase = np.zeros((len(angles), len(shape.limbs)))

    def rest(self):
        """Return the posture in which the robots are put on the ground."""
        return self._targets

    def command(self, tick, sensed):
        """Return the angles, which stay."""
        return Command(self._targets, self._phase)


controller = Rigid
'''
MEASURE = '''"""How long a run lasts."""


def last_time(record):
    """Return the time of the last sample of each run [s]."""
    return record.time.max()


measure = last_time
'''
EXPERIMENT = '''"""How heavy is the robot?"""

from dataclasses import dataclass, field

import xarray as xr

from suchus.article.paper import Claim
from suchus.article.verdict import Clause, Rule
from suchus.experiments.experiment import Experiment, Measure, Measures, SimulationResult, silent
from suchus.robot.design import Robot
from suchus.robot.robots import ROBOTS
from suchus.visual.figures import captioned, panels

CLAIMS = (
    Claim(key="weight_in_hand", of="our wish", where="of May", quantity="mass of the robot", unit="kg",
          sense="The robot weighs less than ten kilogrammes."),
)
RULES = (
    Rule(claim="weight_in_hand", experiment="weight", measure="mass", why="It weighs {mass:.1f} kg.",
         holds=(Clause("mass", "<", 10.0, "what one person carries"),)),
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Weight(Experiment):
    """The mass of a robot."""

    title = "How heavy is the robot?"
    shows = "Beyond the article"

    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot."""

    def simulate(self, progress=silent):
        """Weigh it."""
        return SimulationResult(record=xr.Dataset({"mass": ((), self.robot.mass, {"units": "kg"})}))

    def measure(self, record):
        """Return the mass."""
        return Measures({"mass": Measure(float(record.mass), "kg")})

    def explain(self, measures):
        """Say what decides it."""
        return "The mass is the sum of the masses of the segments and the servos."

    def draw(self, outcome):
        """Draw the mass as a bar."""
        figure, axes = panels()
        axes[0, 0].bar(["robot"], [float(outcome.record.mass)])
        axes[0, 0].set(ylabel="mass [kg]")
        return {"weight": captioned(figure, "The mass of the robot as a bar.")}

    def quick(self):
        """Return the same question."""
        return self


experiment = Weight()
'''
COMMAND = '''"""Say how heavy a robot is."""

from dataclasses import dataclass, field

from suchus.apps.cli.command import UserCommand
from suchus.robot.design import Robot
from suchus.robot.robots import ROBOTS


@dataclass(frozen=True, slots=True, kw_only=True)
class Weigh(UserCommand):
    """Say how heavy a robot is."""

    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot."""

    def run(self):
        """Print the mass."""
        print(f"{self.robot.mass:.6f} kg")


command = Weigh
'''
SHAPE = '''"""A square with sides of a metre."""

from suchus import flow

SQUARE = flow.from_outline([(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)])
'''


def use_robot(folder, capsys):
    """A command builds the robot; all but its shank is the caiman's."""
    assert suchus.ROBOTS["long_shank"].hind_leg.femur == 0.1
    assert suchus.ROBOTS["long_shank"].tail == suchus.ROBOTS["caiman"].tail
    assert main(["export", "--robot", "long_shank", "--format", "urdf"]) == 0
    assert 'name="long_shank"' in next(folder.rglob("*.urdf")).read_text()


def use_gait(folder, capsys):
    """A command writes the servo angles of a cycle, which takes twice as long as that of the crawl."""
    assert suchus.GAITS["slow"].period == 8.0 == 2.0 * suchus.GAITS["belly_crawl"].period
    assert main(["export-commands", "slow"]) == 0
    assert capsys.readouterr().out.startswith("401 samples over 8 s: ")  # 50 Hz, both ends counted


def use_fault(folder, capsys):
    """The servo gives no torque from the beginning; its mirror image does."""
    fault = from_table({"kind": "powerless", "joint": "LF_pitch"})
    run = suchus.Run(robot="caiman", gait=suchus.GAITS["belly_crawl"], faults=(fault,))
    torque = np.abs(suchus.simulate([run], duration=0.3).servo_torque).max("time")
    assert torque.sel(servo="LF_pitch").item() == 0.0
    assert torque.sel(servo="RF_pitch").item() > 0.0


def use_controller(folder, capsys):
    """The angle is commanded to every servo, at all times."""
    control = suchus.CONTROLLERS["rigid"](angle=0.1)
    run = suchus.Run(robot="caiman", gait=suchus.GAITS["belly_crawl"], control=control)
    assert np.unique(suchus.simulate([run], duration=0.3).servo_target) == pytest.approx([0.1], rel=1e-6)


def use_measure(folder, capsys):
    """It is found by the name of its function."""
    record = suchus.simulate([suchus.Run(robot="caiman", gait=suchus.GAITS["belly_crawl"])], duration=0.3)
    assert suchus.MEASURES["last_time"](record).item() == record.time.values[-1]


def use_experiment(folder, capsys):
    """A command asks the question, and judges the claim that the file states."""
    assert main(["run", "weight"]) == 0
    outcome = json.loads((folder / "out/weight/outcome.json").read_text())
    mass = suchus.ROBOTS["caiman"].mass
    assert outcome["measures"] == {"mass": {"value": mass, "unit": "kg"}}
    (verdict,) = outcome["verdicts"]
    assert (verdict["claim"], verdict["of"], verdict["verdict"]) == ("weight_in_hand", "our wish", "reproduced")
    assert verdict["why"] == f"It weighs {mass:.1f} kg."


def use_command(folder, capsys):
    """It runs, stands in the help, and takes its robot from the shelf."""
    assert main(["weigh"]) == 0
    assert main(["weigh", "--robot", "strider"]) == 0
    weights = [f"{suchus.ROBOTS[name].mass:.6f} kg" for name in ("caiman", "strider")]
    assert capsys.readouterr().out.split("\n")[:2] == weights
    assert main(["--help"]) == 0
    assert "Say how heavy a robot is. [commands/weigh.py]" in capsys.readouterr().out


def use_shape(folder, capsys):
    """Its area is exact, and the flow goes round it."""
    square = importlib.import_module("square").SQUARE
    assert square.volume(0.0) == pytest.approx(1.0, rel=1e-6)
    grid = flow.Grid.covering((-2.0, 2.0), (-2.0, 2.0), cell=1 / 8)
    body = flow.Body(shape=square, motion=flow.Pose(position=(0.0, 0.0), angle=0.0))
    setup = flow.Setup(grid=grid, viscosity=1 / 20, stream=(1.0, 0.0), bodies=(body,))
    drag = flow.Simulation(setup).run(0.5).coefficients(length=1.0, speed=1.0).drag
    assert float(drag[-1]) > 0.5  # of a square across a stream about 1.6 in the end


CASES = {
    "robots": ("robots/long_shank.toml", ROBOT, use_robot),
    "gaits": ("gaits/slow.toml", GAIT, use_gait),
    "faults": ("faults/powerless.py", FAULT, use_fault),
    "controllers": ("controllers/rigid.py", CONTROLLER, use_controller),
    "measures": ("measures/last_time.py", MEASURE, use_measure),
    "experiments": ("experiments/weight.py", EXPERIMENT, use_experiment),
    "commands": ("commands/weigh.py", COMMAND, use_command),
    "a shape in the flow": ("square.py", SHAPE, use_shape),
}
"""Of each thing its one file, what stands in it, and how it is used."""


@pytest.fixture
def project(tmp_path, monkeypatch):
    """An empty project, which is the working folder; what was imported from it is forgotten."""
    imported = set(sys.modules)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv(sources.VARIABLE, str(tmp_path))
    monkeypatch.syspath_prepend(tmp_path)
    yield tmp_path
    for name in set(sys.modules) - imported:
        if str(getattr(sys.modules[name], "__file__", "")).startswith(f"{tmp_path}{os.sep}"):
            del sys.modules[name]


@pytest.mark.parametrize("kind", CASES)
def test_one_file_is_enough(kind, project, capsys):
    file, text, use = CASES[kind]
    (project / file).parent.mkdir(exist_ok=True)
    (project / file).write_text(text)
    assert [path for path in project.rglob("*") if path.is_file()] == [project / file]
    use(project, capsys)


def test_every_folder_of_a_project_is_tried():
    assert set(sources.SHELVES) <= set(CASES) | set(ELSEWHERE)
    assert all(Path(file).parent.name in (kind, "") for kind, (file, _, _) in CASES.items())
