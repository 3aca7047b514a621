"""What a robot is and how it is to move, without physics.

``robot.design`` describes bodies, ``robot.kinematics`` computes positions from angles, ``robot.motion`` turns the
phase of a gait into postures, ``robot.control`` turns readings into commands, ``robot.blueprint`` reads and writes
files. The catalogs are ``robot.robots``, ``robot.gaits`` and ``robot.motors``. Nothing here knows MuJoCo.

Start reading with ``robot.design.body``, then ``robot.motion.gait``.
"""
