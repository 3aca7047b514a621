"""The article's robot: its dimensions, and for what it does not give our numbers with their reasons."""

from math import pi, radians

from suchus.design import Chosen, Contact, Crocodile, Head, Leg, Pelvis, Servo, Spine, Tail, Thorax
from suchus.paper import FEMUR, HIP_OFFSET, SPINE_BASE, SPINE_LINK, TAIL_JOINTS, TIBIA

_KP, _KD, _SPEED = 40.0, 0.6, 7.0


def _servo(torque: float) -> Servo:
    return Servo(
        kp=_KP,
        ki=0.0,
        kd=_KD,
        integral_limit=0.5,
        torque=torque,
        speed=_SPEED,
        armature=0.005,
        friction=0.03,
        damping=0.05,
    )


_LIMB_SERVO, _TRUNK_SERVO = _servo(3.0), _servo(4.0)

_hind_leg = Leg(
    hip_offset=HIP_OFFSET,
    femur=FEMUR,
    tibia=TIBIA,
    foot_radius=0.014,
    radius=0.011,
    mass=0.25,
    yaw_range=(radians(-100), radians(100)),
    pitch_range=(radians(-75), radians(150)),
    knee_range=(radians(-140), radians(140)),
    servo=_LIMB_SERVO,
)
_FORE = 0.9  # fore legs of crocodilians are 0.8 to 0.9 of the hind legs
_front_leg = Leg(
    hip_offset=_FORE * HIP_OFFSET,
    femur=_FORE * FEMUR,
    tibia=_FORE * TIBIA,
    foot_radius=0.014,
    radius=0.011,
    mass=0.25,
    yaw_range=_hind_leg.yaw_range,
    pitch_range=_hind_leg.pitch_range,
    knee_range=_hind_leg.knee_range,
    servo=_LIMB_SERVO,
)

robot = Crocodile(
    name="caiman",
    hind_leg=_hind_leg,
    front_leg=_front_leg,
    pelvis=Pelvis(mass=0.75, length=0.090, width=0.110, height=0.064),
    spine=Spine(
        base=SPINE_BASE,
        link=SPINE_LINK,
        radius=0.032,
        link_mass=0.18,
        yaw_range=(radians(-45), radians(45)),
        pitch_range=(radians(-60), radians(60)),
        yaw_servo=_servo(2.5),
        pitch_servo=_TRUNK_SERVO,
    ),
    thorax=Thorax(mass=0.38, shoulder=0.050, width=0.100, height=0.060),
    head=Head(mass=0.22, snout=0.2125, width=0.080, height=0.045),
    tail=Tail(
        offset=0.045,
        root=0.040,
        joints=TAIL_JOINTS,
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
        pitch_servo=_servo(2.5),
        cable_servo=_servo(2.5),
    ),
    contact=Contact(foot_friction=0.8, skin_friction=0.4, time_constant=0.01),
)
"""The article's robot."""

_FORE_WHY = "The article gives the hind leg only; 0.9 of it, as fore legs of crocodilians are 0.8 to 0.9 as long."
_LIMITS_WHY = (
    "Not in the paper; wide enough that the legs can fold under the body for the erect postures, "
    "and within what a 270 degree servo turns."
)
_RADIUS_WHY = "Not in the paper; room for a hobby servo's case, and a belly that clears the ground in the crawl."
_PID_WHY = (
    "Not in the paper beyond 'PID'; 1 to 2 degrees of static droop in stance, damping close to critical. "
    "Integral action is off: stance forces would wind it up."
)


