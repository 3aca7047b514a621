"""Try every experiment and tool on every body of the catalog and of files, for the tables in docs/bodies_evidence.md.

Usage: python tools/body_table.py [--only ROW ...] [--bodies BODY ...] [--anew] [--table]

Each pair is tried at the command line in a short form: it answers, or it refuses in a sentence with the exit code 2;
anything else is written down as it came. The result of each pair goes into results/bodies.json as soon as it is known,
so that a run that was stopped goes on; the tables are made from that file alone. ``--only`` names rows and ``--bodies``
bodies, of which what is not yet known is tried, with ``--anew`` all of it: ``--bodies caiman --anew`` renews a column,
``--only swimming --bodies six.toml --anew`` a cell. ``--table`` tries nothing and writes the tables.
"""

import argparse
import contextlib
import io
import shlex
import sys
import tempfile
from collections.abc import Callable, Iterable, Sequence
from functools import cache
from pathlib import Path
from time import process_time
from unittest import mock

import gymnasium

from body_files import FILES, write_files
from evidence import store
from suchus.animals.capture import Camera, SyntheticAnimal, film_animal, write_table
from suchus.apps.cli.entry import main as suchus
from suchus.apps.envs import TASKS
from suchus.core.errors import SuchusError
from suchus.experiments.catalog import EXPERIMENTS
from suchus.robot import blueprint
from suchus.robot.design import Robot
from suchus.robot.design.scale import coarse_step
from suchus.robot.gaits import default_gait
from suchus.robot.robots import ROBOTS

ROOT = Path(__file__).parents[1]
NAME, PAGE = "bodies", ROOT / "docs" / "bodies_evidence.md"
MARKS = "<!-- bodies: made by tools/body_table.py -->\n", "<!-- /bodies -->\n"
LEAST = {
    "crawl_stability": "--cycles 1 --repeats 1",
    "displacement": "--cycles 1 --repeats 1 --phases 0.0 --strokes 0.5 1.0 --bends 0.5 1.0",
    "feedback": "--starts 1 --cycles 1 --hold 0.1 --after 1",
    "gait_diagram": "--cycles 2",
    "joint_faults": "--cycles 1 --repeats 1 --holds 0.5",
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
    "view": "`suchus view`",
    "lake": "`suchus view --lake`",
    **{f"task {name}": f"task `{name}`" for name in TASKS},
}
"""Commands and tasks that take any body: their rows, and what the table calls them."""
BODIES = (*ROBOTS, *FILES)
"""Names of the bodies, those of files with .toml."""
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


@cache
def _files() -> tuple[tempfile.TemporaryDirectory[str], dict[str, Path]]:
    """Return a folder that lasts as long as this process, and the bodies' files in it."""
    folder = tempfile.TemporaryDirectory()
    return folder, write_files(Path(folder.name))


def asked(body: str) -> str:
    """Return by what a body is asked for: its name, or the path of its file."""
    return body if body in ROBOTS else str(_files()[1][body])


def robot_of(body: str) -> Robot:
    """Return a body."""
    robot: Robot = ROBOTS[body] if body in ROBOTS else blueprint.read_design(asked(body), Robot, ROBOTS)
    return robot


def main(words: Sequence[str] | None = None) -> int:
    """Try what is not yet known, and write the tables; return 1 where a pair neither answered nor refused."""
    rows = (*sorted(EXPERIMENTS, key=lambda name: name not in LEAST), *TOOLS)
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--only", nargs="+", default=rows, choices=rows, metavar="ROW")
    parser.add_argument("--bodies", nargs="+", default=BODIES, choices=BODIES, metavar="BODY")
    parser.add_argument("--anew", action="store_true")
    parser.add_argument("--table", action="store_true")
    given = parser.parse_args(words)
    found = store.load(NAME).values if NAME in store.names() else {}
    for row in () if given.table else (row for row in rows if row in given.only):
        for body in sorted(given.bodies, key=lambda body: robot_of(body).tables is not None):  # they take long
            if given.anew or body not in found.get(row, {}):
                began = process_time()
                found.setdefault(row, {})[body] = answer = tried(row, body)
                store.save_part(NAME, {name: dict(sorted(cells.items())) for name, cells in sorted(found.items())})
                print(f"{row} {body} ({process_time() - began:.0f} s): {answer or 'answers'}", flush=True)
    write(found)
    every = [(row, body, answer) for row, cells in found.items() for body, answer in cells.items()]
    odd = [(row, body) for row, body, answer in every if answer.startswith("exit ")]
    for row, body in odd:
        print(f"{row} on {body}: {found[row][body]}", file=sys.stderr)
    return bool(odd)


