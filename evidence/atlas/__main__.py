"""Run ``python -m evidence.atlas``."""

import sys

from evidence.atlas.command import main

sys.exit(main())
