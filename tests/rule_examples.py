"""Measures by which the rules of an experiment are tested."""

from suchus.article.verdict.judging import Examples
from suchus.experiments.catalog import EXPERIMENTS


def examples_of(experiment: str) -> Examples:
    """Return the ``EXAMPLES`` beside the rules of an experiment, by claim; none if there are none."""
    examples: Examples = EXPERIMENTS.beside(experiment, "EXAMPLES", {}, module="rules")
    return examples