def tried(row: str, body: str) -> str:
    """Return what came of a row on a body: nothing where it answers, else the sentence of refusal or failure."""
    with tempfile.TemporaryDirectory() as folder:
        out, err = io.StringIO(), io.StringIO()
        try:
            with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
                code = door(row, body, Path(folder))()
        except Exception as error:
            return f"exit 1: {type(error).__name__}: {error}"
    if code == 0:
        return ""
    said = err.getvalue().strip().splitlines()[-1:] or [""]
    return said[0] if code == 2 else f"exit {code}: {said[0]}"


def door(row: str, body: str, folder: Path) -> Callable[[], int]:
    """Return what tries a row on a body, in a folder of its own."""
    if row.startswith("task "):
        return lambda: _step(row.removeprefix("task "), asked(body))
    words = command(row, body, folder)
    if row not in ("view", "lake"):
        return lambda: suchus(words)

    def viewed() -> int:
        with mock.patch("suchus.apps.cli.view._serve", return_value=0):  # all but the browser
            return suchus(words)

    return viewed


def _step(task: str, body: str) -> int:
    """Take the first step of an episode of a task; what is refused is told as at the command line."""
    try:
        env = gymnasium.make(f"suchus/{task}-v0", robot=body)
        env.reset(seed=1)
        env.step(env.action_space.sample())
    except SuchusError as error:
        print(f"suchus: {error}", file=sys.stderr)
        return 2
    return 0


def command(row: str, body: str, folder: Path) -> list[str]:
    """Return the words by which a row is tried on a body, in a folder of its own."""
    if row in EXPERIMENTS:
        words = ["run", row, "--quick", "--robot", asked(body), "--out", str(folder), *shlex.split(LEAST.get(row, ""))]
        timed = row in LEAST and hasattr(EXPERIMENTS[row], "timestep")
        return [*words, "--timestep", f"{coarse_step(robot_of(body)):g}"] if timed else words
    if row in ("view", "lake"):
        return ["view", asked(body), *["--lake"] * (row == "lake")]
    if row == "capture":
        tracks = write_table(film_animal(LIZARD, CAMERA, cycles=3), folder / "tracks.csv")
        return ["capture", str(tracks), "--robot", asked(body), "--out", str(folder / "captured.toml")]
    if row == "export":
        return ["export", "--robot", asked(body), "--out", str(folder / "exported")]
    file = folder / f"{row}.toml"
    file.write_text(asked_of(row, body))
    return [row, str(file), "--out", str(folder / "found")]


def asked_of(row: str, body: str) -> str:
    """Return a study or a search, of four runs of two seconds, of the period of a body's own gait."""
    robot = robot_of(body)
    period = default_gait(robot).period
    lines = [f'name = "{row}_{robot.name}"', f'robot = "{asked(body)}"', f"timestep = {coarse_step(robot):g}"]
    lines.append(f"duration = {2.0 if row == 'study' else 3.0}")
    lines += ["measure = ['displacement']"] if row == "study" else ["evaluations = 4", "population = 4"]
    lines += ["[[vary]]", 'field = "gait.period"', f"low = {0.9 * period}", f"high = {1.1 * period}"]
    lines += ["steps = 2"] if row == "study" else ["[[aims]]", 'name = "displacement"']
    return "\n".join(lines) + "\n"


def write(found: dict[str, dict[str, str]]) -> None:
    """Write the tables into the page."""
    begin, end = MARKS
    before, rest = PAGE.read_text().split(begin)
    PAGE.write_text(before + begin + tables(found) + end + rest.split(end)[1])


def tables(found: dict[str, dict[str, str]]) -> str:
    """Return the table of the bodies of the catalog, and that of files."""
    return f"{table(found, ROBOTS)}\n{table(found, FILES)}"


def table(found: dict[str, dict[str, str]], bodies: Iterable[str]) -> str:
    """Return the table of some bodies."""
    bodies = tuple(bodies)
    rows = [row for row in (*EXPERIMENTS, *TOOLS) if set(bodies) & set(found.get(row, {}))]
    lines = ["| | " + " | ".join(f"`{body}`" for body in bodies) + " |", "|---" * (len(bodies) + 1) + "|"]
    for row in rows:
        cells = [mark(found[row].get(body)) for body in bodies]
        lines.append(f"| {TOOLS.get(row, f'`{row}`')} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def mark(answer: str | None) -> str:
    """Return what a cell shows."""
    if answer is None:
        return "not tried"
    return "answers" if not answer else "failed" if answer.startswith("exit ") else "refuses"


if __name__ == "__main__":
    sys.exit(main())
