"""Pictures of surfaces in space, shaded, without OpenGL: triangles from far to near."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.backends.backend_agg import RendererAgg
from matplotlib.transforms import IdentityTransform

from suchus.skin.mesh import Mesh, joined, normals

_LIGHT = np.array([-0.35, 0.75, 0.56])  # to the right, up, towards the camera; of length 1
_FINER = 2  # pixels along each side of one that is shown


class Viewpoint(NamedTuple):
    """Where a picture is taken from."""

    azimuth: float
    """Direction of the camera as seen from its target, from x to y [rad]."""
    elevation: float
    """Angle of that direction above the plane of x and y [rad]."""
    distance: float
    """Distance of the camera [m]."""
    target: tuple[float, float, float]
    """Point in the middle of the picture [m]."""
    width: float
    """Width of what is seen at the target's distance [m]."""

    @property
    def axes(self) -> np.ndarray:
        """To the right, up, and towards the camera, as rows; shape (3, 3) [-]."""
        (c, s), (up, flat) = (
            (np.cos(self.azimuth), np.sin(self.azimuth)),
            (np.sin(self.elevation), np.cos(self.elevation)),
        )
        return np.array([[-s, c, 0.0], [-c * up, -s * up, flat], [c * flat, s * flat, up]])

    def seen(self, points: np.ndarray, size: tuple[int, int]) -> tuple[np.ndarray, np.ndarray]:
        """Return where points are in a picture, from its lower left corner (point, 2) [pixel], and how far off [m]."""
        right, up, near = self.axes @ (points - np.array(self.target)).T
        scale = size[0] / self.width * self.distance / (self.distance - near)
        return np.stack([0.5 * size[0] + scale * right, 0.5 * size[1] + scale * up], axis=1), self.distance - near


def picture(solid: Mesh, clear: Mesh, camera: Viewpoint, size: tuple[int, int], *, share: float = 0.8) -> np.ndarray:
    """Return a picture on white of a solid and of surfaces that it is seen through, (row, column, 3) uint8.

    Args:
        solid: surfaces that hide what is behind them.
        clear: surfaces of which the nearest lets through what is solid behind it.
        camera: where it is taken from.
        size: columns and rows [pixel].
        share: of the light that comes from the clear surfaces [-].
    """
    alone, both = (_drawn(meshes, camera, size) for meshes in ([solid], [solid, clear]))
    return np.round(share * both + (1.0 - share) * alone).astype(np.uint8)


def _drawn(meshes: Sequence[Mesh], camera: Viewpoint, size: tuple[int, int]) -> np.ndarray:
    """Return the picture of surfaces that hide what is behind them, (row, column, 3) [0 to 255]."""
    whole = joined(meshes)
    fine = (_FINER * size[0], _FINER * size[1])
    at, depth = camera.seen(whole.vertices, fine)
    corner = at[whole.faces]
    order = np.argsort(-depth[whole.faces].mean(axis=1), kind="stable")
    colours = np.column_stack([_lit(whole, camera), np.ones(len(whole.vertices))])
    renderer = RendererAgg(fine[0], fine[1], 72.0)  # type: ignore[no-untyped-call]
    gc = renderer.new_gc()
    gc.set_antialiased(False)
    if len(order):
        shades = colours[whole.faces[order]]
        renderer.draw_gouraud_triangles(gc, corner[order], shades, IdentityTransform())
    found = np.asarray(renderer.buffer_rgba())[..., :3]  # type: ignore[no-untyped-call]  # white where nothing is
    first_rows, *rest = (found[i::_FINER, j::_FINER] for i in range(_FINER) for j in range(_FINER))
    total = sum((part.astype(np.float32) for part in rest), first_rows.astype(np.float32))
    return total / _FINER**2


def _lit(mesh: Mesh, camera: Viewpoint) -> np.ndarray:
    """Return the colours of a mesh under a high light from behind the camera's left shoulder, (n, 3) [0 to 1]."""
    axes = camera.axes
    normal, light = normals(mesh), axes.T @ _LIGHT
    normal *= np.where(normal @ axes[2] < 0, -1.0, 1.0)[:, None]  # where a surface is open its other side is seen
    half = light + axes[2]
    half /= np.linalg.norm(half)
    straight = np.clip(normal @ light, 0.0, 1.0)[:, None]
    glint = np.clip(normal @ half, 0.0, 1.0)[:, None] ** 40
    facing = (normal @ axes[2])[:, None]
    shown = mesh.colours * (0.45 + 0.45 * straight + 0.2 * facing) + 0.2 * glint
    return np.clip(shown, 0.0, 1.0)
