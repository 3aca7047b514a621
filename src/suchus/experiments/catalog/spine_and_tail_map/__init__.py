"""When do spine and tail pay, each gait at its own best?"""
