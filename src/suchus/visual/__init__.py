"""Pictures of records: figures, replays as pages, and the skin that is drawn over a robot.

Everything is drawn from what was recorded and nothing else. Nothing here knows an experiment.

Start reading with ``visual.figures.style``, then ``visual.replay.page``.
"""
