"""``suchus capture TRACKS``: keypoints of a walking body in, a gait file and its diagram out."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Literal

import numpy as np
import tyro

from suchus import blueprint
from suchus.capture import (
    NEEDED,
    ReadingOptions,
    Walk,
    driven_share,
    is_angle_table,
    observe,
    read_angles,
    read_tracks,
    summary,
    to_curves,
    to_gait,
    write_gait,
)
from suchus.cli.entry import BadCommand
from suchus.cli.options import parse
from suchus.cli.run import run_it
from suchus.cli.terminal import working
from suchus.design import Robot, check_needs
from suchus.figures import captioned, save
from suchus.figures.gait_diagram import GaitTrack, gait_diagram
from suchus.gaits import own_gait
from suchus.motion import Gait, check_limits
from suchus.record import check_replaceable, check_writable
from suchus.robots import ROBOTS


@dataclass(frozen=True, slots=True, kw_only=True)
class CaptureOptions:
    """Options of ``suchus capture``."""

    tracks: Annotated[Path, tyro.conf.Positional]
    """CSV table of keypoints or of joint angles, or a file of DeepLabCut, SLEAP or LightningPose."""
    out: Path = Path("captured.toml")
    """The gait file; its diagram is saved beside it."""
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
    start: float | None = None
    """Time before which frames are left out [s]."""
    end: float | None = None
    """Time after which frames are left out [s]."""


def capture(words: Sequence[str]) -> int:
    """Read a gait from tracks, write it and its diagram, say what was seen, and return 0.

    Raises:
        SuchusError: the words or the tracks make no sense.
    """
    about = "Read a gait from tracked keypoints of a walking body: a gait file to run, and its diagram."
    options = parse(CaptureOptions, "suchus capture", words, about)
    if options.out.suffix != ".toml":
        raise BadCommand(f"the gait goes into a .toml file; --out is {str(options.out)!r}.")
    check_writable(options.out.parent)
    check_replaceable(options.out)
    if is_angle_table(options.tracks):
        return _play(options, _asked(words))
    robot = options.robot
    check_needs(robot, NEEDED, "a gait from tracked keypoints")
    base = options.base or own_gait(robot)
    with working() as bars:
        move = bars.task(options.tracks.name)
        move("reading", 0.1)
        tracks = read_tracks(options.tracks, _how(options)).between(options.start, options.end)
        move("looking for the cycle", 0.3)
        share = driven_share(robot) if options.tail_share is None else options.tail_share
        walk = observe(tracks, tail_share=share)
        move("writing", 0.8)
        name = options.out.stem
        captured = to_gait(walk, robot, base, name=name, duty=options.duty, girdles=options.girdles)
        write_gait(captured, walk, options.out)
        picture = _draw(walk, options.out)
    print(*summary(walk), *(f"note: {note}" for note in captured.notes), sep="\n")
    print(f"gait: {options.out}", f"diagram: {picture}", *run_it(robot, _asked(words), options.out), sep="\n")
    return 0


def _asked(words: Sequence[str]) -> str:
    """Return the robot as the user asked for it, a name or a file; empty where nothing was asked for."""
    for word, following in zip(words, [*words[1:], ""], strict=True):
        if word == "--robot":
            return following
        if word.startswith("--robot="):
            return word.removeprefix("--robot=")
    return ""


def _play(options: CaptureOptions, asked: str) -> int:
    """Write the gait that plays a table of joint angles, say what it is, and return 0."""
    cycle = read_angles(options.tracks)
    gait = to_curves(cycle, options.robot, name=options.out.stem, period=options.period)
    check_limits(options.robot, gait)
    blueprint.write(gait, options.out)
    left = max(zip(cycle.residual, cycle.joints, strict=True))
    print(f"{len(gait.curves)} servos of {options.robot.name} play {options.tracks.name}; closing the cycle changed")
    print(f"{left[1]} most, by {np.degrees(left[0]):.1f} degrees in the root mean square.")
    lines = run_it(options.robot, asked, options.out, "salamander")
    print(f"gait: {options.out}", *lines, sep="\n")
    return 0


def _how(options: CaptureOptions) -> ReadingOptions:
    names = {}
    for pair in options.names:
        theirs, equals, ours = pair.partition("=")
        if not (theirs and equals and ours):
            raise BadCommand(f"--names has {pair!r}; THEIRS=OURS is needed, as in left_fore_paw=LF.")
        names[theirs] = ours
    return ReadingOptions(
        names=names,
        rate=options.fps,
        software=options.software,
        individual=options.individual,
        confidence=options.confidence,
        y_down=None if options.y_axis == "auto" else options.y_axis == "down",
    )


def _draw(walk: Walk, out: Path) -> Path:
    """Draw two mean cycles one after the other."""
    cycle = walk.cycle
    figure = gait_diagram(
        [
            GaitTrack(
                time=np.concatenate([cycle.phase.values, 1.0 + cycle.phase.values]),
                stance=np.tile(cycle.stance.values, 2),
                spine=np.tile(cycle.spine_lateral.values, 2),
                tail=np.tile(cycle.tail_lateral.values, 2),
                spine_spread=np.tile(cycle.spine_lateral_spread.values, 2),
                tail_spread=np.tile(cycle.tail_lateral_spread.values, 2),
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
    return save(captioned(figure, text), out.parent, out.stem)[1]
