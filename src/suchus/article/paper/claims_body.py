"""What the article says about animals, structure and kinematics (sections II and III)."""

from suchus.article.paper.claim import Claim, statement
from suchus.article.paper.tables import TAIL_JOINTS

KMH = 1 / 3.6
"""One kilometre per hour [m/s]."""

SHARE_READING = 0.05
"""For "roughly half": a share that rounds to one half in tenths [-]."""
SPEED_READING = 0.5 * KMH
"""For a range printed in whole km/h: half of the last digit [m/s]."""
LENGTH_READING = 0.005
"""For a length printed in centimetres: half of the last digit [m]."""


def _count(key: str, location: str, quantity: str, value: int, sense: str, quote: str) -> Claim:
    """Return a claim about a number of things."""
    return Claim(
        key=key,
        where=location,
        quantity=quantity,
        value=float(value),
        unit="-",
        rounding=0.0,
        sense=sense,
        quote=quote,
    )


ANIMALS = (
    _count(
        "species_count",
        "II.A",
        "number of living species",
        26,
        "There are 26 recognised species of crocodilians.",
        "[There] are currently 26 recognized crocodile species",
    ),
    Claim(
        key="largest_length",
        where="II.A",
        quantity="average length of the largest species",
        value=4.0,
        unit="m",
        rounding=0.5,  # printed as "approximately 4 meters": half of the last digit
        sense="The largest crocodile is the Nile crocodile, about 4 m long.",
        quote="the African Nile Crocodile, the largest among them, ... approximately 4 meters",
    ),
    Claim(
        key="smallest_length",
        where="II.A",
        quantity="length of the smallest species",
        value=1.25,
        unit="m",
        rounding=LENGTH_READING,
        sense="The smallest crocodile is the Chinese alligator, about 1.25 m long.",
        quote="the smallest crocodile species, typically measuring around 1.25 meters in length",
    ),
    Claim(
        key="tail_share",
        where="II.A, Fig. 1",
        quantity="tail length over body length",
        value=0.5,
        unit="-",
        rounding=SHARE_READING,
        sense="The tail is roughly half as long as the whole body.",
        quote="the tail's length accounting for roughly half of the crocodile's overall body length",
    ),
    _count(
        "front_toes",
        "II.A",
        "toes of a front foot",
        5,
        "A front foot has five toes.",
        "The front legs exhibit five toes",
    ),
    _count(
        "hind_toes",
        "II.A",
        "toes of a hind foot",
        4,
        "A hind foot has four toes and is webbed.",
        "the hind legs feature four toes",
    ),
    Claim(
        key="high_walk_speed_low",
        where="II.A",
        quantity="slow end of the animal's high walk",
        value=5 * KMH,
        unit="m/s",
        rounding=SPEED_READING,
        sense="A crocodile's high walk is at least 5 km/h fast.",
        quote="This mode typically ranges in speed from 5 to 10 km/h.",
    ),
    Claim(
        key="high_walk_speed_high",
        where="II.A",
        quantity="fast end of the animal's high walk",
        value=10 * KMH,
        unit="m/s",
        rounding=SPEED_READING,
        sense="A crocodile's high walk is at most 10 km/h fast.",
        quote="This mode typically ranges in speed from 5 to 10 km/h.",
    ),
    statement(
        "diagonal_gait",
        "II.A, IV.A, Fig. 12",
        "limb phases of the crawl",
        "Front and hind leg of opposite sides move together.",
        "the front and hind legs move in a diagonal gait",
    ),
    statement(
        "tail_swings_in_crawl",
        "II.A",
        "tail in the crawl",
        "In the belly crawl the tail swings alternately to both sides.",
        "the tail swings alternately from side to side",
    ),
    statement(
        "tail_on_ground_in_high_walk",
        "II.A",
        "tail in the high walk",
        "In the high walk about half of the tail swings along the ground.",
        "about half of their tail alternates in swinging along the ground",
    ),
    statement(
        "gallop_fastest",
        "II.A",
        "gallop",
        "Galloping is the fastest way to move on land.",
        "Galloping movements, which represent their fastest mode of locomotion",
    ),
    statement(
        "bending_lengthens_stride",
        "I",
        "stride with a bending body",
        "Bending the body lengthens the stride.",
        "Crocodiles extend their stride length by bending their bodies",
    ),
)

