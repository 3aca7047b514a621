"""Proportions of the skin that make a robot look like a crocodile."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Proportions:
    """Proportions of the animal where the robot has none; none of them touches the physics."""

    ring_points: int = 28
    """Points around the body, a multiple of four [-]: edges of about 10 mm on the article's robot."""
    step: float = 0.0065
    """Distance between rings along a body one metre long, longer on longer ones [m]."""
    roundness: float = 2.3
    """Exponent of the trunk's section [-]: crocodilians are flatter on back and belly than an ellipse."""
    margin: float = 1.04
    """Size of the skin over that of the shapes beneath [-]."""
    flank: float = 0.93
    """Width of the trunk between the girdles over the mean of theirs [-]: it narrows but slightly in the animal."""
    fin: float = 2.3
    """Height of the tail above its axis over its radius, near the tip [-]: the animal's is a sculling blade."""
    gape: float = 0.075
    """Angle by which the lower jaw hangs open [rad]: enough to see the teeth."""
    skull: float = 0.30
    """Place of the jaw joint between shoulders (0) and snout (1) [-]; the neck ends there."""
    teeth: int = 13
    """Number of visible teeth on each side of each jaw [-]; crocodiles have 14 to 19."""


SKIN = Proportions()
"""The look of every robot in the catalog."""
