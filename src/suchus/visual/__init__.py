"""Pictures of records: figures, replays as pages, the skin of a robot, and what all pages share.

Everything is drawn from what was recorded and nothing else. Nothing here knows an experiment.

Start reading with ``visual.figures.style``, then ``visual.pages.rendering`` and ``visual.replay.page``.
"""
