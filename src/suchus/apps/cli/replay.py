"""``suchus replay RECORD.nc``: a stored run as one HTML file that plays offline, or as a film."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro
import xarray as xr

from suchus.apps.cli.entry import BadCommand
from suchus.apps.cli.options import parse
from suchus.apps.cli.terminal import working
from suchus.apps.cli.word_checks import check_page
from suchus.core import files as record
from suchus.core.files import check_file, check_replaceable, write
from suchus.hardware import fix_in_place
from suchus.robot.design import Robot
from suchus.robot.robots import ROBOTS
from suchus.visual.replay import replay, save
from suchus.visual.replay.video import ENDINGS, check_encoder, video


@dataclass(frozen=True, slots=True, kw_only=True)
class ReplayOptions:
    """Options of ``suchus replay``."""

    file: Annotated[Path, tyro.conf.Positional]
    """The record of a run on land, a NetCDF file, such as out/displacement/record.nc."""
    run: str | None = None
    """The run of the record, by its label or its number from 0; needed if it holds several."""
    ghost: str | None = None
    """Another run of the record, for comparison, by its label or its number."""
    robot: Robot | None = None
    """Robot of the record; by default the one that the record names."""
    title: str = ""
    """Heading of the page; by default robot and gait."""
    out: Path | None = None
    """The page; by default the record's name with .html instead of .nc."""
    video: Path | None = None
    """A film of the run instead of the page: FILE.mp4, FILE.webm or FILE.webp; it needs no graphics card."""


def make_replay(words: Sequence[str]) -> int:
    """Write the page or the film, say where it is, and return 0.

    Raises:
        SuchusError: the words or the record make no sense, or the place cannot be written to.
    """
    description = (
        "Turn a stored run on land into one HTML file: three-dimensional, plays offline, can be mailed. With --video "
        "into a film."
    )
    options = parse(ReplayOptions, "suchus replay", words, description)
    check_file(options.file)
    output = _output(options)
    check_replaceable(output)
    stored = record.load(options.file)
    main_run = _select_run(stored, options.run, "--run")
    ghost = None if options.ghost is None else _select_run(stored, options.ghost, "--ghost")
    robot_name = str(main_run.robot.item()) if "robot" in main_run.coords else "caiman"
    robot = ROBOTS[robot_name] if options.robot is None else options.robot
    main_run = fix_in_place(main_run, robot)
    labels = [_label(run).replace("_", " ") for run in (main_run, ghost) if run is not None]
    if options.video is not None:
        with working() as bars:
            title, progress = options.title or labels[0], bars.reporter("replay")
            film = video(main_run, robot, ending=output.suffix.lower(), title=title, progress=progress)
        write(output, film)
    else:
        save(replay(main_run, robot, ghost=ghost, labels=labels, title=options.title), output)
    print(f"{robot.name}, {' and '.join(labels)}: {output}, {output.stat().st_size / 1e6:.1f} MB")
    return 0


def _output(options: ReplayOptions) -> Path:
    """Return where the page or the film goes.

    Raises:
        BadCommand: the name ends otherwise, or both a film and what a page alone shows are asked for.
        NoVideo: the library that encodes such a film is not installed.
    """
    if options.video is None:
        output = options.out or options.file.with_suffix(".html")
        check_page(output)
        return output
    for option, value in (("--ghost", options.ghost), ("--out", options.out)):
        if value is not None:
            raise BadCommand(
                f"{option} is for the page, and --video writes a film instead of it; leave one of them out."
            )
    ending = options.video.suffix.lower()
    if ending not in ENDINGS:
        raise BadCommand(f"the film would be {options.video}; say --video FILE{', FILE'.join(ENDINGS)}.")
    check_encoder(ending)
    return options.video


def _select_run(stored: xr.Dataset, name: str | None, option: str) -> xr.Dataset:
    """Return one run of a record, by its label or its number.

    Args:
        stored: the record.
        name: label or number of the run; None: the only run.
        option: option that names the run, for messages.
    """
    if "run" not in stored.dims:
        if name is not None and name not in ("0", _label(stored)):
            raise BadCommand(f"{option} asks for {name!r}, but the record holds one run only: leave it out.")
        return stored
    labels = [_label(stored.isel(run=i)) for i in range(stored.sizes["run"])]
    if name is None and len(labels) == 1:
        return stored.isel(run=0)
    choices = ", ".join(f"{i} {label}" for i, label in enumerate(labels))
    if name is None:
        raise BadCommand(f"the record holds {len(labels)} runs ({choices}); choose one with {option}.")
    if name in labels:
        return stored.isel(run=labels.index(name))
    if name.isdecimal() and len(name) < 10 and int(name) < len(labels):
        return stored.isel(run=int(name))
    raise BadCommand(f"{option} asks for {name!r}, but the record's runs are {choices}.")


def _label(run: xr.Dataset) -> str:
    name = run.coords.get("label", run.coords.get("gait"))
    return "this run" if name is None else str(name.values)
