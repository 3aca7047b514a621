"""A swim in three dimensions as one HTML file: the body and the surfaces around its vortices over a cycle."""

import base64
import json
from io import BytesIO
from typing import Any

import numpy as np
import xarray as xr
from markupsafe import Markup
from PIL import Image

from suchus.figures import vortices
from suchus.record import versions
from suchus.replay.page import environment
from suchus.replay.scene import PackedArrays, quantised

LARGEST = 3_500_000
"""Bytes of arrays from which the surfaces are taken of blocks of cells [-]; as text they take a third more."""
_COARSEST = 4


def wake_replay(record: xr.Dataset, *, title: str = "", caption: str = "") -> str:
    """Return a cycle of a swim as an HTML page that plays offline and needs nothing else.

    Args:
        record: of ``water.resolved`` in space with frames, or of the experiment ``swim_3d``.
        title: heading.
        caption: one or two sentences: what there is to see.

    Raises:
        IncompatibleRecord: the record holds no vortices of a swim in three dimensions.
    """
    vortices.check_filmed(record)
    meta, data = _scene(record)
    still = vortices.still(record, record.sizes["frame"] - 1)
    drawn = BytesIO()
    Image.fromarray(still).save(drawn, format="PNG", optimize=True)
    picture = base64.b64encode(drawn.getvalue()).decode("ascii")
    return environment().get_template("wake.html").render(
        title=title or "A swim in three dimensions",
        caption=" ".join(caption.split()),
        alt=f"Three-dimensional replay of a swimming body and the vortices around it, {record.sizes['frame']} instants "
        "of one cycle.",
        still=picture,
        limit=f"{meta['limit']:.3g}",
        keys={"left": vortices.hexed(1.0), "right": vortices.hexed(-1.0)},
        version=versions()["suchus"],
        meta=Markup(json.dumps(meta, separators=(",", ":")).replace("<", "\\u003c")),  # begins no tag, no comment
        data=data,
    )  # fmt: skip


def _scene(record: xr.Dataset) -> tuple[dict[str, Any], str]:
    """Return what the player gets, on the finest blocks whose surfaces are small enough."""
    for coarse in range(1, _COARSEST + 1):
        pack = PackedArrays()
        meta = _packed(record, pack, coarse)
        if pack.size <= LARGEST or coarse == _COARSEST:
            break
    return meta, pack.text()


def _packed(record: xr.Dataset, pack: PackedArrays, coarse: int) -> dict[str, Any]:
    limit = vortices.colour_limit(record)
    found = [vortices.surface(record, i, coarse=coarse) for i in range(record.sizes["frame"])]
    middle = np.array([0.5 * float(record[axis].min() + record[axis].max()) for axis in "xy"] + [0.0])
    scale = max(float(np.abs(one.points - middle).max(initial=0.0)) for one, _ in found) or 1.0
    frames = []
    for one, spin in found:
        whole = np.round((one.points - middle) / scale * np.iinfo(np.int16).max).astype(np.int16)
        shades = np.round(127.0 * np.clip(spin / limit, -1.0, 1.0)).astype(np.int8)
        small = len(whole) <= np.iinfo(np.uint16).max
        faces = pack.add(one.faces.astype(np.uint16 if small else np.uint32))
        frames.append({"points": pack.add(whole), "spin": pack.add(shades), "faces": faces})
    lines = {
        name.removeprefix("film_"): quantised(record[name].values, np.int16) for name in vortices.LINES
    }  # fmt: skip
    return {
        "frames": frames,
        "phase": np.round(record.frame.values.astype(float), 4).tolist(),
        "middle": np.round(middle, 6).tolist(),
        "scale": scale,
        "limit": limit,
        "coarse": coarse,
        "stations": record.sizes["station"],
        "length": round(float(np.ptp(record.film_x.values[0])), 4),
        "lines": {name: {"array": pack.add(values), "scale": size} for name, (values, size) in lines.items()},
        "high": pack.add(record.half_height.values.astype(np.float32)),
        "skin": vortices.SKIN,
        "ramp": np.round(vortices.colours(np.linspace(-limit, limit, 9), limit), 4).tolist(),
    }
