"""The limbs of a robot that is drafted from a file: hinges, links and feet; the left limb is the pattern of a pair."""

from itertools import pairwise

import numpy as np

from suchus.design import Foot, Girdle, Limb, Link
from suchus.design.hinge import Turn
from suchus.errors import UnreadableFile
from suchus.kinematics import limb as limb_kinematics
from suchus.model.importing.draft_hinges import Match, hinge_of, limb_names, limb_turn, numbered
from suchus.model.importing.making import Making, point
from suchus.model.importing.plan import LimbChain
from suchus.model.importing.tree import Joint, TreePart

_NAMES = {1: "H", 2: "FH", 3: "FMH"}
_THIN, _FOOT = 0.1, 0.08  # radius of a link whose shape is not known, over its length; of a foot, over the limb's reach
_FOOT_SHARE = 0.1  # of the last link's mass
_POINT = 1e-6  # m; hinges nearer to each other sit in one point
_LEAST = 1e-5  # m; of a hip's distance from the midline
_ALIKE = 0.01  # of the size, or rad; sides that differ by more are noted
_POSTURES = 256


def draft_girdle(making: Making, number: int) -> Girdle:
    """Return a girdle, its place along the body still from the origin of the robot's frame.

    Raises:
        UnreadableFile: left and right have other hinges, or a hinge is skew.
    """
    left, right = making.plan.pairs[number]
    joints, others = ([j for i in chain.parts for j in making.plan.part(i).joints] for chain in (left, right))
    count = len(making.plan.pairs)
    name = _NAMES[count][number] if count in _NAMES else f"G{number + 1}"
    turns = [limb_turn(joint, making.turned(joint.axis), 1.0, making.remarks) for joint in joints]
    across = [limb_turn(joint, making.turned(joint.axis), -1.0, making.remarks) for joint in others]
    if [turn for turn, _ in turns] != [turn for turn, _ in across]:
        raise UnreadableFile(f"the limbs of {joints[0].name} and {others[0].name} have their hinges in another order.")
    labels = limb_names([j.name for j in joints], [j.name for j in others], name) or numbered([t for t, _ in turns])
    _tell_sides(making, (joints, others), [s for _, s in turns], [s for _, s in across])
    for side, those, signs in (("L", joints, turns), ("R", others, across)):
        making.matches += [
            Match(ours=f"{side}{name}_{label}", theirs=joint.name, sign=sign, zero=joint.zero)
            for label, joint, (_, sign) in zip(labels, those, signs, strict=True)
        ]
    hip = making.into(making.hip(left))
    if hip[1] < _LEAST:
        where = f"the draft has them {_LEAST:g} m beside it"
        making.remarks.append(f"The hips of girdle {name} lie in the midline; {where}.")
    limb = _limb(making, left, turns, labels, f"girdles[{number}].limb")
    return Girdle(
        name=name, segment="-", at=float(hip[0]), aside=max(float(hip[1]), _LEAST), above=float(hip[2]), limb=limb
    )


def lowest(girdle: Girdle) -> float:
    """Return the height above the axis of the lowest point that a limb's foot reaches within its ranges [m]."""
    low, high = np.array([hinge.range or (-np.pi, np.pi) for hinge in girdle.limb.hinges]).T
    angles = np.random.default_rng(0).uniform(low, high, (_POSTURES, len(low)))
    return float(limb_kinematics.forward(girdle.limb, angles)[:, 2].min()) + girdle.above


def _limb(making: Making, chain: LimbChain, turns: list[tuple[Turn, float]], labels: list[str], place: str) -> Limb:
    """Return the left limb: hinges in one point share a link, whose mass is that of the parts up to the next point."""
    parts = [making.plan.part(i) for i in chain.parts]
    stations: list[tuple[np.ndarray, list[tuple[int, Joint]], list[TreePart]]] = []
    number = 0
    for part in parts:
        for joint in part.joints:
            anchor = making.into(joint.anchor)
            if not stations or np.linalg.norm(anchor - stations[-1][0]) > _POINT:
                stations.append((anchor, [], []))
            stations[-1][1].append((number, joint))
            number += 1
        stations[-1][2].append(part)
    foot, radius = _foot(making, parts, stations[-1][0], place)
    ends = [*(anchor for anchor, _, _ in stations[1:]), foot]
    links = []
    for i, ((anchor, hinges, carried), end) in enumerate(zip(stations, ends, strict=True)):
        at = f"{place}.links[{i}]"
        made = []
        for k, (n, joint) in enumerate(hinges):
            turn, sign = turns[n]
            hinge = hinge_of(labels[n], turn, sign, joint, making.size, 1.0, lone=len(turns) == 1)
            making.note_hinge(f"{at}.hinges[{k}]", hinge, joint, sign)
            made.append(hinge)
        mass = sum(part.mass for part in carried) or 1e-3 * making.size.mass
        if not carried:
            making.notes[f"{at}.mass"] = "guess: a thousandth of the robot; the file has none between these hinges"
        last = i == len(stations) - 1
        links.append(
            Link(
                name=_link_name(carried, i, chain, making),
                hinges=tuple(made),
                end=point(end - anchor),
                radius=_radius(making, carried, float(np.linalg.norm(end - anchor)), f"{at}.radius"),
                mass=mass * (1.0 - _FOOT_SHARE) if last else mass,
            )
        )
    feet = _FOOT_SHARE / (1.0 - _FOOT_SHARE) * links[-1].mass
    making.notes[f"{place}.foot.mass"] = "guess: a tenth of the last link's mass"
    if making.words.foot_radius is not None:
        radius = making.words.foot_radius
        making.notes[f"{place}.foot.radius"] = "as asked (--foot-radius)"
    return Limb(links=tuple(links), foot=Foot(radius=radius, mass=feet))


