"""Does a salamander's own walk, played on its model, walk as the animal does?"""
