"""The article's robot: its dimensions with their sources, and for all others our numbers with their reasons.

A number without a source beside it is chosen: ``chosen`` says why, and how far it could be off.
"""

from dataclasses import replace
from math import pi, radians

from suchus.robot.design import Assumption, Contact, Head, Leg, Pelvis, Servo, Spine, Tables, Tail, Thorax, crocodile
from suchus.robot.design.tables import TIBIA_RADIUS_RATIO
from suchus.robot.motors import motor

_servo = replace(Servo.from_motor(motor("STS3250")), kp=40.0, kd=1.5, integral_limit=0.5)

_hind_leg = Leg(
    hip_offset=0.070,  # Table I, a0
    femur=0.086,  # Table I, a2
    tibia=0.089,  # Table I, a3
    foot_radius=0.014,
    radius=0.011,
    mass=0.25,
    yaw_range=(radians(-100), radians(100)),
    pitch_range=(radians(-75), radians(150)),
    knee_range=(radians(-140), radians(140)),
    servo=_servo,
)
_FORE = 0.9  # fore legs of crocodilians are 0.8 to 0.9 of the hind legs
_front_leg = Leg(
    hip_offset=_FORE * _hind_leg.hip_offset,
    femur=_FORE * _hind_leg.femur,
    tibia=_FORE * _hind_leg.tibia,
    foot_radius=0.014,
    radius=0.011,
    mass=0.25,
    yaw_range=_hind_leg.yaw_range,
    pitch_range=_hind_leg.pitch_range,
    knee_range=_hind_leg.knee_range,
    servo=_servo,
)

tables = Tables(
    name="caiman",
    hind_leg=_hind_leg,
    front_leg=_front_leg,
    pelvis=Pelvis(mass=0.75, length=0.090, width=0.110, height=0.064),
    spine=Spine(
        base=0.0505,  # Table II, a0
        link=0.0605,  # Table II, a1 to a4
        radius=0.032,
        link_mass=0.18,
        yaw_range=(radians(-45), radians(45)),
        pitch_range=(radians(-60), radians(60)),
        yaw_servo=_servo,
        pitch_servo=_servo,
    ),
    thorax=Thorax(mass=0.38, shoulder=0.050, width=0.100, height=0.060),
    head=Head(mass=0.22, snout=0.2125, width=0.080, height=0.045),
    tail=Tail(
        offset=0.045,
        root=0.040,
        joints=6,  # section III.C, N
        plate=0.030,
        gap=0.015,
        cord_spacing=0.050,
        pulley=0.025,
        joint_stiffness=0.6,
        joint_damping=0.02,
        fin_segments=3,
        fin_length=0.150,
        fin_stiffness_lateral=0.5,
        fin_stiffness_vertical=1.5,
        fin_damping=0.02,
        radius_root=0.028,
        radius_tip=0.008,
        mass=0.45,
        pitch_range=(radians(-70), radians(60)),
        bend_limit=pi / 2,
        pitch_servo=_servo,
        cable_servo=_servo,
    ),
    contact=Contact(foot_friction=0.8, skin_friction=0.4, time_constant=0.02),
)
"""Its measures."""
robot = crocodile(tables)
"""The article's robot."""

_PID = "1 to 2 degrees of droop in stance, critical damping of rotor and leg; integral action would wind up in stance"
_RULE = "torque at standstill times the mean ratio of the identified servos, times or over a standard deviation of"
_SERVO_CHOICE = "from an STS3215 for 12 V on three empty cells to an STS3250 on three full ones"
_CASE = "room for a hobby servo's case, and a belly that clears the ground in the crawl"
_FORE_LEG = "the article gives the hind leg only; crocodilians' fore legs are 0.8 to 0.9 as long"
_FOLD = "the legs can fold under the body for erect postures, and a 270 degree servo turns that far"
_BRACKET = "what brackets of this size allow, and what rising needs"

_Row = tuple[str, float, float, str]


def _servo_rows(path: str, demand: str) -> tuple[_Row, ...]:
    """Return path, plausible range and reason of every number of a servo.

    Args:
        path: path of the servo in the tables.
        demand: torque that the robot's movements ask of it, as a clause.
    """
    return (
        (f"{path}.torque", 2.4, 5.2, f"{_SERVO_CHOICE}; {demand}"),
        (f"{path}.speed", 3.9, 8.3, f"{_SERVO_CHOICE}, which turn slower by the same share"),
        (f"{path}.kp", 20.0, 80.0, _PID),
        (f"{path}.ki", 0.0, 20.0, _PID),
        (f"{path}.kd", 0.75, 3.0, _PID),
        (f"{path}.integral_limit", 0.1, 1.0, "unused while ki is zero"),
        (f"{path}.armature", 0.0065, 0.034, f"{_RULE} 2.3"),
        (f"{path}.friction", 0.048, 0.116, f"{_RULE} 1.6"),
        (f"{path}.damping", 0.011, 0.062, f"{_RULE} 2.3"),
    )


