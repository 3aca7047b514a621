"""How many of the verdicts are evidence: what could not have come out otherwise is counted as what it is."""

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
back, or an identity of formulas. ``fitted``: a free number was chosen for it, whether its result came out or not.
``animals``: said of animals, which a robot cannot contradict. ``said twice``: the same comparisons of the same measure
decided an earlier claim. ``not testable``: nothing was measured that could decide.
"""
STANDINGS: tuple[Standing, ...] = get_args(Standing)


@dataclass(frozen=True, slots=True, kw_only=True)
class EvidenceCount:
    """How many claims of the article there are of each standing, and what became of them."""

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
        of, agree, evidence = self.standing, self.agree, self.standing["evidence"]
        words = f": {', '.join(f'{count} {word}' for word, count in self.words.items())}" if self.words else ""
        frail = (
            f"; {self.fragile} of these {'is' if self.fragile == 1 else 'are'} fragile, since more than one in ten "
            "plausible designs say otherwise"
        )
        many = f"{self.claims} claim{'s' * (self.claims != 1)}"
        text = f"Of {many} of the article {evidence} could come out either way{words}{frail * bool(words)}."
        text *= self.claims > 0
        wrong = of["by construction"] - agree["by construction"]
        others = {
            "by construction": f"read back or identities of formulas ({wrong} not so as printed)",
            "fitted": f"fitted ({agree['fitted']} came out)",
            "animals": f"said of animals (the robot does the same in {agree['animals']})",
            "said twice": "said twice",
            "not testable": "not testable",
        }
        told = [f"{of[name]} {what}" for name, what in others.items() if of[name]]  # type: ignore[index]
        text = f"{text} The others could not: {listed(told)}." if told else text
        if not self.elsewhere:
            return text
        came = ", ".join(f"{count} {word}" for word, count in self.elsewhere.items())
        number = sum(self.elsewhere.values())
        many = f"{number} statement{'s' * (number != 1)}"
        return f"{text} Of {many} of other publications on salamanders: {came}.".strip()


def counted(
    verdicts: Mapping[str, str], fragile: Iterable[str] = (), rules: Mapping[str, Rule] = RULES
) -> EvidenceCount:
    """Return how many verdicts on the article are evidence, what became of them and of the others, and elsewhere.

    Args:
        verdicts: the word of each claim.
        fragile: claims whose word other plausible designs reverse.
        rules: by claim; a claim without one counts as measured.
    """
    published = {claim: word for claim, word in verdicts.items() if claim in CLAIMS and CLAIMS[claim].of}
    verdicts = {claim: word for claim, word in verdicts.items() if claim not in published}
    standing = standings(verdicts, rules)
    of, agree = (
        Counter(standing.values()),
        Counter(standing[claim] for claim, word in verdicts.items() if word in _AGREES[standing[claim]]),
    )
    return EvidenceCount(
        claims=len(verdicts),
        words=_by_word(word for claim, word in verdicts.items() if standing[claim] == "evidence"),
        fragile=sum(standing.get(claim) == "evidence" for claim in fragile),
        standing={name: of[name] for name in STANDINGS},
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
    """Return what the verdict on each claim is worth.

    Args:
        verdicts: the word of each claim.
        rules: by claim; a claim without one counts as measured.
    """
    found: dict[str, Standing] = {}
    for claim, word in verdicts.items():
        rule = rules.get(claim)
        kind = rule.kind if rule else "measured"
        if rule and _said_before(rule, rules):
            found[claim] = "said twice"
        elif kind == "construction":
            found[claim] = "by construction"
        elif kind == "measured":
            found[claim] = "not testable" if word == "not testable" else "evidence"
        else:
            found[claim] = kind
    return found


def _said_before(rule: Rule, rules: Mapping[str, Rule]) -> bool:
    """Return whether the same comparisons of the same measure decide a claim whose rule stands before."""
    for other in rules.values():
        if other is rule:
            return False
        if other.holds and _compared(other) == _compared(rule):
            return True
    return False


def _compared(rule: Rule) -> tuple[object, ...]:
    clauses = sorted((clause.measure, clause.relation, str(clause.bound)) for clause in rule.holds)
    return rule.experiment, rule.measure, clauses