def _servo_chosen(path: str, low: float, high: float, why: str) -> tuple[Chosen, ...]:
    return (
        Chosen(field=f"{path}.torque", low=low, high=high, why=why),
        Chosen(field=f"{path}.kp", low=20.0, high=80.0, why=_PID_WHY),
        Chosen(field=f"{path}.ki", low=0.0, high=20.0, why=_PID_WHY),
        Chosen(field=f"{path}.kd", low=0.3, high=1.2, why=_PID_WHY),
        Chosen(field=f"{path}.integral_limit", low=0.1, high=1.0, why="Not in the paper; unused while ki is zero."),
        Chosen(
            field=f"{path}.speed",
            low=5.0,
            high=10.0,
            why="Not in the paper; no-load speed of a hobby servo of this torque class.",
        ),
        Chosen(
            field=f"{path}.armature",
            low=0.002,
            high=0.01,
            why="Not in the paper; rotor inertia times the square of a 250:1 gear of that class.",
        ),
        Chosen(field=f"{path}.friction", low=0.01, high=0.1, why="Not in the paper; about 1 % of the torque limit."),
        Chosen(field=f"{path}.damping", low=0.01, high=0.1, why="Not in the paper; back-driven gear, measured class."),
    )


def _leg_chosen(path: str) -> tuple[Chosen, ...]:
    own = "Not in the paper; a rubber ball that a pressure sensor fits into."
    return (
        Chosen(field=f"{path}.foot_radius", low=0.008, high=0.020, why=own),
        Chosen(field=f"{path}.radius", low=0.008, high=0.015, why="Not in the paper; a tube that carries the servos."),
        Chosen(
            field=f"{path}.mass",
            low=0.15,
            high=0.30,
            why="Not in the paper; three 60 g servos and brackets. An isometric alligator of this length has 3.1 kg.",
        ),
        *_servo_chosen(
            f"{path}.servo",
            2.0,
            4.0,
            "Not in the paper; a trotting leg needs 1.3 N m in the crawl and 2.6 N m at the hip when the robot rises.",
        ),
    )


