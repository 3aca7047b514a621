"""Let the article's robot crawl, and measure.

One robot, one gait, one record: an xarray.Dataset with units on every variable.

Usage: python examples/01_crawl.py
"""

import suchus
from suchus.sim.metrics import cost_of_transport, displacement, height_std, slip

robot = suchus.ROBOTS["caiman"]
for name in ("belly_crawl", "limbs_only"):
    record = suchus.crawl(robot, suchus.GAITS[name])  # 9 s: one to settle, two cycles of four
    forward = float(displacement(record).sel(xyz="x"))
    print(
        f"{name:12s} {forward:.2f} m forward, "
        f"height of the centre of mass +- {1000 * float(height_std(record)):.1f} mm, "
        f"cost of transport {float(cost_of_transport(record)):.2f}, slip {float(slip(record)):.2f}"
    )
