"""``python -m suchus`` is the command line."""

import sys

from suchus.apps.cli import main

if __name__ == "__main__":
    sys.exit(main())
