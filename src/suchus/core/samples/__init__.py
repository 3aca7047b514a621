"""Sample data by name: small files to try capture and import with."""

from pathlib import Path

from suchus.core.errors import UnknownName

__all__ = ["SAMPLES", "sample"]

SAMPLES = {
    "lizard": "lizard.csv",
    "crawl": "crawl.csv",
    "quadruped": "quadruped.urdf",
}
"""File of each sample, beside this one.

``lizard`` and ``crawl`` are tracked keypoints as a camera above sees them, with noise and lost points, in pixels of
unknown size: of a made-up lizard in a lateral-sequence walk (duty factor 0.7, its tail a third of a cycle behind the
trunk), and of the built-in caiman in its belly crawl. ``quadruped`` is a made-up URDF of a robot with a rigid trunk
and four legs of three joints. The eighth example makes the keypoints.
"""


def sample(name: str) -> Path:
    """Return the path of a sample file, as ``suchus.animals.capture.read_tracks(suchus.sample("lizard"))`` takes it.

    Args:
        name: one of ``SAMPLES``.

    Raises:
        UnknownName: there is no such sample; the sentence names those that there are.
    """
    if name not in SAMPLES:
        raise UnknownName("sample", name, SAMPLES)
    return Path(__file__).with_name(SAMPLES[name])
