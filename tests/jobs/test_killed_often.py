"""Studies, searches and swims that are killed again and again end with the bytes of those that nobody killed."""

import subprocess
import sys
from pathlib import Path

import pytest

KILLS = 20
WORK = """
import os, random, signal, sys, time
os.environ["SUCHUS_THREADS"] = "1"
sys.path[:0] = [sys.argv[4]]
from pathlib import Path
from suchus.robot.gaits import GAITS
from suchus.sim.land import Run
from suchus.experiments.optimise import Aim, Optimisation, optimise
from suchus.core.progress import silent
from suchus.robot.robots import ROBOTS
from suchus.experiments.study import Study, Vary, conduct
from suchus.swimming.water.resolved import SwimSetting, resolved_swim
from suchus.core.files import save
from tests.swims import crocodile_swim

RUN = Run(robot=ROBOTS["caiman"], gait=GAITS["belly_crawl"])

def study(folder):
    vary = (Vary(field="ground.friction_scale", values=tuple(0.2 + 0.05 * n for n in range(24))),)
    of = {"measure": ("displacement",), "duration": 1.1, "timestep": 0.01, "chunk": 1}
    conduct(Study(name="s", run=RUN, vary=vary, **of), folder)

def search(folder):
    vary = (Vary(field="gait.stroke", low=0.0, high=0.75),)
    asked = Optimisation(name="o", run=RUN, vary=vary, aims=(Aim(name="displacement"),), evaluations=24, population=4,
                         duration=1.2, timestep=0.01)
    optimise(asked, folder)

def swim(folder):
    folder.mkdir(exist_ok=True)
    setting = SwimSetting(cells=32, viscosity=1e-3, cycles=1, frames=6)
    kept = folder / "it.kept-swim"
    found = resolved_swim(ROBOTS["caiman"], crocodile_swim(), setting, checkpoint=kept, progress=silent)
    save(found, folder / "swim.nc")

def begun(folder):
    child = os.fork()
    if child == 0:
        try:
            {"study": study, "search": search, "swim": swim}[sys.argv[1]](folder)
        except BaseException as error:
            print(repr(error), file=sys.stderr)
            os._exit(1)
        os._exit(0)
    return child

whole, often, draw, killed = Path(sys.argv[2]), Path(sys.argv[3]), random.Random(sys.argv[1]), 0
began = time.monotonic()
assert os.waitpid(begun(whole), 0)[1] == 0
took = time.monotonic() - began
for _ in range(4 * int(sys.argv[5])):
    child = begun(often)
    time.sleep(draw.uniform(0.0, 0.3 * took))
    os.kill(child, signal.SIGKILL)
    killed += os.WIFSIGNALED(os.waitpid(child, 0)[1])
    if killed == int(sys.argv[5]):
        break
assert os.waitpid(begun(often), 0)[1] == 0
print(killed)
"""


def contents(folder):
    return {str(f.relative_to(folder)): f.read_bytes() for f in sorted(folder.rglob("*")) if f.is_file()}


@pytest.mark.slow("processes are killed twenty times")
@pytest.mark.battery("kills")
@pytest.mark.parametrize("what", ["study", "search", "swim"])
def test_what_was_killed_twenty_times_ends_as_if_nothing_had_happened(what, tmp_path, counted):
    root = Path(__file__).parents[2]
    words = [what, str(tmp_path / "whole"), str(tmp_path / "often"), str(root), str(KILLS)]
    done = subprocess.run(
        [sys.executable, "-c", WORK, *words], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    killed = int(done.stdout.split()[-1])
    assert killed >= KILLS // 4  # what is finished soon cannot be killed so often
    whole, often = contents(tmp_path / "whole"), contents(tmp_path / "often")
    assert whole.keys() == often.keys()
    told = {name for name in whole if whole[name] != often[name]}
    assert not told
    counted(killed)
