"""The eels of the IBAMR examples, the usual tests of free swimming in two dimensions and in three."""

from functools import partial
from math import pi

import numpy as np

from suchus.flow.midline import Midline, MidlineState
from suchus.flow.trunk import Trunk

HEAD = 0.04
"""Largest half-width of the eel in lengths, and how far from the snout it is reached [-]."""
CURVATURE = (1.29, -22.57, 78.39, -52.83)
"""Cubic of the eel's largest curvature over the arc length from the snout, in lengths [1/length]."""
WAVES = 1.52
"""Waves of curvature on the body of the eel in space [-]."""
MIDDLE, HEIGHT = 0.51, 0.08
"""Where the eel in space is highest, and its half-height there [length]."""


def half_widths(s: np.ndarray) -> np.ndarray:
    """Return the half-width over the arc length from the snout, both in lengths: a round head and a straight taper."""
    head = np.sqrt(np.maximum(2 * HEAD * s - s**2, 0))
    widths: np.ndarray = np.where(s < HEAD, head, HEAD * (1 - s) / (1 - HEAD))
    return widths


def eel(length: float, *, period: float = 1.0, stations: int = 257) -> Midline:
    """Return an eel whose midline is ``0.125 (x + 0.03125) / 1.03125 sin 2 pi (x - t)`` in lengths and periods.

    The head is at the origin, the tail toward +x, and the wave runs to the tail. The stations keep their distance
    along x, as in the source, and their cross-sections stay square to the midline.

    Args:
        length: length of the straight eel [m].
        period: period of the undulation [s].
        stations: points along the midline [-].

    Source: IBAMR examples, ConstraintIB eel2d (inputs); outline of Kern and Koumoutsakos 2006, J. Exp. Biol. 209,
    4841-4857, with a straight taper.
    """
    x = 0.5 * (1 - np.cos(np.linspace(0, np.pi, stations)))
    half = half_widths(x)
    amplitude, slope = 0.125 * (x + 0.03125) / 1.03125, 0.125 / 1.03125
    wave = 2 * np.pi

    def spine(time: float) -> MidlineState:
        """Return the midline of the eel at a time [s]."""
        phase = wave * (x - time / period)
        sin, cos = np.sin(phase), np.cos(phase)
        tangent = slope * sin + amplitude * wave * cos
        tangent_rate = (-slope * wave * cos + amplitude * wave**2 * sin) / period
        return MidlineState(
            x=length * x, y=length * amplitude * sin, heading=np.arctan(tangent), half_width=length * half,
            x_rate=np.zeros_like(x), y_rate=-length * amplitude * wave / period * cos,
            heading_rate=tangent_rate / (1 + tangent**2),
        )  # fmt: skip

    return Midline(spine=spine)


def eel_in_space(length: float, *, period: float = 1.0, stations: int = 257) -> Trunk:
    """Return an eel with elliptic sections whose curvature is ``K(s) sin 2 pi (t - 1.52 s) tanh pi t``.

    K is ``CURVATURE``, s the arc length from the snout in lengths and t the time in periods: the motion grows from
    rest. The snout is at the origin of the body's frame and points to -x.

    Args:
        length: length of the straight eel [m].
        period: period of the undulation [s].
        stations: points along the midline [-].

    Source: Kern and Koumoutsakos 2006, J. Exp. Biol. 209, 4841-4857, as in the IBAMR examples, ConstraintIB eel3d.
    """
    from scipy.integrate import cumulative_simpson  # noqa: PLC0415  a tenth of the time of an import of flow

    s = 0.5 * (1 - np.cos(np.linspace(0, pi, stations)))
    curvature = np.polynomial.Polynomial(CURVATURE)(s)
    half = length * half_widths(s)
    half_height = length * HEIGHT * np.sqrt(np.maximum(1 - ((s - MIDDLE) / MIDDLE) ** 2, 0))
    integrate = partial(cumulative_simpson, x=s, initial=0.0)

    def spine(time: float) -> MidlineState:
        """Return the midline of the eel in space at a time [s]."""
        t = time / period
        phase, ramp = 2 * pi * (t - WAVES * s), np.tanh(pi * t)
        bend_rate = curvature * (2 * pi * np.cos(phase) * ramp + np.sin(phase) * pi * (1 - ramp**2)) / period
        heading, turn = integrate(curvature * np.sin(phase) * ramp), integrate(bend_rate)
        cos, sin = np.cos(heading), np.sin(heading)
        return MidlineState(
            x=length * integrate(cos), y=length * integrate(sin), heading=heading, half_width=half,
            x_rate=-length * integrate(turn * sin), y_rate=length * integrate(turn * cos), heading_rate=turn,
        )  # fmt: skip

    return Trunk(spine=spine, half_height=half_height)
