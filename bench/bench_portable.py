"""What portable arithmetic costs: one crawl, in turns with the fastest routines and those of every processor.

Prints the processor time of each and their ratio, of whole processes, the least of several.
"""

import os
import resource
import subprocess
import sys

from form import in_form
from suchus.core import machine

TURNS = in_form(5, 1)
CRAWL = f"import suchus; suchus.crawl('caiman', 'belly_crawl', cycles={in_form(4, 1)})"


def seconds(environment: dict[str, str]) -> float:
    """Return the processor time of a process [s]."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([sys.executable, "-c", CRAWL], env=environment, check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main() -> None:
    """Measure and print."""
    fastest = {name: value for name, value in os.environ.items() if name not in machine.PORTABLE}
    portable = fastest | dict(machine.PORTABLE)
    turns = [(seconds(fastest), seconds(portable)) for _ in range(TURNS)]
    least = [min(column) for column in zip(*turns, strict=True)]
    times = f"fastest routines {least[0]:.2f} s, portable {least[1]:.2f} s of processor time"
    print(f"{times}: ratio {least[1] / least[0]:.2f}")


if __name__ == "__main__":
    main()
