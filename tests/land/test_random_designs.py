"""Random designs and gaits: a valid finite run or a SuchusError, nothing else."""

from dataclasses import replace
from math import radians

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.metres import with_metres

from suchus.core.errors import SuchusError
from suchus.robot.design import crocodile, servo_names
from suchus.sim.land import Ground, Limp, Locked, Run, Weak, simulate


def maybe_bad(low: float, high: float):
    """Mostly plausible numbers, sometimes nonsense."""
    return st.one_of(
        st.floats(low, high), st.floats(low, high), st.sampled_from([0.0, -1.0, 1e9, float("nan"), float("inf")])
    )


designs = st.fixed_dictionaries(
    {},
    optional={
        "femur": maybe_bad(0.03, 0.2),
        "tibia": maybe_bad(0.03, 0.2),
        "mass": maybe_bad(0.05, 0.6),
        "foot_radius": maybe_bad(0.005, 0.03),
    },
)
gaits = st.fixed_dictionaries(
    {},
    optional={
        "period": maybe_bad(0.5, 8.0),
        "duty_factor": maybe_bad(0.2, 0.9),
        "stroke": maybe_bad(0.0, 0.12),
        "lift": maybe_bad(0.0, 0.06),
        "hip_height": maybe_bad(0.03, 0.15),
        "trunk_bend": maybe_bad(0.0, radians(140)),
        "spine_phase": maybe_bad(-0.5, 0.5),
        "tail_pitch": maybe_bad(-1.0, 1.0),
    },
)
faults = st.lists(
    st.one_of(
        st.builds(Limp, st.sampled_from(servo_names()), st.floats(0, 0.3)),
        st.builds(Locked, st.sampled_from(servo_names()), st.floats(0, 0.3), st.none() | st.floats(-1, 1)),
        st.builds(Weak, st.sampled_from(servo_names()), maybe_bad(0, 1), st.floats(0, 0.3)),
    ),
    max_size=3,
)


@settings(max_examples=60)
@given(design=designs, changes=gaits, broken=faults, grip=maybe_bad(0.3, 1.5), seed=st.integers(0, 9))
def test_a_finite_run_or_a_suchus_error(robot, crawl_gait, design, changes, broken, grip, seed):
    try:
        other = crocodile(replace(robot.tables, hind_leg=replace(robot.tables.hind_leg, **design)))
        run = Run(
            robot=other,
            gait=with_metres(crawl_gait, **changes),
            ground=Ground(friction_scale=grip),
            faults=tuple(broken),
            noise=0.01,
            seed=seed,
        )
        record = simulate([run], duration=0.4, timestep=0.005).isel(run=0)
    except SuchusError as refusal:
        sentence = str(refusal)
        record = None
    if record is None:
        assert sentence
        assert "\n" not in sentence
        return
    lived = record.sel(time=slice(None, float(record.ended) + 1e-9))
    assert np.isfinite(lived.position.values).all()
    assert float(record.ended) == float(record.time[-1]) or str(record.cause.values)
