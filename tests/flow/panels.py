"""Potential flow around ellipses in the plane, by sources on panels: what added mass is held against."""

import numpy as np


def by_panels(places, a, b, count=480):
    """Return the added mass over the density of ellipses, each along x, along y and about its middle.

    What straight panels are off by falls with their number, and is taken away by that.

    Args:
        places: middle and angle of each.
        a, b: half of their length and of their width [m].
        count: panels on each.
    """
    return 2 * _on_panels(places, a, b, count) - _on_panels(places, a, b, count // 2)


def _on_panels(places, a, b, count):
    ends = np.linspace(0.0, 2 * np.pi, count + 1)
    corners = []
    for x, y, angle in places:
        px, py = a * np.cos(ends), b * np.sin(ends)
        corners.append(np.stack([x + px * np.cos(angle) - py * np.sin(angle),
                                 y + px * np.sin(angle) + py * np.cos(angle)]))  # fmt: skip
    low, top = (np.concatenate([c[:, part] for c in corners], axis=1) for part in (slice(None, -1), slice(1, None)))
    middle, along = 0.5 * (low + top), top - low
    long = np.hypot(*along)
    tangent = along / long
    normal = np.stack([tangent[1], -tangent[0]])
    off = middle[:, :, None] - middle[:, None, :]  # from panel j to point i
    x, y = (off * tangent[:, None, :]).sum(axis=0), (off * normal[:, None, :]).sum(axis=0)
    left, right = x + 0.5 * long, x - 0.5 * long
    near, far = 0.5 * np.log(right**2 + y**2), 0.5 * np.log(left**2 + y**2)
    turn = np.arctan2(y, right) - np.arctan2(y, left)
    np.fill_diagonal(turn, np.pi)
    potential = (left * far - right * near - long + y * turn) / (2 * np.pi)
    u, v = (far - near) / (2 * np.pi), turn / (2 * np.pi)
    turned, faced = ((each[:, None, :] * normal[:, :, None]).sum(axis=0) for each in (tangent, normal))
    across = u * turned + v * faced
    modes = []
    for k, (px, py, _) in enumerate(places):
        mine = slice(k * count, (k + 1) * count)
        for motion in (normal[0], normal[1], (middle[0] - px) * normal[1] - (middle[1] - py) * normal[0]):
            whole = np.zeros(len(long))
            whole[mine] = motion[mine]
            modes.append(whole)
    moved = np.array(modes)
    strength = np.linalg.solve(across, moved.T)
    return -moved * long @ (potential @ strength)
