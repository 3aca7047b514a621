"""From a body plan to a robot as data, each guess with its reason."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from suchus.design import Girdle, Robot, layout
from suchus.design.scale import contact_for
from suchus.errors import InvalidDesign, UnreadableFile
from suchus.model.importing.draft_axis import draft_axis
from suchus.model.importing.draft_hinges import Match
from suchus.model.importing.draft_limbs import draft_girdle, lowest
from suchus.model.importing.making import Making, making_of
from suchus.model.importing.options import Words
from suchus.model.importing.plan import BodyPlan, without

_LEG = 0.03  # of the robot's length that a leg reaches below the axis, at least
_CONTACT = {
    "foot_friction": "guess: a rubber foot on a floor; contact is not taken from the file",
    "skin_friction": "guess: a smooth skin on a floor",
    "time_constant": "guess: from the length, as torsion, rolling and depth (design.contact_for)",
}


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Draft:
    """A robot read from a file of another tool."""

    robot: Robot
    """The robot."""
    matches: tuple[Match, ...]
    """Each hinge of the robot and the one of the file, in the order of the robot's layout."""
    remarks: tuple[str, ...]
    """What was guessed and what was not taken, in sentences."""
    notes: Mapping[str, str]
    """Guesses, by the place of the number in the robot's file, as ``girdles[0].limb.foot.radius``."""


def draft_of(plan: BodyPlan, name: str, words: Words) -> Draft:
    """Return the robot of a body plan.

    Args:
        plan: axis and limbs.
        name: of the robot.
        words: what the user said.

    Raises:
        UnreadableFile: the plan is none that a robot can have; the message says why.
    """
    try:
        plan, arms = _legs(plan, words)
        if not plan.pairs and len(plan.axis) == 1:
            raise UnreadableFile(f"nothing is left that could move: {arms[0]}")
        making = making_of(plan, words)
        girdles = [draft_girdle(making, i) for i in range(len(plan.pairs))]
        axis, root, ends = draft_axis(making)
        robot = Robot(
            name=name,
            root=root,
            axis=axis,
            girdles=tuple(
                _seated(girdle, axis[left.on].name, ends[left.on])
                for girdle, (left, _) in zip(girdles, plan.pairs, strict=True)
            ),
            cables=(),
            contact=contact_for(ends[0] - ends[-1], foot_friction=0.8, skin_friction=0.4),
        )
    except InvalidDesign as error:
        raise UnreadableFile(f"the file gives no robot that can be: {error}") from error
    order = layout(robot).hinges
    return Draft(
        robot=robot,
        matches=tuple(sorted(making.matches, key=lambda match: order.index(match.ours))),
        remarks=(*plan.remarks, *dict.fromkeys([*arms, *making.remarks, *_balance(making, robot)])),
        notes=making.notes | {f"contact.{key}": text for key, text in _CONTACT.items()},
    )


def _legs(plan: BodyPlan, words: Words) -> tuple[BodyPlan, list[str]]:
    """Return a plan without limbs that do not reach below the axis, and what is noted of them."""
    remarks = []
    for number in reversed(range(len(plan.pairs))):
        making = making_of(plan, words)
        depth = -lowest(draft_girdle(making, number))
        if depth < _LEG * making.size.length:
            pair = plan.pairs[number]
            parts = " and ".join(plan.part(chain.parts[0]).name for chain in pair)
            remarks.append(
                f"{parts} reach {max(depth, 0.0):.3g} m below the axis, so they are arms or fins and were left out; "
                "their masses went to the part that carries them."
            )
            plan = without(plan, pair)
    return plan, remarks


def _seated(girdle: Girdle, segment: str, front: float) -> Girdle:
    """Return a girdle on its segment, whose front end, its origin, lies at a place along the body [m]."""
    return replace(girdle, segment=segment, at=girdle.at - front)


def _balance(making: Making, robot: Robot) -> list[str]:
    """Say what the draft does to masses: moments of inertia follow from shapes, and the rest from this."""
    lost = abs(robot.mass / making.plan.tree.mass - 1.0)
    if lost > 1e-6:
        return [f"The draft weighs {robot.mass:.4g} kg, the file {np.round(making.plan.tree.mass, 6):g} kg."]
    return []
