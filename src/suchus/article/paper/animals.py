"""Published numbers of animals, with which those of the robot can be compared.

All numbers were read in the text or the abstract of a paper. Numbers that were not found in readable form are left out
(Reilly and Elias 1998 on the high walk, Fish 1984 on swimming).
"""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType


@dataclass(frozen=True, slots=True, kw_only=True)
class Animal:
    """One number of an animal."""

    key: str
    """Its name here."""
    quantity: str
    """Name of the quantity that was measured."""
    who: str
    """Species, number and size of the animals."""
    low: float
    """The number, or the least of a range."""
    high: float
    """The greatest of a range; equal to ``low`` for a single number."""
    unit: str
    """SI unit, ``-`` for none."""
    source: str
    """Publication: authors, year, journal."""
    note: str = ""
    """Caveat for the comparison."""


ANIMALS = (
    Animal(
        key="tail_length",
        quantity="tail over total length",
        who="dwarf caimans of 1.9 to 2.1 m",
        low=0.465,
        high=0.465,
        unit="-",
        source="Amphibia-Reptilia 31:439; from its regression of total length on snout-vent length",
    ),
    Animal(
        key="tail_mass",
        quantity="tail over body mass",
        who="alligators",
        low=0.28,
        high=0.28,
        unit="-",
        source="Willey et al. 2004, J. Exp. Biol. 207:553",
    ),
    Animal(
        key="mass",
        quantity="mass at 0.46 to 1.27 m length",
        who="growing alligators",
        low=0.3,
        high=5.6,
        unit="kg",
        source="J. Exp. Biol. 224:jeb242990",
    ),
    Animal(
        key="speed",
        quantity="speed on land",
        who="42 animals of 15 species of crocodiles, all gaits",
        low=0.15,
        high=4.35,
        unit="m/s",
        source="Hutchinson et al. 2019, Sci. Rep. 9:19302",
        note="the crawl; the article's from its displacement over two cycles of 4 s",
    ),
    Animal(
        key="high_walk_speed",
        quantity="speed of the high walk",
        who="Nile crocodiles of 1.5 to 7 kg",
        low=0.1,
        high=0.7,
        unit="m/s",
        source="Michel, abstract 76-8 of the Society for Integrative and Comparative Biology",
        note="ours at the gait's own cycle time; the article's is the slow end of its range, for any size",
    ),
    Animal(
        key="stride_share",
        quantity="share of the stride that the trunk makes",
        who="alligators, fore stride, rotation of the thorax",
        low=0.025,
        high=0.099,
        unit="-",
        source="J. Exp. Biol. 221:jeb186791 (6.2 ± 3.7 %)",
        note="ours and the article's: the part of the displacement that is missing with limbs only",
    ),
    Animal(
        key="duty_factor",
        quantity="duty factor of a foot",
        who="salamanders, walking (what Pleurobot was made from)",
        low=0.729,
        high=0.790,
        unit="-",
        source="configuration files of Pleurobot, KM-RoBoTa 2016",
        note="ours from foot pressure, mean of the four feet",
    ),
    Animal(
        key="death_roll",
        quantity="turns of the death roll",
        who="alligators of 0.29 m",
        low=1.6,
        high=1.6,
        unit="Hz",
        source="Fish et al. 2007, J. Exp. Biol. 210:2811",
        note="ours in water, trunk and tail to the same side; a longer body turns more slowly",
    ),
)
"""All of them, from the body to its movements."""
ANIMAL: Mapping[str, Animal] = MappingProxyType({animal.key: animal for animal in ANIMALS})
"""The same by key."""