def _leg_rows(path: str) -> tuple[_Row, ...]:
    """Return path, plausible range and reason of every chosen number of the leg at a path."""
    return (
        (
            f"{path}.foot_radius",
            0.008,
            0.020,
            "a rubber ball that a pressure sensor fits into, no thinner than the shank",
        ),
        (f"{path}.radius", 0.008, 0.015, "a tube that carries the servos"),
        (
            f"{path}.mass",
            0.15,
            0.30,
            "three servos of 75 g and brackets; an isometric alligator of this length has 3.1 kg",
        ),
        *((f"{path}.{joint}_range[{i}]", -2.5, 2.7, _FOLD) for joint in ("yaw", "pitch", "knee") for i in (0, 1)),
        *_servo_rows(f"{path}.servo", "1.3 N m in the crawl, 2.6 N m at the hip when the robot rises"),
    )


_ROWS: tuple[_Row, ...] = (
    ("front_leg.hip_offset", 0.056, 0.070, _FORE_LEG),
    ("front_leg.femur", 0.069, 0.086, _FORE_LEG),
    ("front_leg.tibia", 0.071, 0.089, _FORE_LEG),
    *_leg_rows("front_leg"),
    *_leg_rows("hind_leg"),
    (
        "pelvis.mass",
        0.45,
        0.90,
        "battery and electronics: the centre of mass is near the hips, so that it can rise",
    ),
    ("pelvis.length", 0.06, 0.12, _CASE),
    ("pelvis.width", 0.08, 0.14, _CASE),
    ("pelvis.height", 0.05, 0.08, _CASE),
    ("spine.radius", 0.025, 0.04, _CASE),
    ("spine.link_mass", 0.12, 0.25, "two servos of 75 g and a bracket"),
    *((f"spine.{axis}_range[{i}]", -1.3, 1.3, _BRACKET) for axis in ("yaw", "pitch") for i in (0, 1)),
    *_servo_rows("spine.yaw_servo", "the crawl asks for 2.5 N m at the peaks"),
    *_servo_rows("spine.pitch_servo", "lifting the level forebody asks for 3.1 N m at the first pitch joint"),
    ("thorax.mass", 0.30, 0.45, "with the head at most 0.6 kg, or the trunk's servos cannot lift it"),
    ("thorax.shoulder", 0.03, 0.07, "the shoulders clear the last joint"),
    ("thorax.width", 0.08, 0.14, _CASE),
    ("thorax.height", 0.05, 0.08, _CASE),
    ("head.mass", 0.15, 0.30, "with the thorax at most 0.6 kg, or the trunk's servos cannot lift it"),
    (
        "head.snout",
        0.20,
        0.25,
        "hind leg, spine and head make the printed reach of 0.68 m when all is stretched",
    ),
    ("head.width", 0.06, 0.10, "a caiman's broad snout"),
    ("head.height", 0.03, 0.06, "a caiman's flat head"),
    ("tail.offset", 0.03, 0.06, "the pelvis ends here"),
    ("tail.root", 0.03, 0.06, "room for the pitch servo and the pulley"),
    (
        "tail.plate",
        0.025,
        0.035,
        "with the gap 45 mm a joint, which makes the tail half of the body as the text says",
    ),
    ("tail.gap", 0.010, 0.018, "no gap closes before 180 degrees of bend"),
    ("tail.cord_spacing", 0.04, 0.06, "fits the plates"),
    ("tail.pulley", 0.020, 0.030, "half the cord spacing: 90 degrees of servo bend the tail by 90 degrees"),
    (
        "tail.joint_stiffness",
        0.3,
        2.0,
        "chosen to spread the bend evenly; in the crawl the joints still differ by more than 10 degrees at times",
    ),
    ("tail.joint_damping", 0.01, 0.05, "rubber, damping ratio about 0.3"),
    ("tail.fin_length", 0.12, 0.18, "makes the tail half of the body"),
    (
        "tail.fin_stiffness_lateral",
        0.2,
        1.0,
        "'flexible material'; the tip lags by about a quarter cycle at 1 Hz",
    ),
    (
        "tail.fin_stiffness_vertical",
        0.5,
        3.0,
        "three times the lateral one: a blade higher than wide, which carries weight",
    ),
    ("tail.fin_damping", 0.01, 0.05, "damping ratio about 0.3"),
    ("tail.radius_root", 0.02, 0.035, _CASE),
    ("tail.radius_tip", 0.005, 0.012, "a tapering tail"),
    (
        "tail.mass",
        0.35,
        0.80,
        "13 % of the body, since the cable's servo sits in the pelvis; an alligator's is 28 %",
    ),
    *((f"tail.pitch_range[{i}]", -1.3, 1.3, _BRACKET) for i in (0, 1)),
    ("tail.bend_limit", 1.0, 2.4, "15 degrees a joint"),
    *_servo_rows("tail.pitch_servo", "rising asks for 1.9 N m"),
    *_servo_rows("tail.cable_servo", "bending against ground and springs asks for 1 N m"),
    ("contact.foot_friction", 0.5, 1.0, "rubber on a floor"),
    ("contact.skin_friction", 0.2, 0.6, "plastic on a floor"),
    ("contact.time_constant", 0.01, 0.03, "a rubber sole; displacement within 1 % over the range"),
)
chosen = tuple(
    Assumption(
        field=field,
        low=lower_bound,
        high=upper_bound,
        why=reason,
        above=(f"{field.removesuffix('.foot_radius')}.radius", TIBIA_RADIUS_RATIO)
        if field.endswith(".foot_radius")
        else None,
    )
    for field, lower_bound, upper_bound, reason in _ROWS
)
"""Every number of the robot that the article does not give, with its plausible range and the reason."""
