"""Names of keypoints: which ones are ours, and which of ours those of other people come nearest to."""

import re
import unicodedata
from collections.abc import Sequence
from difflib import get_close_matches

from suchus.animals.capture.tracks import GAIT_KEYPOINTS, Tracks, UnusableTracks
from suchus.robot.design import LEGS

_SERIES = re.compile(r"(spine|tail)_\d+")
_SINGLE = ("snout", "neck", *GAIT_KEYPOINTS)
_SIDES = {
    **dict.fromkeys(("left", "l", "links", "linke", "gauche", "izquierda", "izquierdo", "sinistra", "sinistro"), "L"),
    **dict.fromkeys(
        ("right", "r", "rechts", "rechte", "droite", "droit", "derecha", "derecho", "destra", "destro"), "R"
    ),
}
_ENDS = {
    **dict.fromkeys(
        (
            "front",
            "fore",
            "forelimb",
            "forepaw",
            "forefoot",
            "foreleg",
            "hand",
            "anterior",
            "avant",
            "vorne",
            "vorder",
            "delantera",
        ),
        "F",
    ),
    **dict.fromkeys(
        (
            "hind",
            "rear",
            "back",
            "hindlimb",
            "hindpaw",
            "hindfoot",
            "hindleg",
            "foot",
            "posterior",
            "arriere",
            "hinten",
            "hinter",
            "trasera",
        ),
        "H",
    ),
}
_LETTERS = {"f": "F", "h": "H", "b": "H"}
_CODES = {
    **{f"{end}{side}": f"{side.upper()}{leg}" for end, leg in _LETTERS.items() for side in "lr"},
    **{f"{side}{end}": f"{side.upper()}{leg}" for end, leg in _LETTERS.items() for side in "lr"},
    "rl": "LH",
    "rr": "RH",
}
_WORDS = {
    "snout": ("nose", "nosetip", "rostrum", "muzzle"),
    "neck": ("nape", "head", "occiput"),
    "shoulder": ("shoulders", "withers", "pectoral", "thorax", "chest", "scapula"),
    "hip": ("hips", "pelvis", "pelvic", "sacrum", "rump"),
    "tail_base": ("tailbase", "tailroot", "tailstart", "cloaca", "vent"),
    "tail_tip": ("tailtip", "tailend"),
}
_FEET = frozenset(
    (
        "paw",
        "paws",
        "foot",
        "feet",
        "leg",
        "limb",
        "hand",
        "toe",
        "toes",
        "ankle",
        "wrist",
        "claw",
        "hoof",
        "pes",
        "manus",
    )
)  # words of a name that is a foot's, whichever it is
_TAIL_ENDS = {"tail_base": {"base", "root", "start", "proximal"}, "tail_tip": {"tip", "end", "distal"}}
_CUTOFF = 0.75  # likeness of two names from which on one is suggested for the other


def is_keypoint(name: str) -> bool:
    """Return whether a name is one that a walk is read from."""
    return name in _SINGLE or _SERIES.fullmatch(name) is not None


def _words(name: str) -> list[str]:
    """Return the words of a name in lower case, without digits and accents."""
    plain_name = unicodedata.normalize("NFKD", name.lower())
    return [
        word for word in re.split(r"[^a-z]+", "".join(c for c in plain_name if not unicodedata.combining(c))) if word
    ]


def nearest_name(name: str) -> str | None:
    """Return the keypoint of ours that a name probably means, as LF for ``left_fore_paw``; None if nothing is near."""
    words = _words(name)
    for keypoint, tail_ends in _TAIL_ENDS.items():
        if "tail" in words and tail_ends & set(words):
            return keypoint
    for keypoint, synonyms in _WORDS.items():
        if set(words) & {*synonyms, keypoint} or "".join(words) in synonyms:
            return keypoint
    codes = [_CODES[word] for word in words if word in _CODES]
    sides = [_SIDES[word] for word in words if word in _SIDES]
    ends = [_ENDS[word] for word in words if word in _ENDS]
    if codes:
        return codes[0]
    if sides and ends:
        return sides[0] + ends[0]
    close = get_close_matches(name.lower(), _SINGLE[: -len(LEGS)], n=1, cutoff=_CUTOFF)
    return close[0] if close else None


def unused_points(points: Sequence[str]) -> dict[str, str | None]:
    """Return the names that no walk is read from, and of each the nearest keypoint that is not there already."""
    suggestions: dict[str, str | None] = {}
    for name in points:
        if not is_keypoint(name):
            keypoint_name = nearest_name(name)
            is_free = (
                keypoint_name is not None and keypoint_name not in points and keypoint_name not in suggestions.values()
            )
            suggestions[name] = keypoint_name if is_free else None
    return suggestions


def unused_text(points: Sequence[str]) -> str:
    """Return the unused names and the ``--names`` to give, as the rest of a sentence; empty without unused names."""
    suggestions = unused_points(points)
    if not suggestions:
        return ""
    names_option = " ".join(f"{name}={keypoint_name}" for name, keypoint_name in suggestions.items() if keypoint_name)
    remedy = (
        f"give --names {names_option}, if that is what they are"
        if names_option
        else "name with --names THEIRS=OURS any of use"
    )
    return f"{', '.join(suggestions)} {'is' if len(suggestions) == 1 else 'are'} not used: {remedy}"


def check_feet(tracks: Tracks) -> None:
    """Refuse an animal that seems to have no feet because its feet have other names.

    Raises:
        UnusableTracks: it names them, and the option that gives them our names.
    """
    suggestions = unused_points(tracks.points)
    feet = {name: keypoint_name for name, keypoint_name in suggestions.items() if keypoint_name in LEGS}
    unsided_feet = [name for name in suggestions if name not in feet and _FEET & set(_words(name))]
    if unsided_feet and not feet and not tracks.legs:
        names_option = " ".join(f"{name}=..." for name in unsided_feet)
        raise UnusableTracks(
            f"in {tracks.source} no keypoint is called LF, RF, LH or RH, but {' and '.join(unsided_feet)} "
            f"seem{'s' * (len(unsided_feet) == 1)} to be feet; say which with --names {names_option}, each of LF, RF, "
            "LH, RH, or other_1, other_2 and so on for what is none."
        )
    if feet and not tracks.legs:
        names_option = " ".join(f"{name}={keypoint_name}" for name, keypoint_name in feet.items())
        other_names = " ".join(f"{name}=other_{i}" for i, name in enumerate(feet, 1))
        raise UnusableTracks(
            f"in {tracks.source} no keypoint is called LF, RF, LH or RH, but {' and '.join(feet)} "
            f"seem{'s' * (len(feet) == 1)} to be feet; give --names {names_option}, or, to measure without feet, "
            f"--names {other_names}."
        )


def check_trunk(tracks: Tracks) -> None:
    """Refuse tracks whose trunk has other names.

    Raises:
        UnusableTracks: it names the option that gives them our names.
    """
    text = unused_text(tracks.points)
    if len(tracks.trunk_chain) < 2 and text:
        raise UnusableTracks(
            f"{tracks.source} has fewer than two keypoints of the trunk (neck or snout, shoulder, spine_1, ..., hip, "
            f"tail_base), so that nobody knows where the body heads; it holds {', '.join(tracks.points)}; {text}."
        )
