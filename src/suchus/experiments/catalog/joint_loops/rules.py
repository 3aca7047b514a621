"""When the claim on the joints' PID controllers counts as what (section III.D, Fig. 10)."""

from math import radians

from suchus.article.verdict.judging import Examples
from suchus.article.verdict.rule import Clause, Interpretation, Rule, Variation

_DEAD_BAND_REASON = "the dead band of a digital hobby servo: 3 us of 2 000 us for 270 degrees"

RULES = (
    Rule(
        claim="joint_pid",
        experiment="joint_loops",
        measure="load_error_pid",
        definition="angle by which the load of the crawl bends a joint with the greatest integral gain tried",
        unit="rad",
        holds=(
            Clause("load_error_pid", "<=", radians(0.4), f"a joint that walks bears a load; {_DEAD_BAND_REASON}"),
            Clause("step_error_pid", "<=", radians(0.4), _DEAD_BAND_REASON),
            Clause(
                "ripple_pid", "<=", radians(0.4), f"a loop that still swings by more is not stable; {_DEAD_BAND_REASON}"
            ),
            Clause("droop_taken_pid", ">=", 0.1, "an integral that takes less than a tenth of the droop away is none"),
        ),
        interpretation="integral limited as in our design",
        interpretations=(
            Interpretation(name="integral limited by the servo's torque alone", measures=("_pid", "_pid_unlimited")),
        ),
        why="With the greatest integral gain tried {load_error_pid:deg.2f} degrees remain under {load:.2f} N m, the "
        "load of the crawl: the integral takes {droop_taken_pid:.0%} of the droop away. Without load a step ends "
        "{step_error_pid:deg.2f} degrees off its target and swings by {ripple_pid:deg.2f} degrees at most in its last "
        "half second.",
    ),
)

VARIED = Variation(claims=("joint_pid",), designs=("robot",), samples=64)

_LOOP = {
    "load_error_pid": radians(0.396),
    "step_error_pid": radians(0.396),
    "ripple_pid": radians(0.396),
    "droop_taken_pid": 0.101,
}


def _loops(**unlimited: float) -> dict[str, float]:
    """Return example measures of both loops: those of the rule, and others of the one whose integral is not limited."""
    return _LOOP | {f"{name}_unlimited": unlimited.get(name, value) for name, value in _LOOP.items()} | {"load": 0.8}


def _both(**errors: float) -> dict[str, float]:
    """Return example measures with the same errors of both loops."""
    return _loops(**errors) | errors


EXAMPLES: Examples = {
    "joint_pid": [
        (_both(), "reproduced"),
        (_both(load_error_pid=radians(0.404)), "contradicted"),
        (_both(step_error_pid=radians(0.404)), "contradicted"),
        (_both(ripple_pid=radians(0.404)), "contradicted"),
        (_both(droop_taken_pid=0.099), "contradicted"),
        (_loops(load_error_pid=radians(0.404)), "depends on the reading"),
    ],
}
