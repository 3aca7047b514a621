"""A record played back, and a filmed animal beside it: which instant is seen when. It knows nothing of browsers."""

from dataclasses import dataclass
from pathlib import Path
from threading import RLock

import numpy as np
import xarray as xr
from jaxtyping import Float

from suchus.animals.capture import Tracks, UnusableTracks, observe
from suchus.apps.viewer.history import table_of
from suchus.core.errors import IncompatibleRecord, UnknownName
from suchus.core.files import load
from suchus.hardware import fix_in_place
from suchus.robot.design import LEGS, Robot, joint_names
from suchus.robot.design.ground import Ground
from suchus.robot.motion import START
from suchus.robot.robots import ROBOTS
from suchus.sim.record import VARIABLES, check_land, ground_of

_VARIABLES = ("position", "orientation", "joint_angle", "centre_of_mass", "foot_position", "foot_force", "belly_force",
           "tail_force")  # fmt: skip


@dataclass(frozen=True, slots=True)
class Take:
    """One run of a record, ready to be shown."""

    label: str
    """Name, for the page."""
    robot: Robot
    """The robot that walks in it."""
    record: xr.Dataset
    """The run, without the dimension ``run``."""
    ground: Ground
    """The ground; level and even where the record does not say."""

    @property
    def origin(self) -> np.ndarray:
        """Where the centre of mass was when the walk began, (3,) [m]."""
        first_sample = int(np.searchsorted(self.record.time.values, START - 1e-9))
        com = self.record.centre_of_mass.values
        return np.asarray(com[first_sample if first_sample < len(com) else 0])

    @property
    def end(self) -> float:
        """Time of the last valid sample [s]."""
        return float(self.record.time[-1])

    def sample_at(self, time: float) -> dict[str, np.ndarray]:
        """Return the sample nearest to a time, by the names of ``record.VARIABLES``."""
        sample = self._sample(time)
        return {name: self.record[name].values[sample] for name in _VARIABLES}

    def level(self, time: float) -> float | None:
        """Return the level of the water above the world's origin at a time [m]; None on dry land."""
        if "water_level" not in self.record:
            return None
        level = float(self.record.water_level.values[self._sample(time)])
        return level if np.isfinite(level) else None

    def _sample(self, time: float) -> int:
        times = self.record.time.values
        sample = int(np.clip(np.searchsorted(times, time), 0, len(times) - 1))
        return sample - 1 if sample > 0 and time - times[sample - 1] < times[sample] - time else sample

    def table(self) -> dict[str, np.ndarray]:
        """Return the columns for plots, see ``history.columns``."""
        return table_of(self.record, self.origin)


def takes(path: Path, robot: Robot | None = None) -> tuple[Take, ...]:
    """Return the runs of a record on land.

    Args:
        path: path of the file.
        robot: robot that walks in it; by default the robot of the catalog that the record names.

    Raises:
        UnreadableFile: there is no such file.
        IncompatibleRecord: it is no record of a run on land, or of another robot.
    """
    record = load(path)
    if "position" not in record and any("midline_x" in str(name) for name in record):
        raise IncompatibleRecord(f"{path} is no record of a run on land; view it with suchus view swim.")
    check_land(record, _VARIABLES, str(path))
    names = (*VARIABLES, "cause", "ended", "mass", "period", "stands_on")
    run_variables = record[
        [name for name in names if name in record] + (["water_level"] if _tells_level(record) else [])
    ]
    runs = (
        [run_variables]
        if "run" not in run_variables.dims
        else [run_variables.isel(run=i) for i in range(run_variables.sizes["run"])]
    )
    return tuple(_take(path, run, i, robot) for i, run in enumerate(runs))


def _tells_level(record: xr.Dataset) -> bool:
    """Return whether a record says where the level of its water is, as those of runs in water do."""
    if "water_level" not in record:
        return False
    level = record.water_level
    return level.dtype.kind == "f" and set(level.dims) in ({"time"}, {"run", "time"})


def _take(path: Path, run: xr.Dataset, number: int, robot: Robot | None) -> Take:
    """Return one run of a record with its robot, ground and valid samples.

    Args:
        path: file of the record, for messages.
        run: the run, without the dimension ``run``.
        number: index of the run in the record.
        robot: the robot that walks; by default the robot that the record names.
    """
    walker = robot or _robot(path, str(run.coords["robot"].item()) if "robot" in run.coords else "caiman")
    if tuple(run.joint.values) != joint_names(walker):
        raise IncompatibleRecord(
            f"{path} holds {run.sizes['joint']} joints and robot {walker.name!r} has {len(joint_names(walker))}: "
            "name the robot that walked with --robot."
        )
    run = fix_in_place(run, walker)
    valid = np.isfinite(run.position.values).all(axis=-1)
    if valid.sum() < 2:
        raise IncompatibleRecord(f"run {number} of {path} has fewer than two valid samples.")
    ground = ground_of(run) or Ground()
    label = str(run.coords["label"].item()) if "label" in run.coords else f"run {number}"
    return Take(label=f"{number}: {label}", robot=walker, record=run.isel(time=valid).load(), ground=ground)


def _robot(path: Path, name: str) -> Robot:
    """Return the robot of the catalog that a record names."""
    try:
        robot: Robot = ROBOTS[name]
    except UnknownName as error:
        raise IncompatibleRecord(
            f"{path} was walked by robot {name!r}, which is not in the catalog: give its file with --robot FILE.toml."
        ) from error
    return robot


