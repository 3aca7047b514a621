"""The robot in water: its outline, waves fitted to its joints, and the models a designer calculates with."""

from suchus.water.outline import Base, Curve, Outline, Silhouette, silhouette

__all__ = ["Base", "Curve", "Outline", "Silhouette", "silhouette"]
