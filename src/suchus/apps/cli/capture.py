"""``suchus capture TRACKS``: keypoints of a walking body in, a gait file and its diagram out."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Literal

import numpy as np
import tyro
import xarray as xr

from suchus.animals.capture import (
    ROBOT_NEEDS,
    ReadingOptions,
    Tracks,
    View,
    Walk,
    angle_tables,
    compare_joints,
    comparison_lines,
    driven_fraction,
    is_angle_table,
    observe,
    read_angles,
    read_tracks,
    summary,
    tables,
    to_curves,
    to_gait,
    write_gait,
)
from suchus.animals.digitise import digitising_page
from suchus.animals.forces import DRAWS, RUNGS, Rung, Unknown, played_forces, summary_lines, walked_forces
from suchus.animals.overlay import overlay
from suchus.animals.pictures import is_film
from suchus.apps.cli.entry import BadCommand
from suchus.apps.cli.options import parse
from suchus.apps.cli.run import run_command_lines
from suchus.apps.cli.terminal import working
from suchus.apps.cli.word_checks import check_page, check_toml
from suchus.core.files import check_replaceable, check_writable, write
from suchus.core.files.store import packed
from suchus.core.files.tables import COLUMNS, write_tables
from suchus.core.progress import Progress
from suchus.robot import blueprint
from suchus.robot.design import Robot, check_needs
from suchus.robot.gaits import default_gait
from suchus.robot.motion import Gait, check_limits
from suchus.robot.robots import ROBOTS
from suchus.visual.figures import captioned, places, save
from suchus.visual.figures.forces import ground_forces_figure, water_forces_figure
from suchus.visual.figures.gait_diagram import GaitTrack, gait_diagram
from suchus.visual.figures.measured import curvature_figure, strides_figure


@dataclass(frozen=True, slots=True, kw_only=True)
class CaptureOptions:
    """Options of ``suchus capture``."""

    tracks: Annotated[Path, tyro.conf.Positional]
    """CSV table of keypoints or of joint angles, a TRC or C3D file, or one of DeepLabCut, SLEAP, LightningPose or
    Anipose."""
    out: Path | None = None
    """The gait file, by default captured.toml, or none where tables are asked for; its diagram is saved beside it."""
    tables: Path | None = None
    """Folder for what was measured: tables in CSV and NetCDF, every stride and the mean with intervals, and figures."""
    forces: Path | None = None
    """Folder for forces in newtons, through the body of --robot in the animal's size: under single feet of a walk, of
    the water on a swim; tables in CSV and NetCDF with intervals, and a figure."""
    video: Path | None = None
    """The film itself, a video, a GIF or a folder of pictures; with --tables, skeleton and contacts are drawn on it."""
    digitise: Path | None = None
    """A page on which you click the points of a film; PATH is then the film: a video, a GIF or a folder of pictures.
    The page saves the table that this command reads."""
    every: int = 1
    """The page of --digitise has every so many-th frame of the film [-]."""
    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot for which the gait is made."""
    base: Gait | None = None
    """Gait from which the numbers are taken that cannot be seen; by default the robot's own."""
    period: float = 1.0
    """Duration of the cycle in a table of joint angles [s]; keypoints need none."""
    duty: Literal["retraction", "contact"] = "retraction"
    """Duty factor as the fraction of the cycle in which feet move back along the body, or rest on the ground."""
    girdles: Literal["alike", "apart"] = "alike"
    """Stroke and lift as the mean of all feet, or of the front feet and of the hind feet."""
    time: Literal["froude", "own"] = "froude"
    """Whether the robot's period goes with the square root of its length, at the animal's Froude number, or is the
    animal's own."""
    trunk: float | None = None
    """The animal's length from hip to shoulder [m], for films in pixels, which do not show it."""
    length: float | None = None
    """The animal's whole length [m], for the forces of swims in pixels."""
    medium: Literal["auto", "land", "water"] = "auto"
    """Whether the animal of --forces walks or swims; auto: it walks if its feet were tracked."""
    mass: tuple[float, ...] = ()
    """The animal's mass, or the ends of its range [kg]; with --forces, by default that of the body at its size."""
    friction: tuple[float, float] = (0.4, 1.0)
    """Ends of the range of the friction between feet and ground [-]; with --forces."""
    models: tuple[Rung, ...] = RUNGS
    """Models of the water that --forces asks: forces section by section, a plane flow, the flow in space (minutes)."""
    draws: int = DRAWS
    """Choices of what is not known, by which forces have intervals [-]; with 39 these hold the truth in 95 of 100."""
    tail_share: float | None = None
    """Place along the tail up to which its bend is measured, 1 at the tip; by default the end of what is driven."""
    names: tuple[str, ...] = ()
    """Keypoints that have other names in the file, as THEIRS=OURS."""
    fps: float | None = None
    """Frames per second [Hz], if the file does not say."""
    software: str | None = None
    """Software that wrote the file; guessed by default."""
    individual: str | None = None
    """Name of the individual whose tracks are read, if the file holds several."""
    confidence: float = 0.6
    """Confidence below which a keypoint counts as missing [-], 0 to 1."""
    y_axis: Literal["auto", "up", "down"] = "auto"
    """Whether y points to the left of x, seen from above (up), or to the right (down), as in images."""
    view: View = "top"
    """Whether the camera stood above the animal, or beside it: then y is up, and bends up and down are measured."""
    unit: str | None = None
    """Unit of lengths, m, cm or mm, in files of pose estimators that do not say it."""
    start: float | None = None
    """Time before which frames are left out [s]."""
    end: float | None = None
    """Time after which frames are left out [s]."""


