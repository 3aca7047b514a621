"""``python -m suchus.cli`` is ``suchus``."""

import sys

from suchus.cli.entry import main

if __name__ == "__main__":
    sys.exit(main())
