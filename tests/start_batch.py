"""Controllers of a batch, started from lists, for tests."""

from suchus.robot.control import Runs


def start_batch(controls, robots, gaits, seeds, ticks, period):
    """Return the running controller of runs that have one control together, or one each."""
    controls = tuple(controls) if isinstance(controls, (list, tuple)) else (controls,) * len(robots)
    runs = Runs(controls, tuple(robots), tuple(gaits), tuple(seeds), ticks)
    return controls[0].start(runs, period)
