"""A quadruped that paddles through a pool to a beach: ground and water at once.

Usage: python examples/25_quadruped_in_a_pool.py [PICTURE.png]
"""

import sys

import mujoco
import numpy as np
from matplotlib import pyplot
from scipy.spatial import ConvexHull

import suchus

LEVEL = 0.55


def leg(name: str, x: float, y: float) -> str:
    """Return a leg of two links at a corner of the trunk.

    Args:
        name: its name.
        x: position of the hip forward [m].
        y: position of the hip to the left [m].
    """
    return f"""
      <body name="{name}" pos="{x} {y} -0.03">
        <joint name="{name}_hip" axis="0 1 0" range="-80 80" damping="1"/>
        <geom type="capsule" fromto="0 0 0 0 0 -0.18" size="0.03" density="900"/>
        <body pos="0 0 -0.18">
          <joint name="{name}_knee" axis="0 1 0" range="-5 120" damping="0.5"/>
          <geom type="box" size="0.012 0.045 0.08" pos="0 0 -0.09" density="900"/>
          <geom type="sphere" size="0.03" pos="0 0 -0.18" density="900" friction="1.2"/>
        </body>
      </body>"""


LEGS = {"LF": (0.22, 0.13), "RF": (0.22, -0.13), "LH": (-0.22, 0.13), "RH": (-0.22, -0.13)}
XML = f"""
<mujoco>
  <option timestep="0.002"/>
  <worldbody>
    <geom name="bottom" type="plane" size="5 5 0.1"/>
    <geom name="beach" type="box" size="1.5 2 0.5" pos="2.4 0 -0.1" euler="0 -12 0"/>
    <body name="trunk" pos="0 0 0.55">
      <freejoint/>
      <geom type="box" size="0.3 0.1 0.07" density="520"/>
      <geom type="sphere" size="0.08" pos="0.36 0 0.08" density="400"/>
      {"".join(leg(name, x, y) for name, (x, y) in LEGS.items())}
    </body>
  </worldbody>
  <actuator>
    {"".join(f'<position joint="{name}_{part}" kp="30"/>' for name in LEGS for part in ("hip", "knee"))}
  </actuator>
</mujoco>
"""


def command(time: float, yaw: float) -> np.ndarray:
    """Return the angles of hips and knees: paddles go back stretched and forward folded, diagonal legs together.

    Args:
        time: [s].
        yaw: heading, to the left positive [rad]; legs on the side to which it turned stroke farther.
    """
    angles = []
    for name, (_, y) in LEGS.items():
        stroke = 0.6 * min(max(1.0 + np.sign(y) * yaw, 0.3), 1.5)
        phase = 2 * np.pi * 1.2 * time + (np.pi if name in ("LF", "RH") else 0.0)
        angles += [0.2 + stroke * np.sin(phase), 0.9 - 0.8 * np.cos(phase)]
    return np.array(angles)


def swim(duration: float) -> tuple[mujoco.MjModel, mujoco.MjData, list[tuple[float, float, int]]]:
    """Return model and data after a swim, and time, displaced water over weight and contacts along it.

    Args:
        duration: [s].
    """
    model = suchus.wet(XML, level=LEVEL).compile()
    data = mujoco.MjData(model)
    history = []
    while data.time < duration:
        data.ctrl[:] = command(data.time, 2.0 * np.arctan2(data.qpos[6], data.qpos[3]))
        mujoco.mj_step(model, data, 10)
        carried = 1000.0 * suchus.water_loads(model, data).volume.sum() / model.body_subtreemass[0]
        history.append((data.time, carried, data.ncon))
    return model, data, history


def draw(path: str) -> None:
    """Draw the robot from the side, swimming and on the beach.

    Args:
        path: file to write.
    """
    rng = np.random.default_rng(0)
    points = rng.normal(size=(400, 3))
    points /= np.linalg.norm(points, axis=1)[:, None]
    figure, axes = pyplot.subplots(figsize=(9.0, 2.9), layout="constrained")
    for duration, colour in ((0.2, "#1b6ca8"), (2.5, "#3a9188"), (5.0, "#c2571a")):
        model, data, _ = swim(duration)
        for i in range(model.ngeom):
            kind, size = model.geom_type[i], model.geom_size[i]
            if kind == mujoco.mjtGeom.mjGEOM_PLANE:
                continue
            if kind == mujoco.mjtGeom.mjGEOM_BOX:
                shape = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * size
            else:
                length = size[1] if kind == mujoco.mjtGeom.mjGEOM_CAPSULE else 0.0
                shape = points * size[0] + np.sign(points[:, 2:]) * [0.0, 0.0, length]
            world = shape @ data.geom_xmat[i].reshape(3, 3).T + data.geom_xpos[i]
            outline = world[:, [0, 2]][ConvexHull(world[:, [0, 2]]).vertices]
            is_ground = model.geom_bodyid[i] == 0
            axes.fill(
                *outline.T, color="#b9a17a" if is_ground else colour, ec="white", lw=0.6, zorder=1 if is_ground else 3
            )
        axes.text(data.qpos[0], data.qpos[2] + 0.28, f"{duration:g} s", ha="center", color=colour)
    axes.axhspan(0.0, LEVEL, color="#9ecbe8", zorder=0)
    axes.axhline(0.0, color="#b9a17a", lw=3)
    axes.set(xlim=(-0.8, 3.6), ylim=(-0.05, 1.3), aspect="equal", xlabel="forward [m]", ylabel="up [m]")
    figure.savefig(path, dpi=90)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        draw(sys.argv[1])
    model, data, history = swim(5.0)
    carried = np.array([row[1] for row in history])
    print(f"the quadruped paddles {data.qpos[0]:.2f} m in {data.time:.0f} s")
    print(f"water carries between {carried.min():.0%} and {carried.max():.0%} of its weight, the ground the rest")
