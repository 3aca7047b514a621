"""Is the printed end of the spine where Table II puts it, and can the spine be inverted?"""
