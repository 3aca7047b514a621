"""Robots and gaits as TOML files that people write, and every mistake in them named at once."""

from suchus.blueprint.mistakes import MistakenFile
from suchus.blueprint.read import described, described_robot, read
from suchus.blueprint.write import render, write

__all__ = ["MistakenFile", "described", "described_robot", "read", "render", "write"]
