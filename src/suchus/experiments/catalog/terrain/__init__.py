"""Which posture for which ground, and can the robot choose by what it feels?"""
