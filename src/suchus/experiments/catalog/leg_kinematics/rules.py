"""When the claims on the leg's kinematics count as what (section III.A, eqs (1) to (14))."""

from suchus.article.verdict.judging import Examples
from suchus.article.verdict.rule import Clause, Rule

_COUNT_REASON = "A count of the robot that was built so; nothing is simulated."

RULES = (
    Rule(
        claim="leg_inverse",
        experiment="leg_kinematics",
        measure="printed_inverse_holds_crawl",
        definition="share of the crawl's foot positions at which (14) is exact",
        kind="construction",
        holds=(
            Clause(
                "printed_inverse_holds_crawl",
                ">=",
                1.0,
                "a solution that serves 'motion planning and foot trajectory control' must be one at every foot "
                "position of the article's crawl",
            ),
        ),
        why="(14) is exact at {printed_inverse_holds_crawl:.0%} of the foot positions of the crawl, for which the "
        "article needs it; at {printed_inverse_holds_high_walk:.1%} of those with erect legs, and at "
        "{printed_inverse_holds:.0%} of all points in reach: there its arctan is half a turn off. The article names "
        "no limits of (14).",
        unswept="The foot positions are commanded, and (14) has no free number but the lengths of the legs.",
    ),
    Rule(
        claim="leg_servos",
        experiment="leg_kinematics",
        measure="leg_servos",
        definition="servos of a leg",
        kind="construction",
        why=f"{_COUNT_REASON} theta4 of Table I has no servo.",
        unswept=_COUNT_REASON,
    ),
    Rule(
        claim="actuator_count",
        experiment="leg_kinematics",
        measure="actuators",
        definition="actuators of the robot",
        kind="construction",
        why=f"{_COUNT_REASON} It follows the counts of III.D; those of II.B and III.A add up to 14, 18 or 23.",
        unswept=_COUNT_REASON,
    ),
)

_INVERSE = {
    "printed_inverse_holds_crawl": 1.0,
    "printed_inverse_holds_high_walk": 0.999,
    "printed_inverse_holds": 0.25,
}

EXAMPLES: Examples = {
    "leg_inverse": [
        (_INVERSE, "by construction"),
        (_INVERSE | {"printed_inverse_holds_crawl": 0.999}, "contradicted"),
        (_INVERSE | {"printed_inverse_holds": 1.0, "printed_inverse_holds_crawl": 0.98}, "contradicted"),
    ],
    "leg_servos": [
        ({"leg_servos": 3.0}, "by construction"),
        ({"leg_servos": 4.0}, "contradicted"),
    ],
    "actuator_count": [
        ({"actuators": 19.0}, "by construction"),
        ({"actuators": 18.0}, "contradicted"),
        ({"actuators": 23.0}, "contradicted"),
    ],
}
