"""The animal beside the robot: what every joint would have to do, what the gait makes it do, and why they differ."""

from itertools import pairwise

import numpy as np
import xarray as xr
from jaxtyping import Complex, Float

from suchus.animals.capture.retarget import mean_of
from suchus.animals.capture.walk import Walk
from suchus.core.errors import NotConverged, Unreachable
from suchus.robot.design import LEGS, Robot, hips_ahead, layout, servo_ranges
from suchus.robot.kinematics import limb as limb_kinematics
from suchus.robot.motion import Gait, cycle_targets, movement

_ALIKE = np.radians(2.0)  # a residual below this needs no reason
_EVERY = 4  # phase at which limbs are compared
_NEAR = 0.98  # share of its range from which on a joint is at the end of it


def beside(walk: Walk, robot: Robot, gait: Gait) -> xr.Dataset:
    """Return for every joint of a robot how far the animal moves it, what its gait leaves of that, and why.

    The animal's midline is divided among the hinges of trunk and tail by where they are along the part; its feet are
    put as far ahead of their girdles as they are in proportion to the trunk, at the width and the height of the gait's.
    Both clocks have LF's mid-stance in common.

    Args:
        walk: the measured walk, with all keypoints.
        robot: the robot.
        gait: for the robot, as ``to_gait`` read it from the walk.

    Returns:
        Over ``joint``: ``animal``, the root mean square of the animal's angle about its mean; ``residual``, that of the
        difference [rad], NaN where no posture of the limb would do; ``unreachable``, the share of the cycle in which
        none would [-]; and ``why``, what most of the difference is.
    """
    rows = [*_axial(walk, robot, gait), *_limbs(walk, robot, gait)]
    names, animal, residual, unreachable, why = (list(column) for column in zip(*rows, strict=True))
    data = xr.Dataset(coords={"joint": ("joint", names)})
    about = {
        "animal": (animal, "rad", "root mean square of the animal's angle about its mean"),
        "residual": (residual, "rad", "root mean square of the animal's angle less the robot's"),
        "unreachable": (unreachable, "1", "share of the cycle in which the limb cannot be where the animal's is"),
    }
    for name, (values, unit, meaning) in about.items():
        data[name] = ("joint", np.array(values, dtype=float), {"units": unit, "long_name": meaning})
    data["why"] = ("joint", why, {"long_name": "what most of the residual is"})
    return data


def beside_lines(data: xr.Dataset, robot: str) -> list[str]:
    """Return the comparison in lines that people read: a joint each, with what the robot cannot follow and why.

    Args:
        data: as ``beside`` returns it.
        robot: its name.
    """
    wide = max(len(str(name)) for name in data.joint.values)
    lines = [f"the animal beside {robot}, joint by joint: its swing, what the gait leaves of it [deg, r.m.s.], and why"]
    for i, name in enumerate(data.joint.values):
        animal, left = np.degrees([data.animal.values[i], data.residual.values[i]])
        shown = "   -" if np.isnan(left) else f"{left:4.1f}"
        moved = "   -" if np.isnan(animal) else f"{animal:4.1f}"
        lines.append(f"  {name!s:{wide}}  {moved}  {shown}  {data.why.values[i]}".rstrip())
    return lines


_Row = tuple[str, float, float, float, str]


def _clock(walk: Walk, gait: Gait, phase: Float[np.ndarray, " phase"]) -> Float[np.ndarray, " phase"]:
    """Return the gait's clock at phases of the animal's cycle [cycle]."""
    return phase - (gait.duty_factor - mean_of(walk, "duty")) / 2


def _axial(walk: Walk, robot: Robot, gait: Gait) -> list[_Row]:
    """Compare the hinges that bend trunk and tail sideways."""
    if "bend" not in walk.phases or walk.phases.bend.attrs["long_name"].endswith("down positive"):
        return []
    plan, phase = movement(robot, gait), walk.phases.phase.values
    hinges, turn = plan.yaw.hinges, np.exp(2j * np.pi * _clock(walk, gait, phase))
    swings: Complex[np.ndarray, " hinge"] = plan.harmonics()[0]
    ranges = np.abs(servo_ranges(robot)).min(axis=1)
    found = []
    for part in ("trunk", "tail"):
        among = hinges.within(part)
        wanted = _shared(walk, part, [hinges.places[k] for k in among])
        for k, angle in zip(among, wanted, strict=True):
            swing = complex(swings[k])
            left = angle + (swing * turn).real  # the animal's is right positive, the hinge's left positive
            near = hinges.servos[k] not in layout(robot).cables and abs(swing) > _NEAR * ranges[hinges.servos[k]]
            why = _why(left, near) if np.std(left) > _ALIKE or abs(left.mean()) > _ALIKE else ""
            found.append((hinges.names[k], float(np.std(angle)), float(np.sqrt(np.mean(left**2))), 0.0, why))
    return found


