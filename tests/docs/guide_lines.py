"""The lines of README and guide that a reader types, and what their test does with each."""

import re
import shlex
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
FOLLOWED = ("index", "extending", "own_robot", "own_experiment", "own_flow")
"""Pages whose ``sh`` and ``python`` blocks ``test_how_to_pages.py`` runs; here their ``bash`` blocks and inline lines
are looked at."""
SHELLS = ("sh", "bash")

PYTHON_ELSEWHERE = {
    "README": "tests/test_examples.py",
    "water_in_mujoco": "tests/immersion/test_water_page.py",
    **dict.fromkeys(FOLLOWED, "tests/docs/test_how_to_pages.py"),
}
"""Pages whose Python another test runs, and that test."""

UNTIL = {
    "run": ("suchus.apps.cli.run:perform", "tests/shelves/test_experiments.py"),
    "view": ("suchus.apps.cli.view:_serve suchus.apps.cli.view:takes suchus.apps.cli.view:vortex_film",
             "tests/viewer/test_view_command.py"),
    "page": ("suchus.apps.cli.page:laboratory_page", "tests/laboratory/test_page_command.py"),
    "replay": ("suchus.apps.cli.replay:check_file", "tests/cli/test_replay_command.py"),
    "compare": ("suchus.apps.cli.compare:_folder", "tests/cli/test_compare_command.py"),
    "reproduce": ("suchus.apps.cli.reproduce:_run_tasks", "tests/cli/test_command_line.py"),
    "lessons": ("suchus.apps.cli.lessons:write_lessons suchus.apps.cli.lessons:LessonServer",
                "tests/report/test_lessons.py"),
    "study": ("suchus.apps.cli.study:at_scheduler", "tests/cli/test_study_command.py"),
    "optimise": ("suchus.apps.cli.optimise:at_scheduler", "tests/optimise/test_conduct_optimise.py"),
    "train": ("suchus.apps.cli.train:conduct", "tests/train/test_training.py"),
    "size": ("suchus.apps.cli.size:size", "tests/cli/test_size_and_parts.py"),
    "capture": ("suchus.apps.cli.capture:walked_forces suchus.apps.cli.capture:played_forces",
                "tests/capture/test_command.py"),
    "drive": ("suchus.apps.cli.drive:drive", "tests/hardware/test_drive_log.py"),
    "calibrate": ("suchus.apps.cli.calibrate:Rig suchus.apps.cli.calibrate:load", "tests/hardware/test_calibrate.py"),
}  # fmt: skip
"""Commands that are carried out until they would compute or serve for long: where that begins, and the test file in
which the rest runs. All words are read and checked, all files of robots and gaits are read."""

ADDED = {
    "emulate": ("--seconds 0.02 --socket", "it would serve until Ctrl-C, in a terminal"),
    "drive": ("--dry-run", "there is no bus"),
    "parts": ("--no-outlines", "outlines of all bodies take ten seconds"),
}
"""Words that are added to a command, and why."""
REMOVED = {
    "--view": "it opens a page in the browser",
    "--clock bus": "the emulator would wait for a drive, and the drive for the emulator",
    "--dry-run": "it is added to each drive",
}
"""Words that are left out of ``suchus emulate`` and ``suchus drive``, and why."""

