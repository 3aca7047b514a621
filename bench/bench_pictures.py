"""Pictures per second of ``render_mode="rgb_array"``, without OpenGL, for robots on land and in water.

The time is that of the processor. What a picture takes beside a step of the same environment is its ratio.
"""

import time

import gymnasium
import numpy as np

import suchus.apps.envs  # noqa: F401  makes the names known
from form import in_form

COUNT = in_form(20, 2)
CASES = (("Crawl", "caiman"), ("Crawl", "strider"), ("Swim", "floating_caiman"), ("Shore", "floating_caiman"))


def main() -> None:
    """Print a line for each task and robot."""
    for task, robot in CASES:
        env = gymnasium.make(f"suchus/{task}-v0", robot=robot, render_mode="rgb_array").unwrapped
        env.reset(seed=0)
        env.render()
        action = np.zeros(env.action_space.shape, dtype=np.float32)
        step_times, picture_times = [], []
        for _ in range(COUNT):
            start = time.process_time()
            env.step(action)
            middle = time.process_time()
            env.render()
            step_times.append(middle - start)
            picture_times.append(time.process_time() - middle)
        step_time, picture_time = float(np.median(step_times)), float(np.median(picture_times))
        print(
            f"{task:<6} {robot:<16} {1.0 / picture_time:5.0f} pictures/s, each as long as "
            f"{picture_time / step_time:4.1f} steps"
        )


if __name__ == "__main__":
    main()