def _shared(walk: Walk, part: str, places: list[float]) -> list[np.ndarray]:
    """Return the animal's bend within the stretch of the midline that each hinge of a part stands for [rad]."""
    if not places:
        return []
    names, at = [str(name) for name in walk.phases.keypoint.values], walk.phases.place.values
    hip, bend = names.index("hip"), np.nan_to_num(walk.phases.bend.values)
    inside = [i for i, name in enumerate(names) if (i <= hip if part == "trunk" else i > hip) and name != "neck"]
    if part == "trunk":
        front, rear = at[inside[0]], at[hip]
    else:
        front, rear = at[hip], 1.0
        rear = front + walk.tail_share * (rear - front)
    middles = [(a + b) / 2 for a, b in pairwise(sorted(places))]
    first, last = (places[0], places[-1]) if places[0] < places[-1] else (places[-1], places[0])
    half = (last - first) / max(1, 2 * (len(places) - 1)) or 0.5
    edges = (np.array([first - half, *middles, last + half]) - first + half) / (last - first + 2 * half)
    stretch = front + edges * (rear - front)
    found = []
    stretch[0], stretch[-1] = -np.inf, np.inf
    for low, high in pairwise(stretch):
        mine = [i for i in inside if low <= at[i] < high]
        found.append(bend[mine].sum(axis=0))
    return found if places[0] <= places[-1] else found[::-1]


def _why(left: np.ndarray, at_the_end: bool) -> str:
    """Say what most of a residual is."""
    if at_the_end:
        return "the animal's bend is beyond the joint's range"
    waves = np.fft.rfft(left) / len(left)
    parts = {
        "the animal is bent to one side on average, the gait is not": abs(waves[0]) ** 2,
        "the gait bends its part all at once and evenly, the animal here otherwise": 2 * abs(waves[1]) ** 2,
        "the animal's overtones, which the gait has not": 2 * float(np.sum(np.abs(waves[2:]) ** 2)),
    }
    return max(parts, key=lambda name: parts[name])


def _limbs(walk: Walk, robot: Robot, gait: Gait) -> list[_Row]:
    """Compare the hinges of the limbs, by the postures that put feet where the animal's are."""
    plan, place = movement(robot, gait), layout(robot)
    phase = walk.phases.phase.values[::_EVERY]
    clock = _clock(walk, gait, phase)
    targets = cycle_targets(robot, gait, np.mod(clock, 1.0))
    feet = plan.foot_places(clock[:, None] + np.array(gait.limb_phases))
    size = hips_ahead(robot, 0) / walk.value("trunk_length")
    found = []
    for i, (limb, leg) in enumerate(zip(place.limbs, LEGS, strict=True)):
        design, aside = limb.girdle.limb, limb.girdle.aside
        ahead = size * walk.phases.foot_ahead.sel(leg=leg).values[::_EVERY]
        wanted = np.stack([ahead, feet[:, i, 0] - aside, -feet[:, i, 2]], axis=-1)
        near, most = limb_kinematics.reach(design)
        far = np.linalg.norm(wanted, axis=-1)
        reached = (far >= near) & (far <= most)
        angles = np.full((len(phase), len(design.hinges)), np.nan)
        try:
            if reached.any():
                angles[reached] = limb_kinematics.inverse(design, wanted[reached])
        except (Unreachable, NotConverged):
            reached[:] = False
        for j, hinge in enumerate(design.hinges):
            if hinge.servo is None:
                continue
            servo = place.servos.index(f"{limb.name}_{hinge.name}")
            ours = targets[:, servo]
            left = np.angle(np.exp(1j * (angles[reached, j] - ours[reached])))
            off = float(np.sqrt(np.mean(left**2))) if reached.any() else float("nan")
            swing = float(np.std(angles[reached, j])) if reached.any() else float("nan")
            missed = 1.0 - float(reached.mean())
            why = (
                "the gait's foot goes by half a cosine and a straight line, alike on all limbs" if off > _ALIKE else ""
            )
            if missed > 0.0:
                why = f"the limb does not reach the animal's place of {leg} in {100 * missed:.0f} % of the cycle"
            found.append((place.servos[servo], swing, off, missed, why))
    return found
