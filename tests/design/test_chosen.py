import pytest

from suchus.core.errors import InvalidDesign, UnknownName
from suchus.robot.design import value_at, with_values
from suchus.robot.gaits import CONDITIONS, GAITS
from suchus.robot.robots import ROBOTS

CAIMAN = ROBOTS["caiman"]
OTHERS = ("limbs_only", "limbs_tail_lifted", "spine_only", "tail_drag")


@pytest.mark.parametrize("shelf", [ROBOTS, GAITS], ids=["robots", "gaits"])
def test_every_chosen_field_exists_holds_a_number_within_its_range(shelf):
    for name, design in shelf.items():
        for one in shelf.beside(name, "chosen", ()):
            value = value_at(design, one.field)
            assert isinstance(value, float)
            # the values of other arms, zero for what does not take part, may lie outside
            assert one.low <= value <= one.high or name in CONDITIONS


def test_what_was_put_in_is_what_comes_out_and_nothing_else_changes():
    values = {one.field: 0.5 * (one.low + one.high) for one in ROBOTS.beside("caiman", "chosen", ())}
    values = {field: value for field, value in values.items() if "_range[" not in field}
    values |= {"spine.yaw_range[1]": 0.9, "hind_leg.femur": 0.09}
    changed = with_values(CAIMAN, values)
    assert all(value_at(changed, field) == value for field, value in values.items())
    assert changed.spine.yaw_range[0] == CAIMAN.spine.yaw_range[0]
    assert changed.tail.joints == CAIMAN.tail.joints
    back = with_values(changed, {field: value_at(CAIMAN, field) for field in values})
    assert back == CAIMAN


def test_no_values_change_nothing():
    assert with_values(CAIMAN, {}) == CAIMAN


def test_a_pair_moves_as_one():
    # low beyond the old high: refused one after the other, allowed together
    moved = with_values(CAIMAN, {"tail.pitch_range[0]": 1.2, "tail.pitch_range[1]": 1.4})
    assert moved.tail.pitch_range == (1.2, 1.4)


@pytest.mark.parametrize("path", ["nose", "head.nose", "spine.yaw_range[2]", "head[0]", "head.mass.grams"])
def test_an_unknown_field_is_named(path):
    with pytest.raises(UnknownName, match="no field"):
        value_at(CAIMAN, path)
    with pytest.raises(UnknownName, match="no field"):
        with_values(CAIMAN, {path: 1.0})


def test_what_follows_from_other_fields_is_not_set():
    with pytest.raises(InvalidDesign, match=r"^tables follows from what a Robot was made of, and is not set"):
        with_values(ROBOTS["strider"], {"tables": None})


def test_impossible_values_are_refused():
    with pytest.raises(InvalidDesign, match="snout"):
        with_values(CAIMAN, {"head.snout": 0.03})
