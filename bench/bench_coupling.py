"""What a coupled swim costs beside one along the commanded midline: processor time of both in one process.

Ratios travel, times do not. Both swim the same grid, the motion of ``suchus run swim_3d``, in space or, with
``--plane``, in a slice; each is measured from a
quarter of a second on, when kernels are loaded and the first added mass is known.
"""

import argparse
from time import process_time

from form import SHORT, in_form
from suchus import flow
from suchus.core.progress import silent
from suchus.experiments.catalog import EXPERIMENTS
from suchus.robot.control import Swimming
from suchus.robot.motion import LIMBS_BACK, with_limbs
from suchus.sim.land.run import Run
from suchus.sim.land.waters import Slice, Space
from suchus.swimming.coupling import Swim
from suchus.swimming.coupling.on_joints import floating
from suchus.swimming.water import fit, printed_wave
from suchus.swimming.water.setting import GROWS, SwimSetting
from suchus.swimming.water.swim_setup import ResolvedSwim

BEGIN = in_form(0.25, 0.02)
"""Time from which it is measured [s]."""


def spent(go, until):
    """Return the processor time that going on from ``BEGIN`` until a time takes [s]."""
    go(BEGIN)
    start = process_time()
    go(until)
    return process_time() - start


def main():
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--cells", type=int, default=in_form(80, 32), help="per body length")
    options.add_argument(
        "--until", type=float, default=in_form(1.25, 0.08), help="time that is swum, more than 0.25 [s]"
    )
    options.add_argument("--plane", action="store_true", default=SHORT, help="swim in a slice")
    options.add_argument("--tail-height", type=float, default=0.0, help="of a fin on the last third [m]")
    chosen = options.parse_args()
    question = EXPERIMENTS["swim_3d"]
    wave = printed_wave(question.robot, question.reading, frequency=question.frequency, sign=-1)
    gait = fit(question.robot, wave).gait
    setting = SwimSetting(
        axes=2 if chosen.plane else 3, cells=chosen.cells, viscosity=question.viscosity, cycles=2,
        tail_height=chosen.tail_height,
    )  # fmt: skip
    reynolds = question.robot.length**2 / (gait.period * question.viscosity)
    alone = flow.Simulation(ResolvedSwim(robot=question.robot, motion=gait, setting=setting).setup, thread_count=1)
    run = Run(
        robot=floating(question.robot), gait=with_limbs(question.robot, gait, LIMBS_BACK),
        water=Slice(cells=chosen.cells, reynolds=reynolds) if chosen.plane else Space(
            cells=chosen.cells, reynolds=reynolds, tail_height=chosen.tail_height
        ),
        control=Swimming(ramp=GROWS * gait.period),
    )  # fmt: skip
    whole = Swim(run, chosen.until, thread_count=1)
    commanded = spent(lambda time: alone.run(time, progress=False), chosen.until)
    coupled = spent(lambda time: whole.go(time, progress=silent), chosen.until)
    steps = len(alone.record.time), len(whole.series.time)
    later = [residual for time, residual in zip(whole.series.time, whole.series.residual, strict=True) if time > BEGIN]
    print(
        f"{chosen.cells} cells a length, {BEGIN:g} to {chosen.until:g} s, one thread: commanded {commanded:.1f} s in "
        f"{steps[0]} steps, coupled {coupled:.1f} s in {steps[1]} steps, {coupled / commanded:.2f} times; "
        f"{sum(whole.series.corrections) / steps[1]:.2f} corrections a step, added mass {len(whole.series.radius)} "
        f"times anew, at most {max(left for _, left in later):.4f} left over"
    )


if __name__ == "__main__":
    main()
