"""What many swims warn of alike is said once, of the worst, with the options that mend it."""

import warnings
from dataclasses import dataclass, replace

import pytest

from suchus.apps.cli.run import perform
from suchus.core.errors import Doubtful, plain_warnings
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.experiment import silent

pytestmark = pytest.mark.filterwarnings("always")


def thin(size):
    return Doubtful(f"off by {size}.", kind="cells", size=size)


def test_of_a_kind_the_worst_is_said_and_of_others_each_once(capsys):
    with plain_warnings("swim", options=("--cells", "--space-cells", "--out")):
        for one in (thin(2), "it sinks.", thin(3), thin(1), "it sinks."):
            warnings.warn(one, stacklevel=1)
    assert capsys.readouterr().err.splitlines() == [
        "suchus: swim: it sinks.",
        "suchus: swim: off by 3. See --cells, --space-cells.",
    ]


def test_it_is_said_of_what_was_broken_off_and_without_options(capsys):
    def stopped():
        with plain_warnings():
            warnings.warn(thin(2), stacklevel=1)
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        stopped()
    assert capsys.readouterr().err == "suchus: off by 2.\n"


@pytest.mark.usefixtures("fakes")
def test_an_experiment_names_its_own_options(tmp_path, monkeypatch, capsys):
    @dataclass(frozen=True, kw_only=True)
    class Swim(type(EXPERIMENTS["wave"])):
        swim_cells: int = 40

        @classmethod
        def name(cls):
            return "wave"

        def simulate(self, progress=silent):
            warnings.warn(thin(2), stacklevel=1)
            return super().simulate(progress)

    perform(replace(Swim()), "wave", tmp_path / "out", silent, "again")
    assert capsys.readouterr().err == "suchus: wave: off by 2. See --swim-cells.\n"