def capture(words: Sequence[str]) -> int:
    """Read a gait from tracks, write it and its diagram, say what was seen, and return 0.

    Raises:
        SuchusError: the words or the tracks make no sense.
    """
    description = "Read a gait from tracked keypoints of a walking body: a gait file to run, and its diagram."
    options = parse(CaptureOptions, "suchus capture", words, description)
    if options.digitise:
        return _write_digitising_page(options, options.digitise)
    if is_film(options.tracks):
        raise BadCommand(
            f"{options.tracks} is a film or a folder of its pictures, and this command reads tracked keypoints. "
            "--digitise points.html makes a page on which you click them; DeepLabCut and SLEAP track them."
        )
    output = options.out or (None if options.tables or options.forces else Path("captured.toml"))
    if options.video and not options.tables:
        raise BadCommand("--video is drawn into the folder of --tables; give that too, as in --tables measured.")
    for folder in (options.tables, options.forces):
        if folder:
            check_writable(folder)
            check_replaceable(folder)
    if options.tables and options.tables == options.forces:
        raise BadCommand(f"--tables and --forces both name {options.tables}; give each a folder of its own.")
    unknown = _unknown(options)
    if output:
        check_toml(output, "gait")
        check_writable(output.parent)
        check_replaceable(output)
    if is_angle_table(options.tracks):
        return _write_played_gait(options, output, _robot_word(words), unknown)
    robot = options.robot
    if output:
        for path in places(output.parent, output.stem):
            check_replaceable(path)
        check_needs(robot, ROBOT_NEEDS, "a gait from tracked keypoints")
    with working() as bars:
        move = bars.task(options.tracks.name)
        move("reading", 0.1)
        tracks = read_tracks(options.tracks, _reading_options(options)).between(options.start, options.end)
        move("looking for the cycle", 0.3)
        fraction = driven_fraction(robot) if output else 1.0
        walk = observe(tracks, tail_share=fraction if options.tail_share is None else options.tail_share)
        lines, notes, messages = summary(walk), walk.notes, list[str]()
        if output:
            base = options.base or default_gait(robot)
            captured = to_gait(
                walk,
                robot,
                base,
                name=output.stem,
                duty=options.duty,
                girdles=options.girdles,
                time=options.time,
                trunk=options.trunk,
            )
            comparison = compare_joints(walk, robot, captured.gait)
            lines, notes = [captured.timing, *lines], captured.notes
        if options.tables:
            move("measuring", 0.6)
            messages += _write_measurements(walk, tracks, options.tables, options.video)
        if options.forces:
            body = options.robot if _robot_word(words) or walk.cycle.sizes["leg"] else ROBOTS["swimmer"]
            messages += _forces(walk, body, options, unknown, bars.reporter("forces"))
        if output:
            move("writing", 0.8)
            if options.tables:
                write_tables(comparison, options.tables / "beside_the_robot")
            write_gait(captured, walk, output)
            picture = _draw(walk, output.parent, output.stem)
            messages += comparison_lines(comparison, robot.name)
            messages += [
                f"gait: {output}",
                f"diagram: {picture}",
                *run_command_lines(robot, _robot_word(words), output),
            ]
    print(*lines, *(f"note: {note}" for note in notes), *messages, sep="\n")
    return 0