chosen: tuple[Chosen, ...] = (
    *(
        Chosen(field=f"front_leg.{name}", low=low, high=high, why=_FORE_WHY)
        for name, low, high in (
            ("hip_offset", 0.056, 0.070),
            ("femur", 0.069, 0.086),
            ("tibia", 0.071, 0.089),
        )
    ),
    *_leg_chosen("front_leg"),
    *_leg_chosen("hind_leg"),
    Chosen(
        field="pelvis.mass",
        low=0.45,
        high=0.90,
        why="Not in the paper; battery and electronics sit here, so that the centre of mass is near the hips and "
        "the robot can rise (prototype: 0.75 kg stood where 0.60 kg fell).",
    ),
    Chosen(field="pelvis.length", low=0.06, high=0.12, why=_RADIUS_WHY),
    Chosen(field="pelvis.width", low=0.08, high=0.14, why=_RADIUS_WHY),
    Chosen(field="pelvis.height", low=0.05, high=0.08, why=_RADIUS_WHY),
    Chosen(field="spine.radius", low=0.025, high=0.04, why=_RADIUS_WHY),
    Chosen(field="spine.link_mass", low=0.12, high=0.25, why="Not in the paper; two 60 g servos and a bracket each."),
    *_servo_chosen("spine.yaw_servo", 1.5, 4.0, "Not in the paper; the crawl asks for 2.5 N m at the peaks."),
    *_servo_chosen(
        "spine.pitch_servo",
        2.5,
        5.0,
        "Not in the paper; lifting the level forebody off the ground asks for 3.1 N m at the first pitch joint.",
    ),
    Chosen(
        field="thorax.mass",
        low=0.30,
        high=0.45,
        why="Not in the paper; with the head at most 0.6 kg, or the trunk servos cannot lift it.",
    ),
    Chosen(field="thorax.shoulder", low=0.03, high=0.07, why="Not in the paper; the shoulders clear the last joint."),
    Chosen(field="thorax.width", low=0.08, high=0.14, why=_RADIUS_WHY),
    Chosen(field="thorax.height", low=0.05, high=0.08, why=_RADIUS_WHY),
    Chosen(field="head.mass", low=0.15, high=0.30, why="Not in the paper; see thorax.mass."),
    Chosen(
        field="head.snout",
        low=0.20,
        high=0.25,
        why="Not in the paper; 0.2125 m makes leg, spine and head 0.68 m when all is stretched, the printed reach.",
    ),
    Chosen(field="head.width", low=0.06, high=0.10, why="Not in the paper; a caiman's broad snout."),
    Chosen(field="head.height", low=0.03, high=0.06, why="Not in the paper; a caiman's flat head."),
    Chosen(field="tail.offset", low=0.03, high=0.06, why="Not in the paper; the pelvis ends here."),
    Chosen(field="tail.root", low=0.03, high=0.06, why="Not in the paper; room for the pitch servo and the pulley."),
    Chosen(
        field="tail.plate",
        low=0.025,
        high=0.035,
        why="Not in the paper; with the gap 45 mm a joint, so that the tail is half of the body as the text says.",
    ),
    Chosen(field="tail.gap", low=0.010, high=0.018, why="Not in the paper; no gap closes before 180 degrees of bend."),
    Chosen(field="tail.cord_spacing", low=0.04, high=0.06, why="Not in the paper; fits the plates."),
    Chosen(
        field="tail.pulley",
        low=0.020,
        high=0.030,
        why="Not in the paper; half the cord spacing, so that 90 degrees of servo bend the tail by 90 degrees.",
    ),
    Chosen(
        field="tail.joint_stiffness",
        low=0.3,
        high=2.0,
        why="Not in the paper; spreads the bend evenly over the joints under ground load (prototype: within 10 degrees).",
    ),
    Chosen(field="tail.joint_damping", low=0.01, high=0.05, why="Not in the paper; rubber, damping ratio about 0.3."),
    Chosen(field="tail.fin_length", low=0.12, high=0.18, why="Not in the paper; makes the tail half of the body."),
    Chosen(
        field="tail.fin_stiffness_lateral",
        low=0.2,
        high=1.0,
        why="Not in the paper ('flexible material'); the tip lags by about a quarter cycle at 1 Hz.",
    ),
    Chosen(
        field="tail.fin_stiffness_vertical",
        low=0.5,
        high=3.0,
        why="Not in the paper; three times the lateral one: the blade is higher than wide, and it carries weight.",
    ),
    Chosen(field="tail.fin_damping", low=0.01, high=0.05, why="Not in the paper; damping ratio about 0.3."),
    Chosen(field="tail.radius_root", low=0.02, high=0.035, why=_RADIUS_WHY),
    Chosen(field="tail.radius_tip", low=0.005, high=0.012, why="Not in the paper; a tapering tail."),
    Chosen(
        field="tail.mass",
        low=0.35,
        high=0.80,
        why="Not in the paper; 13 % of the body: the wires' servo sits in the pelvis (an alligator's tail is 28 %).",
    ),
    *_servo_chosen("tail.pitch_servo", 1.5, 4.0, "Not in the paper; rising asks for 1.9 N m."),
    *_servo_chosen("tail.cable_servo", 1.5, 4.0, "Not in the paper; bending against ground and springs asks for 1 N m."),
    Chosen(field="contact.foot_friction", low=0.5, high=1.0, why="Not in the paper; rubber on a floor."),
    Chosen(field="contact.skin_friction", low=0.2, high=0.6, why="Not in the paper; plastic on a floor."),
    Chosen(field="contact.time_constant", low=0.005, high=0.02, why="Not in the paper; measured not to matter."),
    *(
        Chosen(field=f"{leg}.{joint}_range[{i}]", low=-2.5, high=2.7, why=_LIMITS_WHY)
        for leg in ("front_leg", "hind_leg")
        for joint in ("yaw", "pitch", "knee")
        for i in (0, 1)
    ),
    *(
        Chosen(
            field=f"{path}[{i}]",
            low=-1.3,
            high=1.3,
            why="Not in the paper; what brackets of this size allow, and what rising needs.",
        )
        for path in ("spine.yaw_range", "spine.pitch_range", "tail.pitch_range")
        for i in (0, 1)
    ),
    Chosen(field="tail.bend_limit", low=1.0, high=2.4, why="Not in the paper; 15 degrees a joint."),
)
"""Every number of the robot that the article does not give, with its plausible range and the reason."""
