"""Rules and claims by experiment, also of the user's, and our rules by claim; they are read on first use."""

import re
from collections.abc import Iterable, Iterator, Mapping
from difflib import get_close_matches
from functools import cached_property
from math import inf
from types import MappingProxyType

from suchus.article.paper import CLAIMS, Claim
from suchus.article.verdict.rule import Rule, Variation
from suchus.core.checks import Checks
from suchus.core.errors import InvalidDesign
from suchus.core.kinds import show
from suchus.experiments.catalog import EXPERIMENTS

_KEY = re.compile(r"[a-z][a-z0-9_]*")
"""Form of a claim's key."""


def claims_of(experiment: str) -> Mapping[str, Claim]:
    """Return the claims that an experiment itself states, by key; none if it is not in the catalog.

    They are the ``CLAIMS`` beside its ``RULES``, see ``rules_of``. An experiment that only imports the article's
    ``CLAIMS`` states none of its own.

    Raises:
        InvalidDesign: ``CLAIMS`` holds something other than claims, or a claim that cannot be judged.
    """
    declared = EXPERIMENTS.beside(experiment, "CLAIMS", (), module="rules") if experiment in EXPERIMENTS else ()
    if declared is CLAIMS:
        return {}
    if not isinstance(declared, (tuple, list)):
        raise InvalidDesign(f"CLAIMS of {experiment} is {show(declared)}; a tuple of Claim is needed.")
    claims: dict[str, Claim] = {}
    for claim in declared:
        _check_claim(claim, experiment)
        if claim.key in claims:
            raise InvalidDesign(f"CLAIMS of {experiment} has two claims {claim.key!r}; give one of them another key.")
        claims[claim.key] = claim
    return claims


def known_claims(experiment: str) -> Mapping[str, Claim]:
    """Return the claims that rules of an experiment may judge, by key: the article's, then its own.

    Raises:
        InvalidDesign: ``CLAIMS`` of the experiment cannot be used, see ``claims_of``.
    """
    return {**CLAIMS, **claims_of(experiment)}


def check_claims(experiment: str, rules: Iterable[Rule]) -> None:
    """Refuse rules of an experiment whose claim nobody states.

    Raises:
        InvalidDesign: a rule judges a claim that is neither the article's nor the experiment's own.
    """
    claims = known_claims(experiment)
    for rule in rules:
        if rule.claim not in claims:
            matches = get_close_matches(str(rule.claim), claims, n=1)
            hint = f" Did you mean {matches[0]!r}?" if matches else ""
            raise InvalidDesign(
                f"a rule of {experiment}, on the measure {show(rule.measure)}, judges the claim {show(rule.claim)}, "
                f"which neither the article nor CLAIMS of {experiment} states. Add a Claim with this key to CLAIMS "
                f"beside RULES, or correct the rule.{hint}"
            )


def _check_claim(claim: object, experiment: str) -> None:
    """Refuse what is no claim, and a claim that cannot be told from the article's.

    Raises:
        InvalidDesign: it is no ``Claim``, or a field of it is of no use.
    """
    if not isinstance(claim, Claim):
        raise InvalidDesign(f"CLAIMS of {experiment} has {show(claim)}, which is no Claim of suchus.article.paper.")
    owner = f"the claim {show(claim.key)} of {experiment}"
    with Checks(owner, claim) as check:
        check.number("rounding", 0.0, inf, claim.unit)
        check.that(
            _KEY.fullmatch(claim.key) is not None,
            f"{owner} needs another key: small letters, digits and underscores are allowed",
        )
        check.that(claim.key not in CLAIMS, f"{owner} has the key of a claim of the article; give it another key")
        for field, meaning in (("of", "who states it"), ("quantity", "what it is about"), ("sense", "the statement")):
            check.that(bool(getattr(claim, field)), f"{owner} lacks `{field}`, {meaning}; an empty text is not allowed")


def rules_of(experiment: str) -> tuple[Rule, ...]:
    """Return the rules that read the measures of an experiment, in their order; none if it is not in the catalog.

    They are the ``RULES`` of the module ``rules`` in the experiment's folder, which is read without the experiment, or
    of its one file.

    Raises:
        InvalidDesign: ``RULES`` holds something other than rules of this experiment, or a rule judges a claim that
            nobody states.
    """
    rules = EXPERIMENTS.beside(experiment, "RULES", (), module="rules") if experiment in EXPERIMENTS else ()
    for rule in rules:
        if not isinstance(rule, Rule) or rule.experiment != experiment:
            raise InvalidDesign(f"RULES of {experiment} hold {rule!r}, which is no Rule of this experiment.")
    check_claims(experiment, rules)
    return tuple(rules)


def design_sweep_of(experiment: str) -> Variation | None:
    """Return the designs and settings over which an experiment is repeated, from the ``VARIED`` beside its rules."""
    sweep: Variation | None = EXPERIMENTS.beside(experiment, "VARIED", None, module="rules")
    return sweep


class ClaimRules(Mapping[str, Rule]):
    """The rules of all experiments of suchus that judge the article, by claim; they are read on first use.

    Claims of other publications on animals, which ``suchus.article.paper`` holds, count among them. Claims that an
    experiment states itself do not.
    """

    @cached_property
    def _by_claim(self) -> dict[str, Rule]:
        shipped_names = [name for name, source in EXPERIMENTS.sources().items() if source.shipped]
        return {rule.claim: rule for name in shipped_names for rule in rules_of(name) if rule.claim in CLAIMS}

    def __getitem__(self, claim: str) -> Rule:
        return self._by_claim[claim]

    def __iter__(self) -> Iterator[str]:
        return iter(self._by_claim)

    def __len__(self) -> int:
        return len(self._by_claim)


RULES = ClaimRules()
"""Rules of all experiments of suchus that judge the article, by claim."""
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
