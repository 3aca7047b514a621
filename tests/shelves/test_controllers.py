"""What holds for every controller on the shelf, on the caiman in its crawl."""

from dataclasses import FrozenInstanceError, fields, is_dataclass, replace

import numpy as np
import pytest
from tests.felt import felt

from suchus.core.sources import snake
from suchus.robot.control import (
    CONTROLLERS,
    LAWS,
    SENSED,
    Control,
    Coordinated,
    HeadingHold,
    HeadingRule,
    LoadRule,
    OpenLoop,
    PatternGenerator,
    Runs,
    Standing,
    Swimming,
    needs,
)
from suchus.sim.land import Run, simulate

SHORT = 1.3
"""Duration of a walk, of which 1 s is settling [s]."""


@pytest.fixture(params=list(CONTROLLERS))
def control(request):
    """A value of each kind: the first of the ``examples`` beside it, or what its defaults give."""
    examples = CONTROLLERS.beside(request.param, "examples", ())
    return examples[0] if examples else CONTROLLERS[request.param]()


def walk(robot, gait, *controls):
    runs = [Run(robot=robot, gait=gait, control=control, noise=0.01, seed=3) for control in controls]
    return simulate(runs, duration=SHORT, timestep=0.01)


def test_it_is_called_as_its_class_and_is_a_frozen_value(control):
    assert CONTROLLERS[snake(type(control).__name__)] is type(control)
    assert isinstance(control, Control)
    assert is_dataclass(control)
    assert control == replace(control)
    assert hash(control) == hash(replace(control))
    for field in fields(control)[:1]:
        with pytest.raises(FrozenInstanceError):
            setattr(control, field.name, None)


def test_it_commands_every_servo_and_answers_the_same_twice_to_the_byte(control, robot, crawl_gait):
    record = walk(robot, crawl_gait, control)
    assert np.isfinite(record.servo_target.values).all()
    assert record.servo_target.std() > 0.0
    assert record.identical(walk(robot, crawl_gait, control))


def test_a_run_comes_out_the_same_alone_and_beside_others(control, robot, crawl_gait):
    alone = walk(robot, crawl_gait, control)
    beside = walk(robot, replace(crawl_gait, period=3.0), control)
    runs = [
        Run(robot=robot, gait=gait, control=control, noise=0.01, seed=3)
        for gait in (crawl_gait, replace(crawl_gait, period=3.0))
    ]
    both = simulate(runs, duration=SHORT, timestep=0.01)
    for i, single in enumerate((alone, beside)):
        for name in ("position", "servo_target", "joint_angle"):
            assert both[name].isel(run=i).values.tobytes() == single[name].isel(run=0).values.tobytes(), name


def test_it_says_what_it_feels_and_nothing_else_counts(control, robot, crawl_gait):
    """A robot that has only the sensors it names does the same."""
    named = needs(control)
    assert bool(named) == control.feels
    if not control.feels:
        return
    seen, rng = felt(robot, foot_pressure=2.0), np.random.default_rng(0)
    lacking = {name: getattr(seen, name) * np.nan for name in set(SENSED) - set(named)}
    other = {name: rng.standard_normal(value.shape) for name, value in lacking.items()}
    commands = []
    for unnamed in (lacking, other):
        controller = control.start(Runs.identical(control, robot, crawl_gait, ticks=400), 0.01)
        ticks = [controller.command(tick, replace(seen, time=0.01 * tick, **unnamed)) for tick in range(0, 400, 4)]
        commands.append(np.array([command.targets for command in ticks]))
    assert np.isfinite(commands[0]).all()
    assert commands[0].tobytes() == commands[1].tobytes()


@pytest.mark.parametrize(
    ("control", "felt_by_it"),
    [
        (OpenLoop(), ()),
        (Coordinated(), ("servo_position", "servo_torque", "foot_pressure")),
        (
            Coordinated(limbs=LAWS["off"], spine=None, tail=None, heading=HeadingRule()),
            ("servo_position", "orientation"),
        ),
        (PatternGenerator(load=LoadRule()), ("foot_pressure", "belly_pressure", "tail_pressure")),
        (Swimming(heading=HeadingHold()), ("servo_position", "orientation")),
        (Standing(at=0.1, hold=0.1, balance=None), ()),
    ],
    ids=lambda value: type(value).__name__,
)
def test_what_is_needed_follows_from_the_rules_that_are_on(control, felt_by_it):
    assert needs(control) == felt_by_it


def test_a_control_that_does_not_say_what_it_feels_needs_everything():
    class Silent:
        feels = True

    class Deaf:
        feels = False

    assert needs(Silent()) == SENSED
    assert needs(Deaf()) == ()
