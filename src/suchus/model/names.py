"""Names of the sites and sensors of a robot's model."""

from suchus.design import Robot, layout

SNOUT, TAIL_TIP, IMU = "snout", "tail_tip", "imu"
"""Sites that every model carries."""


def sites(robot: Robot) -> tuple[str, ...]:
    """Return the points whose world positions are sensed: the feet's centres, the snout's tip, the tail's tip."""
    return (*(f"{limb}_foot" for limb in layout(robot).limb_names), SNOUT, TAIL_TIP)


def force_sensors(robot: Robot) -> tuple[str, ...]:
    """Return the sensors of contact forces: feet, bodies of the trunk from the root forward, the tail if there is one.

    They stand side by side in the model's readings.
    """
    place = layout(robot)
    return (
        *(f"{limb}_force" for limb in place.limb_names),
        *(f"{body}_force" for body in place.trunk),
        *(("tail_force",) if place.tail else ()),
    )


def sensor_names(robot: Robot) -> tuple[str, ...]:
    """Return every sensor, in the order in which the model lists them."""
    servos = layout(robot).servos
    return (
        *(f"{s}_position" for s in servos),
        *(f"{s}_velocity" for s in servos),
        *(f"{s}_torque" for s in servos),
        *force_sensors(robot),
        "imu_orientation",
        "imu_gyroscope",
        "imu_accelerometer",
        "centre_of_mass",
        "angular_momentum",
        *(f"{site}_position" for site in sites(robot)),
    )