ASSUMED = {
    "README": "my_robot.urdf",
    "index": "my_robot.urdf my_study.toml",
    "page": "my_dog.urdf FILE",
    "viewer": "lizard.csv out/displacement/record.nc out/swimming/record.nc out/swim_3d/record.nc",
    "own_robot": "my_robot.toml",
    "own_experiment": "tracks.csv",
    "robots_from_files": "my_robot.urdf dog.urdf examples/linear_tail.toml",
    "studies": "FILE.toml",
    "optimise": "result/coordinated.toml",
    "capture": "tracks.csv film_points.csv salamander_walking.csv",
    "environments": "HEXAPOD.toml HEXAPOD.npz FILE.npz OTHER.npz THIRD.npz out/train/velocity_NAME/velocity_NAME.npz "
                    "out/train/velocity/velocity.npz out/train/velocity_still_axis/velocity_still_axis.npz",
    "terrain": "my_robot.toml",
    "faults": "out/optimise/fault_strider/result/outcome.json",
    "build_one": "my_robot.toml my_gait.toml my_servos.toml export/caiman_size/robot.toml",
}  # fmt: skip
"""Files that a reader of a page has when a line names them: of his own, or of earlier and longer lines."""
COPIES = {
    "my_robot.urdf": "src/suchus/core/samples/quadruped.urdf",
    "my_dog.urdf": "src/suchus/core/samples/quadruped.urdf",
    "dog.urdf": "src/suchus/core/samples/quadruped.urdf",
    "tracks.csv": "src/suchus/core/samples/lizard.csv",
    "lizard.csv": "src/suchus/core/samples/lizard.csv",
    "film_points.csv": "src/suchus/core/samples/lizard.csv",
    "salamander_walking.csv": "tests/data/animals/salamander_walking.csv",
    "my_servos.toml": "src/suchus/robot/motors/motors.toml",
    "examples/linear_tail.toml": "examples/linear_tail.toml",
    "HEXAPOD.npz": "src/suchus/robot/policies/velocity_strider.npz",
    "FILE.npz": "src/suchus/robot/policies/velocity.npz",
    "OTHER.npz": "src/suchus/robot/policies/fault.npz",
    "THIRD.npz": "src/suchus/robot/policies/velocity_untold.npz",
    "out/train/velocity/velocity.npz": "src/suchus/robot/policies/velocity.npz",
    "out/train/velocity_still_axis/velocity_still_axis.npz": "src/suchus/robot/policies/velocity_still_axis.npz",
    "out/train/velocity_NAME/velocity_NAME.npz": "src/suchus/robot/policies/velocity_strider.npz",
}
"""Files of the repository that stand in the place of such files."""
TEXTS = {
    "my_robot.toml": 'base = "caiman"\n',
    "export/caiman_size/robot.toml": 'base = "caiman"\n',
    "HEXAPOD.toml": 'base = "strider"\nname = "strider"\n',
    "my_gait.toml": 'base = "belly_crawl"\n',
    "result/coordinated.toml": 'base = "belly_crawl"\n',
    "FILE": 'base = "belly_crawl"\n',
}
"""Texts of such files; all others are empty, since what reads them is not reached."""

LEFT_OUT = {
    "suchus capture film.mp4 --digitise points.html --every 4 --start 2 --end 6":
        "a film in MP4 needs the extra capture; tests/capture/test_digitise.py makes pages of films",
    "suchus capture film.gif --digitise points.html": "tests/capture/test_digitise.py makes pages of films",
    "suchus export --format usd": "tests/cli/test_export_command.py writes USD where the extra usd is there",
    "suchus export --format onnx --policy FILE.npz": "tests/control/test_learned.py writes ONNX",
    "suchus stride --help": "a command of the page's own; test_how_to_pages.py runs it",
}  # fmt: skip
"""Lines that are not run here, and why."""

FRAGMENTS = ("suchus run swim_3d --jobs", "suchus export-commands --write-map", "suchus calibrate log")
"""Inline words that name an option or a kind of a command and are no whole line: the help has them."""

OTHER_PROGRAMS = {
    "pip": "it installs; tests/release installs wheel and sdist into fresh environments",
    "python3": "it makes an environment",
    "source": "it enters an environment",
    "uvx": "it installs",
    "make": "it sets up environments; here its targets are looked for in the Makefile",
    "venv/bin/pip": "it installs",
    "dask": "a cluster's own program; tests/jobs/test_cluster.py has a cluster",
    "kubectl": "a cluster's own program",
    "openssl": "keys of a cluster; tests/jobs/test_cluster.py makes its own",
    "SUCHUS_PROJECT=~/my_lab": "pytest in a project; test_page_examples.py does that",
}
"""Programs other than suchus by their first word, and why their lines are not run."""

