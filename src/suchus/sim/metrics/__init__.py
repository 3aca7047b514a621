"""From a record to numbers: pure, and along whatever dimensions the record has besides time.

``metrics.decisive`` is asked for by its own name: it needs ``scipy.stats``, a fifth of the time of a command's start.
"""

from suchus.sim.metrics.bends import (
    bend_swings,
    lateral_bend,
    spine_amplitude,
    spine_sine_share,
    spine_swings,
    tail_amplitude,
    tail_joint_spread,
    tail_joint_spread_max,
    tail_swing_least,
    tail_swings,
)
from suchus.sim.metrics.energy import cost_of_transport, peak_torque, work
from suchus.sim.metrics.gait import (
    diagonal_phase_error,
    duty_factor,
    flight_share,
    foot_clearance,
    loaded,
    sensed_phase,
    two_feet_share,
)
from suchus.sim.metrics.loads import swing_height, swing_lift, swing_loads, swing_unloaded, tail_load_share
from suchus.sim.metrics.progress import (
    displacement,
    heading,
    heading_change,
    loss,
    path_length,
    path_speed,
    slip,
    speed,
)
from suchus.sim.metrics.reach import lead, longest_hold, reach, static_margin
from suchus.sim.metrics.rolling import roll_angle, roll_rate
from suchus.sim.metrics.similarity import SIMILARITY, SwimNumbers, swim_numbers
from suchus.sim.metrics.stability import (
    height_peak_to_peak,
    height_std,
    line_distance,
    line_distance_max,
    roll_peak_to_peak,
    support_distance,
    support_polygon,
    tilt,
    two_feet_alone_share,
)
from suchus.sim.metrics.window import each_cycle, first_harmonic, mean_cycle, require_complete, time_window

__all__ = [
    "SIMILARITY",
    "SwimNumbers",
    "bend_swings",
    "cost_of_transport",
    "diagonal_phase_error",
    "displacement",
    "duty_factor",
    "each_cycle",
    "first_harmonic",
    "flight_share",
    "foot_clearance",
    "heading",
    "heading_change",
    "height_peak_to_peak",
    "height_std",
    "lateral_bend",
    "lead",
    "line_distance",
    "line_distance_max",
    "loaded",
    "longest_hold",
    "loss",
    "mean_cycle",
    "path_length",
    "path_speed",
    "peak_torque",
    "reach",
    "require_complete",
    "roll_angle",
    "roll_peak_to_peak",
    "roll_rate",
    "sensed_phase",
    "slip",
    "speed",
    "spine_amplitude",
    "spine_sine_share",
    "spine_swings",
    "static_margin",
    "support_distance",
    "support_polygon",
    "swim_numbers",
    "swing_height",
    "swing_lift",
    "swing_loads",
    "swing_unloaded",
    "tail_amplitude",
    "tail_joint_spread",
    "tail_joint_spread_max",
    "tail_load_share",
    "tail_swing_least",
    "tail_swings",
    "tilt",
    "time_window",
    "two_feet_alone_share",
    "two_feet_share",
    "work",
]
