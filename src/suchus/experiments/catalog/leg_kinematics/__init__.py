"""Does the printed leg kinematics find the joint angles for every point in reach?"""
