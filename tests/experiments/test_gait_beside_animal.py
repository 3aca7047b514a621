"""The gait diagram beside a filmed animal's (Fig. 22 speaks of foot phases of an animal)."""

import numpy as np
import pytest

from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.catalog.gait_diagram.experiment import _ANIMAL_PHASES
from suchus.robot.gaits import GAITS
from suchus.sim.metrics import sensed_phase


def test_how_far_the_animals_feet_are_is_counted_round_the_cycle(quick_outcome):
    record = quick_outcome("gait_diagram").record
    question = EXPERIMENTS["gait_diagram"].quick()
    phase = {str(leg): float(sensed_phase(record).sel(leg=leg)) for leg in record.leg.values}
    apart = {leg: abs((phase[leg] - _ANIMAL_PHASES[leg] + 0.5) % 1 - 0.5) for leg in phase}
    told = question.measure(record)["animal_phase_apart"]
    assert told.value == pytest.approx(max(apart.values()))
    assert told.unit == "cycle"
    assert apart["LF"] == 0.0  # where both are counted from
    samples = round(0.3 * float(record.period) / float(record.time[1] - record.time[0]))
    earlier = record.copy(deep=True)
    forces = earlier.foot_force.transpose("leg", "time", "xyz")
    forces[1] = np.roll(forces[1].values, samples, axis=0)  # the right front foot comes 0.3 cycle later
    later = question.measure(earlier)["animal_phase_apart"].value
    assert later == pytest.approx(0.3, abs=0.05)


def test_the_animal_bends_towards_its_hind_foot_that_swings(quick_outcome):
    """A salamander's standing wave bends the trunk away from the side whose hind foot reaches forward."""
    figure = EXPERIMENTS["gait_diagram"].quick().draw(quick_outcome("gait_diagram"))["beside_an_animal"]
    bars, bends = figure.axes
    assert [label.get_text() for label in bars.get_yticklabels()] == ["LF", "RF", "LH", "RH", "spine", "tail"]
    lines = {line.get_label(): line for line in bends.get_lines()}
    spine = lines["spine, salamander"]
    x, angle = np.asarray(spine.get_xdata()), np.asarray(spine.get_ydata())
    assert angle[0] == pytest.approx(angle[-1], abs=1.0)  # it closes
    assert 35 < np.ptp(angle) / 2 < 45  # the filmed trunk, 39 degrees to each side
    gait = GAITS["animal_walk"]
    right = (x + _ANIMAL_PHASES["RH"]) % 1.0 < 1.0 - gait.duty_factor  # the right hind foot swings
    assert angle[right].mean() > 0 > angle[(x + _ANIMAL_PHASES["LH"]) % 1.0 < 1.0 - gait.duty_factor].mean()


def test_a_body_of_other_limbs_has_no_animal_beside_it():
    question = EXPERIMENTS["gait_diagram"].quick()
    assert "animal" not in question.render_explanation(
        {"x": 1.0} | _numbers(("LF", "RF")), legs=("LF", "RF"), animal_duty=0.8
    )


def _numbers(legs):
    duties = {f"duty_factor_{leg}": 0.6 for leg in legs}
    return duties | {"duty_factor_commanded": 0.5, "diagonal_phase_error": 0.1, "diagonal_phase_error_designed": 0.1}
