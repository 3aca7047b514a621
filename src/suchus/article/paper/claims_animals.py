"""Claims of other publications on animals and their models, with which experiments of suchus are compared.

All were read: they are numbers of public data, and abstracts.
"""

from dataclasses import replace

from suchus.article.paper.claim import Claim, statement

KAWANO = "Kawano and Blob 2013, Integr. Comp. Biol. 53, 283"
KARAKASILIOTIS = "Karakasiliotis et al. 2013, Biol. Cybern. 107, 529"
IJSPEERT = "Ijspeert et al. 2007, Science 315, 1416"


def _force(pair: str, value: float, spread: float, trials: int) -> Claim:
    """Return the claim about the greatest force on the feet of walking salamanders.

    Args:
        pair: fore or hind.
        value: mean over the trials [body weight].
        spread: standard deviation over the trials [body weight].
        trials: number of trials [-].
    """
    return Claim(
        key=f"salamander_{pair}_force",
        of=KAWANO,
        where="public data, FinsAndLimbs/mudskipperKinematics",
        quantity=f"greatest net force of the ground on a {pair} foot, over the weight",
        value=value,
        unit="-",
        rounding=0.0005,  # of the mean as computed here, to three digits
        sense=f"The greatest net force on a {pair} foot of a walking tiger salamander is within two standard "
        f"deviations of single trials of {value:g} body weights.",
        quote=f"[{value:g} ± {spread:g} body weights, mean and standard deviation over {trials} trials]",
    )


FORE_SPREAD, HIND_SPREAD = 0.063, 0.070
"""Standard deviations over trials of the two forces [body weight]."""

SALAMANDERS = (
    _force("fore", 0.457, FORE_SPREAD, 50),
    _force("hind", 0.479, HIND_SPREAD, 48),
    replace(
        statement(
            "salamander_force_times",
            "public data, FinsAndLimbs/mudskipperKinematics",
            "when the force on fore and hind feet is greatest, as a share of stance",
            "The force on a foot is greatest in the middle half of its stance, on a hind foot earlier than on a fore "
            "foot.",
            "[at 61 % of stance on fore feet, at 33 % on hind feet]",
        ),
        of=KAWANO,
    ),
    replace(
        statement(
            "salamander_hind_push",
            "public data, FinsAndLimbs/mudskipperKinematics",
            "force along the course when it is greatest on a foot",
            "When the force on a foot is greatest, hind feet push the body forward and fore feet brake it.",
            "[+0.151 body weights on hind feet, -0.028 on fore feet]",
        ),
        of=KAWANO,
    ),
    Claim(
        key="salamander_swim_stride",
        of=KARAKASILIOTIS,
        where="public data, SalamandraSNN",
        quantity="stride of a swimming salamander, in body lengths",
        value=0.225,
        unit="-",
        rounding=0.0005,
        sense="With the joint angles of the swimming animal the body comes as far in a cycle as the animal, within a "
        "quarter.",
        quote="[0.225 body lengths a cycle, the mean of four speeds at 2.6 to 3.8 Hz]",
    ),
)
"""Salamanders that walk and swim."""

OSCILLATORS = (
    replace(
        statement(
            "oscillators_switch",
            "abstract",
            "standing index of the axis at the drive for walking",
            "With the limbs' oscillators active the axis bends as a standing wave; where the drive silences them it "
            "bends as a travelling wave.",
            "a primitive neural circuit for swimming can be extended by ... limb oscillatory centers to explain the "
            "ability of salamanders to switch between swimming and walking",
        ),
        of=IJSPEERT,
    ),
    replace(
        statement(
            "oscillators_direction",
            "abstract",
            "how far unequal drives of both sides turn the walk in a cycle",
            "A drive that differs between left and right changes the direction of the walk.",
            "The model suggests neural mechanisms for modulation of velocity, direction, and type of gait",
        ),
        of=IJSPEERT,
    ),
)
"""The model of the salamander's spinal cord."""