def _write_digitising_page(options: CaptureOptions, output: Path) -> int:
    """Write the page on which the points of a film are clicked, say what to do with it, and return 0."""
    unused = [f"--{name}" for name in ("out", "tables", "forces", "video") if getattr(options, name)]
    if unused:
        raise BadCommand(
            f"{' and '.join(unused)} cannot stand beside --digitise: first click the points, then give the saved table."
        )
    check_page(output, "--digitise")
    check_replaceable(output)
    page = digitising_page(
        options.tracks, rate=options.fps, start=options.start, end=options.end, every=options.every
    )  # fmt: skip
    write(output, page)
    print(f"{output}, {output.stat().st_size / 1e6:.1f} MB: open it in a browser, click the points, save the table.")
    print(f"then: suchus capture {options.tracks.stem}_points.csv --out my_gait.toml")
    return 0


def _unknown(options: CaptureOptions) -> Unknown:
    """Return the ranges of mass and friction, which the film does not show."""
    mass = options.mass
    if len(mass) > 2 or (mass and not 0.0 < mass[0] <= mass[-1]):
        raise BadCommand(
            f"--mass is {' '.join(map(str, mass))}; one mass above 0 is needed, or two, the lower one first."
        )
    return Unknown(mass=(mass[0], mass[-1]) if mass else None, friction=options.friction, draws=options.draws)


def _forces(walk: Walk, body: Robot, options: CaptureOptions, unknown: Unknown, progress: Progress) -> list[str]:
    """Compute the forces of a walk or a swim, write them, and return the lines that describe them.

    Args:
        walk: the measured walk or swim.
        body: robot whose body stands for the animal's.
        options: options of the command.
        unknown: ranges of mass and friction that the film does not show.
        progress: called with the fraction that is done, 0 to 1.
    """
    assert options.forces is not None
    medium = options.medium
    if medium == "auto":
        medium = "land" if walk.cycle.sizes["leg"] else "water"
    if medium == "water":
        from suchus.animals.forces.water import swim_gait, swum_forces  # noqa: PLC0415  loads the flow solver

        data = swum_forces(
            walk, body, rungs=options.models, unknown=unknown, length=options.length, progress=progress
        )  # fmt: skip
        lines = _write_forces(data, options.forces)
        blueprint.write(swim_gait(walk, body), options.forces / "swim.toml")
        return lines
    data = walked_forces(
        walk, body, options.base, unknown=unknown, duty=options.duty, trunk=options.trunk, progress=progress
    )  # fmt: skip
    return _write_forces(data, options.forces)


def _write_forces(data: xr.Dataset, folder: Path) -> list[str]:
    """Write forces as tables, NetCDF and a figure, and return the lines that describe them."""
    write_tables(data, folder)
    write(folder / "forces.nc", packed(data))
    save(ground_forces_figure(data) if data.attrs["medium"] == "land" else water_forces_figure(data), folder, "forces")
    open_ends = [f"note: {note}" for note in data.attrs["notes"].splitlines()]
    return [*summary_lines(data), *open_ends, f"forces: {folder}; what each column is stands in {folder / COLUMNS}"]


def _write_measurements(walk: Walk, tracks: Tracks, folder: Path, video: Path | None) -> list[str]:
    """Write the tables and the figures of a walk, and return the lines that say where they are.

    Args:
        walk: the measured walk.
        tracks: its keypoints.
        folder: folder for the files.
        video: the film, on which skeleton and contacts are drawn; None: no overlay.
    """
    data = tables(walk)
    overlay_image = overlay(tracks, walk.strides, walk.wrong, video) if video else None
    write_tables(data, folder)
    write(folder / "measured.nc", packed(data))
    if walk.cycle.sizes["leg"] or "spine_lateral" in walk.cycle or "tail_lateral" in walk.cycle:
        _draw(walk, folder, "cycle")
    save(strides_figure(data), folder, "strides")
    if "curvature" in data:
        save(curvature_figure(data), folder, "curvature")
    messages = [f"tables: {folder}, {data.sizes['stride']} strides; what each column is stands in {folder / COLUMNS}"]
    if overlay_image is not None:
        messages.append(f"on the film: {write(folder / 'overlay.gif', overlay_image)}")
    return messages


