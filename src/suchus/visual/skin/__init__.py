"""The skin: a smooth crocodile over the bodies of any robot, for pictures; nothing touches the ground with it."""

from suchus.visual.skin.ankles import ANKLES, ankles, footed
from suchus.visual.skin.bones import Poses, bone_names, bone_rest, poses
from suchus.visual.skin.look import SKIN, Look
from suchus.visual.skin.surface import Skin, skin

__all__ = [
    "ANKLES",
    "SKIN",
    "Look",
    "Poses",
    "Skin",
    "ankles",
    "bone_names",
    "bone_rest",
    "footed",
    "poses",
    "skin",
]
