"""Robot and water solved together, with any model of the water: the section model, a slice, or a flow in space."""

from suchus.swimming.coupling.earned import earned_correction, judgement_text
from suchus.swimming.coupling.on_joints import check_on_joints, swim_on_joints
from suchus.swimming.coupling.residual import residual_table
from suchus.swimming.coupling.simulation import simulate
from suchus.swimming.coupling.swim import Swim

__all__ = [
    "Swim",
    "check_on_joints",
    "earned_correction",
    "judgement_text",
    "residual_table",
    "simulate",
    "swim_on_joints",
]
