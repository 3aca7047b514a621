"""When the claim on the joints' PID controllers counts as what (section III.D, Fig. 10)."""

from math import radians

from suchus.article.verdict.judging import Examples
from suchus.article.verdict.rule import Clause, Rule, Variation

_DEAD_BAND_REASON = "the dead band of a digital hobby servo: 3 us of 2 000 us for 270 degrees"

RULES = (
    Rule(
        claim="joint_pid",
        experiment="joint_loops",
        measure="load_error_pid",
        holds=(
            Clause("load_error_pid", "<=", radians(0.4), f"a joint that walks bears a load; {_DEAD_BAND_REASON}"),
            Clause("step_error_pid", "<=", radians(0.4), _DEAD_BAND_REASON),
            Clause(
                "ripple_pid", "<=", radians(0.4), f"a loop that still swings by more is not stable; {_DEAD_BAND_REASON}"
            ),
            Clause("droop_taken", ">=", 0.1, "an integral that takes less than a tenth of the droop away is none"),
        ),
        why="With the greatest integral gain tried {load_error_pid:deg.2f} degrees remain under {load:.2f} N m, the "
        "load of the crawl: the integral takes {droop_taken:.0%} of the droop away. Without load a step ends "
        "{step_error_pid:deg.2f} degrees off its target and swings by {ripple_pid:deg.2f} degrees at most in its last "
        "half second.",
    ),
)

VARIED = Variation(claims=("joint_pid",), designs=("robot",), samples=64)

_PID = {
    "load_error_pid": radians(0.396),
    "step_error_pid": radians(0.396),
    "ripple_pid": radians(0.396),
    "droop_taken": 0.101,
    "load": 0.8,
}

EXAMPLES: Examples = {
    "joint_pid": [
        (_PID, "reproduced"),
        (_PID | {"load_error_pid": radians(0.404)}, "contradicted"),
        (_PID | {"step_error_pid": radians(0.404)}, "contradicted"),
        (_PID | {"ripple_pid": radians(0.404)}, "contradicted"),
        (_PID | {"droop_taken": 0.099}, "contradicted"),
    ],
}
