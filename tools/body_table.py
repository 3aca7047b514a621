"""Try every experiment and tool on every body of the shelf, for the table in docs/robots_from_files.md.

Usage: python tools/body_table.py [--only NAME ...] [--table]

Each pair is tried at the command line in a short form: it answers, or it refuses in a sentence with the exit code 2;
anything else is written down as it came. The result of each pair goes into docs/bodies.json as soon as it is known, so
that a run that was stopped goes on; the table is made from that file alone. ``--only`` tries the rows named anew, and
``--table`` nothing but writes the table.
"""

import argparse
import contextlib
import io
import json
import shlex
import sys
import tempfile
from pathlib import Path

from suchus.capture import Camera, SyntheticAnimal, film_animal, write_table
from suchus.cli.entry import main as suchus
from suchus.design import Robot
from suchus.design.scale import coarse_step
from suchus.experiments import EXPERIMENTS
from suchus.gaits import GAITS, own_gait
from suchus.robots import ROBOTS

ROOT = Path(__file__).parents[1]
FOUND, PAGE = ROOT / "docs" / "bodies.json", ROOT / "docs" / "robots_from_files.md"
MARKS = "<!-- bodies: made by tools/body_table.py -->\n", "<!-- /bodies -->\n"
LEAST = {
    "crawl_stability": "--cycles 1 --repeats 1",
    "displacement": "--cycles 1 --repeats 1 --phases 0.0 --shares 1.0 --strokes 0.03 --bends 1.0 --pitches 0.1",
    "feedback": "--starts 1 --cycles 1 --hold 0.1 --after 1",
    "gait_diagram": "--cycles 2",
    "joint_faults": "--cycles 1 --variations 1 --repeats 1 --holds 0.5",
    "joint_loops": "--integrals 0.0 20.0 --cycles 1",
    "speed_range": "--slower 1.0 --cycles 1",
    "swim_3d": "--cells 64 --compared-cells 64",
    "terrain": "--bumps --steps --transitions 1 --seeds 1 --walked 1.0 --surfaces even",
    "turning": "--bends 0.0 0.2 --asymmetries 0.0 0.5 --mixtures 0.0 1.0 --asked 1.0 --cycles 1",
}
"""What is added to the quick form of experiments that take long, or whose grid is too coarse for slender robots."""
TOOLS = {
    "study": "`suchus study FILE.toml`",
    "optimise": "`suchus optimise FILE.toml`",
    "capture": "`suchus capture TRACKS`",
    "export": "`suchus export`",
}
"""Commands that take any body: their rows, and what the table calls them."""
LIZARD = SyntheticAnimal(
    trunk=0.12,
    tail=0.20,
    period=0.8,
    duty_factor=0.7,
    limb_phases=(0.0, 0.5, 0.25, 0.75),
    stride=0.15,
    outward=0.06,
    lift=0.02,
    spine_bend=0.5,
    spine_rightmost=0.2,
    tail_bend=0.7,
    tail_lag=1 / 3,
    tail_wave=0.0,
)
CAMERA = Camera(rate=100.0, noise=0.0, lost=0.0, heading=0.0, scale=None, heights=True, seed=0)
"""The walk that is captured, and who films it."""


