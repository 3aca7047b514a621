"""Whatever write, close, rename or fsync of a command fails: a sentence, nothing half-written, then the same bytes."""

import os
import sys
from pathlib import Path

import numpy as np
import pytest
from tests.failing import each_failing
from tests.swims import crocodile_swim

from suchus.animals.capture import Camera, film_animal
from suchus.apps.cli import main
from suchus.apps.report import OUTCOME, PAGE
from suchus.core.errors import SuchusError
from suchus.core.files import save
from suchus.core.progress import silent
from suchus.core.writing import MANIFEST
from suchus.robot.robots import ROBOTS
from suchus.swimming.water.resolved import SwimSetting, resolved_swim

sys.path[:0] = [str(Path(__file__).parents[1] / room) for room in ("model", "capture")]
from hinge_trees import quadruped  # noqa: E402
from menagerie import built  # noqa: E402

STUDY = """
name = "grip"
duration = 1.1
measure = ["displacement"]

[[vary]]
field = "ground.friction_scale"
values = [0.5, 1.0]
"""
SEARCH = """
name = "small"
population = 4
evaluations = 4
duration = 1.2
timestep = 0.01

[[vary]]
field = "gait.stroke"
low = 0.0
high = 0.75

[[vary]]
field = "gait.trunk_bend"
low = 0.0
high = 2.3

[[aims]]
name = "displacement"
"""
SWIM = SwimSetting(cells=32, viscosity=1e-3, cycles=1, frames=6)
COMMANDS = {
    "run": ["run", "wave", "--out", "made"],
    "reproduce": ["reproduce", "--anew", "--out", "made"],
    "export": ["export", "--format", "urdf", "--out", "made/it"],
    "servo map": ["export-commands", "--write-map", "made/map.toml"],
    "import": ["import", "it.urdf", "--out", "made/it.toml"],
    "study": ["study", "grip.toml", "--out", "made"],
    "optimise": ["optimise", "small.toml", "--out", "made"],
    "capture": ["capture", "walk.csv", "--out", "made/walk.toml"],
    "swim": [],
}
MOST = {"optimise": 2, "capture": 6, "swim": 4}
"""Failures of a kind that are tried; of others a dozen."""
VOLATILE = (OUTCOME, PAGE, MANIFEST, "report.html")
"""What says how long something took, or when."""


def swim(place):
    """Swim as experiments in water do: the flow is kept on the way, the result in the end."""
    try:
        found = resolved_swim(
            ROBOTS["caiman"], crocodile_swim(), SWIM, checkpoint=place / "it.kept-swim", progress=silent
        )
        save(found, place / "swim.nc")
    except SuchusError as error:
        print(f"suchus: {error}", file=sys.stderr)
        return 2
    return 0


def film():
    """A film of an animal that walks, as a table of keypoints."""
    animal = built(np.random.default_rng(1), 1, trunk=(0.1, 0.2), period=(0.8, 1.2))
    camera = Camera(rate=25.0, noise=0.0005, lost=0.0, heading=0.3, scale=None, heights=False, seed=1)
    tracks = film_animal(animal, camera, cycles=4)
    rows = ["time [s], " + ", ".join(f"{point}_{axis} [m]" for point in tracks.points for axis in "xy")]
    rows += [
        ", ".join(f"{number:.6f}" for number in (time, *places[:, :2].ravel()))
        for time, places in zip(tracks.time, tracks.position, strict=True)
    ]
    return "\n".join(rows)


def made(place):
    """What a command has made, but for what no two runs have in common; drafts and backups would stand out."""
    files = {str(f.relative_to(place)): f for f in place.rglob("*") if f.is_file()}
    return {name: None if file.name in VOLATILE else file.read_bytes() for name, file in files.items()}


@pytest.mark.battery("failed writes")
@pytest.mark.slow("commands are repeated for every write that can fail")
@pytest.mark.parametrize("name", COMMANDS)
def test_whatever_fails_what_was_kept_is_whole_and_the_next_run_gives_the_same(
    name, request, tmp_path, monkeypatch, capsys, counted
):
    if name in ("run", "reproduce"):
        request.getfixturevalue("fakes")
    monkeypatch.chdir(tmp_path)
    (tmp_path / "it.urdf").write_text(quadruped())
    (tmp_path / "grip.toml").write_text(STUDY)
    (tmp_path / "small.toml").write_text(SEARCH)
    if name == "capture":
        (tmp_path / "walk.csv").write_text(film())
    place, fresh, rename = tmp_path / "made", [False], os.rename  # before any of them fails

    def command():
        return main(COMMANDS[name]) if COMMANDS[name] else swim(place)

    def work():
        if fresh[0]:
            rename(place, tmp_path / f"before{len(list(tmp_path.iterdir()))}")
        return command()

    assert command() == 0
    whole, failures = made(place), 0
    for kind, which, code in each_failing(tmp_path, work, monkeypatch, most=MOST.get(name, 12)):
        told = [line for line in capsys.readouterr().err.splitlines() if line.startswith("suchus: ")]
        allowed = ((2, 1), (0, 0), (1, 0)) if name == "reproduce" else ((2, 1), (0, 0))  # which reports what failed
        assert (code, len(told)) in allowed, (kind, which, told)
        assert code != 2 or "no space left on device" in told[0]
        failures += code > 0
        counted()
        if not fresh[0]:
            assert made(place) == whole, (kind, which)
        assert command() == 0
        assert made(place) == whole, (kind, which)
        capsys.readouterr()
        fresh[0] = not fresh[0]
    assert failures > 3
