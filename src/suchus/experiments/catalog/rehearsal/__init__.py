"""Does it walk the same over the bus, and how much of a real wire does it bear?"""