STRUCTURE = (
    _count(
        "leg_servos",
        "III.D, Fig. 10",
        "servos per leg",
        3,
        "A leg has one yaw servo and two pitch servos.",
        "leg section comprises one yaw joint servo motor, two pitch joint servo motors",
    ),
    _count(
        "spine_joints",
        "II.B, Fig. 4",
        "joints of the trunk",
        5,
        "The trunk has three lateral and two pitch joints.",
        "five degrees of freedom have been set in the torso",
    ),
    _count(
        "spine_lateral_joints",
        "II.B, Fig. 4",
        "lateral joints of the trunk",
        3,
        "Three of the trunk's joints bend it sideways.",
        "three degrees of freedom for the lateral movement of the spinal column",
    ),
    _count(
        "spine_pitch_joints",
        "II.B, Fig. 4",
        "pitch joints of the trunk",
        2,
        "Two of the trunk's joints pitch it.",
        "two degrees of freedom for the robot's pitch motion",
    ),
    _count(
        "tail_joints",
        "II.B, III.C, Figs 5, 9",
        "joints of the tail's cable section",
        TAIL_JOINTS,
        "The driven part of the tail has six joints.",
        "the drive section has six degrees of freedom",
    ),
    _count(
        "tail_actuators",
        "III.D, Fig. 10",
        "actuators of the tail",
        2,
        "The tail has one pitch servo and one actuator for its cords.",
        "one pitch joint servo motor, a linear actuator for tail movement",
    ),
    _count(
        "actuator_count",
        "III.D, Fig. 10",
        "actuators of the robot",
        19,  # not printed as a sum: 4 x 3 + 5 + 2 of III.D
        "Four legs of three, five in the spine and two in the tail make 19 actuators.",
        "one yaw joint servo motor, two pitch ... three yaw ... two pitch ... one pitch ..., a linear actuator",
    ),
    statement(
        "tail_end_flexible",
        "II.B, Fig. 5",
        "end of the tail",
        "The end of the tail is passive and flexible.",
        "the under-drive section is made of flexible material",
    ),
    statement(
        "crawl_structure_flat",
        "II.B, Fig. 3a",
        "sprawled legs",
        "On flat ground the robot moves with sprawled legs.",
        "When moving on a flat surface, the robot adopts the crawling structure",
    ),
    statement(
        "erect_structure_rough",
        "II.B, Fig. 3b",
        "erect legs",
        "On rough ground the robot moves better with its legs erect, as a mammal does.",
        "when traversing rough terrain, it utilizes the lactation type structure",
    ),
    statement(
        "switches_structure",
        "II.B, Fig. 3",
        "switching the leg structure",
        "The robot can change between both leg structures while it moves.",
        "dynamically switch between different structures and gaits",
    ),
)

KINEMATICS = (
    statement(
        "leg_inverse",
        "III.A, eqs (9)-(14)",
        "inverse kinematics of the leg",
        "Equation (14) gives the joint angles that bring the foot to its positions.",
        "The inverse kinematics solution of the legs of the bionic crocodile robot is as follows",
    ),
    statement(
        "spine_forward",
        "III.B, eq. (15)",
        "forward kinematics of the spine",
        "Equation (15) is the end of the chain of Table II.",
        "After solving the matrix operations and organizing them, we obtain the following",
    ),
    statement(
        "tail_equal_bends",
        "III.C",
        "bend of each tail joint",
        "All tail joints turn by the same angle.",
        "The angle of rotation of each joint is the same",
    ),
    statement(
        "tail_quadratic_small",
        "III.C, eqs (16), (17)",
        "quadratic term of the cord lengths",
        "The quadratic term of (16) is small enough to be left out.",
        "the quadratic term in (16) can be ignored because the angle ... is very small",
    ),
    statement(
        "tail_cords_inextensible",
        "III.C",
        "pair of cords on one wheel",
        "The servo shortens one cord and lengthens the other, and so bends the tail.",
        "a pair of inextensible wire cords ... one cord is elongated, and the other is shortened",
    ),
    statement(
        "tail_joint_positions",
        "III.C, eq. (19)",
        "positions of the tail's joints",
        "Equation (19) gives the position of each tail joint.",
        "The position of each joint in the XOY coordinate system can be expressed as",
    ),
    statement(
        "feedback_rules",
        "III.D",
        "three feedback rules",
        "Limb, spine and tail feedback each make a stable closed loop.",
        "Through these three rules, we can achieve stable closed-loop control",
    ),
    statement(
        "shared_variables",
        "III.D, Fig. 10",
        "coordination by shared variables",
        "Independent controllers that share limb phase and bend angles keep the whole body coordinated.",
        "they share certain variables ... to ensure overall temporal and spatial coordination",
    ),
    statement(
        "joint_pid",
        "III.D, Fig. 10",
        "control of the joint angles",
        "PID controllers close the loop of each joint's angle.",
        "We employ PID controllers for closed-loop control of the joint angles",
    ),
    statement(
        "gait_diagram",
        "III.D, Fig. 12",
        "limb phase, spine and tail angle over two cycles",
        "Spine and tail bend once to each side in every cycle of the limbs.",
        "the corresponding relationship between the angle of the spine ..., the tail ..., and the gaits",
    ),
)

BODY = (*ANIMALS, *STRUCTURE, *KINEMATICS)
"""The claims of sections I to III."""
