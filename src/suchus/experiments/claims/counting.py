"""Number of verdicts that are evidence; verdicts that could not have come out otherwise are counted apart."""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal, get_args

from suchus.article.paper import CLAIMS
from suchus.article.verdict.judging import WORDS
from suchus.article.verdict.rule import Rule, listed
from suchus.experiments.claims.table import RULES

Standing = Literal["evidence", "by construction", "fitted", "animals", "said twice", "not testable"]
"""What a verdict is worth. ``evidence``: it could have come out either way. ``by construction``: an input that is read
back, an identity of formulas, or a consequence of symmetry. ``fitted``: a free number was chosen for it, whether its
result came out or not. ``animals``: said of animals, which a robot cannot contradict. ``said twice``: the same
comparisons of the same measure decided an earlier claim. ``not testable``: nothing was measured that could decide.
"""
STANDINGS: tuple[Standing, ...] = get_args(Standing)


@dataclass(frozen=True, slots=True, kw_only=True)
class EvidenceCount:
    """Number of the article's claims by standing, and their verdicts."""

    claims: int
    """Number of claims with a verdict [-]."""
    words: Mapping[str, int]
    """Of those that are evidence the number of each word that occurs, in the order of ``WORDS`` [-]."""
    fragile: int
    """Number of those of which other plausible designs say otherwise too often [-]."""
    standing: Mapping[Standing, int]
    """Number of claims of each standing [-]."""
    agree: Mapping[Standing, int]
    """Number of those in which the article's statement, and for fits its number, came out [-]."""
    elsewhere: Mapping[str, int] = field(default_factory=dict)
    """Of the claims of other publications the number of each word that occurs, in the order of ``WORDS`` [-]."""

    def __str__(self) -> str:
        """Return the count as one or two sentences, for the README and the report alike; of no claim none."""
        standing_counts, agree, evidence = self.standing, self.agree, self.standing["evidence"]
        words = f": {', '.join(f'{count} {word}' for word, count in self.words.items())}" if self.words else ""
        frail = (
            f"; {self.fragile} of these {'is' if self.fragile == 1 else 'are'} fragile, since more than one in ten "
            "plausible designs say otherwise"
        )
        number_text = f"{self.claims} claim{'s' * (self.claims != 1)}"
        text = f"Of {number_text} of the article {evidence} could come out either way{words}{frail * bool(words)}."
        text *= self.claims > 0
        wrong_count = standing_counts["by construction"] - agree["by construction"]
        labels = {
            "by construction": f"read back, or consequences of formulas or symmetry ({wrong_count} do not hold)",
            "fitted": f"fitted ({agree['fitted']} came out)",
            "animals": f"said of animals (the robot does the same in {agree['animals']})",
            "said twice": "said twice",
            "not testable": "not testable",
        }
        phrases = [f"{standing_counts[name]} {label}" for name, label in labels.items() if standing_counts[name]]  # type: ignore[index]
        text = f"{text} The others could not: {listed(phrases)}." if phrases else text
        if not self.elsewhere:
            return text
        came = ", ".join(f"{count} {word}" for word, count in self.elsewhere.items())
        number = sum(self.elsewhere.values())
        number_text = f"{number} statement{'s' * (number != 1)}"
        return f"{text} Of {number_text} of other publications on salamanders: {came}.".strip()


def count_evidence(
    verdicts: Mapping[str, str], fragile: Iterable[str] = (), rules: Mapping[str, Rule] = RULES
) -> EvidenceCount:
    """Return the number of verdicts on the article by standing and word, and those on other publications by word.

    Args:
        verdicts: the word of each claim, none of which is an experiment's own.
        fragile: claims whose word other plausible designs reverse.
        rules: rules by claim; a claim without one counts as measured.
    """
    published = {claim: word for claim, word in verdicts.items() if claim in CLAIMS and CLAIMS[claim].of}
    verdicts = {claim: word for claim, word in verdicts.items() if claim not in published}
    standing = standings(verdicts, rules)
    standing_counts, agree = (
        Counter(standing.values()),
        Counter(standing[claim] for claim, word in verdicts.items() if word in _AGREES[standing[claim]]),
    )
    return EvidenceCount(
        claims=len(verdicts),
        words=_by_word(word for claim, word in verdicts.items() if standing[claim] == "evidence"),
        fragile=sum(standing.get(claim) == "evidence" for claim in fragile),
        standing={name: standing_counts[name] for name in STANDINGS},
        agree={name: agree[name] for name in STANDINGS},
        elsewhere=_by_word(published.values()),
    )


def _by_word(words: Iterable[str]) -> dict[str, int]:
    count = Counter(words)
    return {word: count[word] for word in WORDS if count[word]}


_AGREES: Mapping[Standing, Sequence[str]] = {
    "evidence": ("reproduced", "same sense"),
    "by construction": ("by construction",),
    "fitted": ("fitted",),
    "animals": ("same sense",),
    "said twice": ("reproduced", "same sense"),
    "not testable": (),
}


def standings(verdicts: Mapping[str, str], rules: Mapping[str, Rule] = RULES) -> dict[str, Standing]:
    """Return the standing of the verdict on each claim.

    Args:
        verdicts: the word of each claim.
        rules: rules by claim; a claim without one counts as measured.
    """
    standing_of_claim: dict[str, Standing] = {}
    for claim, word in verdicts.items():
        rule = rules.get(claim)
        kind = rule.kind if rule else "measured"
        if rule and _repeats_earlier_rule(rule, rules):
            standing_of_claim[claim] = "said twice"
        elif kind == "construction":
            standing_of_claim[claim] = "by construction"
        elif kind == "measured":
            standing_of_claim[claim] = "not testable" if word == "not testable" else "evidence"
        else:
            standing_of_claim[claim] = kind
    return standing_of_claim


def _repeats_earlier_rule(rule: Rule, rules: Mapping[str, Rule]) -> bool:
    """Return whether an earlier rule makes the same comparisons of the same measure."""
    for earlier_rule in rules.values():
        if earlier_rule is rule:
            return False
        if earlier_rule.holds and _comparison_key(earlier_rule) == _comparison_key(rule):
            return True
    return False


def _comparison_key(rule: Rule) -> tuple[object, ...]:
    clauses = sorted(clause.comparison for clause in rule.holds)
    return rule.experiment, rule.measure, clauses
