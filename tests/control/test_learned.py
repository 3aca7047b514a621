"""A trained policy as a control: its table, its network, its symmetry, its file, and what is refused."""

import io
import pickle
import warnings
import zipfile
from dataclasses import replace

import numpy as np
import pytest
from tests.felt import felt

from suchus.core.errors import Doubtful, InvalidDesign, UnknownName, UnreadableFile, UnsuitedRobot
from suchus.robot.control import Learned, OpenLoop, Policy, Runs, load_policy, save_policy
from suchus.robot.control.observation import ROBOT_READINGS, observation_layout
from suchus.robot.control.onnx_file import export_onnx
from suchus.robot.control.policy import (
    ACTIONS,
    Layer,
    Networks,
    Replicate,
    action_mirror,
    interpolate,
    mirror_shift,
    observation_mirror,
    policy_bytes,
    robot_digest,
    servo_mirror,
)
from suchus.robot.design import layout
from suchus.robot.gaits import GAITS, default_gait
from suchus.robot.motion import Steer, movement
from suchus.robot.robots import ROBOTS

CAIMAN, STRIDER = ROBOTS["caiman"], ROBOTS["strider"]
PERIOD = 0.01
NAMES = ("rate", "stroke", "asymmetry", "bend")
READINGS = ("command", "clock", "upward", "angular_velocity", "heading_error", "tracking_error")


def table_policy(robot=CAIMAN, gait=None, *, table=None, speeds=(0.0, 0.1), turns=(0.0, 0.4), names=NAMES, **fields):
    place, gait = layout(robot), gait or default_gait(robot)
    neutral = tuple(ACTIONS[name].neutral for name in names)
    return Policy(
        name="test", task="velocity", robot=robot.name, robot_digest=robot_digest(robot), length=robot.length,
        mass=robot.mass, servos=place.servos, limbs=place.limb_names, gait=gait, speeds=speeds, turns=turns,
        parameters=names, table=table or ((neutral,) * len(turns),) * len(speeds), **fields,
    )  # fmt: skip


def network_policy(
    robot=CAIMAN, *, seed=0, hidden=0, readings=READINGS, actions=("stroke", "bend", "limb_stroke"), **fields
):
    random = np.random.default_rng(seed)
    inputs = observation_layout(robot, readings)[-1].columns.stop
    limbs = len(layout(robot).limbs)
    outputs = sum(limbs if ACTIONS[name].per_limb else 1 for name in actions)
    sizes = [(inputs, hidden), (hidden, outputs)] if hidden else [(inputs, outputs)]
    layers = tuple(
        Layer(
            tuple(map(tuple, (0.3 * random.standard_normal(size)).tolist())),
            tuple((0.1 * random.standard_normal(size[1])).tolist()),
        )
        for size in sizes
    )
    return table_policy(robot, actions=actions, spans=(0.3,) * outputs, readings=readings, layers=layers, **fields)


def commands(control, robot, ticks=150, gait=None):
    """Return the servo angles of a control that feels nothing in particular, shape (tick, servo)."""
    controller = control.start(Runs.identical(control, robot, gait or default_gait(robot), ticks=ticks), PERIOD)
    sensed = felt(robot) if control.feels else None
    return np.array([controller.command(tick, sensed).targets[0] for tick in range(ticks)])


@pytest.mark.parametrize("name", ["caiman", "strider", "swimmer", "pleurobot"])
def test_a_neutral_table_plays_the_gait_as_it_is(name):
    robot = ROBOTS[name]
    names = tuple(n for n in ("rate", "stroke", "wave") if n != "stroke" or default_gait(robot).has("strokes"))
    control = Learned(policy=table_policy(robot, names=names), forward=0.1)
    assert commands(control, robot) == pytest.approx(commands(OpenLoop(), robot), abs=1e-9)


def test_the_table_is_interpolated_and_odd_parameters_change_sign_for_the_other_side():
    table = (((0.0, 1.0, 0.0, 0.0), (0.0, 1.0, 1.0, 0.2)), ((1.0, 0.5, 0.0, 0.0), (2.0, 0.9, 0.6, 0.4)))
    policy = table_policy(table=table)
    places = [[name for name, action in ACTIONS.items() if not action.per_limb].index(name) for name in NAMES]
    assert interpolate(policy, 0.1, 0.4)[places] == pytest.approx((2.0, 0.9, 0.6, 0.4))
    assert interpolate(policy, 0.05, 0.2)[places] == pytest.approx((0.75, 0.85, 0.4, 0.15))
    assert interpolate(policy, 0.05, -0.2)[places] == pytest.approx((0.75, 0.85, -0.4, -0.15))
    assert np.array_equal(interpolate(policy, 9.0, 9.0), interpolate(policy, 0.1, 0.4))


