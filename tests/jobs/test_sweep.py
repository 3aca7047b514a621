"""Sweeps in processes of this machine, and with what keeps unfinished pieces."""

import os

import numpy as np
import pytest
import xarray as xr

from suchus.core.errors import InvalidDesign
from suchus.core.jobs import ProcessCrash, conduct_sweep


def squared(item, progress):
    progress("squaring", 0.5)
    if item < 0:
        raise InvalidDesign("no root of this.")
    if item > 100:
        os._exit(3)
    return xr.Dataset({"value": ((), float(item**2)), "root": ("n", np.sqrt([item, item]))})


def marked(item, progress):
    """The same, with a trace of who calculated it."""
    return squared(item, progress).assign_attrs(local=1)


@pytest.mark.slow("a second run, by processes of its own")
def test_processes_give_the_same_as_this_one(tmp_path):
    shares = []
    one = conduct_sweep("squares", squared, (1, 2, 3, 4), tmp_path / "one")
    two = conduct_sweep(
        "squares", squared, (1, 2, 3, 4), tmp_path / "two", jobs=2, progress=lambda _, share: shares.append(share)
    )
    assert [float(part.value) for part in two] == [1.0, 4.0, 9.0, 16.0]
    assert all(a.identical(b) for a, b in zip(one, two, strict=True))
    for i in range(4):
        files = [(tmp_path / name / "parts" / f"{i:06d}.nc").read_bytes() for name in ("one", "two")]
        assert files[0] == files[1]
    assert shares[-1] == 1.0
    assert max(shares) <= 1.0


@pytest.mark.slow("processes die")
def test_an_error_or_a_death_of_a_process_loses_nothing_that_was_finished(tmp_path):
    with pytest.raises(InvalidDesign, match="no root"):
        conduct_sweep("roots", squared, (4, -1), tmp_path / "a", jobs=2)
    with pytest.raises(ProcessCrash, match="at item 0 of sweep 'roots' ended with exit code 3, 3 times"):
        conduct_sweep("roots", squared, (101,), tmp_path / "b", jobs=2)


def test_what_calculates_here_may_be_another_function_than_that_of_the_workers(tmp_path):
    """Its code is no part of the store, so that a path in it does not make another sweep."""
    found = conduct_sweep("squares", squared, (5,), tmp_path / "s", local=marked)
    assert found[0].attrs["local"] == 1
    again = conduct_sweep("squares", squared, (5,), tmp_path / "s")
    assert again[0].identical(found[0])
