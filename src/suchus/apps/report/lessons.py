"""Five lessons of ten minutes for a class: each one page that plays offline, with a replay, a slider and a question.

What is right follows from the runs: every number on a page is measured when the page is made.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from suchus.apps.laboratory.engine import NoEngine, read_engine
from suchus.apps.laboratory.link import constant_level, page_settings
from suchus.apps.laboratory.page import laboratory_page
from suchus.apps.report.qr_code import qr_picture
from suchus.core.files import write
from suchus.core.progress import Progress, silent, staged
from suchus.robot.control import Swimming
from suchus.robot.design.ground import Ground
from suchus.robot.gaits import GAITS
from suchus.robot.motion import START, Gait
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Lake, Run, failing_joints, joint_failure, simulate
from suchus.visual.pages import embed_json, render
from suchus.visual.replay.page import render_template

_TIMESTEP, _SAMPLE_INTERVAL = (
    0.005,
    2,
)  # [s] of physics, and steps between samples; few samples keep the page small
_WATER_LEVEL = 1.0
"""Level of the water in which the swimmer swims [m]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Lesson:
    """One page: runs of one robot, of which a slider chooses, and a question that they answer."""

    name: str
    """Name of the file without its ending."""
    title: str
    """Heading."""
    caption: str
    """Description of the scene, in one or two sentences."""
    choice: str
    """Name of the slider."""
    runs: tuple[Run, ...]
    """The runs, each labelled with the slider's value."""
    cycles: float
    """Cycles of the gait that are shown [-]."""
    question: str
    """Question, whose answer is one of the labels."""
    right: Callable[[Sequence[float]], int]
    """Returns which run is the answer, given how far each got [m]."""
    because: str
    """Explanation, which holds whichever run is the answer."""
    command: str
    """Command to continue with."""
    laboratory: Gait | None = None
    """Gait in which the page of the laboratory begins that shows the same runs; None for a lesson without it."""


def lessons() -> tuple[Lesson, ...]:
    """Return the lessons in their order."""
    return _bending(), _timing(), _joints(), _friction(), _waves()


def write_lessons(
    folder: Path, selection: Sequence[Lesson] = (), progress: Progress = silent, *, address: str = ""
) -> list[Path]:
    """Write lessons, a page that lists them, a sheet to print and the laboratory; return the paths, the list first.

    The laboratory is left out where its engine is not on this machine, see ``laboratory_absence``.

    Args:
        folder: folder for the pages; made where it is not there.
        selection: the lessons; all if empty.
        progress: called with the share that is done, 0 to 1.
        address: address of the folder for the class, with a slash at its end, as the list and the sheet say it, with a
            QR code if segno is installed; empty if it has none.

    Raises:
        Unwritable: the place cannot be written to.
    """
    selection = selection or lessons()
    laboratories = _laboratory_lessons(selection)
    links = [(f"{name}.html", f"{lesson.runs[0].robot.name}") for name, lesson in laboratories.items()]
    codes = {lesson.name: qr_picture(f"{address}{lesson.name}.html" if address else "") for lesson in selection}
    shared: dict[str, Any] = {"lessons": selection, "address": address, "code": qr_picture(address)}
    pages = {
        "index": render("lessons.html", title="Lessons of ten minutes", laboratories=links, **shared),
        "sheet": render("lesson_sheet.html", title="Lessons of ten minutes: the sheet", codes=codes, **shared),
    }
    for i, (lesson, following) in enumerate(zip(selection, [*selection[1:], None], strict=True)):
        page_progress = staged(progress, lesson.name, i / len(selection), (i + 1) / len(selection))
        pages[lesson.name] = page(lesson, following, page_progress)
    for name, lesson in laboratories.items():
        assert lesson.laboratory is not None
        pages[name] = laboratory_page(lesson.runs[0].robot, lesson.laboratory, level=constant_level(lesson.runs[0]))
    return [write(file, pages[file.stem]) for file in lesson_files(folder, selection)]


def lesson_files(folder: Path, selection: Sequence[Lesson] = ()) -> list[Path]:
    """Return where ``write_lessons`` writes, in the order in which it does."""
    selection = selection or lessons()
    names = ("index", *(lesson.name for lesson in selection), "sheet", *_laboratory_lessons(selection))
    return [folder / f"{name}.html" for name in names]


