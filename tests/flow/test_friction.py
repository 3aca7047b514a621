"""Friction by a boundary-layer law: exact on plates, published on spheroids, and what is refused."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from evidence.friction import MIN_TURBULENT_REYNOLDS, FrictionBand, along_stations
from suchus.core.errors import InvalidDesign

WATER = {"viscosity": 1e-6, "density": 1000.0}


def lamb(slenderness):
    """Added mass of a prolate spheroid along its axis over the displaced; Lamb 1932, Hydrodynamics, par. 114."""
    e = np.sqrt(1 - slenderness**-2)
    alpha = 2 * (1 - e**2) / e**3 * (np.arctanh(e) - e)
    return alpha / (2 - alpha)


def meridian(slenderness, points=801):
    """Stations along a spheroid of length 1: arc, girth, speed in potential flow over the stream, cosine, area.

    The speed along it is (1 + k) times the tangent's part along the axis.
    """
    angle = np.linspace(0, np.pi, points)
    x, r = -0.5 * np.cos(angle), 0.5 / slenderness * np.sin(angle)
    ds = np.hypot(np.diff(x), np.diff(r))
    arc = np.concatenate([[0.0], np.cumsum(ds)])
    along = np.sin(angle) / np.hypot(np.sin(angle), np.cos(angle) / slenderness)
    area = float((np.pi * (r[1:] + r[:-1]) * ds).sum())
    return arc, 2 * np.pi * r, (1 + lamb(slenderness)) * along, along, area


@pytest.mark.parametrize("stations", [2, 3, 60])
def test_on_a_plate_the_totals_are_those_of_blasius_and_of_the_line(stations):
    """Whatever the number of stations."""
    arc = np.linspace(0, 2.0, stations) ** 2 / 2.0
    even = np.ones(stations)
    band, reynolds = along_stations(arc, 0.3 * even, 0.5 * even, **WATER), 0.5 * 2.0 / 1e-6
    push = 0.5 * 1000.0 * 0.5**2 * 0.3 * 2.0

    def line(number):
        return 0.075 / (np.log10(number) - 2) ** 2

    at_the_nose = (
        (1.328 / MIN_TURBULENT_REYNOLDS**0.5 - line(MIN_TURBULENT_REYNOLDS)) * MIN_TURBULENT_REYNOLDS / reynolds
    )  # laminar there
    assert band.laminar == pytest.approx(push * 1.328 / reynolds**0.5, rel=1e-9)
    assert band.turbulent == pytest.approx(push * (line(reynolds) + at_the_nose), rel=1e-9)


def test_a_slope_takes_its_share_of_the_force():
    arc, ones = np.array([0.0, 0.5, 1.0]), np.ones(3)
    flat = along_stations(arc, ones, ones, **WATER)
    sloped = along_stations(arc, ones, ones, **WATER, slope=np.array([0.5, 0.5, 0.5]))
    assert np.allclose(sloped, 0.5 * np.array(flat), rtol=1e-12)


@pytest.mark.parametrize("slenderness", [6.0, 8.0, 10.0])
def test_a_spheroid_rubs_as_published(slenderness):
    """Hoerner 1965, Fluid-Dynamic Drag, ch. 6: a streamlined body's friction is 1 + 1.5 (d/l)^1.5 of a plate's.

    Measured on streamlined bodies with turbulent layers; 7 (d/l)^3 more is what the layer does to the pressure. The
    asked 6:1 comes out 4 to 6 % low; shorter ones, whose tails thicken the layer, are no case of the law.
    """
    for reynolds in (1e6, 1e7):
        found = over_plate(slenderness, reynolds).turbulent / (1 + 1.5 * slenderness**-1.5)
        assert 0.94 < found < 1.01


def test_the_memory_of_the_layer_is_needed():
    """A laminar layer that only knew how far it is from the nose would rub less than on a plate; it rubs more."""
    ours = over_plate(6.0, 1e6)
    arc, girth, speed, along, area = meridian(6.0)
    blasius = 0.664 / np.sqrt(np.maximum(speed * arc, 1e-9) * 1e6)
    forgetful = np.trapezoid(girth * along * speed**2 * blasius, arc)
    assert forgetful / (1.328e-3 * area) < 0.9 < 1.05 < ours.laminar < 1.12


def over_plate(slenderness, reynolds):
    """Friction of a spheroid over that of a plate of its length and area, at both ends of the band."""
    arc, girth, speed, along, area = meridian(slenderness)
    ours = along_stations(arc, girth, speed, viscosity=1 / reynolds, density=2.0, slope=along)
    return FrictionBand(
        ours.laminar / (1.328 * reynolds**-0.5 * area), ours.turbulent * (np.log10(reynolds) - 2) ** 2 / 0.075 / area
    )


@given(st.floats(0.1, 10), st.floats(0.1, 10), st.floats(0.1, 10))
def test_the_coefficient_follows_the_reynolds_number_alone(length, speed, density):
    arc, girth, fast, *_ = meridian(6.0, points=41)
    small = along_stations(arc, girth, fast, viscosity=1e-6, density=1.0)
    large = along_stations(
        length * arc, length * girth, speed * fast, viscosity=1e-6 * length * speed, density=density
    )  # fmt: skip
    assert np.allclose(np.array(large) / (density * speed**2 * length**2), small, rtol=1e-9)
    assert 0 < small.laminar < small.turbulent


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"arc": [0.0, 0.2, 0.1]}, "rising distances"),
        ({"arc": [-0.1, 0.2, 0.3]}, "rising distances"),
        ({"girth": [0.1, -0.1, 0.1]}, "none negative"),
        ({"girth": [0.1, np.nan, 0.1]}, "none negative"),
        ({"speed": [1.0, 0.0, 1.0]}, "positive numbers"),
        ({"speed": [1.0, np.inf, 1.0]}, "positive numbers"),
        ({"speed": [1.0, 1.0]}, "three rows"),
        ({"viscosity": 0.0}, "above 0"),
        ({"density": np.inf}, "above 0"),
        ({"slope": 1.5}, "cosine"),
    ],
)
def test_refused_in_a_sentence(changed, message):
    good = {"arc": [0.0, 0.1, 0.2], "girth": [0.1, 0.1, 0.1], "speed": [0.0, 1.0, 0.0], **WATER}
    rows = {key: np.array(value) if isinstance(value, list) else value for key, value in {**good, **changed}.items()}
    along_stations(**{key: np.array(value) if isinstance(value, list) else value for key, value in good.items()})
    with pytest.raises(InvalidDesign, match=message):
        along_stations(**rows)
