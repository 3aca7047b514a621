"""The article's robot with a longer tail: eight cable joints and a longer passive end, as in a young caiman."""

from dataclasses import replace

from suchus.robot.design import Assumption, crocodile
from suchus.robot.robots import caiman

tables = replace(
    caiman.tables,
    name="long_tail",
    tail=replace(caiman.tables.tail, joints=8, fin_segments=4, fin_length=0.200, mass=0.60),
)
"""Its measures."""
robot = crocodile(tables)
"""A robot of another topology, for studies of what a tail is worth."""

_OWN_CHOICES = (
    Assumption(field="tail.fin_length", low=0.15, high=0.25, why="makes the tail 56 % of the body"),
    Assumption(field="tail.mass", low=0.45, high=0.80, why="the caiman's tail, longer in proportion"),
)
chosen = (
    *(entry for entry in caiman.chosen if entry.field not in {choice.field for choice in _OWN_CHOICES}),
    *_OWN_CHOICES,
)
"""Every number of the robot that the article does not give, with its plausible range and the reason."""
