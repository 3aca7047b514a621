"""What a task in water needs: a robot that floats, a swimming motion, and water that stays as it is."""

from dataclasses import replace
from functools import lru_cache

from suchus.control import Swimming
from suchus.design import AnyRobot, crocodile
from suchus.errors import InvalidDesign
from suchus.land import Lake
from suchus.land.afloat import capacity
from suchus.land.lake import check_lake
from suchus.motion import LIMBS_BACK, Swim
from suchus.water import fit, printed_wave

_FREQUENCY = 1.0  # [Hz]; as in the experiments swim_free and shore


@lru_cache(maxsize=16)
def swimming(robot: AnyRobot, swim: Swim | None) -> Swimming:
    """Return the swimming motion of a robot, at full amplitude from the first moment.

    Args:
        robot: a crocodile-like robot with a cable tail.
        swim: the wave; None for that of (20) at 1 Hz, fitted to the robot's joints.

    Raises:
        UnsuitedRobot: the robot is given by another table.
    """
    if swim is None:
        bare = replace(crocodile(robot, "a swim"), hull=None)
        swim = fit(bare, printed_wave(bare, "I", frequency=_FREQUENCY, sign=-1)).swim
    return Swimming(swim=swim, limb_pitch=LIMBS_BACK[1], ramp=0.0)


def check_water(robot: AnyRobot, lake: Lake) -> None:
    """Refuse water that changes while an episode lasts, or that a robot lacks the air for.

    Raises:
        InvalidDesign: level or breath are courses, or breath is let out that there is not.
    """
    if lake.changes():
        raise InvalidDesign(
            "task.lake has a level or a breath that changes with time; in a task both stay, since its episodes begin "
            "at different times: give each as one number."
        )
    check_lake(robot, lake)


def check_floats(robot: AnyRobot, lake: Lake) -> None:
    """Refuse a robot that sinks.

    Raises:
        InvalidDesign: it displaces less than it weighs; the message says by how much.
    """
    litres, needed = (1e3 * value for value in capacity(robot, lake))
    if litres <= needed:
        raise InvalidDesign(
            f"robot {robot.name!r} sinks: it weighs {robot.mass:.3g} kg and displaces at most {litres:.3g} l, of which "
            f"it needs more than {needed:.3g}; a task that begins swimming needs a robot that floats, as "
            "'floating_caiman', or a design.Hull."
        )
