"""Does it float as Archimedes says, and does it right itself?"""
