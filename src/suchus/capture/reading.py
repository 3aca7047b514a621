"""The door of the room: a file of tracks in, whatever wrote it; a gait as a file out."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import degrees
from pathlib import Path

from suchus import blueprint
from suchus.capture.poses import SOFTWARE, read_poses
from suchus.capture.retarget import Captured
from suchus.capture.table import is_table, read_table
from suchus.capture.tracks import Tracks
from suchus.capture.walk import Walk
from suchus.design import LEGS
from suchus.errors import UnknownName, UnreadableFile
from suchus.record import check_file, new_file


@dataclass(frozen=True, slots=True, kw_only=True)
class ReadingOptions:
    """Options with which a file of tracks is read."""

    names: Mapping[str, str] = field(default_factory=dict)
    """Our name of a keypoint by the file's, where they differ."""
    rate: float | None = None
    """Frames per second, for files that do not hold it [1/s]."""
    software: str | None = None
    """What wrote the file, of ``SOFTWARE``; guessed if None."""
    individual: str | None = None
    """Whose tracks, where the file holds several."""
    confidence: float = 0.6
    """Points with less are lost [-]; what DeepLabCut and movement use."""
    y_down: bool | None = None
    """Whether y points to the right of x, seen from above; None: as the file's kind has it."""


def read_tracks(path: str | Path, how: ReadingOptions | None = None) -> Tracks:
    """Read tracks from a CSV table, or from a file of DeepLabCut, SLEAP or LightningPose.

    Args:
        path: the file.
        how: how to read it.

    Raises:
        UnreadableFile: there is no such file, it is empty or broken, or the library that reads it is not installed.
        UnusableTracks: it holds not what is needed.
    """
    how, path = how or ReadingOptions(), Path(path)
    if how.software is not None and how.software not in SOFTWARE:
        raise UnknownName("software", how.software, SOFTWARE)
    check_file(path)
    if path.stat().st_size == 0:
        raise UnreadableFile(f"{path} is empty; a header and one row per frame are needed.")
    if how.software is None and is_table(path):
        return read_table(path, names=how.names, confidence=how.confidence, y_down=how.y_down)
    return read_poses(
        path,
        software=how.software,
        rate=how.rate,
        individual=how.individual,
        names=how.names,
        confidence=how.confidence,
        y_down=how.y_down,
    )


def write_gait(captured: Captured, walk: Walk, path: Path) -> Path:
    """Write a captured gait as TOML, with what was seen and what got lost as comments, and return the path.

    Raises:
        Unwritable: the place cannot be written to.
    """
    head = [f"A gait read from {walk.source}.", *summary(walk), *(f"Note: {note}." for note in captured.notes)]
    text = "".join(f"# {' '.join(line.split())}\n" for line in head) + "\n" + blueprint.render(captured.gait)
    with new_file(path) as draft:
        draft.write_text(text, encoding="utf-8")
    return path


def summary(walk: Walk) -> list[str]:
    """Return what was seen, in lines that people read."""

    def one(name: str, digits: int = 2, scale: float = 1.0) -> str:
        if name not in walk.numbers:
            return "(it does not bend)"
        value, _, error, _ = walk.numbers[name]
        apart = f" ± {scale * error:.{digits}f}" if error == error and error > 0.0 else ""
        return f"{scale * value:.{digits}f}{apart}"

    turn = degrees(1.0)
    return [
        f"{walk.cycles:.1f} cycles of {walk.value('period'):.3f} s; {one('stride')} trunk lengths per cycle",
        "stance share: " + ", ".join(f"{leg} {one(f'duty_{leg}')}" for leg in LEGS),
        "limb phase [cycle]: " + ", ".join(f"{leg} {one(f'phase_{leg}', 3)}" for leg in LEGS),
        f"spine: {one('spine_lateral', 1, turn)} degrees to either side, farthest right at phase "
        f"{one('spine_rightmost', 3)}",
        f"tail: {one('tail_lateral', 1, turn)} degrees to either side at {walk.tail_share:.2f} of its length, "
        f"{one('tail_lag', 3)} cycles behind the spine",
        f"standing index (1 standing, 0 travelling): trunk {one('standing_trunk')}, tail {one('standing_tail')}, "
        f"body {one('standing_body')}",
    ]
