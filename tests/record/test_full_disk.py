import errno
import subprocess
import sys
from pathlib import Path

import pytest
import xarray as xr

from suchus.core.errors import Unwritable
from suchus.core.files import save

SMALL = """
import resource, sys
from pathlib import Path
import numpy as np, xarray as xr
from suchus.core.errors import Unwritable
from suchus.core.files import save
resource.setrlimit(resource.RLIMIT_FSIZE, (9000, 9000))
try:
    save(xr.Dataset({"a": ("x", np.random.default_rng(0).random(4000))}), Path(sys.argv[1]))
except Unwritable as error:
    print(error)
"""


def test_a_full_disk_is_a_sentence_and_leaves_nothing(tmp_path, monkeypatch):
    def fill(self, content):
        self.touch()
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", fill)
    with pytest.raises(Unwritable, match=r"a\.nc cannot be written: no space left on device\.$"):
        save(xr.Dataset({"a": 1}), tmp_path / "a.nc")
    assert not list(tmp_path.iterdir())


def test_a_real_limit_on_the_size_of_files_is_a_sentence(tmp_path):
    pytest.importorskip("resource", reason="this system has no limits on the size of files")
    path = tmp_path / "a.nc"
    done = subprocess.run([sys.executable, "-c", SMALL, str(path)], capture_output=True, text=True, check=True)
    assert done.stdout == f"{path} cannot be written: file too large.\n"
    assert done.stderr == ""
    assert not list(tmp_path.iterdir())
