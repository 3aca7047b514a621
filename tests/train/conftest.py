"""A training small enough for a test."""

import pytest

pytest.importorskip("cma", reason="not installed: pip install 'suchus[optimise]'")
