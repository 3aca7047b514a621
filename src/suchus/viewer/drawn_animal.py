"""A filmed animal in a browser's scene: lines along its midline and to its feet."""

from typing import Any

import numpy as np

from suchus.viewer.animal import FilmedAnimal
from suchus.viewer.drawn import GHOST

_LINE, _FOOT = 0.008, 0.012
"""Thickness of the lines and radius of the feet, over the animal's length [-]."""


class DrawnAnimal:
    """Lines and balls in the scene of one browser.

    Args:
        scene: viser's scene of that browser.
        root: the node under which it stands.
        animal: the animal.
    """

    def __init__(self, scene: Any, root: str, animal: FilmedAnimal) -> None:
        self._animal = animal
        self._lines = scene.add_line_segments(
            f"{root}/lines", np.zeros((len(animal.bones), 2, 3)), GHOST, thickness=_LINE * animal.size
        )
        self._feet = [
            scene.add_icosphere(f"{root}/foot_{i}", _FOOT * animal.size, color=GHOST) for i in range(len(animal.feet))
        ]

    def show(self, time: float) -> None:
        """Move to a time of the record [s]."""
        place = self._animal.at(time)
        self._lines.points = place[np.array(self._animal.bones)].astype(np.float32)
        for ball, foot in zip(self._feet, self._animal.feet, strict=True):
            ball.position = place[foot]