def laboratory_absence() -> str:
    """Return in a sentence why lessons are written without the laboratory; empty if they are written with it."""
    try:
        read_engine()
    except NoEngine as error:
        return str(error)
    return ""


def page(lesson: Lesson, following: Lesson | None = None, progress: Progress = silent) -> str:
    """Return a lesson as an HTML page; ``following`` is the lesson that it leads to."""
    first_run = lesson.runs[0]
    duration = START + lesson.cycles * max(run.gait.period for run in lesson.runs)
    record = simulate(
        lesson.runs, duration=duration, timestep=_TIMESTEP, sample_stride=_SAMPLE_INTERVAL, progress=progress
    )
    run_records = [record.isel(run=i) for i in range(len(lesson.runs))]
    distances = [
        float(run_record.centre_of_mass[-1, 0] - run_record.centre_of_mass[0, 0]) for run_record in run_records
    ]
    labels = [run.label for run in lesson.runs]
    addresses = _laboratory_addresses(lesson)
    return render_template(
        "lesson.html", run_records[0], first_run.robot, other_records=run_records[1:], choice=lesson.choice,
        labels=labels,
        title=lesson.title, caption=lesson.caption, question=lesson.question, options=labels,
        right=lesson.right(distances), because=lesson.because,
        numbers=[f"{value:.2f} m".replace("-", "−") for value in distances],
        heading=f"forward in {duration:g} s", command=lesson.command, following=following,
        addresses=addresses, addresses_json=embed_json(addresses),
    )  # fmt: skip


def _laboratory_lessons(selection: Sequence[Lesson]) -> dict[str, Lesson]:
    """Return the pages of the laboratory that lessons need, by file name, each with the first lesson that needs it."""
    if laboratory_absence():
        return {}
    named = {_laboratory_name(lesson): lesson for lesson in reversed(selection) if lesson.laboratory is not None}
    return dict(reversed(named.items()))


def _laboratory_name(lesson: Lesson) -> str:
    assert lesson.laboratory is not None
    return f"laboratory_{lesson.runs[0].robot.name}_{lesson.laboratory.name}"


def _laboratory_addresses(lesson: Lesson) -> list[str]:
    """Return for each run the link to the laboratory with its settings; none where there is no laboratory."""
    if lesson.laboratory is None or laboratory_absence():
        return []
    start_gait = lesson.laboratory
    settings = [page_settings(run, start_gait, start_level=constant_level(lesson.runs[0])) for run in lesson.runs]
    return [f"{_laboratory_name(lesson)}.html{'#' if text else ''}{text}" for text in settings]


def _index_of_farthest(distances: Sequence[float]) -> int:
    return int(np.argmax(distances))


def _index_of_nearest(distances: Sequence[float]) -> int:
    return int(np.argmin(distances))


def _index_of_backward(distances: Sequence[float]) -> int:
    """Return the first run that goes backwards; the one that gets least far where none does."""
    backward_runs = np.flatnonzero(np.asarray(distances) < 0.0)
    return int(backward_runs[0]) if backward_runs.size else _index_of_nearest(distances)


def _bending() -> Lesson:
    """Return the lesson in which the slider scales the lateral bend of spine and tail."""
    robot, gait = ROBOTS["caiman"], GAITS["belly_crawl"]
    return Lesson(
        name="bending",
        title="What is a bending spine good for?",
        caption="The legs do exactly the same in every run. Only how far spine and tail bend is different.",
        choice="Bend of spine and tail",
        runs=tuple(
            Run(robot=robot, gait=gait.bent(bend_factor), label=f"{bend_factor:.0%} of its crawl")
            for bend_factor in (0.0, 0.25, 0.5, 0.75, 1.0)
        ),
        cycles=2,
        question="With which bend does it get farthest?",
        right=_index_of_farthest,
        because="A foot that stands holds on to the ground. When the trunk bends it turns hips and shoulders, "
        "which carries the body past the standing foot, and reaches out with the foot in the air: the "
        "step gets longer, though the leg moves no more than before. Look at the tracks: how long is a "
        "step in each run?",
        command="suchus run displacement",
        laboratory=gait,
    )


