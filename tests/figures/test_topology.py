"""The topology is what the controllers do, and the figure shows all of it."""

from matplotlib.text import Annotation, Text

from suchus.experiments.catalog.feedback.figure import draw_topology
from suchus.robot.control import LAWS, Coordinated
from suchus.robot.control.shared import OWNERS
from suchus.robot.control.topology import topology
from suchus.robot.gaits import GAITS
from suchus.visual.figures import caption


def parts(robot, **rules):
    control = Coordinated(**rules) if rules else None
    return {part.name: part for part in topology(robot, GAITS["belly_crawl"], control)}


def test_every_controller_writes_what_it_owns_and_nothing_else(robot):
    for name, part in parts(robot).items():
        assert part.writes == {variable for variable, owner in OWNERS.items() if owner == name}


def test_spine_follows_the_limbs_and_tail_the_trunk(robot):
    found = parts(robot)
    assert found["spine"].hears - found["spine"].writes == {"limb_phase"}
    assert found["tail"].hears - found["tail"].writes == {"trunk_bend", "trunk_direction"}
    assert found["limbs"].hears <= {"limb_phase"}
    assert "foot_pressure" in found["limbs"].feels
    assert found["heading"].feels == {"orientation", "servo_position"}
    assert found["heading"].hears == found["heading"].writes == frozenset()


def test_a_rule_that_is_off_feels_nothing(robot):
    found = parts(robot, limbs=LAWS["off"], spine=None, tail=None)
    assert found["spine"].feels == found["tail"].feels == found["heading"].feels == frozenset()
    assert found["spine"].hears >= {"limb_phase"}  # it still follows


def test_the_figure_shows_every_part_and_an_arrow_for_each_link(robot):
    found = tuple(parts(robot).values())
    figure = draw_topology(found)
    drawn = figure.axes[0].texts
    names = {text.get_text().replace("\n", "_") for text in drawn if type(text) is Text}
    assert names >= {part.name for part in found} | set(OWNERS) | {name for part in found for name in part.feels}
    arrows = [text for text in drawn if isinstance(text, Annotation)]
    links = sum(len(part.feels) + len(part.writes) + len(part.hears - part.writes) for part in found)
    assert len(arrows) == links
    assert "heading" in caption(figure)
