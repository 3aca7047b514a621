"""How fast does the robot's own body swim in three dimensions, and what does a higher tail change?"""
