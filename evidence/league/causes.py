"""Why predictions missed, as far as it is known: written after they were judged."""

from collections.abc import Mapping

UNKNOWN = "not known"
"""Cause of a miss of which nothing is known."""
_LOW_TIP = (
    "likely: the theory lets thrust leave at the tip of the tail alone, which is low in a long fish; eels give thrust "
    "along their whole body (Mueller, Smit, Stamhuis and Videler 2001, J. Exp. Biol. 204, 2751, abstract)"
)
_NO_MOMENTUM = (
    "likely: the theory has no added mass, and a long fish gets a part of its thrust from the water's momentum"
)
_SLIDES = (
    "likely: rigid feet slide where claws hold, and the walk was made for level ground; the animal changes its forces, "
    "not its cadence"
)
CAUSES: Mapping[tuple[str, str], str] = {
    ("lamprey", "reactive"): _LOW_TIP,
    ("filmed", "reactive"): _LOW_TIP,
    ("prickleback", "reactive"): _LOW_TIP,
    ("american", "reactive"): _LOW_TIP,
    ("lamprey", "resistive"): _NO_MOMENTUM,
    ("filmed", "resistive"): _NO_MOMENTUM,
    ("prickleback", "resistive"): _NO_MOMENTUM,
    ("american", "resistive"): _NO_MOMENTUM,
    (
        "lamprey",
        "sections",
    ): "in part: the envelope is that of one film, of a beat a third faster than the mean of all swims",
    (
        "american",
        "sections",
    ): "in part: frequency, wavelength and amplitude are from memory, and its fins are drawn by eye",
    (
        "tunabot",
        "reactive",
    ): "likely: all momentum of a fin that swings far leaves with the stream in this theory, in part in fact",
    ("tunabot", "slice"): "known: a plane knows no fin that is higher than the body",
    ("alligator_slope", ""): _SLIDES,
    (
        "salamander",
        "",
    ): "in part: nobody measured the drag of its folded limbs and head; the swing as filmed took a part of the miss",
    ("swimming_law", ""): "in part: the swimmers of the catalog are few, and their tails are alike",
}
"""Cause by the beginning of the contestant's name, and by the model; an empty model stands for all of them."""


def cause_of(name: str, model: str) -> str:
    """Return the cause of a miss in a phrase.

    Args:
        name: of the contestant.
        model: that missed.
    """
    family = name.partition("_")[0]
    for key in ((name, model), (family, model), (name, ""), (family, "")):
        if key in CAUSES:
            return CAUSES[key]
    return UNKNOWN
