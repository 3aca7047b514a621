"""How the experiment ``joint_faults`` lays out what its runs did."""

import numpy as np
import xarray as xr

from suchus.experiments._fault_findings import JOINTS
from suchus.land import KINDS, LEGS_LOST
from suchus.metrics import swing_height, swing_lift, swing_loads, swing_unloaded


def lay(data: xr.Dataset, name: str, values: np.ndarray, more: tuple[str, ...], unit: str, what: str) -> None:
    """Put values of shape (variation, arm, 1 + fault, ...) into a dataset: the intact apart from the faults."""
    about = {"units": unit, "long_name": what}
    data[f"intact_{name}"] = (("variation", "arm", *more), values[:, :, 0], about)
    shape = (*values.shape[:2], len(JOINTS), len(KINDS), len(LEGS_LOST), *values.shape[3:])
    data[name] = (("variation", "arm", "joint", "kind", "legs", *more), values[:, :, 1:].reshape(shape), about)


def support(lost_pitch: xr.Dataset) -> xr.Dataset:
    """Return what carries the body while the right hind leg is meant to swing."""
    loads = swing_loads(lost_pitch, "RH").transpose("run", "part")
    lifted, free = swing_lift(lost_pitch, "RH").values, swing_unloaded(lost_pitch, "RH").values
    height = swing_height(lost_pitch, "RH").values
    return xr.Dataset(
        {
            "support": (("state", "part"), loads.values, {"units": "N", "long_name": "mean load while RH swings"}),
            "lifted": ("state", lifted, {"units": "m", "long_name": "rise of the RH foot"}),
            "free": ("state", free, {"units": "1", "long_name": "share of its swing in which the RH foot is free"}),
            "swing_height": ("state", height, {"units": "m", "long_name": "centre of mass while RH swings"}),
        },
        coords={"state": ["intact", *KINDS], "part": [str(name) for name in loads.part.values]},
    )
