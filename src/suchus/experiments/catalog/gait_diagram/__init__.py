"""When do the feet stand, and which way do spine and tail bend?"""
