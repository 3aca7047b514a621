"""Why predictions missed, as far as it is known: written after they were judged."""

from collections.abc import Mapping

UNKNOWN = "not known"
"""Cause of a miss of which nothing is known."""
_NO_DRAG_ACROSS = (
    "likely: the theory has no drag across the body; eels give thrust along their whole body (Mueller, Smit, Stamhuis "
    "and Videler 2001, J. Exp. Biol. 204, 2751, abstract)"
)
_NO_MOMENTUM = (
    "likely: the theory has no added mass, and a long fish gets a part of its thrust from the water's momentum"
)
_THICK_LAYER = (
    "likely: the layer is as thick as the body, whose friction is then that of a long cylinder, not of a plate "
    "(Glauert and Lighthill 1955, Proc. R. Soc. A 230, 188); tried after the judgement, it takes the miss away"
)
_FAST_FILM = (
    "in part: the same friction of a long cylinder, tried after the judgement, takes a small part of "
    "it; the rest is not known"
)
_ROUND_TAIL = (
    "not known: the drag of head and folded limbs by sources takes little of it; the drawn tail is round where the "
    "animal's is flat, and the joints' angles are those of one mean cycle"
)
_SLIDES = (
    "likely: rigid feet slide where claws hold, and the walk was made for level ground; the animal changes its forces, "
    "not its cadence"
)
CAUSES: Mapping[tuple[str, str], str] = {
    ("lamprey", "reactive"): _NO_DRAG_ACROSS,
    ("filmed", "reactive"): _NO_DRAG_ACROSS,
    ("prickleback", "reactive"): _NO_DRAG_ACROSS,
    ("american", "reactive"): _NO_DRAG_ACROSS,
    ("lamprey", "resistive"): _NO_MOMENTUM,
    ("filmed", "resistive"): _NO_MOMENTUM,
    ("prickleback", "resistive"): _NO_MOMENTUM,
    ("american", "resistive"): _NO_MOMENTUM,
    ("lamprey_20", "sections"): _THICK_LAYER,
    ("filmed", "sections"): _FAST_FILM,
    (
        "tunabot",
        "reactive",
    ): "likely: all momentum of a fin that swings far leaves with the stream in this theory, in part in fact",
    ("tunabot", "slice"): "known: a plane knows no fin that is higher than the body",
    ("alligator_slope", ""): _SLIDES,
    ("salamander", ""): _ROUND_TAIL,
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
