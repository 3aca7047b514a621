"""From film to newtons: forces under feet and of the water on an animal's body that moves as was filmed.

``swum_forces`` is asked for in ``forces.water``, since it loads the flow solver.
"""

from suchus.animals.forces.body import DRAWS, RUNGS, Rung, Unknown, resize_body
from suchus.animals.forces.ground import played_forces, walked_forces
from suchus.animals.forces.words import summary_lines

__all__ = ["DRAWS", "RUNGS", "Rung", "Unknown", "played_forces", "resize_body", "summary_lines", "walked_forces"]
