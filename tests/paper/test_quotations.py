"""The article's words in claims are the article's."""

import pytest
from tests.quotations import foreign_words, kept_article

from suchus.article.paper import CLAIMS

ARTICLE = kept_article()
QUOTED = [key for key, claim in CLAIMS.items() if not claim.of]


@pytest.mark.parametrize("key", QUOTED)
def test_a_quotation_is_in_the_article(key):
    assert foreign_words(CLAIMS[key].quote, ARTICLE) == []


@pytest.mark.parametrize("key", QUOTED)
def test_a_quotation_with_another_word_is_noticed(key):
    """Each word in turn is another; brackets are ours, and are left alone."""
    words = CLAIMS[key].quote.split()
    outside = [
        i
        for i, word in enumerate(words)
        if " ".join(words[: i + 1]).count("[") == " ".join(words[:i]).count("]") and any(map(str.isalpha, word))
    ]
    for i in outside:
        falsified = " ".join([*words[:i], "robotically", *words[i + 1 :]])
        assert foreign_words(falsified, ARTICLE), falsified


def test_words_in_another_order_and_a_number_that_was_changed_are_noticed():
    quote = CLAIMS["smallest_length"].quote
    assert foreign_words(quote, ARTICLE) == []
    assert foreign_words(quote.replace("1.25", "1.52"), ARTICLE)
    assert foreign_words("species crocodile smallest the", ARTICLE)
    assert foreign_words("the African Nile Robot, the largest among them", ARTICLE)
    assert foreign_words("[ours] the smallest crocodile species ... [ours too]", ARTICLE) == []
