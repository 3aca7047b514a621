"""Servos as they are bought: the shipped file, files of a user's own, and what follows from a data sheet."""

from dataclasses import fields, replace
from math import pi

import pytest
from hypothesis import given
from hypothesis import strategies as st

from suchus.core.errors import InvalidDesign, UnknownName, UnreadableFile
from suchus.robot.blueprint import MistakenFile, read_motors, render
from suchus.robot.design import LINE, Motor, Servo, Winding
from suchus.robot.design.motor import COPPER, ROOM_TEMPERATURE
from suchus.robot.motors import motor, motors

WORDS = {"name", "maker", "family", "protocol", "protection", "sources"}


@pytest.mark.parametrize("name", list(motors()))
def test_every_number_of_a_shipped_servo_has_its_source(name):
    one = motors()[name]
    told = dict(one.sources)
    assert set(told) == {field.name for field in fields(Motor)} - WORDS
    assert all(len(text) > 8 for text in told.values())
    for field, text in told.items():
        assert text.startswith(("from memory", "a guess")) == (field in one.unconfirmed_fields)


def test_data_sheets_agree_with_their_own_units():
    """Kilogram centimetres, seconds for 60 degrees and turns a minute, as makers write them."""
    assert motor("STS3215-12V").stall_torque == pytest.approx(30 * 9.80665e-2, rel=1e-3)
    assert motor("STS3215-12V").no_load_speed == pytest.approx(pi / 3 / 0.222, rel=1e-3)
    assert motor("STS3250").no_load_speed == pytest.approx(pi / 3 / 0.133, rel=1e-3)
    assert motor("XM430-W350").no_load_speed == pytest.approx(46 * 2 * pi / 60, rel=1e-3)
    # a motor cannot give more power than it takes: the greatest is a quarter of stall torque times free speed
    for one in motors().values():
        assert one.stall_torque * one.no_load_speed / 4 < one.volts * one.stall_current / 2, one.name
        assert one.idle_current < one.stall_current
        assert one.mass / (one.size[0] * one.size[1] * one.size[2]) < 3000.0  # kg/m3


def test_a_family_has_a_supply_that_all_of_it_bear():
    families = {one.family for one in motors().values()}
    for family in families:
        ones = [one for one in motors().values() if one.family == family]
        volts = max(one.volts for one in ones)
        assert all(one.volts_range[0] <= volts <= one.volts_range[1] for one in ones), family
        assert len({one.protocol for one in ones}) == 1


@pytest.mark.parametrize("name", list(motors()))
def test_at_its_continuous_torque_a_servo_stays_at_its_temperature_limit(name):
    one = motors()[name]
    loss = one.volts * one.stall_current * (one.continuous_torque / one.stall_torque) ** 2
    assert one.heat.steady_temperature(loss) == pytest.approx(one.temperature_limit)
    assert one.heat.steady_temperature(0.99 * loss) < one.temperature_limit < one.heat.steady_temperature(1.01 * loss)


def test_a_winding_that_warms_itself_faster_than_the_air_cools_it_has_no_steady_temperature():
    heat = motor("STS3250").heat
    assert heat.steady_temperature(0.0) == heat.ambient
    assert heat.steady_temperature(1.0 / (COPPER * heat.resistance)) == float("inf")
    assert heat.steady_temperature(0.99 / (COPPER * heat.resistance)) < float("inf")
    warmer = replace(heat, ambient=35.0)
    loss = 5.0
    steady = warmer.steady_temperature(loss)
    assert steady == pytest.approx(35.0 + warmer.resistance * loss * (1 + COPPER * (steady - ROOM_TEMPERATURE)))


@given(st.sampled_from(list(motors())), st.floats(0.0, 1.0))
def test_torque_speed_and_current_go_with_the_supply(name, share):
    one = motors()[name]
    low, high = one.volts_range
    volts = low + share * (high - low)
    servo = Servo.from_motor(one, volts)
    assert servo.torque / one.stall_torque == pytest.approx(volts / one.volts)
    assert servo.speed / one.no_load_speed == pytest.approx(volts / one.volts)
    assert servo.winding.resistance == pytest.approx(one.volts / one.stall_current)
    assert servo.winding.motor == name
    assert Servo.from_motor(one) == Servo.from_motor(one, one.volts)