def main() -> int:
    """Try what is not yet known, and write the table; return 1 where a pair neither answered nor refused."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--only", action="append", default=[], metavar="NAME")
    parser.add_argument("--table", action="store_true")
    asked = parser.parse_args()
    found = json.loads(FOUND.read_text()) if FOUND.exists() else {}
    for row in () if asked.table else (*sorted(EXPERIMENTS, key=lambda name: name not in LEAST), *TOOLS):
        if asked.only and row not in asked.only:
            continue
        for robot in sorted(ROBOTS, key=lambda name: ROBOTS[name].tables is not None):  # they take long
            if row in asked.only or robot not in found.get(row, {}):
                found.setdefault(row, {})[robot] = answer = tried(row, robot)
                FOUND.write_text(json.dumps(found, indent=1, sort_keys=True) + "\n")
                print(f"{row} {robot}: {answer}", flush=True)
    write(found)
    every = [(row, robot, answer) for row, cells in found.items() for robot, answer in cells.items()]
    odd = [(row, robot) for row, robot, answer in every if answer.startswith("exit ")]
    for row, robot in odd:
        print(f"{row} on {robot}: {found[row][robot]}", file=sys.stderr)
    return bool(odd)


def tried(row: str, robot: str) -> str:
    """Return what came of a row on a robot: nothing where it answers, else the sentence of refusal or failure."""
    with tempfile.TemporaryDirectory() as folder:
        words = command(row, robot, Path(folder))
        out, err = io.StringIO(), io.StringIO()
        try:
            with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
                code = suchus(words)
        except Exception as error:
            return f"exit 1: {type(error).__name__}: {error}"
    if code == 0:
        return ""
    said = err.getvalue().strip().splitlines()[-1:] or [""]
    return said[0] if code == 2 else f"exit {code}: {said[0]}"


def command(row: str, name: str, folder: Path) -> list[str]:
    """Return the words by which a row is tried on a robot, in a folder of its own."""
    robot = ROBOTS[name]
    if row in EXPERIMENTS:
        words = ["run", row, "--quick", "--robot", name, "--out", str(folder), *shlex.split(LEAST.get(row, ""))]
        timed = row in LEAST and hasattr(EXPERIMENTS[row], "timestep")
        return [*words, "--timestep", f"{coarse_step(robot):g}"] if timed else words
    if row == "capture":
        tracks = write_table(film_animal(LIZARD, CAMERA, cycles=3), folder / "tracks.csv")
        return ["capture", str(tracks), "--robot", name, "--out", str(folder / "captured.toml")]
    if row == "export":
        return ["export", "--robot", name, "--out", str(folder / "exported")]
    file = folder / f"{row}.toml"
    file.write_text(asked_of(row, name, robot))
    return [row, str(file), "--out", str(folder / "found")]


def asked_of(row: str, name: str, robot: Robot) -> str:
    """Return a study or a search, of four runs of two seconds, of the period of a robot's own gait."""
    own = own_gait(robot)
    gait = next(one for one in GAITS if GAITS[one] == own)
    lines = [f'name = "{row}_{name}"', f'robot = "{name}"', f'gait = "{gait}"', f"timestep = {coarse_step(robot):g}"]
    lines.append(f"duration = {2.0 if row == 'study' else 3.0}")
    lines += ["measure = ['displacement']"] if row == "study" else ["evaluations = 4", "population = 4"]
    lines += ["[[vary]]", 'field = "gait.period"', f"low = {0.9 * own.period}", f"high = {1.1 * own.period}"]
    lines += ["steps = 2"] if row == "study" else ["[[aims]]", 'name = "displacement"']
    return "\n".join(lines) + "\n"


def write(found: dict[str, dict[str, str]]) -> None:
    """Write the table into the page."""
    begin, end = MARKS
    before, rest = PAGE.read_text().split(begin)
    PAGE.write_text(before + begin + table(found) + end + rest.split(end)[1])


def table(found: dict[str, dict[str, str]]) -> str:
    """Return the table, and below it why rows refuse."""
    rows = [row for row in (*EXPERIMENTS, *TOOLS) if row in found]
    lines = ["| | " + " | ".join(f"`{robot}`" for robot in ROBOTS) + " |", "|---" * (len(ROBOTS) + 1) + "|"]
    for row in rows:
        cells = [mark(found[row].get(robot)) for robot in ROBOTS]
        lines.append(f"| {TOOLS.get(row, f'`{row}`')} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def mark(answer: str | None) -> str:
    """Return what a cell shows."""
    if answer is None:
        return "not tried"
    return "answers" if not answer else "failed" if answer.startswith("exit ") else "refuses"


if __name__ == "__main__":
    sys.exit(main())