SHORTER = {
    "wake.run(80.0).select_after(55.0)": ("wake.run(1.0).select_after(0.1)", "half a minute"),
    "flow.strouhal(late.time, late.force()[:, 1], length=1.0, speed=1.0)": (
        "0.0",
        "no vortex is shed so soon",
    ),
    "sim.run(9.0).select_after(8.0)": ("sim.run(0.1).select_after(0.0)", "half a minute"),
    "stream.run(4.0)": ("stream.run(0.1)", "ten seconds"),
    "(20, 30, 40)], 1.0)": ("(20, 30, 40)], 0.1)", "some seconds"),
    "swim.run(0.5)": ("swim.run(0.02)", "some seconds"),
    "sim.run(2.0)": ("sim.run(0.05)", "some seconds"),
    "wake.run(60.0, watch=(rake, series))": ("wake.run(1.2, watch=(rake,))", "half a minute"),
    "simulate([run], duration=4.0)": ("simulate([run], duration=0.02)", "minutes"),
    "= resolved_swim(robot, motion, setting)": ("= signature(resolved_swim).bind(robot, motion, setting)", "minutes"),
    "= swim_on_joints(robot, motion, setting)": ("= signature(swim_on_joints).bind(robot, motion, setting)", "minutes"),
    "steps=11": ("steps=2", "some seconds"),
    ".run(10.0, watch=": (".run(0.2, watch=", "ten seconds"),
    ".select_after(5.0)": (".select_after(0.0)", "so short a run ends earlier"),
}
"""Parts of Python blocks: what stands in their place here, and how long the page's own take. ``signature`` is that of
``inspect``, so that a call is tried without computing."""


CLUSTERS = ("# slurm.py", "# kubernetes.py")
"""How blocks of Python begin that need a cluster; ``tests/jobs/test_cluster.py`` has one of processes."""


@dataclass(frozen=True, slots=True)
class Line:
    """A line that a reader types."""

    page: str
    """Page on which it stands."""
    words: tuple[str, ...]
    """Words, comments left out."""
    is_inline: bool
    """Whether it stands within a sentence."""
    language: str
    """Language of its fence, empty within a sentence."""

    @property
    def text(self) -> str:
        """Return the line without its comment."""
        return shlex.join(self.words)


_FENCE = re.compile(r"^```(\w*)[^\n]*\n(.*?)^```$", re.M | re.S)


def page_text(page: str) -> str:
    """Return the text of a page of the guide, or of the README."""
    path = ROOT / "README.md" if page == "README" else ROOT / "docs" / f"{page}.md"
    return path.read_text(encoding="utf-8")


def lines_of_block(page: str, language: str, text: str) -> list[Line]:
    """Return the lines of a fenced block of a shell."""
    words = [tuple(shlex.split(line, comments=True)) for line in text.splitlines()]
    return [Line(page, _plain(line), is_inline=False, language=language) for line in words if line]


def inline_lines(page: str) -> list[Line]:
    """Return the lines of suchus that stand within sentences of a page."""
    prose = _FENCE.sub("", page_text(page))
    texts = re.findall(r"`((?:suchus|python|pip|uvx|make)\s[^`]+)`", prose)
    return [
        Line(page, tuple(shlex.split(text)), is_inline=True, language="")
        for text in dict.fromkeys(re.sub(r"\s+", " ", text) for text in texts)
    ]


def shell_lines(page: str) -> list[Line]:
    """Return all lines of a shell on a page."""
    blocks = [match for match in _FENCE.finditer(page_text(page)) if match[1] in SHELLS]
    fenced = [line for match in blocks for line in lines_of_block(page, match[1], match[2])]
    return fenced + inline_lines(page)


def _plain(words: tuple[str, ...]) -> tuple[str, ...]:
    """Return words in which suchus is named without the folder of its environment."""
    return ("suchus", *words[1:]) if words[0].endswith("/bin/suchus") else words