def test_a_servo_like_another_keeps_its_loop_and_gear():
    other = Servo(
        kp=40.0, ki=1.0, kd=0.6, integral_limit=0.5, torque=3.0, speed=7.0, armature=5e-3, friction=0.03, damping=0.05
    )
    one = Servo.from_motor(motor("XM430-W350"), template=other)
    assert replace(one, torque=3.0, speed=7.0, winding=None) == other
    own = Servo.from_motor(replace(motor("XM430-W350"), stall_torque=3.0))
    numbers = (own.kp, own.kd, own.armature, own.friction, own.damping)
    assert numbers == pytest.approx((40.0, 1.5, 9.15e-3, 0.0456, 0.0162))
    weak = Servo.from_motor(replace(motor("XM430-W350"), stall_torque=3.0), 10.0)
    assert weak.torque < own.torque
    assert (weak.armature, weak.friction, weak.damping) == (own.armature, own.friction, own.damping)


def test_a_supply_that_it_does_not_bear_is_refused():
    with pytest.raises(InvalidDesign, match=r"24 V is no supply for STS3250; 6 to 12\.6 V is allowed"):
        Servo.from_motor(motor("STS3250"), 24.0)
    with pytest.raises(UnknownName, match="STS3215-12V"):
        motor("STS3215-12")
    with pytest.raises(InvalidDesign, match=r"winding\.volts is 0 V"):
        Winding(volts=0.0, stall_current=1.0)
    with pytest.raises(InvalidDesign, match="above stall_torque"):
        replace(motor("STS3250"), continuous_torque=5.0)
    assert LINE.heat is None


MINE = """
[mine]
maker = "me"
family = "mine"
protocol = "pwm"
model_number = 0
volts = 6.0
volts_range = [5.0, 7.0]
stall_torque = {value = 1.0, source = "measured"}
no_load_speed = 6.0
stall_current = 2.0
idle_current = 0.1
continuous_torque = 0.3
temperature_limit = 70.0
play = 0.01
steps = 1000
turn = 3.0
mass = 0.05
size = [0.04, 0.02, 0.04]
price = [9.0, 10.0]
"""


def test_a_file_of_ones_own_is_read(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(MINE)
    (one,) = read_motors(path).values()
    assert (one.name, one.stall_torque, one.source("stall_torque"), one.source("volts")) == (
        "mine",
        1.0,
        "measured",
        "",
    )


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (("volts = 6.0", "volts = 8.0"), r"mine .*volts is 8 V, outside volts_range, 5 to 7 V"),
        (("turn = 3.0\n", ""), r"mine\.turn is missing"),
        (("turn = 3.0", "turnn = 3.0"), r"mine\.turnn is not known"),
        (("turn = 3.0", "turn = {value = 3.0}"), r"mine\.turn is a table; \{value = \.\.\., source = "),
        (
            ('protocol = "pwm"', 'protocol = "can"'),
            r"mine\.protocol is 'can'; dynamixel, dynamixel1, .* pwm is allowed",
        ),
        (("[mine]", 'name = "x"\n[mine]'), r"name is 'x'; a table of a servo's numbers is needed"),
        (("turn = 3.0", 'name = "other"\nturn = 3.0'), r"mine\.name stands in the file by itself"),
        (("mass = 0.05", "mass = -1.0"), r"mine\.mass is -1 kg"),
    ],
)
def test_mistakes_in_a_file_of_servos_are_named(change, said, tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(MINE.replace(*change))
    with pytest.raises(MistakenFile, match=said):
        read_motors(path)


def test_an_empty_file_and_one_that_is_no_toml_are_refused(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text("")
    with pytest.raises(MistakenFile, match="has no servo"):
        read_motors(path)
    path.write_text("[")
    with pytest.raises(UnreadableFile, match="not valid TOML"):
        read_motors(path)


def test_a_bought_servo_stands_in_a_file_of_its_own_meaning():
    text = render(Servo.from_motor(motor("STS3250")))
    assert 'motor = "STS3250"' in text
    assert "resistance = " in text
