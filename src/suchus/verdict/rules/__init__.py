"""The rules, one module for each experiment; a new module is added to the tuple here."""

from suchus.verdict.rules import crawl_stability, displacement, feedback, gait_diagram, speed_range, swimming, terrain

EXPERIMENTS = (
    displacement.RULES,
    crawl_stability.RULES,
    gait_diagram.RULES,
    feedback.RULES,
    terrain.RULES,
    speed_range.RULES,
    swimming.RULES,
)
"""In the order of the page."""
