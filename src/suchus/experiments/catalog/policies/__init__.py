"""Does a trained policy follow its commands, and what does it bear?"""
