"""Measures for which each rule of ``joint_loops`` says each of its words, close to both sides of every bound."""

from math import radians

from suchus.verdict.judging import Examples

_PID = {"step_error_pid": radians(0.396), "ripple_pid": radians(0.396), "droop_taken": 0.101, "load": 0.8}

EXAMPLES: Examples = {
    "joint_pid": [
        (_PID, "reproduced"),
        (_PID | {"step_error_pid": radians(0.404)}, "contradicted"),
        (_PID | {"ripple_pid": radians(0.404)}, "contradicted"),
        (_PID | {"droop_taken": 0.099}, "contradicted"),
    ],
}
