"""Misprints in signs, numbers, names and the text."""

from suchus.paper.misprint import Misprint

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
