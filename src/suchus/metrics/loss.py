"""What a fault costs."""

import xarray as xr


def loss(distance: xr.DataArray, intact: xr.DataArray) -> xr.DataArray:
    """Return the change of displacement against an intact run, negative where the fault costs displacement [-]."""
    return distance / intact - 1.0
