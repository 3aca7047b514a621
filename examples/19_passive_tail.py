"""A passive tail of one's own: how soft may its end be? Robot and flow are solved together, in a slice of water."""

import suchus
from suchus.robot.control import Swimming
from suchus.robot.design import with_spring
from suchus.sim.land.waters import Slice
from suchus.swimming.coupling import simulate
from suchus.swimming.water import swim_of

robot = suchus.ROBOTS["floating_caiman"]
gait = swim_of(robot, frequency=1.0)  # (20) on the joints; the cable and the passive end share the rest with the water
water = Slice(cells=64, reynolds=3000.0)  # Space(cells=80) is the body itself
fin = [hinge.name for hinge in robot.axis_hinges if hinge.name.startswith("fin_yaw")]
for stiffness in (0.1, 0.4, 1.6):  # [N m/rad]
    limber = with_spring(robot, fin, stiffness)
    record = simulate([suchus.Run(robot=limber, gait=gait, water=water, control=Swimming())], duration=2.0).isel(run=0)
    last = record.sel(time=slice(1.0, None))
    x = last.centre_of_mass.sel(xyz="x")
    bend = float(last.joint_angle.sel(joint=fin).sum("joint").std())
    way, closed = float(x[-1] - x[0]), abs(float(record.energy_error[-1]))
    print(f"{stiffness:.1f} N m/rad: {way:.3f} m in the second cycle, the end bent by {bend:.2f} rad rms")
    print(f"    energy closed to {closed:.1%}")