class Player:
    """The clock of a replay; all methods may be called from any thread.

    Args:
        start: first time [s].
        end: last time [s].
    """

    def __init__(self, start: float, end: float) -> None:
        self._start, self._end = start, max(end, start)
        self._lock = RLock()
        self.time = start
        self.speed = 1.0
        self.playing = True

    def advance(self, seconds: float) -> None:
        """Let real time pass; at the end the replay begins again [s]."""
        with self._lock:
            if self.playing:
                self.time += self.speed * seconds
                if self.time > self._end:
                    self.time = self._start

    def seek(self, time: object) -> None:
        """Jump to a time, clipped to the record; ignore a value that is no number [s]."""
        try:
            seconds = float(time)  # type: ignore[arg-type]
        except (TypeError, ValueError, OverflowError):
            return
        with self._lock:
            if np.isfinite(seconds):
                self.time = min(max(seconds, self._start), self._end)


_LATERAL_OFFSET = 0.35
"""Distance of the animal from the robot, to the robot's left, over the robot's length [-]."""
_MIDLINE_HEIGHT = 0.06
"""Height at which the midline is drawn where heights were not filmed, over the robot's length [-]."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FilmedAnimal:
    """Keypoints of an animal in the world of a record."""

    label: str
    """Name of its file, for the page."""
    time: Float[np.ndarray, " frame"]
    """Times in the record [s]."""
    position: Float[np.ndarray, "frame point 3"]
    """Position of each keypoint [m]."""
    bones: tuple[tuple[int, int], ...]
    """Pairs of keypoints that are joined by a line: along the midline, and from the girdles to the feet."""
    feet: tuple[int, ...]
    """Places of the feet among the keypoints."""
    scale: float
    """Length of the robot over that of the animal, [-], or [m/px] where the film has no scale."""
    pace: float
    """Period of the robot's gait over that of the animal; 1 where the record names none [-]."""

    def keypoints_at(self, time: float) -> Float[np.ndarray, "point 3"]:
        """Return the keypoints at a time of the record [m]; before and after the film as at its ends."""
        frame = float(np.interp(time, self.time, np.arange(len(self.time))))
        first_frame = min(int(frame), len(self.time) - 2)
        fraction = frame - first_frame
        return np.asarray((1.0 - fraction) * self.position[first_frame] + fraction * self.position[first_frame + 1])

    @property
    def size(self) -> float:
        """Distance between its snout and its tail's tip in the first frame, for the thickness of lines [m]."""
        return float(np.linalg.norm(self.position[0, self.bones[0][0]] - self.position[0, self.bones[-5][1]]))


def place_animal(tracks: Tracks, take: Take) -> FilmedAnimal:
    """Return an animal to the left of a robot, scaled to the robot's length and period.

    Its film begins when the robot's first cycle does. Between frames in which a point was lost, it moves straight on.

    Args:
        tracks: keypoints of the animal.
        take: the robot's walk.

    Raises:
        UnusableTracks: no walk can be seen in the tracks, or a point of the midline is never seen.
    """
    animal_period = observe(tracks).numbers["period"].value
    tracks = tracks.ahead()
    names = (*tracks.trunk_chain, *tracks.tail_chain[1:])
    names = names if names[0] == "snout" or "snout" not in tracks.points else ("snout", *names)
    chain = list(dict.fromkeys(names))
    points = [*chain, *LEGS]
    positions = np.stack([_track_without_gaps(tracks, name) for name in points], axis=1)
    links = np.linalg.norm(np.diff(positions[:, : len(chain), :2], axis=1), axis=-1)
    scale = take.robot.length / float(np.median(links.sum(axis=1)))
    positions = scale * positions
    if not tracks.has_heights:
        heights = np.where(np.arange(len(points)) < len(chain), _MIDLINE_HEIGHT * take.robot.length, 0.0)
        positions = np.concatenate([positions, np.broadcast_to(heights, positions.shape[:2])[..., None]], axis=-1)
    hip, ground = chain.index("hip"), float(np.percentile(positions[:, len(chain) :, 2], 5))
    start = np.array([*positions[0, hip, :2], ground])
    positions = (
        positions
        - start
        + np.array([*take.origin[:2], 0.0])
        + np.array([0.0, _LATERAL_OFFSET * take.robot.length, 0.0])
    )
    robot_period = float(take.record["period"]) if "period" in take.record else float("nan")
    pace = robot_period / animal_period if np.isfinite(robot_period) and robot_period > 0 else 1.0
    girdles = ("shoulder", "shoulder", "hip", "hip")
    return FilmedAnimal(
        label=tracks.source,
        time=START + pace * (tracks.time - tracks.time[0]),
        position=positions,
        bones=(
            *((i, i + 1) for i in range(len(chain) - 1)),
            *((chain.index(girdle), len(chain) + i) for i, girdle in enumerate(girdles)),
        ),
        feet=tuple(range(len(chain), len(points))),
        scale=scale,
        pace=pace,
    )


def _track_without_gaps(tracks: Tracks, name: str) -> np.ndarray:
    """Return the track of a point without gaps, shape (frame, axis) [m or px]."""
    track = tracks.at(name)
    is_valid = np.isfinite(track).all(axis=-1)
    if not is_valid.any():
        raise UnusableTracks(f"in {tracks.source} the keypoint {name} is never seen.")
    return np.stack([np.interp(tracks.time, tracks.time[is_valid], axis[is_valid]) for axis in track.T], axis=-1)
