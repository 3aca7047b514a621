"""Run ``python -m evidence.league``."""

import sys

from evidence.league.command import main

sys.exit(main())
