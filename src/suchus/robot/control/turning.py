"""A turn command: which bend and which strokes make the robot walk a circle of an asked radius."""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from types import MappingProxyType

import numpy as np

from suchus.core.checks import Checks
from suchus.core.errors import OutsideLimits
from suchus.robot.control.attitude import AttitudeRule
from suchus.robot.control.walking import Walking


@dataclass(frozen=True, slots=True, kw_only=True)
class TurningCurve:
    """How a gait turns as bend and asymmetry grow together, as measured on a robot."""

    bend: float
    """Lasting bend of the trunk at full mixture, left positive [rad]."""
    asymmetry: float
    """Asymmetry of the strokes at full mixture [-]."""
    mixtures: tuple[float, ...]
    """Shares of both, increasing from 0 to 1 [-]."""
    curvatures: tuple[float, ...]
    """Curvature of the path at each share, left positive, increasing [1/m]."""

    def __post_init__(self) -> None:
        with Checks("turning_curve", self) as checks:
            checks.number("bend", 0.0, 2.0, "rad")
            checks.number("asymmetry", 0.0, 3.0, "")
            pairs = len(self.mixtures) == len(self.curvatures) >= 2
            checks.that(pairs, "turning_curve needs as many mixtures as curvatures, two or more")
            for name, row in (("mixtures", self.mixtures), ("curvatures", self.curvatures)):
                checks.that(all(a < b for a, b in pairwise(row)), f"turning_curve.{name} must increase")

    @property
    def tightest(self) -> float:
        """Return the smallest radius that it reaches [m]."""
        return 1.0 / self.curvatures[-1]


def turn(curve: TurningCurve, radius: float, *, attitude: AttitudeRule | None = None) -> Walking:
    """Return the control that walks a circle on ground of the friction on which the curve was measured.

    Nothing is fed back: on other friction the radius is another one.

    Args:
        curve: curve of the gait.
        radius: radius of the circle, to the left positive, to the right negative [m].
        attitude: as in ``Walking``.

    Raises:
        OutsideLimits: the circle is tighter than the gait can turn.
    """
    if abs(radius) < curve.tightest:
        raise OutsideLimits(
            f"a circle of {radius:.3g} m was asked for; this gait turns no tighter than {curve.tightest:.3g} m: "
            "ask for more, or take another gait."
        )
    fraction = float(np.sign(radius) * np.interp(1.0 / abs(radius), curve.curvatures, curve.mixtures))
    return Walking(bend=fraction * curve.bend, asymmetry=fraction * curve.asymmetry, attitude=attitude)


CURVES: Mapping[str, TurningCurve] = MappingProxyType(
    {
        "low_crawl": TurningCurve(
            bend=0.79,
            asymmetry=1.0,
            mixtures=(0.0, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0),
            curvatures=(-0.003, 0.176, 0.332, 0.5, 0.734, 0.944, 1.265, 1.581),
        ),
        "semi_erect": TurningCurve(
            bend=0.79,
            asymmetry=1.0,
            mixtures=(0.0, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0),
            curvatures=(-0.001, 0.301, 0.581, 0.859, 1.379, 1.741, 2.319, 2.828),
        ),
        "high_walk": TurningCurve(
            bend=0.79,
            asymmetry=0.0,
            mixtures=(0.0, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0),
            curvatures=(-0.027, 0.235, 0.433, 0.723, 1.301, 1.778, 2.344, 2.958),
        ),
    }
)
"""By gait, as the experiment ``turning`` measured them on the robot ``caiman``, to the left, on the friction of its
design. On 0.8 to 1.25 times that friction a circle may be a fifth larger or smaller; the experiment measures by how
much (``radius_off_friction_...``)."""
