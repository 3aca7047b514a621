"""What is not known of the water around a swimmer, alike for all of them."""

from evidence.league import Given

_MODEL = "no measurement of this body; range of the model"


def fresh(*, drag: tuple[float, float, float], rub: tuple[float, float, float], shed: tuple[float, float, float],
          why_drag: str, why_rub: str, why_shed: str) -> dict[str, Given]:  # fmt: skip
    """Return the numbers of the water and of its force on sections, each as value, low, high.

    Args:
        drag: drag coefficient across.
        rub: factor on a plate's friction along the body.
        shed: share of Lighthill's momentum that is shed.
        why_drag: source of the first.
        why_rub: of the second.
        why_shed: of the third.
    """
    return {
        "density": Given(value=998.0, low=997.0, high=1000.0, unit="kg/m3", source="fresh water at 15 to 25 C"),
        "viscosity": Given(value=1.0e-6, low=0.9e-6, high=1.15e-6, unit="m2/s", source="fresh water at 15 to 25 C"),
        "cross_drag": Given(value=drag[0], low=drag[1], high=drag[2], unit="-", source=why_drag),
        "thickening": Given(value=rub[0], low=rub[1], high=rub[2], unit="-", source=why_rub),
        "shedding": Given(value=shed[0], low=shed[1], high=shed[2], unit="-", source=why_shed),
        "added_mass": Given(
            value=1.0, low=0.7, high=1.3, unit="-",
            source=f"{_MODEL}: sections of finite length and close to the surface have less added mass than in ideal "
            "water, those that oscillate far have more (docs/amphibious.md)",
        ),
    }  # fmt: skip
