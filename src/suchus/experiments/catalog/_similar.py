"""The numbers by which swims of other sizes are compared, as measures of an experiment."""

from suchus.experiments.experiment import Measure, Measures
from suchus.sim.metrics import SwimNumbers


def similar(numbers: SwimNumbers, ending: str = "", *, but: tuple[str, ...] = ()) -> Measures:
    """Return Reynolds, Froude, Strouhal and swimming number of a swim, see ``metrics.SwimNumbers``.

    Args:
        numbers: parameters of the swim.
        ending: ending of the names of the measures, which says whose they are.
        but: those that the experiment calls otherwise, or measures for itself.
    """
    return Measures(
        {f"{name}{ending}": Measure(value, "-") for name, value in numbers._asdict().items() if name not in but}
    )
