"""Rules by experiment, also of the user's experiments, and our rules by claim; they are read on first use."""

from collections.abc import Iterator, Mapping
from functools import cached_property
from types import MappingProxyType

from suchus.article.verdict.rule import Rule, Variation
from suchus.core.errors import InvalidDesign
from suchus.experiments.catalog import EXPERIMENTS


def rules_of(experiment: str) -> tuple[Rule, ...]:
    """Return the rules that read the measures of an experiment, in their order; none if it is not in the catalog.

    They are the ``RULES`` of the module ``rules`` in the experiment's folder, which is read without the experiment, or
    of its one file.

    Raises:
        InvalidDesign: ``RULES`` holds something other than rules of this experiment.
    """
    rules = EXPERIMENTS.beside(experiment, "RULES", (), module="rules") if experiment in EXPERIMENTS else ()
    for rule in rules:
        if not isinstance(rule, Rule) or rule.experiment != experiment:
            raise InvalidDesign(f"RULES of {experiment} hold {rule!r}, which is no Rule of this experiment.")
    return tuple(rules)


def design_sweep_of(experiment: str) -> Variation | None:
    """Return the designs and settings over which an experiment is repeated, from the ``VARIED`` beside its rules."""
    sweep: Variation | None = EXPERIMENTS.beside(experiment, "VARIED", None, module="rules")
    return sweep


class ClaimRules(Mapping[str, Rule]):
    """The rules of all experiments of suchus, by claim; they are read on first use."""

    @cached_property
    def _by_claim(self) -> dict[str, Rule]:
        shipped_names = [name for name, source in EXPERIMENTS.sources().items() if source.shipped]
        return {rule.claim: rule for name in shipped_names for rule in rules_of(name)}

    def __getitem__(self, claim: str) -> Rule:
        return self._by_claim[claim]

    def __iter__(self) -> Iterator[str]:
        return iter(self._by_claim)

    def __len__(self) -> int:
        return len(self._by_claim)


RULES = ClaimRules()
"""Rules of all experiments of suchus, by claim."""
_ANIMAL_REASON = "A number of the animals' own body: no robot, of whatever size and toes, confirms or contradicts it."
_SNAPSHOT_REASON = (
    "When a picture was taken, which says nothing of what it shows: crawl_stability looks at its runs at this time."
)
_INPUT_REASON = (
    "It is put in, not found: swimming commands the wave (20) with this number, in the one reading of its units that "
    "makes a swim, and whether the body follows that wave is the claim swim_body_wave."
)
UNRULED: Mapping[str, str] = MappingProxyType(
    {
        **dict.fromkeys(
            ("species_count", "largest_length", "smallest_length", "front_toes", "hind_toes"), _ANIMAL_REASON
        ),
        **dict.fromkeys(("snapshot_time_1", "snapshot_time_2", "snapshot_time_3"), _SNAPSHOT_REASON),
        **dict.fromkeys(("wave_c1", "wave_c2", "wave_k"), _INPUT_REASON),
    }
)
"""Statements of the article that no rule judges, and why not, by key."""
