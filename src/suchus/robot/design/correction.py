"""Factors on added mass and drag of the section model, fitted to a flow simulation at one Reynolds number."""

from collections.abc import Mapping
from dataclasses import dataclass

from suchus.core.checks import Checks
from suchus.core.errors import InvalidDesign

MAX_FACTOR = 100.0
"""Greatest factor [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LinkFactors:
    """Factors on the sections of one link between two lateral joints."""

    bodies: tuple[str, ...]
    """Names of the robot's bodies that the link is made of."""
    added: float
    """Factor on their added mass and on the momentum that is shed with it [-]."""
    drag: float
    """Factor on their drag, across and along [-]."""
    added_interval: tuple[float, float] = (0.0, MAX_FACTOR)
    """Interval of the first that the fit gave, for the reader [-]."""
    drag_interval: tuple[float, float] = (0.0, MAX_FACTOR)
    """Interval of the second [-]."""

    def __post_init__(self) -> None:
        with Checks("link", self) as check:
            check.that(bool(self.bodies), "a link of a correction has no bodies; name those that it is made of")
            for name in ("added", "drag"):
                check.number(name, 0.0, MAX_FACTOR, "")
                lower_bound, upper_bound = getattr(self, f"{name}_interval")
                check.that(
                    lower_bound <= upper_bound,
                    f"{name}_interval goes from {lower_bound:g} to {upper_bound:g}; give the lower end first",
                )


@dataclass(frozen=True, slots=True, kw_only=True)
class SectionCorrection:
    """A correction of the section model for one body, for the Reynolds numbers at which it was found."""

    name: str
    """What it is called in messages."""
    reynolds: tuple[float, float]
    """Least and greatest frequency times length squared over viscosity of the flows that it was found in [-]."""
    links: tuple[LinkFactors, ...]
    """Links with factors; those that have none stay as they are."""

    def __post_init__(self) -> None:
        with Checks("correction", self) as check:
            lower_bound, upper_bound = self.reynolds
            check.that(
                1e-3 <= lower_bound <= upper_bound <= 1e12,
                f"correction.reynolds is {self.reynolds}; two numbers from 0.001 to 1e12 that do not fall are allowed",
            )
            bodies = [body for link in self.links for body in link.bodies]
            duplicates = sorted({body for body in bodies if bodies.count(body) > 1})
            check.that(
                not duplicates, f"a correction has factors twice for {', '.join(duplicates)}; give each body one link"
            )
            check.that(bool(self.links), "a correction has no link with factors; leave it out")

    @property
    def factors(self) -> Mapping[str, LinkFactors]:
        """Factors by the names of bodies."""
        return {body: link for link in self.links for body in link.bodies}

    def validity_warning(self, reynolds: float) -> str:
        """Return a warning for a Reynolds number outside the range of the correction; an empty text inside it.

        Args:
            reynolds: frequency times length squared over viscosity [-].
        """
        lower_bound, upper_bound = self.reynolds
        if lower_bound * (1 - 1e-6) <= reynolds <= upper_bound * (1 + 1e-6):
            return ""
        valid_range = f"{lower_bound:.3g}" if lower_bound == upper_bound else f"{lower_bound:.3g} to {upper_bound:.3g}"
        return (
            f"the correction {self.name!r} of the section model was found at f L2 / nu = {valid_range}, and this swim "
            f"is at {reynolds:.3g}: layers and wakes differ there, so that its factors may mislead; leave it out, or "
            "take water of the viscosity that it was found in."
        )

    def check(self, bodies: tuple[str, ...], robot: str) -> None:
        """Refuse a robot that lacks a body which the correction names.

        Raises:
            InvalidDesign: naming them.
        """
        unknown = [body for body in self.factors if body not in bodies]
        if unknown:
            raise InvalidDesign(
                f"the correction {self.name!r} of the section model has factors for {', '.join(unknown)}, and robot "
                f"{robot!r} has the bodies {', '.join(bodies)}; take a correction that was found for this robot."
            )
