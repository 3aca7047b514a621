"""Misprints in tables and equations."""

from suchus.paper.misprint import Misprint

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
