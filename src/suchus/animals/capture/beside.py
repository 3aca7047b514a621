"""Comparison of animal and robot for each joint: required motion, commanded motion, and reason for the difference."""

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

_RESIDUAL_TOLERANCE = np.radians(2.0)  # a residual below this needs no reason
_PHASE_STEP = 4  # phases of the table per phase at which limbs are compared
_RANGE_END = 0.98  # fraction of its range from which on a joint is at its end


def compare_joints(walk: Walk, robot: Robot, gait: Gait) -> xr.Dataset:
    """Return for every joint of a robot the animal's angle, the residual of the gait, and the reason for the residual.

    The midline of the animal is divided among the hinges of trunk and tail by their positions. The feet have the
    animal's forward offset in proportion to the trunk, and the width and height of the gait. Both clocks agree at the
    mid-stance of LF.

    Args:
        walk: the measured walk, with all keypoints.
        robot: the robot.
        gait: gait for the robot, as ``to_gait`` read it from the walk.

    Returns:
        Over ``joint``: ``animal``, the root mean square of the animal's angle about its mean; ``residual``, that of the
        difference [rad], NaN where no posture of the limb would do; ``unreachable``, the share of the cycle in which
        none would [-]; and ``why``, what most of the difference is.
    """
    rows = [*_axial(walk, robot, gait), *_limbs(walk, robot, gait)]
    names, animal, residual, unreachable, reasons = (list(column) for column in zip(*rows, strict=True))
    data = xr.Dataset(coords={"joint": ("joint", names)})
    variables = {
        "animal": (animal, "rad", "root mean square of the animal's angle about its mean"),
        "residual": (residual, "rad", "root mean square of the animal's angle less the robot's"),
        "unreachable": (unreachable, "1", "share of the cycle in which the limb cannot be where the animal's is"),
    }
    for name, (values, unit, meaning) in variables.items():
        data[name] = ("joint", np.array(values, dtype=float), {"units": unit, "long_name": meaning})
    data["why"] = ("joint", reasons, {"long_name": "what most of the residual is"})
    return data


def comparison_lines(data: xr.Dataset, robot: str) -> list[str]:
    """Return the comparison as text, a line for each joint: amplitude, residual and reason.

    Args:
        data: data as ``compare_joints`` returns it.
        robot: its name.
    """
    name_width = max(len(str(name)) for name in data.joint.values)
    lines = [
        f"joints of the animal beside those of {robot}, root mean squares in degrees: the animal's swing about its "
        "mean, the difference of the gait from the animal's angle, and the reason for that difference"
    ]
    for i, name in enumerate(data.joint.values):
        animal, residual = np.degrees([data.animal.values[i], data.residual.values[i]])
        residual_text = "   -" if np.isnan(residual) else f"{residual:4.1f}"
        animal_text = "   -" if np.isnan(animal) else f"{animal:4.1f}"
        lines.append(f"  {name!s:{name_width}}  {animal_text}  {residual_text}  {data.why.values[i]}".rstrip())
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
    rows = []
    for region in ("trunk", "tail"):
        hinge_indices = hinges.indices_in(region)
        animal_bends = _animal_bends(walk, region, [hinges.axial_positions[k] for k in hinge_indices])
        for k, angle in zip(hinge_indices, animal_bends, strict=True):
            swing = complex(swings[k])
            residual = angle + (swing * turn).real  # the animal's is right positive, the hinge's left positive
            is_at_range_end = (
                hinges.servos[k] not in layout(robot).cables and abs(swing) > _RANGE_END * ranges[hinges.servos[k]]
            )
            reason = (
                _explain_residual(residual, is_at_range_end)
                if np.std(residual) > _RESIDUAL_TOLERANCE or abs(residual.mean()) > _RESIDUAL_TOLERANCE
                else ""
            )
            rows.append((hinges.names[k], float(np.std(angle)), float(np.sqrt(np.mean(residual**2))), 0.0, reason))
    return rows


