"""What the article says about its robot on land (sections IV.A to IV.D)."""

from suchus.article.paper.claim import Claim, statement
from suchus.article.paper.tables import CYCLE_PERIOD, CYCLES, SNAPSHOT_TIMES

DISPLACEMENT_COORDINATED = 0.73
DISPLACEMENT_LIMBS_ONLY = 0.16

CENTIMETRE = 0.005
"""Half of the last digit of a length printed in hundredths of a metre [m]."""
PERCENT = 0.005
"""Half of the last digit of a share printed in whole percent [-]."""


def _fault(key: str, figure: int, joint: str, trunk: bool, change: float, sense: str, quote: str) -> Claim:
    """Return the claim about the displacement with a failed joint, with and without a moving trunk."""
    return Claim(
        key=f"fault_{key}_{'coordinated' if trunk else 'limbs_only'}",
        where=f"IV.C, Fig. {figure}",
        quantity=f"change of displacement, {joint} lost, trunk {'moving' if trunk else 'still'}",
        value=change,
        unit="-",
        rounding=PERCENT,
        sense=sense,
        quote=quote,
    )


STABILITY = (
    Claim(
        key="cycle_period",
        where="IV.A, Fig. 13",
        quantity="duration of a crawling cycle",
        value=CYCLE_PERIOD,
        unit="s",
        rounding=0.5,  # printed in whole seconds
        sense="A crawling cycle takes four seconds.",
        quote="1-5 seconds is the first crawling cycle and 5-9 seconds is the second crawling cycle",
    ),
    Claim(
        key="cycle_count",
        where="IV.A, Fig. 13",
        quantity="cycles in the experiment",
        value=float(CYCLES),
        unit="-",
        rounding=0.0,
        sense="The experiment holds two cycles.",
        quote="The experiment contains two complete crawling cycles",
    ),
    *(
        Claim(
            key=f"snapshot_time_{i + 1}",
            where="IV.A, Fig. 14",
            quantity=f"time of snapshot {i + 1}",
            value=time,
            unit="s",
            rounding=0.05,  # half of the last digit
            sense="The posture is shown at 1.2, 1.5 and 1.8 s.",
            quote="screenshots of the simulation experiments at 1.2s, 1.5s and 1.8s",
        )
        for i, time in enumerate(SNAPSHOT_TIMES)
    ),
    statement(
        "spine_sinusoidal",
        "IV.A, Fig. 14",
        "swing of the spine",
        "The spine swings from side to side in a sine with the limbs.",
        "the spine swings from side to side in a sinusoidal pattern with the limbs",
    ),
    statement(
        "tail_supports",
        "IV.A, Fig. 14",
        "tail on the ground",
        "The dragged tail supports the body and makes it more stable.",
        "the tail stays on the ground ... to provide support for the body and improve the stability",
    ),
    statement(
        "com_on_support_line",
        "IV.A, Fig. 14",
        "centre of mass over the supporting feet at 1.2, 1.5 and 1.8 s",
        "Stability needs the centre of mass on the line of the two supporting feet.",
        "The center of gravity should always be on the line of the two supporting points",
    ),
    statement(
        "tilt_limbs_only",
        "IV.A, Fig. 14",
        "tilt without spine and tail",
        "With limbs only the body tilts at 1.2 s because its centre of mass is off the supporting line.",
        "at 1.2 seconds, the bionic crocodile robot tilts its body",
    ),
    statement(
        "com_fluctuation",
        "IV.A, Fig. 15",
        "fluctuation of the height of the centre of mass",
        "The height of the centre of mass fluctuates less with spine and tail than without.",
        "the variation amplitude ... with the tails involved ... is significantly smaller",
    ),
)

DISPLACEMENT = (
    Claim(
        key="displacement_coordinated",
        where="IV.B, Fig. 16",
        quantity="forward displacement with spine and tail",
        value=DISPLACEMENT_COORDINATED,
        unit="m",
        rounding=CENTIMETRE,
        sense="With spine and tail the robot moves forward.",
        quote="the robot achieves a displacement of 0.73 meters in the forward direction",
    ),
    Claim(
        key="displacement_limbs_only",
        where="IV.B, Fig. 16",
        quantity="forward displacement with limbs only",
        value=DISPLACEMENT_LIMBS_ONLY,
        unit="m",
        rounding=CENTIMETRE,
        sense="With limbs only the robot moves forward, but little.",
        quote="0.16 meters when the spine and tail are not engaged in the motion",
    ),
    Claim(
        key="displacement_ratio",
        where="IV.B, Fig. 16",
        quantity="displacement with spine and tail over displacement without",
        value=DISPLACEMENT_COORDINATED / DISPLACEMENT_LIMBS_ONLY,  # not printed; follows from the two
        unit="-",
        rounding=(DISPLACEMENT_COORDINATED + CENTIMETRE) / (DISPLACEMENT_LIMBS_ONLY - CENTIMETRE)
        - DISPLACEMENT_COORDINATED / DISPLACEMENT_LIMBS_ONLY,  # both at the farther ends of their last digits
        sense="In the same time the robot gets farther with spine and tail than without.",
        quote="the robot attains a higher velocity, covering more distance in the same time",
    ),
)

