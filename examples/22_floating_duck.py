"""A rubber duck that falls into waves and floats: water for any MuJoCo model.

Usage: python examples/22_floating_duck.py
"""

import mujoco

import suchus
from suchus.sim.immersion import Wave

DUCK = """
<mujoco>
  <worldbody>
    <body name="duck" pos="0 0 0.3" euler="40 0 0">
      <freejoint/>
      <geom name="belly" type="ellipsoid" size="0.08 0.06 0.05" density="120"/>
      <geom name="head" size="0.032" pos="0.05 0 0.06" density="60"/>
      <geom name="weight" size="0.012" pos="0 0 -0.035" density="8000"/>
    </body>
  </worldbody>
</mujoco>
"""

spec = suchus.wet(DUCK, waves=Wave(height=0.05, length=1.5))
model = spec.compile()
data = mujoco.MjData(model)
mujoco.mj_step(model, data, 5000)
upright = data.body("duck").xmat[8]
loads = suchus.water_loads(model, data)
body = model.body("duck").id
print(f"after {data.time:.0f} s the duck is upright to a cosine of {upright:.2f}")
print(f"its water weighs {9.81 * 1000 * loads.volume[body]:.2f} N, the duck {9.81 * model.body_mass[body]:.2f} N")
