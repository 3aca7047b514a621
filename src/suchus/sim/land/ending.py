"""Runs of a batch that end when their answer is known, before the others."""

from typing import Protocol

import numpy as np
from jaxtyping import Bool, Float, Int


class EndRule(Protocol):
    """Says after each sample which runs of a batch have shown what they were to show, and end.

    The record of such a run ends with that sample: it is NaN from then on, ``ended`` says when, and ``cause`` is empty,
    since nothing failed. The other runs of the batch go on to the same bytes as without it.
    """

    def __call__(
        self, runs: Int[np.ndarray, " n"], time: float, phase: Float[np.ndarray, "n limb"]
    ) -> Bool[np.ndarray, " n"]:
        """Return which of some runs end now.

        Args:
            runs: numbers of the runs in the batch, increasing.
            time: time of the sample [s].
            phase: phase of the limbs of these runs [cycle].
        """
