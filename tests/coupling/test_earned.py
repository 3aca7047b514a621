"""A correction of the section model: offered where other swims bear it out, not where they do not, and what it does."""

from dataclasses import replace

import numpy as np
import pytest

from suchus.core.errors import InvalidDesign
from suchus.robot import blueprint
from suchus.robot.blueprint import MistakenFile, read_correction
from suchus.robot.control import Swimming
from suchus.robot.design import LinkFactors, SectionCorrection, with_values
from suchus.robot.motion.axis import yaw_hinges
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Lake, Run, simulate
from suchus.sim.land.lake import lake_text
from suchus.sim.land.prescribed import link_bodies, sections_along
from suchus.swimming.coupling.earned import ForceParts, judge_link, judgement_text
from suchus.swimming.water import swim_of

TIME = np.arange(600) / 100.0


def swim(added, drag, phase=0.0, noise=0.02, seed=0):
    """A link's force in a flow that has so much of each part of the sections' force."""
    one, rng = 2 * np.pi * TIME + phase, np.random.default_rng(seed)
    a, d = np.sin(one), np.cos(one) * np.abs(np.cos(one))
    return ForceParts(flow=added * a + drag * d + noise * rng.normal(size=TIME.size), added_mass=a, drag=d, block=50)


def test_what_other_swims_bear_out_is_offered():
    found = judge_link(swim(2.0, 4.0), [swim(2.1, 3.8, 0.4, seed=1), swim(1.9, 4.2, 1.0, seed=2)])
    assert found.why_not == ""
    assert found.added_mass_factor == pytest.approx(2.0, abs=0.02)
    assert found.added_interval[0] < 2.0 < found.added_interval[1]
    assert max(found.shipped) < 0.8 < 0.99 < min(found.corrected)


@pytest.mark.parametrize(("fit", "others", "why"), [
    ((2.0, 4.0), [(2.0, 4.0), (1.0, 1.0)], "no gain in every other swim"),  # one swim is as the model is shipped
    ((1.0, 1.0), [(1.0, 1.0)], "no gain in every other swim"),  # nothing to correct
    ((2.0, 4.0), [], "no other swim to hold them against"),
    ((-0.5, 4.0), [(-0.5, 4.0)], "a factor may be negative"),
])  # fmt: skip
def test_what_they_do_not_is_not_offered(fit, others, why):
    held_out = [swim(*one, 0.4, noise=0.3, seed=k + 1) for k, one in enumerate(others)]
    assert judge_link(swim(*fit, noise=0.3), held_out).why_not == why


def test_a_swim_of_too_few_cycles_earns_nothing():
    one = swim(2.0, 4.0)
    short = ForceParts(flow=one.flow[:120], added_mass=one.added_mass[:120], drag=one.drag[:120], block=50)
    assert judge_link(short, [one]).why_not == "too few cycles for an interval"
    assert judge_link(one, [short]).why_not == "no gain in every other swim"
    text = judgement_text({"link_1": judge_link(one, [short])}, ["tail_only"])
    assert "| link_1 | 2.00 (" in text
    assert "R2 in tail_only, shipped | corrected" in text


CAIMAN = ROBOTS["floating_caiman"]
BARE = with_values(CAIMAN, {"hull": None})
JOINTS = tuple(yaw_hinges(BARE).names)
LINKS = link_bodies(BARE, JOINTS)


def correction(factors, reynolds=(7000.0, 7000.0)):
    """A correction of some links by their numbers."""
    links = tuple(LinkFactors(bodies=LINKS[k], added=a, drag=d) for k, (a, d) in factors.items())
    return SectionCorrection(name="found", reynolds=reynolds, links=links)


def test_factors_are_on_the_two_parts_of_their_link_alone():
    """To rounding what the residual table fits is what the water of a run then does."""
    rng = np.random.default_rng(4)
    place, rate, push = 0.2 * rng.normal(size=(3, 4, 3 + len(JOINTS)))
    lake = Lake(level=0.0)
    whole, still = (
        sections_along(BARE, JOINTS, place, rate, push, one) for one in (lake, replace(lake, added_mass=0.0))
    )
    other = sections_along(BARE, JOINTS, place, rate, push, replace(lake, correction=correction({1: (2.5, 3.0)})))
    expected = whole.links.copy()
    expected[:, 1] = 2.5 * (whole.links - still.links)[:, 1] + 3.0 * still.links[:, 1]
    assert other.links == pytest.approx(expected, rel=1e-9, abs=1e-9)
    assert np.abs(other.links - whole.links).max() > 0.1 * np.abs(whole.links).max()
    assert np.abs(other.joints - whole.joints).max() > 0.01 * np.abs(whole.joints).max()


def test_a_run_in_a_corrected_lake_swims_otherwise_and_one_beside_it_does_not():
    gait = swim_of(CAIMAN, frequency=1.0)
    same, other = (correction(dict.fromkeys(range(len(LINKS)), (1.0, drag))) for drag in (1.0, 3.0))
    lakes = [Lake(level=2.0, correction=one) for one in (None, same, other)]
    runs = [Run(robot=CAIMAN, gait=gait, lake=lake, control=Swimming(ramp=0.5)) for lake in lakes]
    x = simulate(runs, duration=0.6).centre_of_mass.sel(xyz="x").values
    assert x[1] == pytest.approx(x[0], abs=1e-12)
    assert np.abs(x[2] - x[0]).max() > 1e-4
    assert "correction" not in lake_text(lakes[0])
    assert '"drag": 3.0' in lake_text(lakes[2])


def test_a_correction_is_read_back_and_says_where_it_does_not_hold(tmp_path):
    one = correction({0: (2.0, 3.0), 3: (1.5, 4.0)}, reynolds=(3500.0, 7000.0))
    file = blueprint.write(one, tmp_path / "found.toml")
    assert read_correction(file) == one
    assert one.validity_warning(5000.0) == ""
    assert "was found at f L2 / nu = 3.5e+03 to 7e+03, and this swim is at 1e+06" in one.validity_warning(1e6)
    file.write_text(file.read_text().replace("drag = 4.0", "drag = -4.0"))
    with pytest.raises(MistakenFile, match=r"drag"):
        read_correction(file)
    whole = SectionCorrection(
        name="found", reynolds=(1.0, 2.0), links=(LinkFactors(bodies=("pelvis",), added=1.0, drag=1.0),)
    )
    swimmer = ROBOTS["swimmer"]
    run = Run(robot=swimmer, gait=swim_of(swimmer), lake=Lake(level=2.0, correction=whole))
    with pytest.raises(InvalidDesign, match=r"has factors for pelvis.*robot 'swimmer' has the bodies segment_6"):
        simulate([run], duration=0.1)
    with pytest.raises(InvalidDesign, match=r"factors twice for pelvis"):
        replace(whole, links=2 * whole.links)
    with pytest.raises(InvalidDesign, match=r"correction.reynolds is \(2.0, 1.0\)"):
        replace(whole, reynolds=(2.0, 1.0))
