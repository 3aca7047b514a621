# mypy: disable-error-code="no-untyped-def, var-annotated"
# (the faces get their types from numba, once per precision)
"""Advection schemes: what a velocity is on a face, from the values at the three nodes that the water comes by.

Sources: Leonard 1979, Comput. Methods Appl. Mech. Eng. 19, 59-98 (QUICK); Leonard 1991, ibid. 88, 17-74 (the
universal limiter).
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import isfinite
from typing import Any

import numba
import numpy as np

from suchus.core.errors import InvalidDesign
from suchus.core.kinds import show
from suchus.flow.compiled import kernel_part
from suchus.flow.grid import check_kinds

TEST_VELOCITIES = -1.0, 0.0, 3.0
"""Uniform velocities that a scheme must preserve [m/s]."""


@kernel_part
def median(a, b, c):
    """Return the median of three numbers."""
    smaller = a if a < b else b
    larger = a if a > b else b
    capped = larger if larger < c else c
    return smaller if smaller > capped else capped


@kernel_part
def limited_quick(upstream, centre, downstream):
    """Return the velocity on a face by QUICK, limited so that it stays between its neighbours.

    Args:
        upstream: velocity at the second node upstream of the face.
        centre: velocity at the first node upstream of the face.
        downstream: velocity at the node downstream of the face.
    """
    real = type(centre)
    quick_value = real(0.75) * centre + real(0.375) * downstream - real(0.125) * upstream
    steepest = real(10.0) * centre - real(9.0) * upstream
    return median(quick_value, centre, median(steepest, centre, downstream))


def central(upstream, centre, downstream):  # noqa: ARG001
    """Return the face value: the mean of both sides, which keeps energy and makes waves where gradients are steep."""
    return type(centre)(0.5) * (centre + downstream)


def upwind(upstream, centre, downstream):  # noqa: ARG001
    """Return the face value: what comes, which makes no waves and as much friction as half a cell times the speed."""
    return centre


@dataclass(frozen=True, slots=True)
class Scheme:
    """An advection scheme."""

    face: Callable[..., Any]
    """Function that returns the velocity on a face [m/s] from three nodes: the second and the first upstream of it, and
    the one downstream. It is compiled by numba; ``type(centre)(0.5)`` is a half in the precision of the fields."""

    def __post_init__(self) -> None:
        check_kinds(self)

    def check(self) -> None:
        """Try the scheme on uniform velocities.

        Raises:
            InvalidDesign: the function cannot be compiled, or does not carry a uniform velocity on.
        """
        compiled, name = numba.njit(self.face), self.name
        try:
            face_values = [float(compiled(*(np.float32(value),) * 3)) for value in TEST_VELOCITIES]
        except Exception as error:  # whatever a user's function raises, and numba's errors, which have no base but this
            raise InvalidDesign(
                f"the advection scheme {name} cannot be used: {show(str(error).strip())}; it is a function "
                f"of three numbers (upstream, centre, downstream) that numba compiles and that returns one."
            ) from error
        for value, face_value in zip(TEST_VELOCITIES, face_values, strict=True):
            if not (isfinite(face_value) and abs(face_value - value) <= 1e-5 * abs(value)):
                raise InvalidDesign(
                    f"the advection scheme {name} makes {face_value:.6g} m/s of water that moves at {value:g} m/s "
                    f"everywhere; shares of the three velocities must add up to 1."
                )

    @property
    def name(self) -> str:
        """What the function is called."""
        return str(getattr(self.face, "__name__", show(self.face)))


QUICK = Scheme(limited_quick.py_func)
"""Limited QUICK: third order where the flow is smooth, without new extremes."""

CENTRAL = Scheme(central)
"""Central differences: second order."""

UPWIND = Scheme(upwind)
"""First-order upwind, to demonstrate numerical diffusion."""
