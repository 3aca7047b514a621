"""Names of the sites and sensors that every model carries."""

from suchus.design import LEGS, servo_names

SITES = (*(f"{leg}_foot" for leg in LEGS), "snout", "tail_tip")
"""Points whose world positions are sensed: the feet's centres, the snout's tip, the tail's tip."""
TRUNK_BODIES = ("pelvis", "spine_1", "spine_2", "spine_3", "spine_4", "thorax")
"""Bodies with a belly force sensor, from the hind girdle forward."""


def sensor_names() -> tuple[str, ...]:
    """Return every sensor, in the order in which the model lists them."""
    servos = servo_names()
    return (
        *(f"{s}_position" for s in servos),
        *(f"{s}_velocity" for s in servos),
        *(f"{s}_torque" for s in servos),
        *(f"{leg}_force" for leg in LEGS),
        *(f"{body}_force" for body in TRUNK_BODIES),
        "tail_force",
        "imu_orientation",
        "imu_gyroscope",
        "imu_accelerometer",
        "centre_of_mass",
        "angular_momentum",
        *(f"{site}_position" for site in SITES),
    )