def test_the_rate_is_the_speed_of_the_clock():
    fast = table_policy(table=(((2.0, 1.0, 0.0, 0.0),) * 2,) * 2)
    control = Learned(policy=fast, forward=0.1)
    controller = control.start(Runs.identical(control, CAIMAN, fast.gait, ticks=300), PERIOD)
    phases = [controller.command(tick, None).phase[0, 0] for tick in range(300)]
    assert phases[299] - phases[199] == pytest.approx(2.0 * 100 * PERIOD / fast.gait.period, abs=1e-9)
    assert phases[100] == phases[0]


def test_a_file_gives_the_same_policy_and_the_same_bytes(tmp_path):
    policy = network_policy(hidden=5, training=(("seed", "3"), ("note", "none")))
    path = save_policy(policy, tmp_path / "one.npz")
    again = load_policy(path)
    assert again == policy
    assert hash(again) == hash(policy)
    assert policy_bytes(again) == path.read_bytes()
    assert len(path.read_bytes()) < 300_000


def test_what_is_no_policy_is_refused_and_nothing_is_unpickled(tmp_path):
    good = policy_bytes(table_policy())
    fired = tmp_path / "fired"

    class Bomb:
        def __reduce__(self):
            return (open, (str(fired), "w"))

    bomb = tmp_path / "bomb.npz"
    np.savez(bomb, format=np.array(1), name=np.array([Bomb()], dtype=object))
    with pytest.raises(UnreadableFile, match="holds Python objects"):
        load_policy(bomb)
    raw = tmp_path / "raw.npz"
    raw.write_bytes(pickle.dumps(Bomb()))
    with pytest.raises(UnreadableFile, match="damaged"):
        load_policy(raw)
    assert not fired.exists()
    for number, content in enumerate((good[: len(good) // 2], good[:-400], b"", b"PK\x03\x04 nothing")):
        path = tmp_path / f"{number}.npz"
        path.write_bytes(content)
        with pytest.raises(UnreadableFile, match="damaged"):
            load_policy(path)
    np.savez(tmp_path / "other.npz", x=np.zeros(3))
    with pytest.raises(UnreadableFile, match="lacks format"):
        load_policy(tmp_path / "other.npz")
    np.savez(tmp_path / "large.npz", x=np.random.default_rng(0).random(10**5))
    with pytest.raises(UnreadableFile, match="at most"):
        load_policy(tmp_path / "large.npz")


def rewritten(path, name, value):
    """Return a copy of a policy's file in which an array has another value."""
    with np.load(path) as arrays:
        values = {key: arrays[key] for key in arrays.files} | {name: value}
    content = io.BytesIO()
    np.savez(content, **values)
    other = path.with_name(f"{name}.npz")
    other.write_bytes(content.getvalue())
    return other


def test_a_file_with_impossible_numbers_is_refused(tmp_path):
    path = save_policy(network_policy(), tmp_path / "one.npz")
    with pytest.raises(UnreadableFile, match="not finite"):
        load_policy(rewritten(path, "table", np.full((2, 2, 4), np.nan)))
    with pytest.raises(UnreadableFile, match="has not the shape"):
        load_policy(rewritten(path, "table", np.zeros((2, 2, 3))))
    with pytest.raises(UnreadableFile, match="this version of suchus reads 1"):
        load_policy(rewritten(path, "format", np.array(99)))
    with pytest.raises(UnreadableFile, match="parameter 'teleport'"):
        load_policy(rewritten(path, "parameters", np.array(["rate", "stroke", "asymmetry", "teleport"])))


def test_a_bomb_of_zeros_is_not_unpacked(tmp_path):
    path = tmp_path / "zeros.npz"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("format.npy", b"\0" * 10**7)
    with pytest.raises(UnreadableFile, match="unpacks to more"):
        load_policy(path)


def test_another_robot_is_refused_with_what_differs():
    policy = table_policy()
    with pytest.raises(UnsuitedRobot, match="with 4 limbs; robot 'strider' has 6 and has LM, RM"):
        policy.check_robot(STRIDER)
    with pytest.raises(UnsuitedRobot, match=r"1\.25 times"):
        replace(policy, mass=2 * CAIMAN.mass).check_robot(CAIMAN)
    control = Learned(policy=policy, forward=0.05)
    with pytest.raises(UnsuitedRobot, match="suchus train velocity --robot strider"):
        control.start(Runs.identical(control, STRIDER, default_gait(STRIDER)), PERIOD)


def test_a_command_beyond_what_was_trained_is_clamped_and_said():
    policy = table_policy()
    control = Learned(policy=policy, forward=0.3, turn=((0.0, 0.0), (2.0, -1.0)))
    with pytest.warns(Doubtful, match=r"learned.forward is 0.3 m/s; .* and gets 0.1; learned.turn is -1 rad/s"):
        control.start(Runs.identical(control, CAIMAN, policy.gait), PERIOD)
    assert control.speed_course == 0.1
    assert control.turn_course == ((0.0, 0.0), (2.0, -0.4))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        inside = Learned(policy=policy, forward=0.1, turn=-0.4)
        inside.start(Runs.identical(inside, CAIMAN, policy.gait), PERIOD)


def test_a_failure_of_no_servo_is_refused():
    control = Learned(policy=table_policy(), forward=0.1, failures=((1.0, "LF_nothing"),))
    with pytest.raises(UnknownName, match="LF_nothing"):
        control.start(Runs.identical(control, CAIMAN, default_gait(CAIMAN)), PERIOD)


@pytest.mark.parametrize("robot", [CAIMAN, STRIDER, ROBOTS["swimmer"]], ids=lambda robot: robot.name)
def test_the_mirror_of_the_mirror_is_the_observation(robot):
    columns, signs = observation_mirror(robot, default_gait(robot), ROBOT_READINGS)
    rows = np.random.default_rng(0).standard_normal((3, len(columns)))
    once = rows[:, columns] * signs
    assert np.array_equal(once[:, columns] * signs, rows)
    assert not np.array_equal(once, rows)


@pytest.mark.parametrize("hidden", [0, 6])
def test_a_symmetric_network_answers_a_mirrored_observation_with_the_mirrored_action(hidden):
    policy = network_policy(STRIDER, hidden=hidden)
    columns, signs = observation_mirror(STRIDER, policy.gait, policy.readings)
    action_columns, action_signs = action_mirror(policy)
    rows = np.random.default_rng(1).uniform(-1.0, 1.0, (20, len(columns))).astype(np.float32)
    answers = Networks([policy] * 20, STRIDER).answer(rows)
    mirrored = Networks([policy] * 20, STRIDER).answer((rows[:, columns] * signs).astype(np.float32))
    assert mirrored == pytest.approx(answers[:, action_columns] * action_signs, abs=1e-15)
    lopsided = Networks([replace(policy, is_symmetric=False)] * 20, STRIDER)
    plain = lopsided.answer(rows)
    assert not np.allclose(
        lopsided.answer((rows[:, columns] * signs).astype(np.float32)), plain[:, action_columns] * action_signs
    )


@pytest.mark.parametrize("name", ["caiman", "strider", "pleurobot"])
def test_the_mirrored_posture_is_that_of_half_a_cycle_later_with_odd_parameters_the_other_way(name):
    robot, gait = ROBOTS[name], default_gait(ROBOTS[name])
    images, signs = servo_mirror(robot)
    moves, sides = movement(robot, gait), np.array([limb.side for limb in layout(robot).limbs])
    clock = np.linspace(0.0, 1.0, 37, endpoint=False)

    def targets(clock, turn):
        phases = clock[:, None] + np.array(gait.limb_phases)
        steer = Steer(stroke=np.tile(0.9 - 0.3 * turn * sides, (len(clock), 1)), bend=0.1 * turn, tail=0.05 * turn)
        return moves.targets(phases, moves.axis_phase(phases) * 0.8, steer)

    mirrored = targets(clock + mirror_shift(gait), -1.0)
    cranks = ~np.isfinite(targets(clock, 1.0)).all(axis=0)
    assert not cranks.any()
    expected = targets(clock, 1.0)[:, images] * signs
    assert mirrored == pytest.approx(expected, abs=1e-9)
    assert not np.allclose(targets(clock, -1.0), expected, atol=1e-3)


def test_a_gait_without_symmetry_has_no_shift():
    gait = replace(GAITS["belly_crawl"], limb_phases=(0.0, 0.3, 0.5, 0.9))
    with pytest.raises(InvalidDesign, match="is not symmetric"):
        mirror_shift(gait)


def test_a_run_does_not_depend_on_what_runs_beside_it():
    controls = [
        Learned(policy=network_policy(seed=1), forward=0.1, turn=0.2),
        Learned(policy=network_policy(seed=2), forward=0.05),
        Learned(policy=table_policy(), forward=0.1),
        Learned(policy=network_policy(seed=3, hidden=4), forward=0.1, turn=-0.4),
    ]
    random = np.random.default_rng(5)
    position = random.standard_normal((40, len(layout(CAIMAN).servos)))
    gait = default_gait(CAIMAN)

    def answers(chosen):
        runs = Runs.identical(None, CAIMAN, gait, count=len(chosen), ticks=160)._replace(controls=tuple(chosen))
        controller = Learned.start(runs, PERIOD)
        rows = []
        for tick in range(140):
            sensed = felt(CAIMAN, runs=len(chosen), servo_position=position[tick % 40], angular_velocity=0.1)
            rows.append(controller.command(tick, sensed).targets)
        return np.array(rows)

    together = answers(controls)
    for i, control in enumerate(controls):
        assert answers([control])[:, 0].tobytes() == together[:, i].tobytes()


def test_the_network_moves_the_robot_and_reads_what_it_says():
    control = Learned(policy=network_policy(), forward=0.1)
    assert control.feels
    assert control.needs == ("servo_position", "orientation", "angular_velocity")
    assert not Learned(policy=table_policy(), forward=0.1).feels
    plain = commands(Learned(policy=table_policy(), forward=0.1), CAIMAN)
    assert np.abs(commands(control, CAIMAN) - plain)[110:].max() > 1e-3


def test_a_told_failure_reaches_the_network_at_its_time():
    policy = network_policy(readings=("clock", "failure"), actions=("stroke", "limb_stroke"))
    servo = layout(CAIMAN).servos[0]
    sound = commands(Learned(policy=policy, forward=0.1), CAIMAN)
    told = commands(Learned(policy=policy, forward=0.1, failures=((1.2, servo),)), CAIMAN)
    assert np.array_equal(sound[:120], told[:120])
    assert not np.allclose(sound[130:], told[130:])


def test_onnx_gives_the_same_actions(tmp_path):
    pytest.importorskip("onnx", reason="not installed: pip install 'suchus[onnx]'")
    runtime = pytest.importorskip("onnxruntime", reason="not installed: pip install 'suchus[onnx]'")
    for number, policy in enumerate((network_policy(), network_policy(hidden=7, seed=4, is_symmetric=False))):
        path = export_onnx(policy, CAIMAN, tmp_path / f"{number}.onnx")
        rows = np.random.default_rng(2).uniform(-1.0, 1.0, (50, len(policy.layers[0].weights))).astype(np.float32)
        session = runtime.InferenceSession(str(path))
        (answer,) = session.run(None, {"observation": rows})
        assert np.abs(answer - Networks([policy] * 50, CAIMAN).answer(rows)).max() < 1e-5
        assert "limb_stroke LF" in session.get_modelmeta().custom_metadata_map["actions"]


def test_a_table_has_no_onnx(tmp_path):
    pytest.importorskip("onnx", reason="not installed: pip install 'suchus[onnx]'")
    with pytest.raises(InvalidDesign, match="is a table without a network"):
        export_onnx(table_policy(), CAIMAN, tmp_path / "t.onnx")


def seeded_policy():
    """Return a policy with a network that carries another seed with a network, and one without."""
    other = Replicate(
        seed=7,
        speeds=(0.0, 0.05, 0.1),
        turns=(0.0, 0.2),
        table=((tuple(ACTIONS[name].neutral for name in NAMES),) * 2,) * 3,
        layers=network_policy(seed=8).layers,
        training=(("error", "0.2"),),
    )
    policy = network_policy(training=(("command", "suchus train velocity --seeds 3"), ("seed", "5"), ("error", "0.1")))
    return replace(policy, replicates=(other, replace(other, seed=6, layers=())))


def test_a_file_carries_the_policies_of_other_seeds(tmp_path):
    policy = seeded_policy()
    path = save_policy(policy, tmp_path / "seeds.npz")
    read = load_policy(path)
    assert read == policy
    assert policy_bytes(read) == path.read_bytes()
    first, second, third = read.seeds
    assert first == replace(policy, replicates=())
    assert second.layers == network_policy(seed=8).layers
    assert second.speeds == (0.0, 0.05, 0.1)
    assert dict(second.training) == {"command": "suchus train velocity --seeds 3", "seed": "7", "error": "0.2"}
    assert third.layers == third.actions == ()
    assert np.abs(commands(Learned(policy=second, forward=0.1), CAIMAN)[-1]).max() > 0.0
    assert len(path.read_bytes()) < 1.6 * len(policy_bytes(first))


def test_a_replicate_whose_network_does_not_fit_is_refused(tmp_path):
    policy = seeded_policy()
    with pytest.raises(InvalidDesign, match="needed, one for each column"):
        replace(policy, replicates=(replace(policy.replicates[0], layers=(Layer(((0.0,),), (0.0,)),)),))
    path = save_policy(policy, tmp_path / "one.npz")
    with pytest.raises(UnreadableFile, match="not finite"):
        load_policy(rewritten(path, "replicate_0_table", np.full((3, 2, 4), np.inf)))


def test_a_failure_that_the_policy_cannot_read_is_said():
    servo = layout(CAIMAN).servos[0]
    control = Learned(policy=table_policy(), forward=0.1, failures=((1.0, servo),))
    with pytest.warns(Doubtful, match=f"failures names {servo}, and policy 'test' reads no failures"):
        control.start(Runs.identical(control, CAIMAN, default_gait(CAIMAN)), PERIOD)
    with pytest.raises(InvalidDesign, match=r"failures has a failure at -1\.0 s"):
        Learned(policy=table_policy(), failures=((-1.0, servo),))
