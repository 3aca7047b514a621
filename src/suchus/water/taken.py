"""The midline that the joints really took: from the angles of every lateral joint of a run to a periodic motion.

A cable fixes the sum of its joints only, and a passive end bends as the water lets it; a ``Swim`` commands them and
cannot see that.
"""

import numpy as np
import xarray as xr

from suchus.design import Robot, cable_joints
from suchus.design.joints import fin_joints
from suchus.errors import InvalidDesign
from suchus.water.outline import Outline
from suchus.water.undulation import Undulation

HARMONICS = 4
"""Harmonics that are kept, the mean among them [-]; a mean bend would steer, and is left out."""


def lateral_joints(robot: Robot) -> tuple[str, ...]:
    """Return the joints that bend the midline, in the order of ``Outline.places``: trunk, cable, passive end."""
    trunk = tuple(f"spine_yaw_{i}" for i in (1, 2, 3))
    return (*trunk, *cable_joints(robot), *fin_joints(robot)[::2])


def taken(outline: Outline, record: xr.Dataset, *, frequency: float, cycles: int, name: str = "as taken") -> Undulation:
    """Return the motion of the midline in the last whole cycles of a run, averaged over them.

    Only yaw counts, as in the slice of water seen from above that it is for: pitch, heave and roll of the run are not
    in it, and of yaw its mean over a cycle is not.

    Args:
        outline: of the robot without a hull.
        record: of one run of a robot with these joints.
        frequency: of the motion [Hz].
        cycles: over which is averaged [-].
        name: of the motion.

    Raises:
        InvalidDesign: the run is shorter, or a cycle has fewer than two samples for each harmonic.
    """
    period, time = 1.0 / frequency, record.time.values.astype(float)
    step = float(time[1] - time[0]) if time.size > 1 else np.inf
    if time[-1] - time[0] < cycles * period - 0.5 * step:
        raise InvalidDesign(
            f"the run lasts {time[-1] - time[0]:.3g} s, and {cycles} cycles of {period:.3g} s are asked for; let it "
            "last longer, or ask for fewer cycles."
        )
    if period < 2 * HARMONICS * step:
        raise InvalidDesign(
            f"a cycle of {period:.3g} s has {period / step:.3g} samples; {2 * HARMONICS} are needed: keep more samples."
        )
    last = time > time[-1] - cycles * period + 0.5 * step
    angles = record.joint_angle.sel(joint=list(lateral_joints(outline.robot))).transpose("time", "joint").values[last]
    turning = np.exp(-2j * np.pi * frequency * np.outer(np.arange(HARMONICS), time[last]))
    harmonics = 2.0 * turning @ angles / last.sum()
    harmonics[0] = 0.0
    middle = 0.5 * (outline.s[1:] + outline.s[:-1])
    middles, stations = harmonics @ outline.joints_at(middle).T, harmonics @ outline.joints_at(outline.s).T
    return Undulation(
        name=name, frequency=frequency, outline=outline, middles=middles, stations=stations,
        sway=np.zeros(HARMONICS, complex),
    )  # fmt: skip


def unevenness(motion: Undulation, meant: Undulation) -> float:
    """Return how far a midline is from another of the same outline, the head alike: rms angle over the other's [-]."""
    count = max(len(motion.middles), len(meant.middles))
    one, other = (np.pad(each.middles, ((0, count - len(each.middles)), (0, 0))) for each in (motion, meant))
    return float(np.sqrt((np.abs(one - other) ** 2).sum() / (np.abs(other) ** 2).sum()))
