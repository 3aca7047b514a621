"""A swimmer without limbs: eleven equal segments and ten yaw joints, as AmphiBot and Envirobot."""

from math import radians

from suchus.core.physics import WATER_DENSITY
from suchus.robot.design import Hinge, Robot, Rod, Segment, Servo, Shell
from suchus.robot.design.pieces import volumes
from suchus.robot.design.reasons import Reason, assumptions_of
from suchus.robot.design.scale import contact_for, servo_for
from suchus.robot.robots._plans import BY_SIZE

_COUNT, _SEGMENT, _HEIGHT, _WIDTH = 11, 0.095, 0.056, 0.040
_LENGTH = _COUNT * _SEGMENT
_HALF = (0.55 * _SEGMENT, _WIDTH / 2, _HEIGHT / 2)
# mass over that of the water that it displaces when it is all under water: it swims at the surface
_RELATIVE_DENSITY = 0.95
# share of the mass in each of the two edges of the belly: the batteries lie low, so that it floats upright
_BELLY_MASS_FRACTION = 0.15
_ROOT = _COUNT // 2


def _hinge(number: int, servo: Servo) -> Hinge:
    word, count = ("spine", _ROOT - number) if number < _ROOT else ("tail", number - _ROOT + 1)
    return Hinge(name=f"{word}_yaw_{count}", turn="yaw", drive=servo, range=(-radians(65), radians(65)))


def _shapes(name: str, mass: float) -> tuple[Shell | Rod, ...]:
    """Return an ellipsoid and the two edges of its flat belly, on which it stands.

    Args:
        name: name of the segment.
        mass: mass of all three together [kg].
    """
    end, edge = 0.4 * _SEGMENT, 0.2 * _WIDTH
    edges = tuple(
        Rod(
            name=f"{name}_{side}",
            start=(-end, y, edge - _HEIGHT / 2),
            end=(end, y, edge - _HEIGHT / 2),
            radius=edge,
            mass=_BELLY_MASS_FRACTION * mass,
        )
        for side, y in (("left", 0.3 * _WIDTH), ("right", -0.3 * _WIDTH))
    )
    return Shell(name=name, at=(0.0, 0.0, 0.0), half=_HALF, mass=(1 - 2 * _BELLY_MASS_FRACTION) * mass), *edges


def _swimmer(mass: float) -> Robot:
    """Return the swimmer.

    Args:
        mass: mass of each segment [kg].
    """
    servo = servo_for(_COUNT * mass, _LENGTH)
    return Robot(
        name="swimmer",
        root=f"segment_{_ROOT + 1}",
        axis=tuple(
            Segment(
                name=f"segment_{i + 1}",
                front=_SEGMENT / 2,
                rear=_SEGMENT / 2,
                shapes=_shapes(f"segment_{i + 1}", mass),
                hinges=(_hinge(i, servo),) if i < _COUNT - 1 else (),
            )
            for i in range(_COUNT)
        ),
        girdles=(),
        cables=(),
        contact=contact_for(_LENGTH, foot_friction=0.4, skin_friction=0.4),
    )


robot = _swimmer(_RELATIVE_DENSITY * WATER_DENSITY * sum(volumes(_swimmer(1.0)).values()) / _COUNT)
"""A row of equal segments that float with a twentieth of their volume above the water."""

_REASONS = (
    Reason(r"\.half\[0\]$", 0.9, 1.1, "neighbouring shells overlap by a tenth, so that the outline closes"),
    Reason(r"\.(start|end|radius)", 0.7, 1.3, "a flat belly, so that it does not roll to its side"),
    Reason(r"\.mass$", 0.9, 1.1, "together they float with a twentieth of their volume above the water, batteries low"),
)
_PUBLISHED = (r"^axis\[\d+\]\.(front|rear)$", r"\.half\[[12]\]$")
chosen = assumptions_of(robot, (*_REASONS, *BY_SIZE), _PUBLISHED)
"""Every number that the public models do not give, with its plausible range and the reason."""
