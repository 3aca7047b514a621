"""Animals: keypoints of a film become angles, contacts and a gait, and forces under feet and of the water.

``animals.capture`` reads tracks, ``animals.forces`` computes forces from a film. Nothing here knows an experiment.

Start reading with ``animals.capture``.
"""
