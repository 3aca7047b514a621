"""A remotely operated vehicle (ROV) with four thrusters: it trims, dives to a depth and holds it in a current.

Usage: python examples/24_rov.py
"""

import mujoco

import suchus
from suchus.sim.immersion import Current, GeomCoefficients

ROV = """
<mujoco>
  <worldbody>
    <body name="rov" pos="0 0 -0.5">
      <freejoint/>
      <geom name="frame" type="box" size="0.23 0.17 0.06" pos="0 0 -0.05" density="1040"/>
      <geom name="foam" type="box" size="0.2 0.15 0.04" pos="0 0 0.05" density="890"/>
      <site name="left" pos="-0.15 0.1 0" zaxis="1 0 0"/>
      <site name="right" pos="-0.15 -0.1 0" zaxis="1 0 0"/>
      <site name="up_front" pos="0.1 0 0.1"/>
      <site name="up_rear" pos="-0.1 0 0.1"/>
    </body>
  </worldbody>
  <actuator>
    <motor name="left" site="left" gear="0 0 1 0 0 0" ctrlrange="-40 40"/>
    <motor name="right" site="right" gear="0 0 1 0 0 0" ctrlrange="-40 40"/>
    <motor name="up_front" site="up_front" gear="0 0 1 0 0 0" ctrlrange="-40 40"/>
    <motor name="up_rear" site="up_rear" gear="0 0 1 0 0 0" ctrlrange="-40 40"/>
  </actuator>
</mujoco>
"""
DEPTH = 3.0

frame = GeomCoefficients(drag=(1.0, 1.2, 1.4), linear_drag=4.0, linear_turning_drag=0.2)
model = suchus.wet(
    ROV, level=0.0, density=1025.0, coefficients={"frame": frame}, current=Current(velocity=(-0.2, 0.0))
).compile()
data = mujoco.MjData(model)
while data.time < 40.0:
    error, rate = -DEPTH - data.qpos[2], data.qvel[2]
    lift = 300.0 * error - 120.0 * rate
    pitch = 2.0 * data.qpos[5]
    data.actuator("up_front").ctrl = lift / 2 + 20.0 * pitch
    data.actuator("up_rear").ctrl = lift / 2 - 20.0 * pitch
    ahead = -20.0 * data.qpos[0] - 40.0 * data.qvel[0]
    data.actuator("left").ctrl = data.actuator("right").ctrl = ahead
    mujoco.mj_step(model, data)
print(f"after {data.time:.0f} s it is {-data.qpos[2]:.2f} m deep and {data.qpos[0]:+.2f} m from where it began")
print(f"against the current its thrusters push with {2 * data.actuator('left').ctrl[0]:.1f} N")
