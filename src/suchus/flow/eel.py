"""The eel of the IBAMR example, the usual test of free swimming in two dimensions."""

import numpy as np

from suchus.flow.midline import Midline, Spine


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
    head = 0.04
    half = np.where(x < head, np.sqrt(np.maximum(2 * head * x - x**2, 0)), head * (1 - x) / (1 - head))
    amplitude, slope = 0.125 * (x + 0.03125) / 1.03125, 0.125 / 1.03125
    wave = 2 * np.pi

    def spine(time: float) -> Spine:
        phase = wave * (x - time / period)
        sin, cos = np.sin(phase), np.cos(phase)
        tangent = slope * sin + amplitude * wave * cos
        tangent_rate = (-slope * wave * cos + amplitude * wave**2 * sin) / period
        return Spine(
            x=length * x, y=length * amplitude * sin, heading=np.arctan(tangent), half_width=length * half,
            x_rate=np.zeros_like(x), y_rate=-length * amplitude * wave / period * cos,
            heading_rate=tangent_rate / (1 + tangent**2),
        )  # fmt: skip

    return Midline(spine=spine)
