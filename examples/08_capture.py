"""From video to gait: film a walk, track its keypoints, read the gait, let the robot walk it.

Two films, so that the truth is known: our own crawl, and a lizard in a lateral-sequence walk whose tail lags its
spine by a third of a cycle. Both have noise, lost points, a camera that nobody aligned, and pixels of unknown size.
The CSV files it leaves can be fed to `suchus capture` as well.

Usage: python examples/08_capture.py [FOLDER]
"""

import sys
from pathlib import Path

import suchus
from suchus.animals.capture import (
    Camera,
    SyntheticAnimal,
    driven_fraction,
    film,
    film_animal,
    observe,
    read_tracks,
    summary,
    to_gait,
    write_gait,
    write_table,
)
from suchus.sim.metrics import displacement

folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out/capture")
robot, crawl = suchus.ROBOTS["caiman"], suchus.GAITS["belly_crawl"]
lizard = SyntheticAnimal(
    trunk=0.12,
    tail=0.20,
    period=0.8,
    duty_factor=0.7,
    limb_phases=(0.0, 0.5, 0.25, 0.75),
    stride=0.15,
    outward=0.06,
    lift=0.02,
    spine_bend=0.5,
    spine_rightmost=0.2,
    tail_bend=0.7,
    tail_lag=1 / 3,
    tail_wave=0.0,
)

above_us = Camera(rate=50, noise=0.002, lost=0.05, heading=2.1, scale=700.0, heights=False, seed=0)
above_it = Camera(rate=100, noise=0.0005, lost=0.05, heading=-0.7, scale=4000.0, heights=False, seed=0)
record = suchus.crawl(robot, crawl)
write_table(film(robot, record, above_us), folder / "crawl.csv")
write_table(film_animal(lizard, above_it, cycles=4), folder / "lizard.csv")

for name in ("crawl", "lizard"):
    walk = observe(read_tracks(folder / f"{name}.csv"), tail_share=driven_fraction(robot) if name == "crawl" else 1.0)
    captured = to_gait(walk, robot, crawl, name=f"{name}_walk")
    file = write_gait(captured, walk, folder / f"{name}_walk.toml")
    again = suchus.crawl(robot, captured.gait, duration=1.0 + 2 * captured.gait.period)
    print(name, *summary(walk), *(f"note: {note}" for note in captured.notes), sep="\n  ")
    print(f"  {file}: the robot walks {float(displacement(again)[0]):.2f} m in two cycles\n")
print(f"the crawl that was filmed: {float(displacement(record)[0]):.2f} m")
