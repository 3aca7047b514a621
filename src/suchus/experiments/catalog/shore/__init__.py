"""Does it swim in, touch ground, stand and walk out, and go back into the water?"""
