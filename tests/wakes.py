"""A record of vortices around a body, made by hand."""

import numpy as np
import xarray as xr

RADIUS, CORE = 0.2, 0.06
"""Of a vortex ring around the x axis, and of the surface around it [m]."""


def ringed(frames=3, h=0.02):
    """A straight body with a vortex ring that moves along it, the half above z = 0."""
    x, y, z = np.arange(-0.1, 1.3, h) + h / 2, np.arange(-0.4, 0.4, h) + h / 2, np.arange(0.0, 0.4, h) + h / 2
    zz, yy, xx = np.meshgrid(z, y, x, indexing="ij")
    off = np.hypot(yy, zz) - RADIUS
    level = np.stack([2.0 - np.hypot(off, xx - 0.5 - 0.1 * i) / CORE for i in range(frames)])
    s = np.linspace(0.0, 1.0, 33)
    wide = 0.05 * np.sqrt(1.0 - (2.0 * s - 1.0) ** 2)
    lines = {"x": s, "y": 0.0 * s, "heading": 0.0 * s, "half_width": wide}
    return xr.Dataset(
        {
            "vortices": (("frame", "z", "y", "x"), np.round(1000 * np.maximum(level, 0.0)).astype(np.int16)),
            "spin": (("frame", "z", "y", "x"), np.stack([np.sign(yy).astype(np.int8) * 100] * frames)),
            "vortex_unit": ((), 0.004), "vortex_level": ((), 4.0), "spin_unit": ((), 0.1), "reynolds": ((), 7000.0),
            "half_height": ("station", 0.8 * wide),
            **{f"film_{name}": (("frame", "station"), np.stack([values] * frames).astype(np.float32))
               for name, values in lines.items()},
        },
        coords={"x": x, "y": y, "z": z, "frame": (np.arange(frames) + 1.0) / frames, "cells": ("grid", [64])},
    )  # fmt: skip