def _animal_bends(walk: Walk, region: str, places: list[float]) -> list[np.ndarray]:
    """Return the animal's bend in the section of the midline that belongs to each hinge [rad]."""
    if not places:
        return []
    names, positions = [str(name) for name in walk.phases.keypoint.values], walk.phases.place.values
    hip, bend = names.index("hip"), np.nan_to_num(walk.phases.bend.values)
    region_indices = [
        i for i, name in enumerate(names) if (i <= hip if region == "trunk" else i > hip) and name != "neck"
    ]
    if region == "trunk":
        front, rear = positions[region_indices[0]], positions[hip]
    else:
        front, rear = positions[hip], 1.0
        rear = front + walk.tail_share * (rear - front)
    middles = [(a + b) / 2 for a, b in pairwise(sorted(places))]
    start, end = (places[0], places[-1]) if places[0] < places[-1] else (places[-1], places[0])
    half = (end - start) / max(1, 2 * (len(places) - 1)) or 0.5
    edges = (np.array([start - half, *middles, end + half]) - start + half) / (end - start + 2 * half)
    boundaries = front + edges * (rear - front)
    hinge_bends = []
    boundaries[0], boundaries[-1] = -np.inf, np.inf
    for lower_bound, upper_bound in pairwise(boundaries):
        indices = [i for i in region_indices if lower_bound <= positions[i] < upper_bound]
        hinge_bends.append(bend[indices].sum(axis=0))
    return hinge_bends if places[0] <= places[-1] else hinge_bends[::-1]


def _explain_residual(residual: np.ndarray, is_at_range_end: bool) -> str:
    """Return a sentence for the largest part of a residual: offset, fundamental or overtones."""
    if is_at_range_end:
        return "the animal's bend is beyond the joint's range"
    waves = np.fft.rfft(residual) / len(residual)
    parts = {
        "the animal is bent to one side on average, the gait is not": abs(waves[0]) ** 2,
        "the gait bends its part all at once and evenly, the animal here otherwise": 2 * abs(waves[1]) ** 2,
        "the animal's overtones, which the gait has not": 2 * float(np.sum(np.abs(waves[2:]) ** 2)),
    }
    return max(parts, key=lambda name: parts[name])


def _limbs(walk: Walk, robot: Robot, gait: Gait) -> list[_Row]:
    """Compare the hinges of the limbs, in postures that put the feet at the animal's positions."""
    plan, place = movement(robot, gait), layout(robot)
    phase = walk.phases.phase.values[::_PHASE_STEP]
    clock = _clock(walk, gait, phase)
    targets = cycle_targets(robot, gait, np.mod(clock, 1.0))
    feet = plan.foot_positions(clock[:, None] + np.array(gait.limb_phases))
    size = hips_ahead(robot, 0) / walk.value("trunk_length")
    rows = []
    for i, (limb, leg) in enumerate(zip(place.limbs, LEGS, strict=True)):
        design, lateral_offset = limb.girdle.limb, limb.girdle.aside
        forward_offset = size * walk.phases.foot_ahead.sel(leg=leg).values[::_PHASE_STEP]
        foot_positions = np.stack([forward_offset, feet[:, i, 0] - lateral_offset, -feet[:, i, 2]], axis=-1)
        min_reach, max_reach = limb_kinematics.reach(design)
        distance = np.linalg.norm(foot_positions, axis=-1)
        is_reachable = (distance >= min_reach) & (distance <= max_reach)
        angles = np.full((len(phase), len(design.hinges)), np.nan)
        try:
            if is_reachable.any():
                angles[is_reachable] = limb_kinematics.inverse(design, foot_positions[is_reachable])
        except (Unreachable, NotConverged):
            is_reachable[:] = False
        for j, hinge in enumerate(design.hinges):
            if hinge.servo is None:
                continue
            servo = place.servos.index(f"{limb.name}_{hinge.name}")
            gait_angles = targets[:, servo]
            residual = np.angle(np.exp(1j * (angles[is_reachable, j] - gait_angles[is_reachable])))
            residual_rms = float(np.sqrt(np.mean(residual**2))) if is_reachable.any() else float("nan")
            swing = float(np.std(angles[is_reachable, j])) if is_reachable.any() else float("nan")
            unreachable_fraction = 1.0 - float(is_reachable.mean())
            reason = (
                "the gait's foot goes by half a cosine and a straight line, alike on all limbs"
                if residual_rms > _RESIDUAL_TOLERANCE
                else ""
            )
            if unreachable_fraction > 0.0:
                percent = 100 * unreachable_fraction
                reason = f"the limb does not reach the animal's place of {leg} in {percent:.0f} % of the cycle"
            rows.append((place.servos[servo], swing, residual_rms, unreachable_fraction, reason))
    return rows
