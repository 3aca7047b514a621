"""What water adds to MuJoCo's step: a model of 20 geoms, dry, and wet in several ways, taking turns on one thread.

Usage: python bench/bench_wet.py
"""

import time

import mujoco
import numpy as np

from form import in_form
from suchus.sim.immersion import sea, wet

STEPS = in_form(400, 5)
TURNS, WARM = in_form(40, 1), in_form(4, 1)  # the first WARM turns do not count
KINDS = (
    'type="sphere" size="0.05"',
    'type="capsule" size="0.03 0.06"',
    'type="ellipsoid" size="0.08 0.05 0.03"',
    'type="cylinder" size="0.04 0.06"',
    'type="box" size="0.08 0.05 0.03"',
)
SEA = sea(0.05, 2.0, count=12)


def legged() -> str:
    """Return a trunk with eight legs of two links on the ground, 20 geoms in all."""
    legs = ""
    for i in range(8):
        x, y, side = 0.12 * (i // 2) - 0.18, 0.08 * (-1) ** i, (-1) ** i
        legs += (
            f'<body pos="{x} {y} 0"><joint axis="1 0 0" damping="0.1" stiffness="5"/>'
            f'<geom type="capsule" fromto="0 0 0 0 {0.08 * side} 0.02" size="0.02" density="500"/>'
            f'<body pos="0 {0.08 * side} 0.02"><joint axis="1 0 0" damping="0.1" stiffness="5"/>'
            f'<geom type="capsule" fromto="0 0 0 0 {0.02 * side} -0.12" size="0.015" density="500"/></body></body>'
        )
    trunk = "".join(
        f'<geom type="box" size="0.07 0.06 0.03" pos="{x} 0 0" density="500"/>' for x in (-0.21, -0.07, 0.07, 0.21)
    )
    return (
        '<mujoco><worldbody><geom type="plane" size="5 5 0.1"/><body pos="0 0 0.16"><freejoint/>'
        f"{trunk}{legs}</body></worldbody></mujoco>"
    )


def adrift() -> str:
    """Return 20 free bodies at the surface, four of each kind of geom."""
    bodies = "".join(
        f'<body pos="{0.4 * (i % 5)} {0.4 * (i // 5)} 0.01"><freejoint/><geom {KINDS[i % 5]} density="500"/></body>'
        for i in range(20)
    )
    return f"<mujoco><worldbody>{bodies}</worldbody></mujoco>"


ARMS = {
    "legged robot on the ground": (legged(), {
        "wet far below": {"level": -10.0},
        "wading": {"level": 0.08},
        "under water": {"level": 5.0},
        "in a sea of 12 waves": {"level": 0.1, "waves": SEA},
    }),
    "20 free bodies at the surface": (adrift(), {
        "afloat": {},
        "under water": {"level": 5.0},
        "in a sea of 12 waves": {"waves": SEA},
    }),
}  # fmt: skip


class Arm:
    """A model that is stepped turn by turn from one state."""

    def __init__(self, spec: mujoco.MjSpec) -> None:
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        mujoco.mj_step(self.model, self.data, STEPS)
        self.start = np.array(self.data.qpos)

    def turn(self) -> float:
        """Return the processor time of a step, over a turn that begins where the others began [s]."""
        self.data.qpos[:], self.data.qvel[:] = self.start, 0.0
        start = time.process_time()
        mujoco.mj_step(self.model, self.data, STEPS)
        return (time.process_time() - start) / STEPS


def main() -> None:
    """Print the time of a step, and how much longer it takes in water."""
    print(f"{TURNS} turns of {STEPS} steps each; microseconds of processor time, and the median ratio to dry")
    for name, (xml, waters) in ARMS.items():
        arms = {"dry": Arm(mujoco.MjSpec.from_string(xml))}
        arms |= {words: Arm(wet(xml, **options)) for words, options in waters.items()}
        times = np.array([[arm.turn() for arm in arms.values()] for _ in range(WARM + TURNS)])[WARM:]
        ratios = np.median(times / times[:, :1], axis=0)
        print(name)
        for words, step, ratio in zip(arms, 1e6 * times.min(axis=0), ratios, strict=True):
            print(f"  {words:22s} {step:7.1f}  ratio {ratio:.2f}")


if __name__ == "__main__":
    main()
