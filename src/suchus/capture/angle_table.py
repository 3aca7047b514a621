"""Joint angles over one cycle as a CSV table, closed where the end meets the beginning."""

import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Complex, Float

from suchus.design.checks import require
from suchus.errors import UnreadableFile

LEAST_HARMONICS, MOST_HARMONICS = 4, 6
"""How many close the seam of a mean cycle: fewer lose the joints' movement, more follow the jump."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class AngleCycle:
    """The angles of some joints over one cycle that closes; nothing in it knows of a robot."""

    joints: tuple[str, ...]
    """Their names, as the table has them."""
    harmonics: Complex[np.ndarray, "joint k"]
    """Steady part and complex amplitudes of ``exp(2 pi i k phase)``, k = 0 upward [rad]."""
    residual: Float[np.ndarray, " joint"]
    """Root mean square of what the harmonics leave of the table [rad]."""
    source: str
    """File or publication that they are from."""

    def at(self, phase: Float[np.ndarray, "*batch"]) -> Float[np.ndarray, "*batch joint"]:
        """Return the angles at phases [cycle]; any whole number of cycles further they are the same [rad]."""
        k = np.arange(self.harmonics.shape[1])
        turn = np.exp(2j * np.pi * np.multiply.outer(np.asarray(phase, dtype=float), k))
        return np.asarray((turn @ self.harmonics.T).real)


def is_angle_table(path: Path) -> bool:
    """Return whether a file is a CSV table of joint angles: its first column is ``time``, a share, without a unit."""
    if path.suffix.lower() != ".csv" or not path.is_file():
        return False
    with path.open("rb") as file:
        return file.read(16).removeprefix(b"\xef\xbb\xbf").partition(b",")[0].strip() == b"time"


def read_angles(path: Path, *, harmonics: int = MOST_HARMONICS) -> AngleCycle:
    """Read a table of one cycle: ``time`` as a share of it, then an angle in degrees for every joint.

    Args:
        path: of the CSV file.
        harmonics: how many are kept, 4 to 6.

    Raises:
        InvalidDesign: the number of harmonics is out of range.
        UnreadableFile: there is no such table, or it does not hold one whole cycle.
    """
    require("angles", "harmonics", harmonics, LEAST_HARMONICS, MOST_HARMONICS, "")
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            rows = [row for row in csv.reader(file) if row]
        names, values = tuple(rows[0][1:]), np.array(rows[1:], dtype=float)
    except (OSError, UnicodeDecodeError, csv.Error, ValueError, IndexError) as error:
        raise UnreadableFile(f"{path} is no table of joint angles: a header and rows of numbers are needed.") from error
    if values.ndim != 2 or not names or rows[0][0].strip() != "time" or not np.isfinite(values).all():
        raise UnreadableFile(f"{path} is no table of joint angles: 'time' and finite angles of joints are needed.")
    phase, most = values[:, 0], 1.0 / (2 * harmonics + 1)
    steps = np.diff(np.append(phase, phase[0] + 1.0))
    if steps.min() <= 0.0 or steps.max() > most:
        raise UnreadableFile(
            f"in {path} the time does not go through one cycle, 0 to 1, in steps of at most {most:.2f} for {harmonics} "
            "harmonics."
        )
    k = 2 * np.pi * np.multiply.outer(phase, np.arange(1, harmonics + 1))
    X = np.hstack([np.ones((len(phase), 1)), np.cos(k), np.sin(k)])
    angles = np.radians(values[:, 1:])
    found = np.linalg.lstsq(X, angles, rcond=None)[0]
    cos, sin = found[1 : harmonics + 1], found[harmonics + 1 :]
    return AngleCycle(
        joints=names,
        harmonics=np.vstack([found[:1], cos - 1j * sin]).T,
        residual=np.sqrt(np.mean((angles - X @ found) ** 2, axis=0)),
        source=path.name,
    )
