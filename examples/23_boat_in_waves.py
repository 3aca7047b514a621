"""A boat in a sea and a current: heave, pitch and drift, and a rollout of four seas on threads.

Usage: python examples/23_boat_in_waves.py
"""

import mujoco
import mujoco.rollout
import numpy as np

import suchus
from suchus.sim.immersion import Current, sea

HULL = "".join(
    f'<geom type="box" size="0.25 {width} 0.15" pos="{x} 0 0" density="250"/>'
    for x, width in ((-0.75, 0.3), (-0.25, 0.35), (0.25, 0.3), (0.75, 0.15))
)
BOAT = f"""
<mujoco>
  <worldbody>
    <body name="boat" pos="0 0 0.05">
      <freejoint/>
      {HULL}
      <geom name="keel" type="box" size="0.5 0.01 0.1" pos="0 0 -0.24" density="7800"/>
    </body>
  </worldbody>
</mujoco>
"""
DURATION = 20.0


def motion(seed: int) -> np.ndarray:
    """Return the states of the boat in one sea, shape (step, state): time, position, orientation, velocity."""
    waves = sea(0.3, 2.5, heading=np.pi, seed=seed)
    model = suchus.wet(BOAT, waves=waves, current=Current(velocity=(0.2, 0.0)), lift=1.5).compile()
    data = mujoco.MjData(model)
    state = np.zeros(mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_FULLPHYSICS))
    mujoco.mj_getState(model, data, state, mujoco.mjtState.mjSTATE_FULLPHYSICS)
    steps = round(DURATION / model.opt.timestep)
    states, _ = mujoco.rollout.rollout(model, data, state, nstep=steps)
    return states[0]


for seed in range(4):
    states = motion(seed)
    height, w, y = states[:, 3], states[:, 4], states[:, 6]
    pitch = np.degrees(2 * np.arctan2(y, w))
    print(
        f"sea {seed}: heave {4 * height.std():.2f} m, pitch up to {np.abs(pitch).max():.0f} degrees, drifted "
        f"{states[-1, 1]:.1f} m in {DURATION:.0f} s"
    )