def _timing() -> Lesson:
    """Return the lesson in which the slider delays the bend of the spine against the limbs."""
    robot, gait = ROBOTS["caiman"], GAITS["belly_crawl"]
    lags = {"in time with the legs": 0.0, "1/8 cycle late": 0.125, "1/4 cycle late": 0.25, "3/8 cycle late": 0.375,
            "1/2 cycle late": 0.5}  # fmt: skip
    return Lesson(
        name="timing",
        title="Does it matter when the spine bends?",
        caption="Legs and spine move just as much in every run. Only when the spine bends is different.",
        choice="The spine bends",
        runs=tuple(Run(robot=robot, gait=gait.lagged(lag), label=label) for label, lag in lags.items()),
        cycles=2,
        question="How late must the spine be at least for the robot to crawl backwards?",
        right=_index_of_backward,
        because="In time, the trunk turns each leg backwards while its foot stands: leg and spine push the same "
        "way. Half a cycle late the spine turns the leg forwards while its foot stands, and takes away "
        "what the leg gives. Where it takes more than the leg gives, the robot goes backwards.",
        command="suchus view",
        laboratory=gait,
    )


def _joints() -> Lesson:
    """Return the lesson in which the slider chooses the joint that gives no torque."""
    robot, gait = ROBOTS["caiman"], GAITS["belly_crawl"]
    return Lesson(
        name="joints",
        title="Which broken joint is the worst?",
        caption="In every run one joint of a left leg gives no torque. The robot does not know, and crawls on as "
        "before.",
        choice="Joint without torque",
        runs=tuple(
            Run(robot=robot, gait=gait, faults=joint_failure(robot, gait, joint, "limp"), label=joint.replace("_", " "))
            for joint in failing_joints(robot)
        ),
        cycles=2,
        question="Which joint costs the most distance?",
        right=_index_of_nearest,
        because="Yaw swings a leg forward and back, pitch and knee carry the body and lift the foot. Watch the "
        "arrows, which are the forces on the feet: a leg can lose its push, or its load, which other feet "
        "and the belly then take. Does the robot still go straight?",
        command="suchus run joint_faults",
        laboratory=gait,
    )


def _friction() -> Lesson:
    """Return the lesson in which the slider scales the friction of the ground."""
    robot, gait = ROBOTS["caiman"], GAITS["belly_crawl"]
    factors = {
        "a tenth of usual": 0.1,
        "a fifth of usual": 0.2,
        "half of usual": 0.5,
        "usual": 1.0,
        "twice as rough": 2.0,
    }
    return Lesson(
        name="friction",
        title="Is rougher ground better?",
        caption="The same crawl, on ground from slippery to rough.",
        choice="Friction of the ground",
        runs=tuple(
            Run(robot=robot, gait=gait, ground=Ground(friction_scale=factor), label=label)
            for label, factor in factors.items()
        ),
        cycles=2,
        question="On which ground does it get least far?",
        right=_index_of_nearest,
        because="Friction does two things: feet push with it, and whatever drags over the ground is braked by it. "
        "If both were scaled alike and nothing else counted, the distance would not change at all. Look "
        "which feet slide, in which direction, and what the tail does.",
        command="suchus run terrain",
        laboratory=gait,
    )


def _waves() -> Lesson:
    """Return the lesson in which the slider sets the number of waves on a swimming body."""
    robot, gait = ROBOTS["swimmer"], GAITS["undulation"]
    waves = {"one, from tail to head": -1.0, "none: all joints at once": 0.0, "a half, from head to tail": 0.5,
             "one, from head to tail": 1.0, "one and a half, from head to tail": 1.5}  # fmt: skip
    return Lesson(
        name="waves",
        title="How does a body without legs swim?",
        caption="A row of joints in water. Each swings just as far in every run; only which swings first is different.",
        choice="Waves on the body",
        runs=tuple(
            Run(
                robot=robot,
                gait=gait.with_numbers(waves=count),
                label=label,
                lake=Lake(level=_WATER_LEVEL),
                control=Swimming(),
            )
            for label, count in waves.items()
        ),
        cycles=6,
        question="Which swims fastest?",
        right=_index_of_farthest,
        because="A wave that runs along the body presses on the water behind it, and the water presses back: the "
        "body goes the other way. So a wave towards the tail swims forwards, and one towards the head "
        "swims backwards. How many waves there are decides how much of the pressing is along the body and "
        "how much only to the sides.",
        command="suchus run swim_sweep",
        laboratory=gait,
    )
