"""Kinematics: pure NumPy, double precision, batched over leading axes."""

from suchus.kinematics import dh, leg

__all__ = ["dh", "leg"]
