"""A run that can be mailed: one HTML file, three-dimensional, that plays offline.

The crawl with spine and tail and, half transparent beside it, the same crawl with a limp leg. The page has a time
slider, speeds, views, foot forces, the support and the centre of mass; any browser opens it from the disk.

Usage: python examples/09_replay.py [FOLDER]
"""

import sys
from pathlib import Path

import suchus
from suchus.visual.replay import replay, save

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
robot, gait = suchus.ROBOTS["caiman"], suchus.GAITS["belly_crawl"]
whole = suchus.crawl(robot, gait, duration=5.0)
limp = suchus.crawl(robot, gait, duration=5.0, faults=[suchus.Limp("LF_pitch")])
page = replay(
    whole,
    robot,
    ghost=limp,
    labels=("intact", "left front pitch joint limp"),
    title="A limp leg",
    caption="One cycle of the crawl after the first second, in which the robot settles.",
)
path = save(page, folder / "limp_leg.html")
print(f"{path}, {path.stat().st_size / 1e6:.1f} MB: open it in a browser")