SWING = (
    statement(
        "tail_swing",
        "IV.B",
        "displacement gained by the swing of the tail",
        "The swing of the tail, not only its contact with the ground, adds to the displacement.",
        "the swing of the tail and spine can improve the motion displacement",
    ),
    statement(
        "spine_swing",
        "IV.B",
        "displacement gained by the swing of the spine",
        "The swing of the spine adds to the displacement.",
        "the swing of the tail and spine can improve the motion displacement",
    ),
    statement(
        "wagging_balances",
        "I, IV.A",
        "steadiness gained by wagging the tail",
        "Wagging the dragged tail makes the body steadier than dragging it still.",
        "they achieve balance by wagging their tails",
    ),
)

FAULTS = (
    _fault(
        "front_yaw",
        18,
        "front yaw joint",
        False,
        -0.80,
        "Without the trunk, losing a front yaw joint costs most of the displacement.",
        "without trunk cooperative motion has an 80% reduction in locomotion",
    ),
    _fault(
        "front_yaw",
        18,
        "front yaw joint",
        True,
        -0.22,
        "With the trunk, losing a front yaw joint costs little.",
        "with trunk cooperative motion has only a 22% reduction in locomotion",
    ),
    _fault(
        "hind_yaw",
        19,
        "hind yaw joint",
        False,
        -0.75,
        "Without the trunk, losing a hind yaw joint costs most of the displacement.",
        "without trunk cooperative motion has a 75% decrease in locomotion",
    ),
    _fault(
        "hind_yaw",
        19,
        "hind yaw joint",
        True,
        -0.17,
        "With the trunk, losing a hind yaw joint costs little.",
        "with trunk cooperative motion has only a 17% decrease in locomotion",
    ),
    _fault(
        "front_pitch",
        20,
        "front pitch joint",
        False,
        -1.0,
        "Without the trunk, losing a front pitch joint ends forward motion.",
        "the pitching joint of the front leg caused the ... robot to lose the ability of forward motion",
    ),
    _fault(
        "front_pitch",
        20,
        "front pitch joint",
        True,
        -1.0,
        "Even with the trunk, losing a front pitch joint ends forward motion.",
        "the pitching joint of the front leg caused the ... robot to lose the ability of forward motion",
    ),
    _fault(
        "hind_pitch",
        21,
        "hind pitch joint",
        False,
        -0.55,
        "Without the trunk, losing a hind pitch joint costs about half of the speed.",
        "without cooperating motion of trunk had a 55% reduction in locomotion velocity",
    ),
    _fault(
        "hind_pitch",
        21,
        "hind pitch joint",
        True,
        0.0,
        "With the trunk, losing a hind pitch joint costs almost nothing.",
        "with cooperating motion of trunk showed almost no reduction in locomotion",
    ),
    statement(
        "fault_support",
        "IV.C, Fig. 21",
        "support with a hind pitch joint lost",
        "Tail, right front and left hind leg carry the body and raise its centre of gravity, so that the damaged hind "
        "leg can be lifted and swing.",
        "raises the center of gravity of the robot through the support function of the tail, right front leg and left "
        "back leg, so that the hind legs can be lifted off the ground and swing",
    ),
    statement(
        "fault_tolerance",
        "IV.C, V",
        "fault tolerance with and without the trunk",
        "With spine and tail the robot bears the loss of a joint better.",
        "heightened fault tolerance when individual joints are compromised",
    ),
)

HEIGHTS = (
    Claim(
        key="height_crawl",
        where="IV.D, Fig. 24",
        quantity="reachable height when crawling",
        value=0.16,
        unit="m",
        rounding=CENTIMETRE,
        sense="Crawling, the robot can reach this height.",
        quote="can reach a height of 0.16m in the crawling state",
    ),
    Claim(
        key="height_standing",
        where="IV.D, Figs 23, 24",
        quantity="reachable height when standing on hind legs and tail",
        value=0.68,
        unit="m",
        rounding=CENTIMETRE,
        sense="On hind legs and tail the robot stands and reaches higher than when it crawls.",
        quote="and 0.68m in the bipedal standing state",
    ),
    Claim(
        key="height_ratio",
        where="IV.D, Fig. 24",
        quantity="reachable height standing over crawling",
        value=4.25,
        unit="-",
        rounding=0.005,
        sense="Standing, the robot reaches several times as high as crawling.",
        quote="The reachable height in the bipedal standing state is 4.25 times higher",
    ),
    statement(
        "height_from_legs",
        "IV.D, Fig. 23a",
        "what limits the crawling height",
        "The crawling height follows the length of the legs.",
        "depends on the length of its legs when crawling on land",
    ),
    statement(
        "height_from_spine_head_legs",
        "IV.D, Fig. 23b",
        "what limits the standing height",
        "The standing height follows the lengths of spine, head and hind legs together.",
        "determined by the length of the spine, the length of the head and the length of the hind legs",
    ),
    statement(
        "working_space",
        "IV.D",
        "working space",
        "Standing on hind legs and tail greatly enlarges the working space.",
        "thus the working space of the crocodile robot can be greatly improved",
    ),
)

LAND = (*STABILITY, *DISPLACEMENT, *SWING, *FAULTS, *HEIGHTS)
"""The claims of section IV about the land."""
