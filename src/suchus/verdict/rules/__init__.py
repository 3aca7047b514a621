"""The rules, one module for each experiment; a new module is added to the tuple here."""

from suchus.verdict.rules import (
    bipedal_reach,
    crawl_stability,
    displacement,
    feedback,
    gait_diagram,
    gallop_limits,
    joint_faults,
    joint_loops,
    leg_kinematics,
    speed_range,
    spine_kinematics,
    swimming,
    tail_bending,
    terrain,
    working_space,
)

EXPERIMENTS = (
    displacement.RULES,
    crawl_stability.RULES,
    gait_diagram.RULES,
    feedback.RULES,
    terrain.RULES,
    speed_range.RULES,
    gallop_limits.RULES,
    swimming.RULES,
    joint_faults.RULES,
    leg_kinematics.RULES,
    spine_kinematics.RULES,
    tail_bending.RULES,
    bipedal_reach.RULES,
    working_space.RULES,
    joint_loops.RULES,
)
"""In the order of the page."""
