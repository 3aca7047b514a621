"""A swimmer without limbs: eleven equal segments and ten yaw joints, as AmphiBot and Envirobot."""

from math import radians

from suchus.design import Hinge, Robot, Rod, Segment, Shell
from suchus.design.physics import WATER_DENSITY
from suchus.design.reasons import Reason, chosen_numbers
from suchus.design.scale import contact_for, servo_for
from suchus.robots._plans import BY_SIZE

_COUNT, _SEGMENT, _HEIGHT, _WIDTH = 11, 0.095, 0.056, 0.040
_LENGTH = _COUNT * _SEGMENT
_HALF = (0.55 * _SEGMENT, _WIDTH / 2, _HEIGHT / 2)
_SEGMENT_MASS = WATER_DENSITY * 4.18879 * _HALF[0] * _HALF[1] * _HALF[2]  # of the ellipsoid, 4 pi / 3: it hovers
_ROOT = _COUNT // 2
_servo = servo_for(_COUNT * _SEGMENT_MASS, _LENGTH)


def _hinge(number: int) -> Hinge:
    word, count = ("spine", _ROOT - number) if number < _ROOT else ("tail", number - _ROOT + 1)
    return Hinge(name=f"{word}_yaw_{count}", turn="yaw", drive=_servo, range=(-radians(65), radians(65)))


def _shapes(name: str) -> tuple[Shell | Rod, ...]:
    """Return an ellipsoid and the two edges of its flat belly, on which it stands."""
    end, edge = 0.4 * _SEGMENT, 0.2 * _WIDTH
    edges = tuple(
        Rod(
            name=f"{name}_{side}",
            start=(-end, y, edge - _HEIGHT / 2),
            end=(end, y, edge - _HEIGHT / 2),
            radius=edge,
            mass=0.05 * _SEGMENT_MASS,
        )
        for side, y in (("left", 0.3 * _WIDTH), ("right", -0.3 * _WIDTH))
    )
    return Shell(name=name, at=(0.0, 0.0, 0.0), half=_HALF, mass=0.9 * _SEGMENT_MASS), *edges


robot = Robot(
    name="swimmer",
    root=f"segment_{_ROOT + 1}",
    axis=tuple(
        Segment(
            name=f"segment_{i + 1}",
            front=_SEGMENT / 2,
            rear=_SEGMENT / 2,
            shapes=_shapes(f"segment_{i + 1}"),
            hinges=(_hinge(i),) if i < _COUNT - 1 else (),
        )
        for i in range(_COUNT)
    ),
    girdles=(),
    cables=(),
    contact=contact_for(_LENGTH, foot_friction=0.4, skin_friction=0.4),
)
"""A row of equal segments, neutrally buoyant."""

_OWN = (
    Reason(r"\.half\[0\]$", 0.9, 1.1, "neighbouring shells overlap by a tenth, so that the outline closes"),
    Reason(r"\.(start|end|radius)", 0.7, 1.3, "a flat belly, so that it does not roll to its side"),
    Reason(r"\.mass$", 0.9, 1.1, "each segment weighs the water that it displaces"),
)
_PUBLISHED = (r"^axis\[\d+\]\.(front|rear)$", r"\.half\[[12]\]$")
chosen = chosen_numbers(robot, (*_OWN, *BY_SIZE), _PUBLISHED)
"""Every number that the public models do not give, with its plausible range and the reason."""
