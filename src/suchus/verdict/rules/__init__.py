"""The rules, one module for each experiment; a new module is added to the tuple here."""

from suchus.verdict.rules import crawl_stability, displacement, gait_diagram, joint_loops, working_space

EXPERIMENTS = (displacement.RULES, crawl_stability.RULES, gait_diagram.RULES, joint_loops.RULES, working_space.RULES)
"""In the order of the page."""
