"""Drag that slender-body theory leaves out, each term with its range: head, blunt end, folded limbs, and the layer.

None of it is in the models unless it is asked for: ``resist_form`` makes a model that has it. Each range is that of
its source, and no number was chosen by a swim.

Source: Hoerner 1965, Fluid-Dynamic Drag, chapters 2 and 3.
"""

from math import log10, pi, sqrt
from typing import NamedTuple

import numpy as np

from suchus.core.errors import OutsideLimits
from suchus.robot.design import Robot
from suchus.robot.design.water import Water
from suchus.swimming.water.outline import MidlineCurve, Outline
from suchus.swimming.water.slender import Effort, Model

MIN_TURBULENT_REYNOLDS = 2e4
"""Reynolds number of the length below which no layer is turbulent [-]."""
HEAD_DRAG = (0.1, 0.05, 0.2)
"""Drag coefficient of a streamlined nose over the greatest section, with its range [-]."""
LIMB_DRAG = (0.5, 0.2, 0.9)
"""Drag coefficient of a rod along the stream over its section: of 0.2 with a round nose to 0.9 with flat ends [-]."""
FOOT_DRAG = (0.47, 0.2, 0.47)
"""Drag coefficient of a ball, from behind the crisis to before it, over its section [-]."""


class DragArea(NamedTuple):
    """Drag area, the drag over half the density and the square of the speed, with its range."""

    value: float
    """Most likely [m2]."""
    low: float
    """Least [m2]."""
    high: float
    """Greatest [m2]."""


class FormDrag(NamedTuple):
    """Drag areas of the parts of a body that swims along its axis."""

    head: DragArea
    """Of the nose."""
    base: DragArea
    """Of the blunt end; 0 where the body ends in a point."""
    limbs: DragArea
    """Of the limbs, folded back along the body."""

    @property
    def total(self) -> DragArea:
        """Sum of the three."""
        return DragArea(*(float(sum(ends)) for ends in zip(*self, strict=True)))


class FrictionEnds(NamedTuple):
    """Friction coefficient of a plate at the two ends of what its layer can be."""

    laminar: float
    """Where the layer is laminar to the end [-]."""
    turbulent: float
    """Where it is turbulent from the nose on; the laminar one where no layer is turbulent [-]."""


def friction_ends(speed: float, length: float, viscosity: float) -> FrictionEnds:
    """Return the friction coefficients of a plate whose layer is laminar, and turbulent from the nose on.

    Args:
        speed: of the plate, above 0 [m/s].
        length: of the plate [m].
        viscosity: kinematic [m2/s].

    Raises:
        OutsideLimits: the Reynolds number is not above 1.

    Source: Blasius 1908; ITTC 1957, 8th International Towing Tank Conference, Madrid.
    """
    reynolds = speed * length / viscosity
    if not reynolds > 1.0:
        raise OutsideLimits(f"the Reynolds number of a plate is {reynolds:.3g}; friction of a layer needs one above 1.")
    laminar = 1.328 / sqrt(reynolds)
    turbulent = 0.075 / (log10(reynolds) - 2.0) ** 2 if reynolds > MIN_TURBULENT_REYNOLDS else laminar
    return FrictionEnds(laminar, max(laminar, turbulent))


def form_drag(robot: Robot, speed: float, water: Water | None = None) -> FormDrag:
    """Return the form drag of a robot that swims along its axis with its limbs folded back.

    Args:
        robot: the robot.
        speed: its speed, above 0, for the drag of the blunt end [m/s].
        water: its water; fresh water if None.

    Raises:
        OutsideLimits: the Reynolds number is not above 1.
    """
    water = water or Water()
    outline = Outline(robot)
    half_width, half_height = outline.silhouette
    sections = pi * half_width * half_height
    head = DragArea(*(factor * float(sections.max()) for factor in HEAD_DRAG))
    return FormDrag(head=head, base=_base(outline, sections, speed, water), limbs=_limbs(robot))


def _base(outline: Outline, sections: np.ndarray, speed: float, water: Water) -> DragArea:
    """Return the drag area of the blunt end by the friction ahead of it, which thickens the layer that it sheds.

    Args:
        outline: outline of the robot.
        sections: areas of its sections [m2].
        speed: speed [m/s].
        water: its water.

    Source: Hoerner 1965, chapter 3: 0.029 / sqrt(C_f S / S_base), over the section of the end.
    """
    half_width, half_height = outline.silhouette
    end = float(sections[-1])
    a, b = half_width, half_height
    girth = pi * (3 * (a + b) - np.sqrt((3 * a + b) * (a + 3 * b)))
    wetted = float(np.trapezoid(girth, outline.s))
    ends = friction_ends(speed, outline.robot.length, water.viscosity)
    low, high = sorted(0.029 * end / sqrt(friction * wetted / max(end, 1e-30)) for friction in ends)
    return DragArea(0.5 * (low + high), low, high)


def _limbs(robot: Robot) -> DragArea:
    """Return the drag area of all limbs, folded back along the body: rods along the stream that end in a ball."""
    areas = np.zeros(3)
    for girdle in robot.girdles:
        limb = girdle.limb
        rod = pi * max(link.radius for link in limb.links) ** 2
        areas += 2.0 * (rod * np.array(LIMB_DRAG) + pi * limb.foot.radius**2 * np.array(FOOT_DRAG))
    return DragArea(*areas.tolist())


def resist_form(model: Model, area: float) -> Model:
    """Return a slender-body model that resists with a drag area too.

    Args:
        model: the model.
        area: drag area, see ``FormDrag`` [m2].
    """

    def resisted(outline: Outline, curve: MidlineCurve, speed: float, water: Water) -> Effort:
        """Return thrust and power of the model, less the drag of the form."""
        effort = model(outline, curve, speed, water)
        return effort._replace(thrust=effort.thrust - 0.5 * water.density * area * abs(speed) * speed)

    return resisted
