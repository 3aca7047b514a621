"""Every number and every testable statement of the article, and some of other publications, by key."""

from collections.abc import Mapping
from types import MappingProxyType

from suchus.article.paper.claim import Claim, statement
from suchus.article.paper.claims_animals import OSCILLATORS, SALAMANDERS
from suchus.article.paper.claims_body import BODY
from suchus.article.paper.claims_land import LAND
from suchus.article.paper.tables import C1, C2, K


def _wave_constant(key: str, name: str, value: float, last_digit: float) -> Claim:
    """Return the claim about a constant of the body wave (20).

    Args:
        key: key of the claim.
        name: name of the constant.
        value: value as printed.
        last_digit: unit of the last printed digit.
    """
    return Claim(
        key=key,
        where="IV.B, eq. (20)",
        quantity=f"{name} of the body wave",
        value=value,
        unit="-",  # none is printed
        rounding=last_digit / 2,  # half of the last printed digit
        sense="The midline of the swimming robot is fitted by (20) with c1 = 0.027, c2 = 0.30, k = 0.023.",
        quote="c1 = 0.027, c2 = 0.30 and k = 0.023",
    )


WATER = (
    statement(
        "swim_tail_sine",
        "II.A",
        "swing of the tail in water",
        "A crocodile's swimming tail swings like a sine wave.",
        "The tail's swinging motion resembles a sine wave",
    ),
    statement(
        "swim_limbs_pressed",
        "II.A",
        "gain of speed with limbs along the body",
        "A swimming crocodile presses its limbs to its sides: with limbs spread it is slower.",
        "crocodiles tightly press their limbs against their body's sides",
    ),
    statement(
        "swim_rapid_swings",
        "II.A",
        "gain of speed by faster swings",
        "Faster swings of the tail make a crocodile faster.",
        "crocodiles use rapid tail swings to accelerate",
    ),
    statement(
        "swim_body_wave",
        "IV.B, eq. (20)",
        "wave of the robot's midline in water",
        "The midline of the swimming robot has the form (20): a sine under an envelope that grows to the tail.",
        "the center line trajectory is drawn and modeled into the form of fish body wave function",
    ),
    _wave_constant("wave_c1", "linear envelope coefficient c1", C1, 0.001),
    _wave_constant("wave_c2", "quadratic envelope coefficient c2", C2, 0.01),
    _wave_constant("wave_k", "wave number k", K, 0.001),
    statement(
        "swim_pressure_convex",
        "IV.B, Fig. 17a",
        "pressure on both sides of the tail at T/4",
        "At a quarter of the cycle the pressure on the convex side of the tail is above that on the concave side.",
        "the pressure on the bending and convex side of the flexible tail is greater than that on the concave side",
    ),
    statement(
        "swim_diagonal_force",
        "IV.B, Fig. 17a",
        "force at T/4",
        "The pressure difference at a quarter of the cycle pushes the robot diagonally forward.",
        "results in a diagonal forward force, propelling the robot in a diagonal direction",
    ),
    statement(
        "swim_pressure_falls",
        "IV.B, Fig. 17a, c",
        "pressure difference at T/4 less that at 3T/4",
        "While body and tail move on towards the axis, from T/4 to 3T/4, the pressure difference falls.",
        "towards the head-to-tail axis, the pressure difference gradually decreases, as demonstrated in Figure 17(c)",
    ),
    statement(
        "swim_thrust_symmetric",
        "IV.B, Fig. 17c",
        "forces at T/4 and 3T/4, mirrored",
        "At three quarters of the cycle the thrust is forward again and mirrors that at one quarter.",
        "the pressure difference ... generates a symmetrical diagonal forward thrust",
    ),
    statement(
        "swim_s_shape",
        "IV.B, Fig. 17",
        "track of the swimming robot",
        "The robot swims along an S-shaped track.",
        'producing an "S"-shaped swimming trajectory',
    ),
    statement(
        "swim_tail_thrust",
        "IV.B",
        "speed that the swing of the tail adds in water",
        "The swing of the tail gives the main thrust in water.",
        "When moving through the water, the swing of the tail and spine provides the main thrust.",
    ),
    statement(
        "swim_spine_thrust",
        "IV.B",
        "speed that the swing of the spine adds in water",
        "The swing of the spine gives thrust in water too.",
        "When moving through the water, the swing of the tail and spine provides the main thrust.",
    ),
)
"""The claims about the water."""


CLAIMS: Mapping[str, Claim] = MappingProxyType(
    {claim.key: claim for claim in (*BODY, *LAND, *WATER, *SALAMANDERS, *OSCILLATORS)}
)
"""All claims, in the article's order; then those of other publications (``Claim.of``)."""
