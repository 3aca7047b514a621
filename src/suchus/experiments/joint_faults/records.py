"""How the experiment ``joint_faults`` lays out what its runs did."""

import numpy as np
import xarray as xr

from suchus.land import KINDS, LEGS_FAILED
from suchus.metrics import swing_height, swing_lift, swing_loads, swing_unloaded


def lay(data: xr.Dataset, name: str, values: np.ndarray, more: tuple[str, ...], unit: str, what: str) -> None:
    """Put values of shape (variation, arm, 1 + fault, ...) into a dataset: the intact apart from the faults."""
    about = {"units": unit, "long_name": what}
    data[f"intact_{name}"] = (("variation", "arm", *more), values[:, :, 0], about)
    shape = (*values.shape[:2], data.sizes["joint"], len(KINDS), len(LEGS_FAILED), *values.shape[3:])
    data[name] = (("variation", "arm", "joint", "kind", "legs", *more), values[:, :, 1:].reshape(shape), about)


def support(lost_pitch: xr.Dataset) -> xr.Dataset:
    """Return what carries the body while the last limb, the right hind leg, is meant to swing."""
    leg = str(lost_pitch.leg.values[-1])
    loads = swing_loads(lost_pitch, leg).transpose("run", "part")
    lifted, free = swing_lift(lost_pitch, leg).values, swing_unloaded(lost_pitch, leg).values
    height = swing_height(lost_pitch, leg).values
    return xr.Dataset(
        {
            "support": (("state", "part"), loads.values, {"units": "N", "long_name": f"mean load while {leg} swings"}),
            "lifted": ("state", lifted, {"units": "m", "long_name": f"rise of the {leg} foot"}),
            "free": ("state", free, {"units": "1", "long_name": f"share of its swing in which the {leg} foot is free"}),
            "swing_height": ("state", height, {"units": "m", "long_name": f"centre of mass while {leg} swings"}),
        },
        coords={"state": ["intact", *KINDS], "part": [str(name) for name in loads.part.values]},
    )
