"""The sentence with which a controller refuses to steer by a bend of the trunk whose effect is unknown or too small."""

from suchus.robot.design import Robot
from suchus.robot.gaits import MIN_TRUNK_STEERING, trunk_steering
from suchus.robot.motion import Gait


def no_trunk_steering(robot: Robot, gait: Gait, consumer: str, setting: str) -> str:
    """Return why a bend of the trunk cannot steer a robot in a gait, and what its user can do.

    Args:
        robot: the robot.
        gait: the gait.
        consumer: that wants to steer, as the beginning of a sentence.
        setting: field that gives the bend explicitly, with its path.
    """
    turn_per_bend = trunk_steering(robot, gait)
    names = f"robot {robot.name!r} in gait {gait.name!r}"
    if turn_per_bend is None:
        return (
            f"{consumer} steers by a bend of the trunk, and to which side a bend turns {names} was not measured: "
            f"measure it with suchus.sim.land.measure_trunk_steering, and set {setting} to that side."
        )
    return (
        f"{consumer} steers by a bend of the trunk, which turns {names} by {turn_per_bend:.3f} rad a cycle and radian; "
        f"{MIN_TRUNK_STEERING:g} is needed: steer by unequal strokes, as a HeadingRule does, or set {setting}."
    )