def _robot_word(words: Sequence[str]) -> str:
    """Return the robot's name or file as the user typed it; empty where the user named no robot."""
    for word, following in zip(words, [*words[1:], ""], strict=True):
        if word == "--robot":
            return following
        if word.startswith("--robot="):
            return word.removeprefix("--robot=")
    return ""


def _write_played_gait(options: CaptureOptions, output: Path | None, robot_word: str, unknown: Unknown) -> int:
    """Write the gait that plays a table of joint angles, and its tables, print what they are, and return 0.

    Args:
        options: options of the command.
        output: the gait file; None: no gait is written.
        robot_word: the robot as the user named it; empty if not named.
        unknown: ranges of mass and friction that the film does not show.
    """
    cycle = read_angles(options.tracks)
    gait = to_curves(cycle, options.robot, name=output.stem, period=options.period) if output else None
    if gait:
        check_limits(options.robot, gait)
    if options.tables:
        data = angle_tables(cycle)
        write_tables(data, options.tables)
        write(options.tables / "measured.nc", packed(data))
        print(f"tables: {options.tables}, {data.sizes['joint']} joints over one cycle")
    if options.forces:
        with working() as bars:
            data = played_forces(
                cycle, options.robot, period=options.period, unknown=unknown, progress=bars.reporter("forces")
            )  # fmt: skip
        print(*_write_forces(data, options.forces), sep="\n")
    if output is None or gait is None:
        return 0
    blueprint.write(gait, output)
    largest_residual = max(zip(cycle.residual, cycle.joints, strict=True))
    print(f"{len(gait.curves)} servos of {options.robot.name} play {options.tracks.name}; closing the cycle changed")
    print(f"{largest_residual[1]} most, by {np.degrees(largest_residual[0]):.1f} degrees in the root mean square.")
    lines = run_command_lines(options.robot, robot_word, output, "salamander")
    print(f"gait: {output}", *lines, sep="\n")
    return 0


def _reading_options(options: CaptureOptions) -> ReadingOptions:
    """Return the settings with which tracks are read; ``--names`` becomes a mapping from names in the file to ours."""
    names = {}
    for pair in options.names:
        file_name, equals, keypoint = pair.partition("=")
        if not (file_name and equals and keypoint):
            raise BadCommand(f"--names has {pair!r}; THEIRS=OURS is needed, as in left_fore_paw=LF.")
        names[file_name] = keypoint
    return ReadingOptions(
        names=names,
        rate=options.fps,
        software=options.software,
        individual=options.individual,
        confidence=options.confidence,
        y_down=None if options.y_axis == "auto" else options.y_axis == "down",
        view=options.view,
        unit=options.unit,
    )


def _draw(walk: Walk, folder: Path, stem: str) -> Path:
    """Draw the mean cycle twice in a row as a gait diagram and return the path of its PNG.

    Args:
        walk: the measured walk.
        folder: folder for the figure.
        stem: name of the file without its ending.
    """
    cycle = walk.cycle

    def repeat_cycle(quantity: str) -> np.ndarray | None:
        return np.tile(cycle[quantity].values, 2) if quantity in cycle else None

    figure = gait_diagram(
        [
            GaitTrack(
                legs=tuple(str(leg) for leg in cycle.leg.values),
                time=np.concatenate([cycle.phase.values, 1.0 + cycle.phase.values]),
                stance=np.tile(cycle.stance.values, 2),
                **{region: repeat_cycle(f"{region}_lateral") for region in ("spine", "tail")},
                **{f"{region}_spread": repeat_cycle(f"{region}_lateral_spread") for region in ("spine", "tail")},
                label=walk.source,
            )
        ],
        cycles=(0.0, 1.0, 2.0),
        unit="cycle",
    )
    text = (
        f"The mean of {walk.cycles:.1f} cycles of {walk.source}, drawn twice. Black: a foot stands, spine or tail bend "
        "to the right. Bands: standard deviation of single frames, camera noise included."
    )
    return save(captioned(figure, text), folder, stem)[1]
