"""Every misprint of the article, by key.

The printed formulas can be run: they stand in ``suchus.robot.kinematics.printed``, and tests set each beside ours.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType


@dataclass(frozen=True, slots=True, kw_only=True)
class Misprint:
    """A misprint, a missing definition or a contradiction."""

    key: str
    """Its name here."""
    where: str
    """Section, equation, table or figure."""
    printed: str
    """The formula or the words as printed."""
    ours: str
    """The form that suchus uses instead."""
    shows: str
    """Evidence that the printed form fails."""


LEG = (
    Misprint(
        key="table_1_columns",
        where="Table I",
        printed="columns a_i, alpha_i",
        ours="columns a_(i-1), alpha_(i-1): a0 = 70, a1 = 0, a2 = 86, a3 = 89 mm, alpha1 = pi/2",
        shows="Read as printed, row i feeds matrix i + 1 and the hip becomes two parallel yaw joints; "
        "only the shifted reading reproduces (2) to (7).",
    ),
    Misprint(
        key="eq_2_5_subscripts",
        where="eqs (2)-(5)",
        printed="a1, a2, a3, a4 in the matrices 0T1 to 3T4",
        ours="a0, a1 = 0, a2, a3, as in (1) and (7) to (14)",
        shows="With a1 = 70, a2 = 0, a3 = 86, a4 = 89 mm in (2) to (5), (7) would have a2 = 0, a3 = 86 mm.",
    ),
    Misprint(
        key="eq_7_third_column",
        where="eq. (7)",
        printed="n, o and p only",
        ours="a = (S1, -C1, 0), the third column",
        shows="Without it the rotation is incomplete; n x o gives it.",
    ),
    Misprint(
        key="eq_8_origin",
        where="III.A, after eq. (9)",
        printed="O is the origin of the X'-Z plane",
        ours="A = (a0, 0, 0) is",
        shows="The foot's coordinates in that plane subtract a0: they are measured from A.",
    ),
    Misprint(
        key="eq_9_arctan",
        where="eqs (9), (14)",
        printed="theta1 = arctan(Py / (Px - a0))",
        ours="theta1 = atan2(s Py, s (Px - a0)), s = 1 or -1",
        shows="For a foot inboard of the hip (Px < a0) the printed yaw is half a turn off; at Px "
        "= a0 it divides by zero.",
    ),
    Misprint(
        key="eq_10_denominator",
        where="eq. (10)",
        printed="angle ABC = arccos((AB2 + BC2 - AC2) / (2 AB AC))",
        ours="the denominator is 2 AB BC, as in (11)",
        shows="The printed knee is off by 8 degrees in the median, and for 5 % of the points its "
        "arccos does not exist.",
    ),
    Misprint(
        key="eq_11_branch",
        where="eqs (11), (14)",
        printed="theta3 = 180 deg - angle ABC only",
        ours="theta3 = e arccos((R2 - a2^2 - a3^2) / (2 a2 a3)), e = 1 or -1",
        shows="The leg with the knee on the other side reaches the same foot point and is missing.",
    ),
    Misprint(
        key="eq_12_arctan",
        where="eqs (12), (13), (14)",
        printed="angle CAZ = arctan(rho / Pz)",
        ours="angle CAZ = atan2(rho, Pz)",
        shows="For Pz < 0 the printed pitch is half a turn off; at Pz = 0 it divides by zero.",
    ),
    Misprint(
        key="eq_14_domain",
        where="eq. (14)",
        printed="given as the solution without conditions",
        ours="two branch signs, atan2 throughout, refusal outside |a2 - a3| <= R <= a2 + a3",
        shows="Exact where Px > a0 and Pz > 0, wrong at every point of the other three quarters of the workspace.",
    ),
    Misprint(
        key="eq_14_primes",
        where="eq. (14)",
        printed="a'2, a'3",
        ours="a2, a3 (with the superscript t of (10) to (13))",
        shows="No primed length is defined anywhere.",
    ),
    Misprint(
        key="eq_14_theta4",
        where="eq. (14)",
        printed="theta4 = theta4",
        ours="theta4 is passive; the foot is a ball",
        shows="(7) does not contain theta4 in p, and III.D counts three servos per leg.",
    ),
)

SPINE = (
    Misprint(
        key="table_2_columns",
        where="Table II",
        printed="columns a_i, alpha_i",
        ours="columns a_(i-1), alpha_(i-1): a0 = 50.5, a1 to a4 = 60.5 mm",
        shows="Only the shifted reading gives Pz of (15).",
    ),
    Misprint(
        key="eq_15_position",
        where="eq. (15), Px and Py",
        printed="0.5 C1 C2 C3 and 0.5 C2 C3 S1",
        ours="60.5 C1 C2 C3 C4 and 60.5 S1 C2 C3 C4",
        shows="A straight spine comes out 232.5 mm long instead of 292.5; with the change it equals Table II exactly.",
    ),
    Misprint(
        key="eq_15_theta5",
        where="eq. (15)",
        printed="the position of the torso's end",
        ours="the position of joint 5; the head follows along x5",
        shows="theta5 does not appear, so nothing beyond joint 5 is described.",
    ),
)

TAIL = (
    Misprint(
        key="eq_16_per_joint",
        where="eqs (16), (17)",
        printed="the change in length of the two strings",
        ours="the change at one joint; the cord changes by N times as much",
        shows="The hole-to-hole distances of the whole chain of plates add up to N times (16), and (18) has the N.",
    ),
    Misprint(
        key="eq_16_symbols",
        where="eqs (16)-(19)",
        printed="d, h, H without a definition",
        ours="d between the cords, h gap, H plate, pivot in the middle of the gap",
        shows="Of the joint models tried only this one gives (16) exactly; with d as a cord's "
        "offset every d would be 2 d.",
    ),
    Misprint(
        key="eq_17_slack",
        where="III.C, eq. (17)",
        printed="both cords change by the same length: the quadratic term is left out",
        ours="a slack of 4 N h sin^2(theta / 4N) always appears; one cord needs a spring",
        shows="The two exact changes of (16) do not add up to zero: -1.5 mm at 90 deg for d = 50, h = 15 mm.",
    ),
    Misprint(
        key="eq_18_degrees",
        where="eq. (18)",
        printed="phi = 180 / (pi r) N d sin(theta / 2N), degrees unstated",
        ours="phi = N d sin(theta / 2N) / r, everything in radians",
        shows="The factor 180 / pi makes phi degrees while theta, inside the sine, stays in radians.",
    ),
    Misprint(
        key="eq_19_x",
        where="eq. (19), x",
        printed="x_i = sum over j < i of (H + h) cos(i theta / N)",
        ours="x_i = (H + h) / 2 + (H + h) sum over j < i of cos(j theta / N)",
        shows="As printed, pivots 1 and 2 are half a pitch apart, and the chain of a bent tail "
        "does not keep its lengths.",
    ),
    Misprint(
        key="eq_19_y",
        where="eq. (19), y",
        printed="y_i = sum over j < i of (H + h) cos(i theta / N)",
        ours="y_i = (H + h) sum over j < i of sin(j theta / N)",
        shows="As printed, a straight tail points 45 degrees sideways: y equals x.",
    ),
)

WAVE = (
    Misprint(
        key="eq_20_sign",
        where="eq. (20)",
        printed="sin(k x + omega t)",
        ours="sin(k x - omega t), x from head to tail",
        shows="The printed wave runs from tail to head, a fish's from head to tail. The resistive model of the round "
        "body swims tail first with it, by 0.20 m/s at 1 Hz; by two-dimensional CFD the robot still goes head first, "
        "at about half the speed of the wave from head to tail.",
    ),
    Misprint(
        key="eq_20_units",
        where="eq. (20)",
        printed="c1 = 0.027, c2 = 0.30, k = 0.023 without units, no omega",
        ours="a named reading; by default lengths in body lengths and one wave per body",
        shows="No single system of units gives a fish-like amplitude and a fish-like wavelength on a body of 1 m.",
    ),
)

FORMULAS = (*LEG, *SPINE, *TAIL, *WAVE)
"""The misprints of tables and equations."""


SIGNS = (
    Misprint(
        key="bend_angle_names",
        where="III.D",
        printed="theta_q1, theta_w1 are pitch angles, theta_q2, theta_w2 yaw angles",
        ours="index 1 is lateral (left negative, right positive), index 2 vertical (up negative, down positive)",
        shows="The sentences on the signs say left and right of the first, top and bottom of the second.",
    ),
    Misprint(
        key="figure_12_for_11",
        where="III.D",
        printed="the definitions of the angles are shown in Fig. 12",
        ours="in Fig. 11",
        shows="Fig. 11 is captioned as the definition, Fig. 12 as the correspondence over time.",
    ),
)

NUMBERS = (
    Misprint(
        key="fault_75_percent",
        where="IV.C, Fig. 19",
        printed="hind yaw joint lost, no trunk: 75 % less than the intact coordinated robot",
        ours="reported beside both baselines, 0.73 and 0.16 m",
        shows="25 % of 0.73 m is 0.1825 m: the damaged robot would beat the intact one without a trunk (0.16 m).",
    ),
    Misprint(
        key="fault_55_percent",
        where="IV.C, Fig. 21",
        printed="hind pitch joint lost, no trunk: 55 % less",
        ours="reported beside both baselines, 0.73 and 0.16 m",
        shows="45 % of 0.73 m is 0.3285 m: twice what the intact robot without a trunk covers (0.16 m).",
    ),
    Misprint(
        key="fault_kind",
        where="IV.C",
        printed='"unable to receive and execute the motion commands"',
        ours="limp or locked, one leg or both: a field of the experiment",
        shows="Whether the joint hangs loose or holds, on one leg or two, and which joint the "
        "pitch joint is, is not said.",
    ),
    Misprint(
        key="actuator_count",
        where="II.B, III.A, III.C, III.D",
        printed="legs of two degrees of freedom, or one yaw and two pitch servos, or four angles",
        ours="19 actuators: 4 x 3 + 5 + 2, after III.D",
        shows="The sections' counts add up to 14, 18, 19 and 23.",
    ),
    Misprint(
        key="tail_actuator",
        where="III.C against III.D",
        printed="a servo motor with a wheel; a linear actuator",
        ours="a servo with a wheel of radius r, (18)",
        shows="Only the wheel has the radius that (18) needs.",
    ),
    Misprint(
        key="snapshots_in_one_fifth",
        where="IV.A, Fig. 14",
        printed="three selected time points within a complete crawling cycle",
        ours="phases 0.05, 0.125 and 0.2 of a cycle that begins at 1 s and takes 4 s",
        shows="All three lie in the first fifth of the cycle.",
    ),
    Misprint(
        key="times_higher",
        where="IV.D",
        printed="4.25 times higher",
        ours="4.25 times as high, 3.25 times higher",
        shows="0.68 / 0.16 = 4.25.",
    ),
    Misprint(
        key="displacement_window",
        where="IV.B, Fig. 16",
        printed="within the same simulation time",
        ours="two cycles, 8 s",
        shows="The time is not stated.",
    ),
)

NAMES = (
    Misprint(
        key="lactation",
        where="II.B, Fig. 3b",
        printed="lactation type structure",
        ours="mammal type: legs erect under the body",
        shows="It stands against the crawling type; milk has no part in it.",
    ),
    Misprint(
        key="order_name",
        where="II.A",
        printed="the biological order Alligatoridae",
        ours="the order Crocodylia; Alligatoridae is one of its families",
        shows="The next sentence lists Alligatoridae among the three families of that order.",
    ),
    Misprint(
        key="caiman_genus",
        where="II.B",
        printed="the spectacled caiman, a member of the genus Alligator",
        ours="Caiman crocodilus, genus Caiman",
        shows="Its own scientific name.",
    ),
    Misprint(
        key="largest_species",
        where="II.A",
        printed="the African Nile crocodile, the largest",
        ours="the saltwater crocodile, Crocodylus porosus",
        shows="The reference given for it, [14], is about the saltwater crocodile.",
    ),
    Misprint(
        key="smallest_species",
        where="II.A",
        printed="the Chinese alligator represents the smallest crocodile species",
        ours="Cuvier's dwarf caiman, Paleosuchus palpebrosus",
        shows="Its females grow to 1.2 m, its males to 1.4 m on average; the largest measured have 2.1 m (Campos et "
        "al. 2010, Amphibia-Reptilia 31:439), as have large Chinese alligators.",
    ),
    Misprint(
        key="high_walk_missing",
        where="II.A",
        printed='"On the other hand, sees crocodiles raising their legs"',
        ours="the High Walk sees crocodiles ...",
        shows="The sentence has lost its subject; of the modes listed before, the High Walk is the one with the legs "
        "upright beneath the body.",
    ),
)

WORDS = (*SIGNS, *NUMBERS, *NAMES)
"""The misprints of signs, numbers and names."""


ERRATA: Mapping[str, Misprint] = MappingProxyType({m.key: m for m in (*FORMULAS, *WORDS)})
"""All misprints: tables and equations first, then signs, units, numbers and names."""
