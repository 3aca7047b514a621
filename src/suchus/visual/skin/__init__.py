"""The skin: a smooth crocodile over the bodies of any robot, for pictures; nothing touches the ground with it."""

from suchus.visual.skin.ankles import ANKLES, ankles, skin_with_ankles
from suchus.visual.skin.bones import Poses, bone_names, bone_rest, poses
from suchus.visual.skin.look import SKIN, Proportions
from suchus.visual.skin.surface import Skin, skin

__all__ = [
    "ANKLES",
    "SKIN",
    "Poses",
    "Proportions",
    "Skin",
    "ankles",
    "bone_names",
    "bone_rest",
    "poses",
    "skin",
    "skin_with_ankles",
]
