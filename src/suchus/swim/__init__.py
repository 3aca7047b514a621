"""Robots in water: models for a designer, and robot and flow solved together.

``swim.water`` has the outline of the robot, waves fitted to its joints and the reactive and resistive models;
``swim.coupling`` solves the robot together with the flow of ``flow``. Nothing here draws pictures.

Start reading with ``swim.water``, then ``swim.coupling.swim``.
"""
