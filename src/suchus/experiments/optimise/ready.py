"""Ready-made searches, by name."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from types import MappingProxyType

from suchus.core.errors import UnknownName, UnsuitedRobot
from suchus.experiments.optimise.spec import Aim, Limit, Optimisation
from suchus.experiments.study import Arm, Vary
from suchus.experiments.study.plan import vary_assumption
from suchus.robot.control import Standing, Walking
from suchus.robot.design import Robot, check_needs, layout, value_at
from suchus.robot.gaits import DRAFTED, GAITS, conditions_of, control_group, default_gait
from suchus.robot.gaits.belly_crawl import FRONT, HIND
from suchus.robot.motion import Gait, draft_gait
from suchus.robot.robots import ROBOTS
from suchus.sim.land import FAILED_JOINTS, Run, failing_joints, joint_failure

_LEGS = (
    ("duty_factor", 0.5, 0.8),
    ("stroke", 0.0, 0.12 / FRONT),
    ("lift", 0.01 / FRONT, 0.05 / FRONT),
    ("limbs[0].outward", 0.02 / FRONT, 0.13 / FRONT),
    ("limbs[1].outward", 0.02 / HIND, 0.14 / HIND),
    ("limbs[0].ahead", -0.06 / FRONT, 0.06 / FRONT),
    ("limbs[1].ahead", -0.06 / HIND, 0.06 / HIND),
    ("height", 0.06 / HIND, 0.13 / HIND),
)
_BODY = (
    ("trunk_bend", 0.0, 2.3),
    ("axis_lag", -0.2, 0.2),
    ("tail_bend", 0.0, 1.5),
    ("tail_lag", 0.0, 1.0),
    ("tail_pitch", -0.3, 0.4),
)
_LIMITS = (
    Limit(name="torque", value=0.65),
    Limit(name="slip", value=0.5),
    Limit(name="clearance", value=0.005),
    Limit(name="sideways", value=0.25),
)
_CRAWL_REASONS = (
    "The cycle stays at the article's four seconds, so that two cycles compare with its 0.73 m; feet stand at least "
    "half of it, so that it is a walk. Legs and trunk may go as far as joints and reach let them.",
    "Torque and slip may be a little more than in the article's crawl on this robot (0.60 and 0.46); parts of the "
    "body, whose contacts the physics does not know, stay 5 mm apart; it walks straight within 0.25 m.",
    "Both conditions have the same legs, ranges, limits, population and budget; limbs_only holds trunk and tail "
    "straight and the tail off the ground.",
)


def _vary(rows: tuple[tuple[str, float, float], ...]) -> tuple[Vary, ...]:
    return tuple(
        Vary(field=f"gait.{name}", low=lower_bound, high=upper_bound) for name, lower_bound, upper_bound in rows
    )


def _limbs_only() -> Arm:
    limbs = GAITS["limbs_only"]
    return Arm(name="limbs_only", values={f"gait.{name}": value_at(limbs, name) for name, _, _ in _BODY})


def crawl(robot: Robot | None = None) -> Optimisation:
    """The farthest two cycles with spine and tail, and the farthest with limbs only, on the same budget."""
    if robot is not None and robot != ROBOTS["caiman"]:
        return _crawl_of(robot)
    return Optimisation(
        name="crawl",
        run=Run(robot=ROBOTS["caiman"], gait=GAITS["belly_crawl"]),
        vary=_vary((*_LEGS, *_BODY)),
        aims=(Aim(name="displacement"),),
        limits=_LIMITS,
        arms=(Arm(name="coordinated"), _limbs_only()),
        evaluations=960,
        seed=1,
        reasons=_CRAWL_REASONS,
    )


def search_gait(robot: Robot) -> Gait:
    """Return the gait from which a search for legs starts: the robot's own, or a draft where that has no strokes.

    Raises:
        UnsuitedRobot: it has no limbs or no axis that bends, or no gait of it has feet that follow paths.
    """
    check_needs(
        robot,
        ("foot_paths", "axis"),
        "the search crawl",
        remedy="choose another robot, or write a search as a file (docs/optimise.md)",
    )
    own_gait = default_gait(robot)
    gait = own_gait if own_gait.has("strokes") else draft_gait(robot, DRAFTED)
    if not gait.has("strokes"):
        raise UnsuitedRobot(
            f"the search crawl needs limbs whose feet follow paths; robot {robot.name!r} walks in the gait "
            f"{gait.name!r}, which has none: write a search as a file (docs/optimise.md)."
        )
    return gait


def _crawl_of(robot: Robot) -> Optimisation:
    """Return the search for the best legs of another body, with its axis and with limbs only.

    It starts from the gait that ``search_gait`` returns. Each range is that of the article's crawl, moved as far as it
    must be to hold the gait's own value. Limits in metres grow with the length of the body.

    Raises:
        UnsuitedRobot: it has no limbs or no axis that bends, or its feet follow no paths.
    """
    gait = search_gait(robot)
    legs = [row for row in _LEGS if not row[0].startswith("limbs[")]
    for number in range(len(gait.limbs)):
        pattern = 0 if number < len(gait.limbs) - 1 else 1
        legs += [
            (f"limbs[{number}].{name}", lower, upper)
            for path, lower, upper in _LEGS
            for head, _, name in [path.partition("].")]
            if head == f"limbs[{pattern}"
        ]
    body = [row for row in _BODY if row[0] != "tail_pitch" or layout(robot).tail_pitch]
    rows = [_shifted(row, value) for row in (*legs, *body) if (value := _number_at(gait, row[0])) is not None]
    control = control_group(gait)
    fixed = {f"gait.{name}": value_at(control, name) for name, _, _ in rows if name in {row[0] for row in _BODY}}
    length_ratio = robot.length / ROBOTS["caiman"].length
    return Optimisation(
        name=f"crawl_{robot.name}",
        run=Run(robot=robot, gait=gait),
        vary=_vary(tuple(rows)),
        aims=(Aim(name="displacement"),),
        limits=tuple(
            replace(limit, value=limit.value * length_ratio) if limit.name in ("clearance", "sideways") else limit
            for limit in _LIMITS
        ),
        arms=(Arm(name="coordinated"), Arm(name="limbs_only", values=fixed)),
        evaluations=960,
        seed=1,
        reasons=(
            f"The cycle is that of the gait {gait.name}. Ranges are those of the article's crawl in parts of the "
            "limbs, moved where they would not hold the gait's own value.",
            "Both conditions have the same legs, ranges, limits, population and budget; limbs_only holds the axis "
            "straight.",
        ),
    )


def fault(robot: Robot | None = None) -> Optimisation:
    """The farthest two cycles intact, and with each joint of a leg limp: a gait for each fault, and one for none."""
    base = crawl(robot)
    run = base.run
    possible_joints = failing_joints(run.robot)
    joints = [joint for joint in possible_joints if joint in FAILED_JOINTS] or possible_joints
    intact_arms = tuple(replace(arm, name=f"intact_{arm.name}") for arm in base.arms)
    fault_arms = tuple(
        Arm(
            name=f"{joint}_{arm.name}",
            values={**arm.values, "faults": joint_failure(run.robot, run.gait, joint, "limp")},
        )
        for joint in joints
        for arm in base.arms
    )
    return replace(
        base,
        name=base.name.replace("crawl", "fault", 1),
        arms=(*intact_arms, *fault_arms),
        limits=tuple(limit for limit in base.limits if limit.name in ("torque", "clearance")),
        evaluations=160,
        reasons=(
            "Each condition begins with the gait of the intact robot: the first number is that of a robot that does "
            "not know its fault, the best that of one that does. The search intact, with the same budget, shows what "
            "of the difference is due to the search alone.",
            "A limp joint turns the robot, and a foot that is not lifted slips, so that neither is a limit here.",
            *base.reasons,
        ),
    )


def _number_at(gait: Gait, path: str) -> float | None:
    """Return the number of a field of a gait; None where the gait has no such field or no number there."""
    try:
        value = value_at(gait, path)
    except UnknownName:
        return None
    return float(value) if isinstance(value, (int, float)) else None


def _shifted(row: tuple[str, float, float], value: float) -> tuple[str, float, float]:
    """Return a range of the same width, moved as little as lets it hold a value."""
    name, lower, upper = row
    shift = min(0.0, value - lower) + max(0.0, value - upper)
    return name, lower + shift, upper + shift


def thrift() -> Optimisation:
    """The front between displacement and cost of transport, with spine and tail."""
    return Optimisation(
        name="thrift",
        run=Run(robot=ROBOTS["caiman"], gait=GAITS["belly_crawl"]),
        vary=_vary((*_LEGS, *_BODY)),
        aims=(Aim(name="displacement"), Aim(name="cost_of_transport")),
        limits=_LIMITS,
        pareto=True,
        evaluations=1200,
        population=10,
        seed=1,
        reasons=_CRAWL_REASONS[:2],
    )


def turn() -> Optimisation:
    """The greatest change of heading in two cycles of the low crawl."""
    return Optimisation(
        name="turn",
        run=Run(robot=ROBOTS["caiman"], gait=GAITS["low_crawl"], control=Walking(bend=0.4, asymmetry=0.5)),
        vary=(
            Vary(field="control.bend", low=0.0, high=1.2),
            Vary(field="control.asymmetry", low=0.0, high=1.5),
            *_vary((("stroke", 0.01 / FRONT, 0.08 / FRONT), ("trunk_bend", 0.0, 1.5), ("duty_factor", 0.5, 0.8))),
        ),
        aims=(Aim(name="turning"),),
        limits=(Limit(name="torque", value=0.65), Limit(name="clearance", value=0.005)),
        evaluations=240,
        population=12,
        duration=5.0,
        seed=1,
    )


def stand() -> Optimisation:
    """The greatest height that it reaches standing, with other lengths of hind legs and spine."""
    return Optimisation(
        name="stand",
        run=Run(robot=ROBOTS["caiman"], gait=GAITS["limbs_only"], control=Standing(at=1.1, hold=3.0)),
        vary=(
            Vary(field="robot.hind_leg.femur", low=0.08, high=0.095),
            Vary(field="robot.hind_leg.tibia", low=0.08, high=0.098),
            Vary(field="robot.spine.link", low=0.055, high=0.067),
            Vary(field="robot.pelvis.mass", low=0.45, high=0.9),
            Vary(field="robot.spine.pitch_servo.torque", low=2.5, high=5.0),
        ),
        aims=(Aim(name="standing_reach"),),
        limits=(Limit(name="torque", value=0.9),),
        evaluations=120,
        population=10,
        duration=14.0,
        seed=1,
    )


def lifted() -> Optimisation:
    """A plausible design on which limbs alone, the tail held in the air, walk: the control group of the article."""
    robot, gait = ROBOTS["caiman"], GAITS["limbs_only"]
    excluded = ("_range[", ".ki", ".integral_limit")  # limits only forbid; robots of a batch have equal integral action
    numbers = ROBOTS.beside(robot.name, "chosen", ())
    rows = [
        (f"robot.{choice.field}", choice)
        for choice in numbers
        if not any(pattern in choice.field for pattern in excluded)
    ]
    fixed_fields = {name for name, _, _ in _BODY}
    rows += [
        (f"gait.{choice.field}", choice)
        for choice in GAITS.beside(gait.name, "chosen", ())
        if choice.field not in fixed_fields
    ]
    control = conditions_of(robot, GAITS["belly_crawl"], gait)["limbs_tail_lifted"]
    return Optimisation(
        name="lifted",
        run=Run(robot=robot, gait=control),
        vary=tuple(vary_assumption(path, choice) for path, choice in rows),
        aims=(Aim(name="foot_lift"),),
        limits=(
            Limit(name="duty_greatest", value=0.85),
            Limit(name="duty_least", value=0.5),
            Limit(name="sideways", value=0.25),
        ),
        evaluations=960,
        population=24,
        seed=1,
        reasons=(
            "All numbers of robot and gait that the article does not give, within their plausible ranges, but for the "
            "limits of joints and integral action.",
            "In a walk each foot stands for at least half of the cycle; one that hardly leaves the ground, more than "
            "0.85 of it, walks in no gait. The lift of the foot that is lifted least says whether all four step.",
        ),
    )


FOR_ANY_ROBOT = ("crawl", "fault")
"""Those that take another robot than the article's."""
READY: Mapping[str, Callable[..., Optimisation]] = MappingProxyType(
    {maker.__name__: maker for maker in (crawl, fault, thrift, turn, stand, lifted)}
)
"""What makes each; its docstring says what it is."""
