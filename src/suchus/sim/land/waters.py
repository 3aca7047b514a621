"""The water of a run, rung by rung: forces section by section, a plane flow, a flow in space.

All three take the same runs and give the same records. ``swimming.coupling.simulate`` solves robot and flow together;
nothing here loads the flow solver.
"""

from dataclasses import dataclass
from typing import Literal

from suchus.core.checks import Checks
from suchus.sim.land.lake import Lake

Form = Literal["sections", "slice", "space"]
"""Short forms of the rungs."""
_MAX_CELLS = {"slice": 4096, "space": 1024}


@dataclass(frozen=True, slots=True, kw_only=True)
class Sections:
    """Forces of the water section by section, from what each section does now; with a surface, waves and a ground."""

    lake: Lake
    """The water."""


@dataclass(frozen=True, slots=True, kw_only=True)
class _Resolved:
    """A flow that is solved together with the robot, far from surface and ground; the robot weighs nothing in it."""

    cells: int
    """Cells per body length [-]."""
    reynolds: float = 7000.0
    """Frequency of the gait times length squared over viscosity [-], chosen for what the cells carry: in real water it
    is some 1e6 for a robot of 1 m at 1 Hz, where no such grid resolves the layer along the body."""
    corrections: int = 8
    """Times that a step's motion is corrected by the forces that it met, and the water with it, at most [-]; one or two
    do where the added mass fits, since each leaves over a twentieth to a quarter, and six where a step on coarse cells
    begins with twice the force that it finds."""
    tolerance: float = 5e-3
    """Force that a step may leave over, over the greatest so far, each coordinate's by the root of its inertia; and
    impulse on the whole robot, over its greatest momentum so far, which is what counts where it is light [-]."""
    renewed: float = 0.5
    """Angle by which a joint turns before the added mass is computed anew [rad]; until then corrections teach it."""
    parts: int = 45
    """Rigid parts that the body is taken for where forces become moments of joints, at least [-]."""
    tail_height: float = 0.0
    """In space: height of the last third of the body, as a fin as thick as the tail is; 0 leaves it as it is [m]."""
    limbs: bool = False
    """In space: whether the limbs are in the water, folded straight back along the body."""
    linked: bool = False
    """In space: whether each piece of the robot moves as its own joints do and the root in all six ways, so that limbs
    paddle and the axis may leave its plane; there is no mirror then, and twice as much water."""
    floor: float | None = None
    """In space: depth of a lake's floor below the middle of the body, which then has no mirror and twice as much water;
    None is a flow far from any floor [m]."""
    beside: float | None = None
    """In space: water beside the widest swing, to each side; None for that of a commanded swim [body length]."""

    def _check(self, name: str) -> None:
        """Refuse settings of a solved flow outside their ranges, and settings of a body in space for a slice."""
        with Checks(name, self) as check:
            check.whole("cells", 32, _MAX_CELLS[name])
            check.number("reynolds", 10.0, 1e7, "")
            check.whole("corrections", 0, 20)
            check.number("tolerance", 1e-8, 1.0, "")
            check.number("renewed", 1e-3, 10.0, "rad")
            check.whole("parts", 4, 48)
            check.number("tail_height", 0.0, 1.0, "m")
            if self.beside is not None:
                check.number("beside", 0.0, 3.0, "body lengths")
            if self.floor is not None:
                check.number("floor", 1e-3, 100.0, "m")
            space_options = [
                option for option in ("tail_height", "limbs", "linked", "floor", "beside") if getattr(self, option)
            ]
            check.that(
                not (self.linked and self.floor is not None),
                f"{name}.floor is below a body that stays in its plane, and with linked it may leave it: leave out one",
            )
            check.that(
                not (self.linked and (self.limbs or self.tail_height)),
                f"{name}.linked has all of the robot's own pieces in the water, its limbs among them and no raised "
                "tail: leave out limbs and tail_height",
            )
            check.that(
                name == "space" or not space_options,
                f"{name}.{', '.join(space_options)} is for a body in space: leave it out",
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class Slice(_Resolved):
    """A plane flow through the body's plane, as deep as ``depth`` says: the water cannot pass over and under it."""

    cells: int = 128
    """Cells per body length [-]."""
    depth: float | None = None
    """Depth by which forces per metre are multiplied; None is the one at which the slice displaces what the body does
    [m]."""
    blunt: float = 1.75
    """Least half-width; where the body is thinner it is thickened, its ends made round [cell]."""

    def __post_init__(self) -> None:
        """Refuse cells, thickness or depth outside their ranges."""
        self._check("slice")
        with Checks("slice", self) as check:
            check.number("blunt", 0.0, 5.0, "cells")
            if self.depth is not None:
                check.number("depth", 1e-4, 100.0, "m")


@dataclass(frozen=True, slots=True, kw_only=True)
class Space(_Resolved):
    """A flow in three dimensions around the body, mirrored at its plane of symmetry."""

    cells: int = 80
    """Cells per body length [-]."""

    def __post_init__(self) -> None:
        self._check("space")


AnyWater = Sections | Slice | Space
"""What a run may swim in."""

FORMS = {"slice": Slice, "space": Space}
"""Resolved rungs by their short forms."""
