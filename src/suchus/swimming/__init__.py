"""Robots in water: models for a designer, and robot and flow solved together.

``swimming.water`` has the outline of the robot, waves fitted to its joints and the reactive and resistive models;
``swimming.coupling`` solves the robot together with the flow of ``flow``. Nothing here draws pictures.

Start reading with ``swimming.water``, then ``swimming.coupling.swim``.
"""
