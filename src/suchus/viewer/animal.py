"""A filmed animal beside a robot's walk: its keypoints at the robot's size and pace. It knows nothing of browsers."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from suchus.capture import Tracks, UnusableTracks, observe
from suchus.design import LEGS
from suchus.motion import START
from suchus.viewer.replay import Take

_ASIDE = 0.35
"""Distance of the animal from the robot, to the robot's left, over the robot's length [-]."""
_BACK = 0.06
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

    def at(self, time: float) -> Float[np.ndarray, "point 3"]:
        """Return the keypoints at a time of the record [m]; before and after the film as at its ends."""
        frame = float(np.interp(time, self.time, np.arange(len(self.time))))
        first = min(int(frame), len(self.time) - 2)
        part = frame - first
        return np.asarray((1.0 - part) * self.position[first] + part * self.position[first + 1])

    @property
    def size(self) -> float:
        """Distance between its snout and its tail's tip in the first frame, for the thickness of lines [m]."""
        return float(np.linalg.norm(self.position[0, self.bones[0][0]] - self.position[0, self.bones[-5][1]]))


def beside(tracks: Tracks, take: Take) -> FilmedAnimal:
    """Return an animal as it walks to the left of a robot, as long as the robot and with its cycle time.

    Its film begins when the robot's first cycle does. Between frames in which a point was lost, it moves straight on.

    Args:
        tracks: keypoints of the animal.
        take: the robot's walk.

    Raises:
        UnusableTracks: no walk can be seen in the tracks, or a point of the midline is never seen.
    """
    animal = observe(tracks).numbers["period"].value
    tracks = tracks.ahead()
    names = (*tracks.trunk_chain, *tracks.tail_chain[1:])
    names = names if names[0] == "snout" or "snout" not in tracks.points else ("snout", *names)
    chain = list(dict.fromkeys(names))
    points = [*chain, *LEGS]
    place = np.stack([_filled(tracks, name) for name in points], axis=1)
    links = np.linalg.norm(np.diff(place[:, : len(chain), :2], axis=1), axis=-1)
    scale = take.robot.length / float(np.median(links.sum(axis=1)))
    place = scale * place
    if not tracks.upright:
        heights = np.where(np.arange(len(points)) < len(chain), _BACK * take.robot.length, 0.0)
        place = np.concatenate([place, np.broadcast_to(heights, place.shape[:2])[..., None]], axis=-1)
    hip, ground = chain.index("hip"), float(np.percentile(place[:, len(chain) :, 2], 5))
    start = np.array([*place[0, hip, :2], ground])
    place = place - start + np.array([*take.origin[:2], 0.0]) + np.array([0.0, _ASIDE * take.robot.length, 0.0])
    robot = float(take.record["period"]) if "period" in take.record else float("nan")
    pace = robot / animal if np.isfinite(robot) and robot > 0 else 1.0
    girdles = ("shoulder", "shoulder", "hip", "hip")
    return FilmedAnimal(
        label=tracks.source,
        time=START + pace * (tracks.time - tracks.time[0]),
        position=place,
        bones=(
            *((i, i + 1) for i in range(len(chain) - 1)),
            *((chain.index(girdle), len(chain) + i) for i, girdle in enumerate(girdles)),
        ),
        feet=tuple(range(len(chain), len(points))),
        scale=scale,
        pace=pace,
    )


def _filled(tracks: Tracks, name: str) -> np.ndarray:
    """Return the track of a point without gaps, shape (frame, axis) [m or px]."""
    track = tracks.at(name)
    seen = np.isfinite(track).all(axis=-1)
    if not seen.any():
        raise UnusableTracks(f"in {tracks.source} the keypoint {name} is never seen.")
    return np.stack([np.interp(tracks.time, tracks.time[seen], axis[seen]) for axis in track.T], axis=-1)
