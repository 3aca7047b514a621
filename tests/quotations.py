"""Whether words stand in the article: its word sequences are kept as hashes, since its text is not ours to copy.

``python tests/quotations.py ARTICLE.txt`` writes the hashes anew from the article's text.
"""

import re
import sys
from hashlib import sha256
from pathlib import Path

HASHES = Path(__file__).parent / "data" / "article_word_sequences.txt"
LENGTH = 4
"""Number of words in a sequence [-]; of a shorter quotation all words are one sequence."""
_OURS = re.compile(r"\[[^\]]*\]|\.\.\.")
"""What is not the article's in a quotation: words in brackets, and dots for words that are left out."""


def words_of(text: str) -> list[str]:
    """Return the words of a text in small letters, without marks of punctuation, of emphasis and of formulas."""
    plain = re.sub(r"[*_$\\{}]", "", text.lower())
    return [word.strip(".") for word in re.findall(r"[a-z0-9.%]+", plain) if word.strip(".")]


def sequences(words: list[str], length: int = LENGTH) -> list[str]:
    """Return the hash of each sequence of consecutive words."""
    rows = [" ".join(words[i : i + length]) for i in range(len(words) - length + 1)]
    return [sha256(row.encode()).hexdigest()[:8] for row in rows]


def foreign_words(quotation: str, article: frozenset[str]) -> list[str]:
    """Return the parts of a quotation with a sequence of words that is not in the article.

    Args:
        quotation: words, with ours in brackets and dots for what is left out.
        article: hashes of the article's sequences.
    """
    parts = [words_of(part) for part in _OURS.split(quotation)]
    return [
        " ".join(words) for words in parts if words and not set(sequences(words, min(LENGTH, len(words)))) <= article
    ]


def kept_article() -> frozenset[str]:
    """Return the hashes of the article's sequences."""
    return frozenset(HASHES.read_text(encoding="utf-8").split())


def write_hashes(article: Path) -> None:
    """Write the hashes of all sequences of up to ``LENGTH`` words of the article."""
    words = words_of(article.read_text(encoding="utf-8"))
    hashes = {row for length in range(1, LENGTH + 1) for row in sequences(words, length)}
    HASHES.write_text("\n".join(sorted(hashes)) + "\n", encoding="utf-8")


if __name__ == "__main__":
    write_hashes(Path(sys.argv[1]))
