"""A table's columns of numbers as one variable, which a file holds a hundred times faster than a hundred."""

import numpy as np
import xarray as xr

_NUMBERS, _COLUMN, _ABOUT, _ORDER = "numbers", "column", "about", "order"


def packed(table: xr.Dataset) -> xr.Dataset:
    """Return a table with all its columns of numbers along one dimension in one variable.

    Args:
        table: of which columns of 64-bit numbers have one dimension and the same; another is returned as it is.
    """
    names = [str(name) for name, column in table.data_vars.items() if column.ndim == 1 and column.dtype == float]
    dims = {table[name].dims for name in names}
    if len(dims) != 1:
        return table
    about = [[name, dict(table[name].attrs)] for name in names]  # a list: files keep no order of names
    order = [str(name) for name in table.data_vars]
    numbers = np.stack([table[name].values for name in names], axis=1)
    rest = table.drop_vars(names).assign_attrs({_ABOUT: about, _ORDER: order})
    return rest.assign({_NUMBERS: ((*dims.pop(), _COLUMN), numbers)})


def unpacked(table: xr.Dataset) -> xr.Dataset:
    """Return the table that was packed."""
    if _ABOUT not in table.attrs:
        return table
    dim, numbers = table[_NUMBERS].dims[0], table[_NUMBERS].values
    columns = {name: (dim, numbers[:, i].copy(), attrs) for i, (name, attrs) in enumerate(table.attrs[_ABOUT])}
    whole = table.drop_vars(_NUMBERS).assign(columns)[table.attrs[_ORDER]]
    whole.attrs = {name: value for name, value in table.attrs.items() if name not in (_ABOUT, _ORDER)}
    return whole
