"""How much memory and time runs on land take, estimated before they begin."""

from collections.abc import Sequence

from suchus.core import large
from suchus.robot.design import layout, servo_names
from suchus.sim.land.run import Run
from suchus.sim.record import EFFORT

_SECONDS = 5e-6  # of a processor for each hinge and physics step; 4 to 12 us were measured, of one run and of many
_PER_SAMPLE = 33  # numbers that every record has at each sample, whatever the body
_PER_SERVO = 4 + len(EFFORT)  # angle, speed, torque, target and effort
_PER_LIMB = 13  # four vectors and the phase
_COPIES = 2  # a record and the arrays that it is made of


def record_bytes(run: Run, samples: float) -> float:
    """Return an estimate of what the record of a run takes in memory [bytes].

    Args:
        run: whose.
        samples: how many samples it keeps [-].
    """
    robot_layout = layout(run.robot)
    numbers = (
        len(robot_layout.hinges) + _PER_SERVO * len(servo_names(run.robot)) + _PER_LIMB * len(robot_layout.limb_names)
    )
    return 8.0 * samples * (_PER_SAMPLE + numbers + 3 * len(run.robot.axis))


def processor_seconds(run: Run, duration: float, timestep: float) -> float:
    """Return an estimate of the processor time of a run on land [s].

    Args:
        run: which.
        duration: duration of the run [s].
        timestep: time step of the physics [s].
    """
    return _SECONDS * len(layout(run.robot).hinges) * duration / timestep


def check_extent(runs: Sequence[Run], duration: float, timestep: float, period: float, sample_stride: int) -> None:
    """Refuse runs that the machine cannot hold, or that compute for longer than a day, see ``suchus.core.large``.

    Args:
        runs: runs that are simulated together.
        duration: duration of each [s].
        timestep: time step of the physics [s].
        period: control period [s].
        sample_stride: control periods for each sample that is kept [-].

    Raises:
        InvalidDesign: with the estimate.
    """
    subject = f"a batch of {len(runs)} runs of {duration:g} s" if len(runs) > 1 else f"a run of {duration:g} s"
    samples = duration / period / sample_stride
    need = _COPIES * sum(record_bytes(run, samples) for run in runs)
    large.check_memory(subject, need, "ask for fewer or shorter runs, or keep one sample of many (every)")
    seconds = sum(processor_seconds(run, duration, timestep) for run in runs)
    large.check_work(subject, seconds, "ask for fewer or shorter runs, or a longer time step")
