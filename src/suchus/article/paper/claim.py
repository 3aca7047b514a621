"""One statement of the article, of another publication, or of a user's own."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Claim:
    """A number that a publication or a hypothesis states, or a statement that can be tested."""

    key: str
    """Its name here."""
    of: str = ""
    """Source: the publication or the hypothesis that states it; empty for the article alone."""
    where: str
    """Section and figure or equation; of other publications what was read of them."""
    quantity: str
    """Name of the claimed quantity."""
    value: float | None = None
    """The number in SI units; None where no number is stated."""
    unit: str = "-"
    """SI unit, ``-`` for none."""
    rounding: float = 0.0
    """Half of the last printed digit, in ``unit``; zero for whole numbers and for statements."""
    sense: str
    """The statement in one plain sentence; it can hold where the number does not."""
    quote: str = ""
    """The source's own words, shortened with dots; in brackets ours, where it states a thing without words. Empty
    where the statement itself is the source, as in a hypothesis of one's own."""

    def __str__(self) -> str:
        if self.value is None:
            return f"{self.quantity} ({self.place})"
        unit = "" if self.unit == "-" else f" {self.unit}"
        return f"{self.quantity}: {self.value:g}{unit} ({self.place})"

    @property
    def place(self) -> str:
        """Return where it is stated, with the publication unless that is the article."""
        return f"{self.of}, {self.where}" if self.of else self.where


def statement(key: str, location: str, quantity: str, sense: str, quote: str) -> Claim:
    """Return a claim without a number: a statement that holds or does not."""
    return Claim(
        key=key, where=location, quantity=quantity, value=None, unit="-", rounding=0.0, sense=sense, quote=quote
    )
