"""A salamander's own walk, joint by joint as it was filmed; nothing is fitted."""

from typing import Literal

from suchus.robot.design.reasons import Reason, assumptions_of
from suchus.robot.motion import Curve, Gait

# fmt: off
_ANGLES = {
    "neck_yaw_1": (-0.087, -0.036, 0.009, 0.041, 0.061, 0.066, 0.077, 0.074, 0.029, -0.004, -0.045, -0.073, -0.084),
    "spine_yaw_2": (-0.395, -0.349, -0.197, -0.063, 0.09, 0.244, 0.355, 0.352, 0.267, 0.157, 0.027, -0.119, -0.267),
    "spine_yaw_1": (-0.287, -0.248, -0.19, -0.06, 0.085, 0.221, 0.3, 0.282, 0.225, 0.138, 0.009, -0.133, -0.258),
    "tail_yaw_1": (0.019, 0.003, 0.018, 0.007, -0.006, -0.022, -0.016, -0.02, -0.024, -0.02, -0.006, 0.01, 0.048),
    "tail_yaw_2": (-0.325, -0.28, -0.159, -0.028, 0.101, 0.224, 0.309, 0.314, 0.228, 0.108, -0.034, -0.164, -0.274),
    "tail_yaw_3": (-0.297, -0.181, -0.1, 0.016, 0.121, 0.228, 0.3, 0.26, 0.146, 0.055, -0.046, -0.149, -0.301),
    "tail_yaw_4": (0.005, -0.017, -0.011, -0.027, -0.027, -0.026, -0.026, -0.012, 0.006, 0.008, 0.023, 0.035, 0.053),
    "tail_yaw_5": (0.065, 0.019, 0.009, -0.031, -0.054, -0.08, -0.087, -0.07, -0.03, -0.012, 0.034, 0.053, 0.094),
    "LF_yaw": (-0.48, -0.588, -0.623, -0.656, -0.652, -0.595, -0.611, -0.753, -0.89, -0.778, -0.268, -0.011, -0.276),
    "LF_pitch": (0.094, 0.123, 0.045, -0.07, -0.121, -0.176, -0.211, -0.221, -0.303, -0.591, -0.486, -0.009, 0.07),
    "LF_roll": (1.114, 1.003, 0.91, 0.781, 0.626, 0.539, 0.51, 0.465, 0.653, 0.934, 1.194, 1.176, 1.117),
    "LF_elbow": (1.457, 1.568, 1.605, 1.661, 1.595, 1.46, 1.301, 1.097, 1.138, 1.667, 1.669, 1.145, 1.262),
    "RF_yaw": (-0.675, -0.846, -0.877, -0.516, -0.038, -0.141, -0.408, -0.536, -0.609, -0.636, -0.663, -0.629, -0.583),
    "RF_pitch": (-0.216, -0.243, -0.461, -0.623, -0.192, 0.076, 0.07, 0.12, 0.101, -0.008, -0.099, -0.142, -0.196),
    "RF_roll": (0.47, 0.545, 0.81, 1.099, 1.22, 1.12, 1.133, 1.067, 0.965, 0.857, 0.717, 0.568, 0.536),
    "RF_elbow": (1.191, 1.055, 1.415, 1.804, 1.329, 1.149, 1.393, 1.507, 1.593, 1.626, 1.658, 1.53, 1.405),
    "LH_yaw": (-0.481, -0.713, -0.854, -0.879, -0.564, 0.472, 0.543, 0.284, 0.199, 0.031, -0.104, -0.233, -0.308),
    "LH_pitch": (-0.12, -0.151, -0.199, -0.204, -0.268, -0.445, -0.086, 0.016, -0.027, -0.034, -0.032, -0.055, -0.087),
    "LH_roll": (0.95, 1.203, 1.407, 1.516, 1.297, 1.086, 0.62, 0.314, 0.403, 0.423, 0.543, 0.631, 0.791),
    "LH_elbow": (0.874, 0.553, 0.498, 0.487, 0.845, 0.67, 0.524, 0.988, 1.2, 1.371, 1.36, 1.31, 1.129),
    "RH_yaw": (0.37, 0.251, 0.096, -0.037, -0.193, -0.265, -0.397, -0.572, -0.808, -0.854, -0.857, -0.111, 0.663),
    "RH_pitch": (0.02, -0.023, -0.023, -0.042, -0.031, -0.084, -0.095, -0.145, -0.157, -0.225, -0.185, -0.391, -0.327),
    "RH_roll": (0.403, 0.357, 0.413, 0.485, 0.593, 0.716, 0.874, 1.057, 1.298, 1.484, 1.45, 1.198, 0.931),
    "RH_elbow": (0.748, 1.142, 1.301, 1.386, 1.336, 1.224, 1.003, 0.713, 0.509, 0.473, 0.616, 0.882, 0.489),
}
# fmt: on
_PARTS: dict[str, Literal["neck", "trunk", "tail"]] = {"neck": "neck", "spine": "trunk", "tail": "tail"}
gait = Gait(
    name="animal_walk",
    period=1.0,
    duty_factor=0.786,
    limb_phases=(0.41, 0.92, 0.775, 0.27),
    curves=tuple(
        Curve(servo=servo, part=_PARTS.get(servo.partition("_")[0], "limb"), angles=angles)
        for servo, angles in _ANGLES.items()
    ),
)
"""The mean walking cycle of Pleurodeles waltl on the robot ``salamander``, closed with six harmonics.

Karakasiliotis, Schilling, Cabelguen and Ijspeert 2013, Biol. Cybern. 107, 529, as processed in the repository
AlexPazzaglia/SalamandraSNN (MIT licence); ``suchus.animals.capture.to_curves`` made it of that table.
"""

PUBLISHED = (r"^curves",)
"""The measured angles."""
_REASONS = (
    Reason(r"^period$", 0.5, 2.0, "a slow walk; the measured cycle is given as shares of its duration"),
    Reason(r"^(duty_factor|limb_phases)", 0.8, 1.2, "read from the angles: a foot that goes forward swings"),
)
chosen = assumptions_of(gait, _REASONS, PUBLISHED)
"""Every number that was not measured, with its plausible range and the reason."""
