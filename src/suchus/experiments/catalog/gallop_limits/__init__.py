"""Could the robot gallop, and which servos would it take?"""
