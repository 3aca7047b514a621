"""When the model's walk counts as the salamander's: forces on single feet, beside those of animals."""

from suchus.article.paper.claims_animals import FORE_SPREAD, HIND_SPREAD
from suchus.article.verdict.judging import Examples
from suchus.article.verdict.rule import Clause, Rule, SmallestEffect, Variation

_FORE, _HIND = 0.457, 0.479
_TRIALS = "two standard deviations of single trials, which 19 of 20 animals' steps are within"
_LEAST_PUSH = SmallestEffect(
    size=0.01, why="a hundredth of the weight is less than a sixth of the scatter of the animals' single trials"
)
_HALF = "a quarter of stance from touch-down or from lift-off at least"

RULES = (
    Rule(
        claim="salamander_fore_force",
        experiment="salamander",
        measure="foot_force_net_fore",
        definition="greatest net force on a fore foot in the mean cycle",
        unit="body weight",
        holds=(
            Clause("foot_force_net_fore", ">=", round(_FORE - 2 * FORE_SPREAD, 3), _TRIALS),
            Clause("foot_force_net_fore", "<=", round(_FORE + 2 * FORE_SPREAD, 3), _TRIALS),
        ),
        why="The greatest net force on a fore foot of the mean cycle is {foot_force_net_fore:.3f} body weights.",
    ),
    Rule(
        claim="salamander_hind_force",
        experiment="salamander",
        measure="foot_force_net_hind",
        definition="greatest net force on a hind foot in the mean cycle",
        unit="body weight",
        holds=(
            Clause("foot_force_net_hind", ">=", round(_HIND - 2 * HIND_SPREAD, 3), _TRIALS),
            Clause("foot_force_net_hind", "<=", round(_HIND + 2 * HIND_SPREAD, 3), _TRIALS),
        ),
        why="The greatest net force on a hind foot of the mean cycle is {foot_force_net_hind:.3f} body weights.",
    ),
    Rule(
        claim="salamander_force_times",
        experiment="salamander",
        measure="foot_force_time_fore",
        definition="time in the stance when the force on a fore foot is greatest",
        unit="stance",
        holds=(
            Clause("foot_force_time_fore", "<=", 0.75, _HALF),
            Clause("foot_force_time_hind", ">=", 0.25, _HALF),
            Clause("foot_force_time_hind", "<", "foot_force_time_fore", "earlier on a hind foot"),
        ),
        why="The force is greatest at {foot_force_time_fore:.0%} of stance on fore feet and at "
        "{foot_force_time_hind:.0%} on hind feet.",
    ),
    Rule(
        claim="salamander_hind_push",
        experiment="salamander",
        measure="foot_force_foreaft_hind",
        definition="force along the course on a hind foot when its force is greatest",
        unit="body weight",
        holds=(
            Clause("foot_force_foreaft_hind", ">", 0.0, "forward along the course", _LEAST_PUSH),
            Clause("foot_force_foreaft_fore", "<", 0.0, "backward along the course", _LEAST_PUSH),
        ),
        why="At that instant the ground pushes a hind foot by {foot_force_foreaft_hind:+.3f} body weights along the "
        "course and a fore foot by {foot_force_foreaft_fore:+.3f}.",
    ),
)

VARIED = Variation(claims=tuple(rule.claim for rule in RULES), settings={"friction_scales": (0.7,), "cycles": 6})

_TIMES = {"foot_force_time_fore": 0.6, "foot_force_time_hind": 0.4}
_PUSHES = {"foot_force_foreaft_hind": 0.0101, "foot_force_foreaft_fore": -0.0101}

EXAMPLES: Examples = {
    "salamander_fore_force": [
        ({"foot_force_net_fore": 0.4574}, "reproduced"),
        ({"foot_force_net_fore": 0.4578}, "same sense"),
        ({"foot_force_net_fore": 0.457}, "reproduced"),
        ({"foot_force_net_fore": 0.582}, "same sense"),
        ({"foot_force_net_fore": 0.584}, "contradicted"),
        ({"foot_force_net_fore": 0.332}, "same sense"),
        ({"foot_force_net_fore": 0.33}, "contradicted"),
    ],
    "salamander_hind_force": [
        ({"foot_force_net_hind": 0.4794}, "reproduced"),
        ({"foot_force_net_hind": 0.4798}, "same sense"),
        ({"foot_force_net_hind": 0.479}, "reproduced"),
        ({"foot_force_net_hind": 0.618}, "same sense"),
        ({"foot_force_net_hind": 0.62}, "contradicted"),
        ({"foot_force_net_hind": 0.34}, "same sense"),
        ({"foot_force_net_hind": 0.338}, "contradicted"),
    ],
    "salamander_force_times": [
        (_TIMES, "reproduced"),
        (_TIMES | {"foot_force_time_fore": 0.749}, "reproduced"),
        (_TIMES | {"foot_force_time_fore": 0.751}, "contradicted"),
        (_TIMES | {"foot_force_time_hind": 0.251}, "reproduced"),
        (_TIMES | {"foot_force_time_hind": 0.249}, "contradicted"),
        ({"foot_force_time_fore": 0.401, "foot_force_time_hind": 0.4}, "reproduced"),
        ({"foot_force_time_fore": 0.399, "foot_force_time_hind": 0.4}, "contradicted"),
    ],
    "salamander_hind_push": [
        (_PUSHES, "reproduced"),
        (_PUSHES | {"foot_force_foreaft_hind": 0.0099}, "contradicted"),
        (_PUSHES | {"foot_force_foreaft_fore": -0.0099}, "contradicted"),
        ({"foot_force_foreaft_hind": 0.06, "foot_force_foreaft_fore": -0.06}, "reproduced"),
    ],
}