def _link_name(carried: list[TreePart], number: int, chain: LimbChain, making: Making) -> str:
    """Return the name of a link: that of its part without the limb's, if it is called so."""
    names = [making.plan.part(i).name for i in chain.parts]
    own = carried[-1].name if carried else ""
    head, found, tail = own.partition("_")
    alike = all(name.partition("_")[0] == head for name in names)
    unique = sum(name.partition("_")[2] == tail for name in names) == 1
    return tail if found and tail and alike and unique else f"link_{number + 1}"


def _foot(making: Making, parts: list[TreePart], knee: np.ndarray, place: str) -> tuple[np.ndarray, float]:
    """Return the foot's centre in the robot's frame [m] and its radius [m]."""
    last = parts[-1]
    balls = [(making.into(piece.centre), float(piece.half[0])) for piece in last.pieces if piece.ball]
    rods = [(making.into(end), float(p.half[0])) for p in last.pieces if len(p.ends) == 2 for end in p.ends]
    for found, why in ((balls, ""), (rods, "guess: the round end of the link's rod")):
        far = [one for one in found if np.linalg.norm(one[0] - knee) > _POINT]
        if far:
            if why:
                making.notes[f"{place}.foot.radius"] = why
            return max(far, key=lambda one: float(np.linalg.norm(one[0] - knee)) + one[1])
    reach = sum(float(np.linalg.norm(two.joints[0].anchor - one.joints[0].anchor)) for one, two in pairwise(parts))
    ends = [making.into(point) for point in (*last.points, *(c for p in last.pieces for c in p.corners))]
    far_end = max(ends, key=lambda end: float(np.linalg.norm(end - knee)), default=knee)
    if np.linalg.norm(far_end - knee) < max(0.1 * reach, _POINT):
        far_end = knee - np.array([0.0, 0.0, reach or 0.2 * making.size.length])
        making.remarks.append(
            f"Nothing of the file says how far {last.name} reaches beyond its joint; the draft has its foot "
            f"{knee[2] - far_end[2]:.3g} m below."
        )
        making.notes[f"{place}.links[{len(parts) - 1}].end"] = "guess: straight down, as long as the links before it"
    elif last.pieces:
        middle = np.mean([making.into(piece.centre) for piece in last.pieces], axis=0)
        far_end = np.array([*middle[:2], far_end[2]]) if abs(far_end[2] - knee[2]) > _POINT else far_end
        making.remarks.append(f"{last.name} has no ball for a foot; the draft has the foot at its farthest end.")
    radius = _FOOT * max(reach + float(np.linalg.norm(far_end - knee)), _POINT)
    making.notes[f"{place}.foot.radius"] = "guess: a twelfth of the limb's reach; see --foot-radius"
    return far_end, max(radius, 1e-5)


def _radius(making: Making, carried: list[TreePart], length: float, place: str) -> float:
    """Return the radius of a link: of its thickest rod, else from the box around its shapes, else from its length."""
    pieces = [piece for part in carried for piece in part.pieces]
    rods = [float(piece.half[0]) for piece in pieces if len(piece.ends) == 2]
    if rods:
        return max(rods)
    making.notes[place] = "guess: from its shapes" if pieces else "guess: a tenth of its length"
    return max(min([float(np.sort(piece.half)[0]) for piece in pieces], default=_THIN * length), 1e-5)


def _tell_sides(
    making: Making, joints: tuple[list[Joint], list[Joint]], ours: list[float], theirs: list[float]
) -> None:
    """Say where the right limb is no exact mirror image of the left one."""
    for one, two, a, b in zip(*joints, ours, theirs, strict=True):
        gap = making.into(one.anchor) * np.array([1.0, -1.0, 1.0]) - making.into(two.anchor)
        line = making.turned(two.axis)
        off = float(np.linalg.norm(gap - (gap @ line) * line))
        if off > _ALIKE * making.size.length:
            making.remarks.append(
                f"{two.name} lies {off:.3g} m off the mirror image of {one.name}; the draft has the image."
            )
        if one.range and two.range:
            left, right = (sorted(sign * end for end in r) for sign, r in ((a, one.range), (b, two.range)))
            if np.abs(np.subtract(left, right)).max() > _ALIKE:
                which = f"{two.name} has another range than {one.name}"
                making.remarks.append(f"{which}; the draft has the left one on both.")
